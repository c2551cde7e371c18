#include "uplift/mesh/soil_box.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "uplift/base/text.h"
#include "uplift/mesh/grid.h"
#include "uplift/mesh/index.h"

namespace uplift {
namespace {

constexpr double round_off = 1e-9;  // of the soil's width or depth: lines nearer to each other are one

class Check {
 public:
  Check(const SoilBox& model, const Where& where, const std::string& path) : model_(model), where_(where), path_(path) {}
  void all() const {
    const SoilBox& m = model_;
    if (m.dimension != 2 && m.dimension != 3) refuse("dimension", "2 or 3", std::to_string(m.dimension));
    if (info(m.cell).dimension != m.dimension)
      refuse("cell", "a cell of dimension " + std::to_string(m.dimension), std::string(info(m.cell).name));
    if (!(m.growth >= 1.01 && m.growth <= 2)) refuse("growth", "a factor from 1.01 to 2", shortest(m.growth));
    soil();
    part("raft", m.raft, m.soil.width, {0, 0}, "the soil");
    const bool raft = m.raft.height > 0;
    part("block", m.block, raft ? m.raft.width : m.soil.width, raft ? m.raft.offset : std::array{0.0, 0.0}, raft ? "the raft" : "the soil");
    depth();
  }

 private:
  [[noreturn]] void refuse(const std::string& path, const std::string& wanted, const std::string& found) const {
    throw InputError(where_, path_ + path, wanted, found);
  }
  void positive(const std::string& path, double value) const {
    if (!(value > 0) || !std::isfinite(value)) refuse(path, "a length > 0 m", shortest(value) + " m");
  }
  void size(const std::string& path, double value) const {
    positive(path, value);
    const double least = model_.soil.width[0] / 1e6;  // before that many lines are made
    if (value < least)
      refuse(path, "a length of at least a millionth of the soil's width (" + shortest(least) + " m)", shortest(value) + " m");
  }
  void soil() const {
    for (int a = 0; a < model_.dimension - 1; ++a) positive("soil.width", model_.soil.width[at(a)]);
    size("soil.size", model_.soil.size);
    if (model_.soil.layers.empty()) refuse("soil.layers", "at least one layer", "none");
    for (const SoilBox::Layer& layer : model_.soil.layers) {
      positive("soil.layers.thickness", layer.thickness);
      size("soil.layers.size", layer.size);
    }
  }
  [[noreturn]] void beyond(const std::string& name, const std::string& below, double room, double width, double middle) const {
    refuse(name + ".width", "a " + name + " inside the plan of " + below + ", " + shortest(room) + " m wide",
           shortest(width) + " m with its middle at " + shortest(middle) + " m");
  }
  void part(const std::string& name, const SoilBox::Part& part, std::array<double, 2> room, std::array<double, 2> centre,
            const std::string& below) const {
    if (!(part.height >= 0) || !std::isfinite(part.height)) refuse(name + ".height", "a length >= 0 m", shortest(part.height) + " m");
    if (part.height == 0) return;
    size(name + ".size", part.size);
    for (int a = 0; a < model_.dimension - 1; ++a) {
      const double width = part.width[at(a)], offset = part.offset[at(a)] - centre[at(a)];
      positive(name + ".width", width);
      if (name == "raft" && offset != 0) refuse("raft.offset", "0 m: the raft is the middle of the model", shortest(offset) + " m");
      if (!(std::abs(offset) + width / 2 <= room[at(a)] / 2 + round_off * model_.soil.width[at(a)]))
        beyond(name, below, room[at(a)], width, part.offset[at(a)]);
    }
  }
  void depth() const {
    double all = 0;
    for (const SoilBox::Layer& layer : model_.soil.layers) all += layer.thickness;
    const double structure = model_.raft.height + model_.block.height, most = std::min(all, structure);
    if (!(structure > 0) && model_.embedment == 0) return;  // level ground
    if (!(structure > 0)) refuse("embedment", "0 m where there is neither a raft nor a block", shortest(model_.embedment) + " m");
    if (!(model_.embedment >= 0 && model_.embedment < most))
      refuse("embedment", "a depth from 0 m to less than that of the soil and the height of the structure (" + shortest(most) + " m)",
             shortest(model_.embedment) + " m");
  }
  const SoilBox& model_;
  const Where& where_;
  const std::string& path_;
};

/// A stretch of an axis on which a size is wanted.
struct Wish {
  double from, to, size;
};

/// An axis before its lines are made.
struct Axis {
  double from = 0;
  std::vector<Stretch> stretches;
  /// The least number of cells: no cell is longer than the size of its stretch.
  double least_cells() const {
    double count = 0, begin = from;
    for (const Stretch& stretch : stretches) count += std::ceil((stretch.to - begin) / stretch.size - 1e-6), begin = stretch.to;
    return count;
  }
};

/// Lines are wanted at the ends of all wishes; between two of them the least size wanted there holds.
Axis axis_for(const std::vector<Wish>& wishes) {
  std::vector<double> ends;
  for (const Wish& w : wishes) ends.insert(ends.end(), {w.from, w.to});
  std::sort(ends.begin(), ends.end());
  const double near = round_off * (ends.back() - ends.front());
  ends.erase(std::unique(ends.begin(), ends.end(), [near](double a, double b) { return b - a <= near; }), ends.end());
  Axis axis{ends.front(), {}};
  for (std::size_t i = 1; i < ends.size(); ++i) {
    const double middle = (ends[i - 1] + ends[i]) / 2;
    Stretch stretch{ends[i], HUGE_VAL};
    for (const Wish& w : wishes)
      if (w.from < middle && middle < w.to) stretch.size = std::min(stretch.size, w.size);
    axis.stretches.push_back(stretch);
  }
  return axis;
}

Axis plan_axis(const SoilBox& m, int axis) {
  const std::size_t a = at(axis);
  std::vector<Wish> wishes{{-m.soil.width[a] / 2, m.soil.width[a] / 2, m.soil.size}};
  for (const SoilBox::Part* part : {&m.raft, &m.block})
    if (part->height > 0) wishes.push_back({part->offset[a] - part->width[a] / 2, part->offset[a] + part->width[a] / 2, part->size});
  return axis_for(wishes);
}

Axis height_axis(const SoilBox& m) {
  std::vector<Wish> wishes;
  double depth = 0;
  for (const SoilBox::Layer& layer : m.soil.layers) {
    wishes.push_back({-depth - layer.thickness, -depth, layer.size});
    depth += layer.thickness;
  }
  double bottom = -m.embedment;
  for (const SoilBox::Part* part : {&m.raft, &m.block}) {
    if (!(part->height > 0)) continue;
    wishes.push_back({bottom, bottom + part->height, part->size});
    bottom += part->height;
  }
  return axis_for(wishes);
}

/// Parts by number: 0 raft, 1 block, 2 first layer of the soil, ...
enum : int { raft = 0, block = 1, first_layer = 2 };

int part_at(const SoilBox& m, const Vec3& x) {
  const double height = x[m.dimension - 1];
  const auto inside = [&](const SoilBox::Part& part, double bottom) {
    if (height < bottom || height > bottom + part.height) return false;
    for (int a = 0; a < m.dimension - 1; ++a)
      if (std::abs(x[a] - part.offset[at(a)]) > part.width[at(a)] / 2) return false;
    return true;
  };
  if (m.raft.height > 0 && inside(m.raft, -m.embedment)) return raft;
  if (m.block.height > 0 && inside(m.block, m.raft.height - m.embedment)) return block;
  double depth = 0;
  if (height < 0)
    for (std::size_t i = 0; i < m.soil.layers.size(); ++i)
      if ((depth += m.soil.layers[i].thickness) > -height || i + 1 == m.soil.layers.size()) return first_layer + static_cast<int>(i);
  return -1;
}

std::string face_name(int part, Direction direction, int other) {
  const bool soil = part >= first_layer, other_soil = other >= first_layer;
  if (other < 0) return (soil ? "soil_" : part == raft ? "raft_" : "block_") + std::string(name_of(direction));
  return soil && !other_soil ? "interface" : "";
}

}  // namespace

Mesh soil_box(const SoilBox& model, const Where& where, const std::string& path, double most) {
  Check(model, where, path).all();
  std::vector<Axis> axes{plan_axis(model, 0)};
  if (model.dimension == 3) axes.push_back(plan_axis(model, 1));
  axes.push_back(height_axis(model));
  constexpr double always = 5e7;
  const auto check_count = [&](double cells, const char* count) {
    const std::string found = count + fmt::format("{:.4g}", cells);
    if (cells > always) throw InputError(where, path + "soil.size", "sizes that make at most 50 million elements", found);
    if (cells > most)
      throw InputError(where, path + "soil.size",
                       fmt::format("sizes that make at most {:.3g} elements, whose matrices fit into memory", most), found);
  };
  double least = 1;
  for (const Axis& axis : axes) least *= std::max(1.0, axis.least_cells());
  check_count(least, "a grid of at least ");
  std::vector<std::vector<double>> lines_of_axes;
  double cells = 1;
  for (const Axis& axis : axes) {
    lines_of_axes.push_back(graded_lines(axis.from, axis.stretches, model.growth));
    cells *= static_cast<double>(lines_of_axes.back().size() - 1);
  }
  check_count(cells, "a grid of ");
  Grid lines{lines_of_axes[0], lines_of_axes[1], {}};
  if (model.dimension == 3) lines.z = lines_of_axes[2];
  std::vector<std::string> names{"raft", "block"};
  for (std::size_t i = 0; i < model.soil.layers.size(); ++i) names.push_back("soil_" + std::to_string(i + 1));
  const auto middle = [](const std::vector<double>& axis, int i) { return axis.empty() ? 0.0 : (axis[at(i)] + axis[at(i + 1)]) / 2; };
  const auto part = [&](int i, int j, int k) { return part_at(model, {middle(lines.x, i), middle(lines.y, j), middle(lines.z, k)}); };
  return with_cells(grid(lines, part, names, face_name), model.cell);
}

}  // namespace uplift
