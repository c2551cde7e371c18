#include "uplift/laws/cohesive.h"

#include <fmt/format.h>

#include "uplift/laws/path.h"

namespace uplift {

Point CohesiveLaw::advance(double, double from, double to, Memory old, double* now) const {
  now[0] = larger(larger(old[0], from), to);
  const double start = larger(larger(old[0], from), onset_);  // a step that begins beyond the memory begins on the envelope
  const double first = traction(start), secant = first / start;
  const bool softens = to > start;
  const double last = softens ? traction(to) : first;

  Point point;
  point.end = softens ? last : (to < 0 ? stiffness_ : secant) * to;
  point.end_slope = softens ? slope(to) : to < 0 ? stiffness_ : secant;
  const double damage_old = 1 - secant / stiffness_, damage = softens ? 1 - last / (to * stiffness_) : damage_old;
  const double damage_slope = softens ? (last / to - point.end_slope) / (to * stiffness_) : 0;
  point.damage = smoothly(damage_old, damage, damage_slope);
  point.openness = {.begin = from > 0 ? damage_old : 0, .end = to > 0 ? damage : 0, .end_slope = damage_slope};

  const Path path(from, to);
  if (!path.moves()) {
    point.mean = point.end;
    point.mean_slope = 0.5 * point.end_slope;
    point.openness.mean = point.openness.end;
    return point;
  }
  const Piece closed = path.below(0), open = path.within(0, start), broken = path.above(start);
  point.mean = closed.share * stiffness_ * closed.middle + open.share * secant * open.middle;
  point.mean_slope = closed.share * stiffness_ * closed.lever + open.share * secant * open.lever;
  point.openness.mean = open.share * damage_old + broken.share * point.damage.mean;
  // d mean/d to = (d integral/d to - mean)/(to - from), the softening part of the integral being a trapezium
  point.openness.mean_slope =
      softens ? ((1 - broken.share) * point.damage.mean - open.share * damage_old) / path.length() + broken.share * 0.5 * damage_slope
              : (point.openness.end - point.openness.mean) / (to - from);
  if (!softens) return point;

  const double mean = average(start, to);
  point.mean += broken.share * mean;
  // 1/length^2 * integral of (x - from) t'(x); for a short piece t' counts as constant, as the difference of its end values is lost in
  // round-off
  if (first - last < 1e-5 * first)
    point.mean_slope += broken.share * broken.lever * slope(0.5 * (start + to));
  else
    point.mean_slope += ((last - first) * broken.lever + broken.share * (0.5 * (first + last) - mean)) / path.length();
  return point;
}

PointEnergy CohesiveLaw::energy_at(double opening, Memory history) const {
  const double peak = larger(history[0], onset_);
  const double stiffness = opening < 0 ? stiffness_ : traction(peak) / peak;
  return {.stored = 0.5 * stiffness * opening * opening, .dissipated = dissipated(peak)};
}

double checked_fracture_energy(const Values& values) {
  const double stiffness = values.number("K_n"), strength = values.number("F_u"), energy = values.number("G_f");
  const double least = strength * strength / (2 * stiffness);
  if (!(energy > least))
    throw InputError(values.where("G_f"), values.path("G_f"),
                     fmt::format("G_f > F_u^2/(2 K_n) = {:.6g} J/m2, the energy stored when the strength is reached", least),
                     fmt::format("{:.6g} J/m2", energy));
  return energy;
}

}  // namespace uplift
