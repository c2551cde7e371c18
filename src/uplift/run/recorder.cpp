#include "uplift/run/recorder.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "uplift/math/lanes.h"
#include "uplift/run/quantities.h"

namespace uplift {
namespace {

constexpr double nothing = 0;

}  // namespace

Recorder::Recorder(const Model& model, const RunPlan& plan, const State& state, const Energies& energies, const Stepper* stepper,
                   const std::vector<InterfaceView>& views, const ForceStage& stage, long steps, double step, Recorded& result)
    : model_(model),
      state_(state),
      energies_(energies),
      stepper_(stepper),
      views_(views),
      result_(result),
      floors_(model, plan, steps, step, result),
      pictures_(model, plan, result.frames) {
  wants_acceleration_ = records_accelerations(plan);
  for (const Frame& frame : result.frames)
    for (const double share : frame.uplifted) peak_uplift_ = std::max(peak_uplift_, share);
  if (asks_for_forces(plan)) forces_ = std::make_unique<ForceRecorder>(stage, plan, stepper, state, result);
  const std::size_t expected_rows = static_cast<std::size_t>(steps / plan.every) + 2;
  const bool fresh = result_.table.empty();  // a later dynamic stage goes on in the same table
  if (fresh) {
    result_.columns = plan.requests;
    result_.table.assign(plan.requests.size() + 1, {});
  }
  for (std::vector<double>& column : result_.table) {
    column.reserve(column.size() + expected_rows + 2);
    provide_pages(column, most_provided / 2 / result_.table.size());
  }
  recent_.resize(plan.requests.size() * apart);
  for (const Request& request : plan.requests) {
    Source source = source_of(request);
    source.request = &request;
    source.to = recent_.data() + most_.size() * apart;
    if (fresh) result_.peaks.push_back({request.name, request.unit, 0, 0});
    most_.push_back(std::abs(result_.peaks[most_.size()].value));
    (source.place != nullptr ? placed_ : source.vector != nullptr ? entries_ : made_).push_back(std::move(source));
  }
  if (std::ranges::any_of(made_, [](const Source& each) { return each.in_pose != nullptr; }))
    for (std::size_t k = 0; k < plan.bases.size(); ++k) bases_.emplace_back(model, model.interfaces[k], plan.bases[k]);
  for (const CombinedRequest& request : plan.combined) {
    std::vector<std::vector<Term>>& components = combined_.emplace_back();
    bool recorded = true;
    for (const std::vector<CombinedRequest::Term>& terms : request.components) {
      std::vector<Term>& sum = components.emplace_back();
      for (const CombinedRequest::Term& term : terms) {
        const int column = term.column.empty() ? find_request(plan.requests, term.kind, term.of) : find_request(plan.requests, term.column);
        recorded = recorded && column >= 0;
        if (recorded) sum.push_back({recent_.data() + static_cast<std::size_t>(column) * apart, term.factor});
      }
    }
    if (!recorded) components.clear();
  }
  result_.combined.resize(plan.combined.size());
  if (stepper_ == nullptr) acceleration_ = Vector::Zero(model.free());
  before_ = state.time;
}

Recorder::Source Recorder::source_of(const Request& request) const {
  using What = Request::Kind;
  const auto entry_of = [&](const Vector State::*vector) {  // of one free unknown, or made from several
    Source source{.vector = vector};
    for (Sparse::InnerIterator entry(model_.expansion, request.unknown); entry; ++entry)
      source.terms.emplace_back(static_cast<int>(entry.row()), entry.value());
    if (request.below >= 0)
      for (Sparse::InnerIterator entry(model_.expansion, request.below); entry; ++entry)
        source.terms.emplace_back(static_cast<int>(entry.row()), -entry.value());
    for (const PrescribedMotion& motion : model_.motions)
      source.moved = source.moved || motion.shape[request.unknown] != 0 || (request.below >= 0 && motion.shape[request.below] != 0);
    for (auto& [unknown, factor] : source.terms) factor *= request.factor;
    if (source.moved || source.terms.size() != 1)
      source.vector = nullptr;
    else
      source.entry = source.terms.front().first, source.factor = source.terms.front().second;
    return source;
  };
  const auto row_of = [&](const Vector State::*vector, bool per_area) {
    int first = 0;
    for (int i = 0; i < request.interface; ++i) first += model_.interfaces[static_cast<std::size_t>(i)].rows();
    const Interface& interface = model_.interfaces[static_cast<std::size_t>(request.interface)];
    if (request.component >= interface.batch.components) return Source{.place = &nothing};  // free to slide: neither moved nor pulled
    return Source{.vector = vector,
                  .entry = first + request.component * interface.batch.points + request.point,
                  .factor = per_area ? 1 / interface.area[request.point] : 1.0};
  };
  switch (request.kind) {
    case What::displacement:
      return entry_of(&State::displacement);
    case What::velocity:
      return entry_of(&State::velocity);
    case What::acceleration:
    case What::absolute_acceleration:
      return entry_of(nullptr);
    case What::opening:
      return row_of(&State::opening, false);
    case What::traction:
      return row_of(&State::mean_force, true);
    case What::end_traction:
      return row_of(&State::force, true);
    case What::force:
      return {.place = forces_->value(request)};
    default:
      break;
  }
  if (const EnergyQuantity* energy = find_energy_quantity(request.kind)) return {.place = &(energies_.*energy->of)};
  const InterfaceQuantity* quantity = find_interface_quantity(request.kind, model_.space.dimension);
  assert(quantity != nullptr);  // every other kind is in one of the tables
  if (quantity->in_view == nullptr) return {.in_pose = quantity->in_pose};
  return {.place = quantity->in_view(views_[static_cast<std::size_t>(request.interface)])};
}

/// Acceleration of the relative frame along the axis of the request [m/s2].
double Recorder::ground(const Request& request, double time) const {
  return model_.ground_acceleration(model_.space.axis(model_.space.index_of(request.unknown)), time);
}

double Recorder::made(const Source& source) const {
  using What = Request::Kind;
  const Request& request = *source.request;
  const State& state = state_;
  const bool rests = stepper_ == nullptr;
  const auto sum = [&](const Vector& q, int derivative) {
    if (source.moved) {
      const auto at = [&](MotionInstant instant) {
        const double below = request.below >= 0 ? model_.full(request.below, q, derivative, instant) : 0;
        return request.factor * (model_.full(request.unknown, q, derivative, instant) - below);
      };
      return derivative == 2 ? 0.5 * (at(before_) + at(state.time)) : at(state.instant());
    }
    double total = 0;
    for (const auto& [unknown, factor] : source.terms) total += factor * q[unknown];
    return total;
  };
  switch (request.kind) {
    case What::displacement:
      return sum(state.displacement, 0);
    case What::velocity:
      return rests ? 0 : sum(state.velocity, 1);
    case What::acceleration:
      return rests ? 0 : sum(acceleration_, 2);
    case What::absolute_acceleration:
      return rests ? 0 : sum(acceleration_, 2) + 0.5 * (ground(request, before_) + ground(request, state.time));
    case What::rotation: {
      const std::array<double, 2>& slope = views_[static_cast<std::size_t>(request.interface)].rotation;
      return std::hypot(slope[0], slope[1]);
    }
    default: {
      if (source.in_pose == nullptr) return 0;
      BasePose pose;
      bases_[static_cast<std::size_t>(request.interface)].look(state, pose);
      return pose.*source.in_pose;
    }
  }
}

/// The columns that are made from several numbers.
[[gnu::noinline]] void Recorder::make(std::size_t at) {
  for (const Source& each : made_) each.to[at] = made(each);
}

void Recorder::record(bool row, double abscissa) {
  const State& state = state_;
  if (wants_acceleration_ && stepper_ != nullptr) stepper_->acceleration(acceleration_);
  if (stepper_ == nullptr || !stepper_->averages_acceleration()) before_ = state.time;
  if (floors_.any()) floors_.record(acceleration_, before_, state.time);
  if (forces_) forces_->record();
  const std::size_t at = count_;
#pragma GCC unroll 4
  for (const Source& each : placed_) each.to[at] = *each.place;
#pragma GCC unroll 4
  for (const Source& each : entries_) each.to[at] = each.factor * (state.*each.vector).data()[each.entry];
  if (!made_.empty()) make(at);
  time_[at] = abscissa;
  before_ = state.time;
  is_row_[at] = row;
  if (++count_ == many) flush();
}

void Recorder::flush() {
  const std::size_t count = std::exchange(count_, 0);
  for (std::size_t k = 0; k < most_.size(); ++k) {
    const double* recent = recent_.data() + k * apart;
    Lanes sizes = most_[k];
    for_lanes(static_cast<std::ptrdiff_t>(count), [&](const auto& at) {
      const Lanes size = absolute(at(recent));
      sizes = choose(size > sizes, size, sizes);  // never what is not a number
    });
    const double most = largest(sizes);
    if (most == most_[k]) continue;
    most_[k] = most;
    const double* peak = std::find_if(recent, recent + count, [most](double value) { return std::abs(value) == most; });
    result_.peaks[k].value = *peak, result_.peaks[k].time = time_[static_cast<std::size_t>(peak - recent)];
  }
  combine(count);
  std::array<std::size_t, many> rows;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < count; ++i)
    if (is_row_[i]) rows[kept++] = i;
  const auto append_rows = [&](std::vector<double>& column, double* numbers) {
    for (std::size_t i = 0; kept < count && i < kept; ++i) numbers[i] = numbers[rows[i]];
    column.insert(column.end(), numbers, numbers + kept);
  };
  append_rows(result_.table.front(), time_.data());
  for (std::size_t k = 0; k < most_.size(); ++k) append_rows(result_.table[k + 1], recent_.data() + k * apart);
}

