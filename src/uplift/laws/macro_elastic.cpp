#include <algorithm>
#include <cmath>

#include "uplift/laws/macro_rows.h"

// Steps of the macro-element without yielding: nothing but the potential, in as many variables as the point has. Most steps are of this
// kind. Filtered energy decay: docs/theory/macro_element.md, eqs M29 to M32.
namespace uplift {
namespace {

/// How far a force (N, M_i) is from pulling at an edge, see macro_filter.cpp.
template <int R>
double reserve(const MacroElasticity& ground, const Vec3& force) {
  const double one = 2 * std::abs(force[1]) / ground.length[0];
  if constexpr (R == 1) return force[0] - one;
  const double two = 2 * std::abs(force[2]) / ground.length[1];
  return force[0] - (ground.disc ? std::sqrt(one * one + two * two) : std::max(one, two));
}

}  // namespace

/// The joint filter of the torsion, which takes effect as far as that of the other rows.
void MacroElement::Rows::filter_torsion(const MacroFilter& filter, double coefficient, const Batch& batch, const double* from,
                                        const double* to, const LawResponse& response) const {
  if (!has_torsion()) return;
  const int last = at(components - 1);
  const double whole = coefficient * (to[last] - from[last]) - batch.lag[last];
  response.plain[last] = response.traction[last];
  response.traction[last] += filter.share * whole;
  if (response.slope == nullptr) return;
  response.slope[at(components - 1, components - 1)] += filter.share * coefficient;
  for (int c = 0; c < count; ++c) response.slope[at(components - 1, c)] = whole * sign(c) * filter.share_slope[variable[c]];
}

/// A footing without contact at the start of the step: the forces at its end, where that dissipates.
void MacroElement::Rows::take_end(const double* from, const double* to, const LawResponse& response) const {
  double gained = 0;
  for (int r = 0; r < components; ++r) {
    response.plain[at(r)] = response.traction[at(r)];
    gained += (response.end[at(r)] - response.traction[at(r)]) * (to[at(r)] - from[at(r)]);
  }
  if (!(gained >= 0)) return;
  for (int r = 0; r < components; ++r) response.traction[at(r)] = response.end[at(r)];
  if (response.slope == nullptr) return;
  for (int r = 0; r < components; ++r)
    for (int c = 0; c < components; ++c) response.slope[at(r, c)] = 2 * response.next[at(r, c)];
}

/// The whole step without yielding, in contact at its end, with the whole filter where there is one. False where it is not so. R: axes of
/// rocking.
template <int R>
bool MacroElement::go_elastically(bool average, const Batch& batch, const Rows& rows, const double* from, const double* to,
                                  const double* old, const LawResponse& response) const {
  constexpr int normal = Rows::normal<R>, last = Rows::of_point<R> - 1;
  const MacroVector& closed = uplift_.stiffness();
  const auto row = [&](int i) { return rows.at(Rows::rotation<R>[i]); };
  const auto shear = [&](const double* q, int i) { return closed[macro_h1 + i] * (q[rows.at(i)] - old[rows.at(i)]); };
  const Vec3 after = rows.rocking<R>(to, old);
  const MacroRocking& end = uplift_.recall<R>(after);
  if (!end.contact) return false;
  if (surfaces_.has_bearing() || surfaces_.has_sliding()) {
    MacroVector force = MacroVector::Zero();
    force[macro_n] = end.force[0];
    for (int i = 0; i < R; ++i) force[macro_h1 + i] = shear(to, i), force[macro_m1 + i] = end.force[1 + i];
    if (!macro_holds(surfaces_, force, old[rows.at(rows.count)])) return false;
  }
  const auto put = [&](const Vec3& force, double before, double behind, double* out) {  // shares of the shear at either end
    out[rows.at(normal)] = -force[0];
    for (int i = 0; i < R; ++i) out[row(i)] = force[1 + i];
    for (int i = 0; i < R; ++i) out[rows.at(i)] = behind * shear(to, i) + (before > 0 ? before * shear(from, i) : 0);
  };
  if (average) {
    const Vec3 before = rows.rocking<R>(from, old);
    const MacroRocking& begin = uplift_.recall<R>(before);
    const int filter = batch.coefficient == nullptr ? 0 : batch.coefficient[rows.point] > 0 ? 1 : -1;
    if (filter > 0 && !begin.contact) return false;  // at rest
    MacroUplift::RockingAverage mean = uplift_.average<R>(before, begin, after, end, false);
    double share = 0.5;  // of the stiffness of shear and torsion
    if (filter > 0) {
      const double gain = batch.gain;
      Vec3 pull = Vec3::Zero();
      pull[0] = -batch.lag[rows.at(normal)];
      for (int i = 0; i < R; ++i) pull[1 + i] = batch.lag[row(i)];
      const Vec3 filtered = mean.force + gain * (begin.stiffness * (after - before)) - pull;
      const MacroElasticity& ground = uplift_.elasticity();
      if (!(reserve<R>(ground, filtered) >= std::min(0.0, reserve<R>(ground, mean.force)))) return false;
      put(mean.force, 0.5, 0.5, response.plain);
      put(filtered, 0.5, 0.5, response.traction);
      for (int i = 0; i < R; ++i) {
        const int at = rows.at(i);
        response.traction[at] += gain * closed[macro_h1 + i] * (to[at] - from[at]) - batch.lag[at];
      }
      if constexpr (R == 2) {
        const int at = rows.at(last);
        response.plain[at] = response.traction[at];
        response.traction[at] += gain * torsion_ * (to[at] - from[at]) - batch.lag[at];
      }
      mean.by_to += gain * begin.stiffness;
      share += gain;
    } else {
      put(mean.force, begin.contact ? 0.5 : 0, 0.5, response.traction);
    }
    if (response.slope != nullptr) rows.put_elastic<R>(mean.by_to, 1, share, closed, torsion_, response.slope);
    if (response.end != nullptr) put(end.force, 0, 1, response.end);
    if (response.next != nullptr) rows.put_elastic<R>(end.stiffness, 0.5, 0.5, closed, torsion_, response.next);
    if (filter < 0) rows.take_end(from, to, response);
  } else {
    put(end.force, 0, 1, response.traction);
    if (response.slope != nullptr) rows.put_elastic<R>(end.stiffness, 1, 1, closed, torsion_, response.slope);
  }
  if (response.now != nullptr)
    for (int k = 0; k < rows.count + macro_scalars; ++k) response.now[rows.at(k)] = old[rows.at(k)];
  return true;
}

template bool MacroElement::go_elastically<1>(bool, const Batch&, const Rows&, const double*, const double*, const double*,
                                              const LawResponse&) const;
template bool MacroElement::go_elastically<2>(bool, const Batch&, const Rows&, const double*, const double*, const double*,
                                              const LawResponse&) const;

/// The torsion of every step.
void MacroElement::put_torsion(bool average, const Rows& rows, const double* from, const double* to, const LawResponse& response) const {
  const int last = rows.at(rows.components - 1);
  response.traction[last] = torsion_ * (average ? 0.5 * (from[last] + to[last]) : to[last]);
  if (response.slope != nullptr) rows.put_torsion(average ? 0.5 * torsion_ : torsion_, response.slope);
  if (response.end != nullptr) response.end[last] = torsion_ * to[last];
  if (response.next != nullptr) rows.put_torsion(0.5 * torsion_, response.next);
}

/// See InterfaceLaw::elastic.
template <int R>
void MacroElement::put_elastic(const Rows& rows, const double* opening, const double* history, double* elastic, double* slope) const {
  const Vec3 q = rows.rocking<R>(opening, history);
  bool at_rest = q.isZero(0);
  for (int r = 0; r < rows.count; ++r) {
    elastic[r] = opening[r] - history[r];
    at_rest = at_rest && elastic[r] == 0;
  }
  if constexpr (R == 2) elastic[Rows::of_point<R> - 1] = opening[Rows::of_point<R> - 1];
  const MacroRocking state = at_rest ? uplift_.rock<R>(q, true, true) : uplift_.recall<R>(q);
  const double share = state.contact ? 1 : 0;
  rows.put_elastic<R>(state.stiffness, share, share, uplift_.stiffness(), torsion_, slope);
}

void MacroElement::elastic(int components, const double* opening, const double* history, double* elastic, double* slope) const {
  const Rows rows(1, 0, components);
  rows.has_torsion() ? put_elastic<2>(rows, opening, history, elastic, slope) : put_elastic<1>(rows, opening, history, elastic, slope);
}

}  // namespace uplift
