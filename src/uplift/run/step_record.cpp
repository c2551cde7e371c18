#include "uplift/run/step_record.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "uplift/linear/memory.h"

namespace uplift {
namespace {

void note(StepRecord::Reached& reached, double value, double time) {
  if (value > reached.value) reached = {value, time};
}

/// Intervals begin and end where the smallest opening passes the tolerance, linear between two instants.
void note_loss(StepRecord::Extremes& extremes, double least, double tolerance, bool first, double before, double now) {
  const bool off = least > tolerance, was_off = !first && extremes.least_opening > tolerance;
  const auto passing = [&] {
    const double from = extremes.least_opening - tolerance, to = least - tolerance;
    return before + (now - before) * std::clamp(from / (from - to), 0.0, 1.0);  // of different signs
  };
  if (off && !was_off) extremes.full_loss.push_back({first ? now : passing(), now});
  if (was_off) extremes.full_loss.back().to = off ? now : passing();
  extremes.least_opening = least;
}

}  // namespace

void StepRecord::reserve(std::size_t interfaces, std::size_t count, std::size_t in_tail) {
  extremes.resize(interfaces);
  tail.resize(interfaces);
  for (Extremes& each : extremes) each.full_loss.reserve(each.full_loss.size() + count / 2 + 1);
  for (std::vector<BasePose>& each : tail) {
    each.reserve(each.size() + in_tail);
  }
  time.reserve(time.size() + count);
  instants.reserve(instants.size() + count * interfaces);
  provide_pages(time, most_provided / 4);
  provide_pages(instants, most_provided / 4);
}

void StepRecord::add(double now, const std::vector<InterfaceView>& views, double gap_tolerance) {
  const bool first = time.empty();
  for (std::size_t k = 0; k < views.size(); ++k) {
    const InterfaceView& view = views[k];
    const Resultant& sum = view.resultant;
    const bool plane = sum.shear_1 == 0 && sum.shear_2 == 0 && sum.moment_1 == 0 && sum.moment_2 == 0;
    instants.push_back({sum.axial, plane ? sum.shear : sum.shear_1, sum.shear_2, plane ? sum.moment : sum.moment_1, sum.moment_2,
                        view.open_area, sum.torsion, view.max_pressure});
    Extremes& most = extremes[k];
    note(most.max_opening, view.max_opening, now);
    note(most.max_pressure, view.max_pressure, now);
    note(most.tension_area, view.tension_area, now);
    note(most.penetration, -view.least_opening, now);
    note_loss(most, view.least_opening, gap_tolerance, first, first ? now : time.back(), now);
  }
  time.push_back(now);
}

void StepRecord::average(double window) {
  const std::size_t count = size(), interfaces = extremes.size();
  if (count < 2) return;
  using Part = double Instant::*;
  constexpr std::array<Part, 7> parts{&Instant::axial,    &Instant::shear_1, &Instant::shear_2, &Instant::moment_1,
                                      &Instant::moment_2, &Instant::torsion, &Instant::pressure};
  std::vector<double> integral(count);  // from the first instant; every value is the mean of the step before its instant
  for (std::size_t k = 0; k < interfaces; ++k) {
    Extremes& most = extremes[k];
    double shear = 0, moment = 0;  // squares
    for (std::size_t i = 0; i < count; ++i) {
      const Instant& now = at(i, k);
      shear = std::max(shear, now.shear_1 * now.shear_1 + now.shear_2 * now.shear_2);
      moment = std::max(moment, now.moment_1 * now.moment_1 + now.moment_2 * now.moment_2);
      most.step_compression = std::max(most.step_compression, -now.axial);
      most.step_pressure = std::max(most.step_pressure, now.pressure);
    }
    most.step_shear = std::max(most.step_shear, std::sqrt(shear));
    most.step_moment = std::max(most.step_moment, std::sqrt(moment));
    for (const Part part : parts) {
      const auto value = [&](std::size_t i) -> double& { return instants[i * interfaces + k].*part; };
      bool any = false;
      for (std::size_t i = 0; i < count; ++i) any |= value(i) != 0;
      if (!any) continue;  // in the plane
      for (std::size_t i = 1; i < count; ++i) integral[i] = integral[i - 1] + value(i) * (time[i] - time[i - 1]);
      const double first = value(0);
      std::size_t begin = 1;  // step in which the window begins
      for (std::size_t i = 1; i < count; ++i) {
        const double from = time[i] - window;
        if (time[i] - time[i - 1] >= window) continue;
        while (time[begin] < from) ++begin;
        const double before = from < time[0] ? first * (from - time[0])
                                             : integral[begin] - (integral[begin] - integral[begin - 1]) * (time[begin] - from) /
                                                                     (time[begin] - time[begin - 1]);
        value(i) = (integral[i] - before) / window;
      }
    }
    most.max_pressure = {};
    for (std::size_t i = 0; i < count; ++i) note(most.max_pressure, at(i, k).pressure, time[i]);
  }
}

void StepRecord::add_slip(const std::vector<Interface>& interfaces, const Vector& opening, const std::vector<char>& is_wall) {
  Index first = 0;
  for (std::size_t k = 0; k < interfaces.size(); ++k) {
    const Index points = interfaces[k].batch.points, tangents = interfaces[k].batch.translations() - 1;
    for (Index i = 0; is_wall[k] && tangents > 0 && i < points; ++i) {
      const double one = opening[first + i], two = tangents > 1 ? opening[first + points + i] : 0;
      note(extremes[k].max_slip, std::hypot(one, two), time.back());
    }
    first += interfaces[k].rows();
  }
}

void StepRecord::add_strength(const std::vector<InterfaceView>& views) {
  for (std::size_t k = 0; k < views.size(); ++k) {
    note(extremes[k].bearing_utilisation, views[k].bearing_utilisation, time.back());
    note(extremes[k].sliding_utilisation, views[k].sliding_utilisation, time.back());
    extremes[k].bearing_capacity = views[k].bearing_capacity;
  }
}

double StepRecord::full_loss_time(const std::vector<char>& is_wall) const {
  const auto common = [&](const auto& self, std::size_t k, double from, double to, bool any) -> double {  // of the interfaces from k on
    while (k < extremes.size() && !is_wall.empty() && is_wall[k]) ++k;
    if (k == extremes.size()) return any ? to - from : 0;
    double sum = 0;
    for (const Interval& each : extremes[k].full_loss)
      if (each.from < to && each.to > from) sum += self(self, k + 1, std::max(from, each.from), std::min(to, each.to), true);
    return sum;
  };
  return common(common, 0, -HUGE_VAL, HUGE_VAL, false);
}

std::vector<Interval> StepRecord::full_loss(const std::vector<char>& is_wall) const {
  std::optional<std::vector<Interval>> all;  // intersection over the bases
  for (std::size_t k = 0; k < extremes.size(); ++k) {
    if (!is_wall.empty() && is_wall[k]) continue;
    if (!all) {
      all = extremes[k].full_loss;
      continue;
    }
    std::vector<Interval> common;
    for (const Interval& a : *all)
      for (const Interval& b : extremes[k].full_loss)
        if (const Interval both{std::max(a.from, b.from), std::min(a.to, b.to)}; both.from < both.to) common.push_back(both);
    all = std::move(common);
  }
  return all.value_or(std::vector<Interval>{});
}

}  // namespace uplift