void Recorder::combine(std::size_t count) {
  constexpr double less = 1 - 1e-12;  // the exact length is only taken where it may be the largest
  alignas(64) std::array<std::array<double, many>, 2> values;
  for (std::size_t k = 0; k < combined_.size(); ++k) {
    const std::vector<std::vector<Term>>& components = combined_[k];
    if (components.empty() || count == 0) continue;  // it stays unknown
    CombinedPeak& peak = result_.combined[k];
    std::array<Lanes, 2> least, most;
    for (std::size_t c = 0; c < components.size(); ++c) {
      double* to = values[c].data();
      for_lanes(static_cast<std::ptrdiff_t>(count), [&](const auto& at) {
        Lanes value = 0;
        for (const Term& term : components[c]) value += term.factor * at(term.numbers);
        at.put(to, value);
      });
      least[c] = peak.known ? peak.least[c] : to[0], most[c] = peak.known ? peak.most[c] : to[0];
    }
    Lanes longest = 0;  // squares
    for_lanes(static_cast<std::ptrdiff_t>(count), [&](const auto& at) {
      Lanes square = 0;
      for (std::size_t c = 0; c < components.size(); ++c) {
        const Lanes value = at(values[c].data(), values[c][0]);
        least[c] = choose(value < least[c], value, least[c]);  // never what is not a number
        most[c] = choose(value > most[c], value, most[c]);
        square += value * value;
      }
      longest = choose(square > longest, square, longest);
    });
    for (std::size_t c = 0; c < components.size(); ++c) peak.least[c] = smallest(least[c]), peak.most[c] = largest(most[c]);
    peak.known = true;
    if (!(largest(longest) > less * peak.value * peak.value)) continue;
    for (std::size_t i = 0; i < count; ++i) {
      const double one = values[0][i], two = components.size() > 1 ? values[1][i] : 0;
      if (!(one * one + two * two > less * peak.value * peak.value)) continue;
      const double length = components.size() == 1 ? one : std::hypot(one, two);
      if (std::abs(length) > std::abs(peak.value)) peak.value = length, peak.time = time_[i];
    }
  }
}

