#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include "uplift/io/report/parts.h"

namespace uplift {
namespace {

// Levels from zero to the largest value. The largest displacement is drawn about 60 pixels long: one level is far below a pixel.
constexpr int levels_of_displacements = 4095, levels_of_points = 32767;

/// Values of all frames as whole levels of one unit. A level is written as its difference to that of the frame before, less the same
/// difference `stride` entries earlier (a neighbouring node or point): compressed, this takes half a byte to one byte per value. What is
/// not finite is written as zero. A value above `nonzero` keeps at least one level: of a gap the sign tells open from closed.
class QuantisedFrames {
 public:
  QuantisedFrames(JsonWriter& json, double largest, int levels, std::size_t stride, double nonzero)
      : json_(json), unit_(largest > 0 ? largest / levels : 1), nonzero_(nonzero), stride_(stride) {
    json_.begin_object().member("unit", unit_).member("stride", static_cast<long>(stride)).key("differences").begin_array();
  }
  void add(std::span<const double> values) {
    levels_.resize(values.size());
    changes_.resize(values.size());
    for (std::size_t i = 0; i < values.size(); ++i) {
      double level = std::isfinite(values[i]) ? std::round(values[i] / unit_) : 0;
      if (values[i] > nonzero_) level = std::max(level, 1.0);
      changes_[i] = level - std::exchange(levels_[i], level);
    }
    differences_ = changes_;
    for (std::size_t i = stride_; i < values.size(); ++i) differences_[i] -= changes_[i - stride_];
    json_.numbers(differences_);
  }
  void end() { json_.end_array().end_object(); }

 private:
  JsonWriter& json_;
  double unit_, nonzero_;
  std::size_t stride_;
  std::vector<double> levels_, changes_, differences_;
};

double largest_of(std::span<const double> values) {
  double largest = 0;
  for (const double value : values)
    if (std::isfinite(value)) largest = std::max(largest, std::abs(value));
  return largest;
}

/// Values of the interfaces' points in the frames, by interface.
void write_points(JsonWriter& json, std::string_view key, const BuiltCase& built, const std::vector<const Frame*>& frames,
                  Vector Frame::*field) {
  json.key(key).begin_object();
  Index first = 0;
  for (const Interface& joint : built.model.interfaces) {
    const auto values = [&](const Frame& frame) {
      return std::span<const double>((frame.*field).data() + first, static_cast<std::size_t>(joint.batch.points));
    };
    double largest = 0;
    for (const Frame* frame : frames) largest = std::max(largest, largest_of(values(*frame)));
    json.key(joint.name);
    QuantisedFrames quantised(json, largest, levels_of_points, 1, built.plan.gap_tolerance);
    for (const Frame* frame : frames) quantised.add(values(*frame));
    quantised.end();
    first += joint.batch.points;
  }
  json.end_object();
}

/// So many frames, evenly chosen, that the report stays small; the one of the largest uplift is among them.
std::vector<const Frame*> chosen_frames(const Model& model, const RunResult& result, std::size_t nodes) {
  const std::size_t most = most_pictures_in_space(nodes);
  const std::size_t every = std::max<std::size_t>((result.frames.size() + most - 1) / most, 1);
  const auto share = [&](const Frame& frame) { return uplifted_share(model, frame); };
  const Frame* peak = &*std::ranges::max_element(result.frames, {}, share);
  std::vector<const Frame*> frames;
  for (std::size_t i = 0; i < result.frames.size(); ++i)
    if (i % every == 0 || &result.frames[i] == peak || i + 1 == result.frames.size()) frames.push_back(&result.frames[i]);
  return frames;
}

/// Displacements (or rotations) of nodes, three numbers each.
std::vector<double> motion_of(const BuiltCase& built, const Frame& frame, std::span<const int> nodes, bool rotation) {
  const Space space = built.model.space;
  const std::vector<int>& pictured = built.plan.pictured;
  std::vector<double> numbers;
  for (const int node : nodes) {
    const Index place = pictured.empty() ? node : std::ranges::lower_bound(pictured, node) - pictured.begin();
    for (int k = 0; k < 3; ++k) numbers.push_back(frame.displacement[space.unknowns() * place + k + (rotation ? space.dimension : 0)]);
  }
  return numbers;
}

void write_displacements(JsonWriter& json, const BuiltCase& built, const std::vector<const Frame*>& frames, const std::vector<int>& nodes) {
  double largest = 0;
  for (const Frame* frame : frames) largest = std::max(largest, largest_of(motion_of(built, *frame, nodes, false)));
  json.key("displacement");
  QuantisedFrames quantised(json, largest, levels_of_displacements, 3, std::numeric_limits<double>::infinity());
  for (const Frame* frame : frames) quantised.add(motion_of(built, *frame, nodes, false));
  quantised.end();
}

}  // namespace

void write_space_animation(JsonWriter& json, const DrawnParts& parts, const ReportRun& run, const std::vector<int>& nodes) {
  const BuiltCase& built = *run.built;
  const std::vector<const Frame*> frames = chosen_frames(built.model, *run.result, nodes.size());
  json.begin_object().member("run", run.result->label).key("time").begin_array();
  for (const Frame* frame : frames) json.value(frame->time);
  json.end_array();
  write_uplifted(json, built.model, frames);
  write_displacements(json, built, frames, nodes);
  json.key("rotation").begin_object();
  for (const DrawnParts::Body& body : parts.bodies) {
    if (body.foundation) continue;
    json.key(built.facts[body.interface].body).begin_array();
    for (const Frame* frame : frames) json.numbers(motion_of(built, *frame, {&body.node, 1}, true));
    json.end_array();
  }
  json.end_object();
  write_points(json, "openings", built, frames, &Frame::opening);
  write_points(json, "pressures", built, frames, &Frame::pressure);
  json.end_object();
}

}  // namespace uplift