void Recorder::finish() {
  flush();
  pictures_.finish();
  complete_peak();
  if (peak_frame_.displacement.size() == 0) return;
  const auto next = std::ranges::lower_bound(result_.frames, peak_frame_.time, {}, &Frame::time);
  if (next == result_.frames.end() || next->time != peak_frame_.time) result_.frames.insert(next, std::move(peak_frame_));
}

void Recorder::keep(RunState& run) {
  flush();
  pictures_.finish();
  complete_peak();
  run.recorded_until = before_;
  run.peak_frame = peak_frame_;
  run.peak_uplift = peak_uplift_;
}

void Recorder::resume(const RunState& run) {
  before_ = run.recorded_until;
  peak_frame_ = run.peak_frame;
  peak_uplift_ = run.peak_uplift;
}

void Recorder::picture(const State& state) {
  pictures_.add(frame_of(state), state);
}

/// Its displacements come later.
[[gnu::noinline]] void Recorder::keep_peak(double share) {
  peak_uplift_ = share;
  peak_frame_ = frame_of(state_);
  peak_coordinates_ = state_.displacement;
  peak_load_factor_ = state_.load_factor;
}

void Recorder::complete_peak() {
  if (peak_coordinates_.size() == 0) return;
  peak_frame_.displacement = pictures_.displacement({peak_frame_.time, peak_load_factor_}, peak_coordinates_);
  peak_coordinates_.resize(0);
}

/// Without its displacements.
Frame Recorder::frame_of(const State& state) const {
  Frame frame;
  frame.time = state.time;
  int points = 0;
  for (const Interface& interface : model_.interfaces) points += interface.batch.points;
  frame.opening.resize(points);
  frame.pressure.resize(points);
  int first = 0, point = 0;
  for (std::size_t k = 0; k < model_.interfaces.size(); ++k) {
    const Interface& interface = model_.interfaces[k];
    if (interface.footprint) {  // its forces are no pressures, and its edges open before its middle
      frame.opening[point] = views_[k].max_opening;
      frame.pressure[point++] = 0;
      first += interface.rows();
      continue;
    }
    for (int i = 0; i < interface.batch.points; ++i, ++point) {
      frame.opening[point] = state.opening[first + interface.batch.normal() + i];
      frame.pressure[point] = std::max(0.0, -state.mean_force[first + interface.batch.normal() + i] / interface.area[i]);
    }
    first += interface.rows();
  }
  for (const InterfaceView& view : views_) frame.uplifted.push_back(view.open_area);
  return frame;
}

}  // namespace uplift
