#pragma once
#include "uplift/laws/filter.h"
#include "uplift/laws/fused.h"
#include "uplift/math/lanes.h"

// The pass itself, for laws that write their formulas for one register of points.
namespace uplift {

/// Of a law, for the points of one register: `straight(from, to, old)` the averages of paths without a bend, `bends(from, to, old)`,
/// `average(from, to, old)` those of any path; both with the members value, slope (path average and its derivative with respect to `to`),
/// end and end_slope (traction and slope at `to`). `twice_stored(to, old, end)`: twice the energy at the end [J/m2]. `remembers`: there is
/// one memory value, and `changes(from, to, old)` is true where it may not stay. False where that is so: what was made is of no use then.
/// `rises`: the traction never falls with the opening. `filters`: with the joint filter; `tension`: the law carries tension.
template <int R, bool filters, bool tension, class Law>
[[gnu::always_inline]] inline bool evaluate_points(const Law law, const FusedEvaluation evaluation) {
  Lanes pull[R] = {}, end_pull[R] = {}, gram[R][R] = {}, stored = 0;
  LaneMask changed(false);
  for_lanes(
      evaluation.points, [&](const auto& at) __attribute__((always_inline)) {
        Lanes column[R], to = at(evaluation.free);
        for (int r = 0; r < R; ++r) {
          column[r] = at(evaluation.factor + r * evaluation.stride);
          to += column[r] * evaluation.z[r];
        }
        const Lanes from = at(evaluation.from);
        Lanes old = 0;
        if constexpr (Law::remembers) {
          old = at(evaluation.old);
          changed = changed || law.changes(from, to, old);
          at.put(evaluation.now, old);
        }
        auto path = law.straight(from, to, old);
        if (any(law.bends(from, to, old))) path = law.average(from, to, old);
        if constexpr (filters) {
          at.put(evaluation.plain, path.value);
          filter_normal(path.value, path.slope, path.end, path.end_slope, Lanes(to - from), Lanes(at(evaluation.coefficient)),
                        Lanes(at(evaluation.lag)), tension, Law::rises);
        }
        const Lanes area = at(evaluation.area), weight = evaluation.scale * area;
        const Lanes force = weight * path.value, slope = weight * path.slope, end = weight * path.end;
        stored += area * law.twice_stored(to, old, path.end);
        at.put(evaluation.opening, to);
        at.put(evaluation.force, force);
        at.put(evaluation.slope, slope);
        at.put(evaluation.end, path.end);
        at.put(evaluation.next, 0.5 * path.end_slope);
        for (int s = 0; s < R; ++s) {
          const Lanes weighted = slope * column[s];
          pull[s] += column[s] * force;
          end_pull[s] += column[s] * end;
          for (int r = s; r < R; ++r) gram[s][r] += weighted * column[r];
        }
      });
  for (int s = 0; s < R; ++s) {
    evaluation.pull[s] = sum(pull[s]);
    evaluation.end_pull[s] = sum(end_pull[s]);
    for (int r = s; r < R; ++r) evaluation.stiffness[s * R + r] = evaluation.stiffness[r * R + s] = sum(gram[s][r]);
  }
  *evaluation.stored = 0.5 * sum(stored);
  return !any(changed);
}

template <bool filters, bool tension, class Law>
bool evaluate_columns(const Law& law, const FusedEvaluation& evaluation) {
  switch (evaluation.columns) {
    case 1:
      return evaluate_points<1, filters, tension>(law, evaluation);
    case 2:
      return evaluate_points<2, filters, tension>(law, evaluation);
    case 3:
      return evaluate_points<3, filters, tension>(law, evaluation);
    default:
      return false;
  }
}

template <class Law>
bool evaluate_points(const Law& law, const FusedEvaluation& evaluation, bool tension) {
  if (evaluation.coefficient == nullptr) return evaluate_columns<false, false>(law, evaluation);
  return tension ? evaluate_columns<true, true>(law, evaluation) : evaluate_columns<true, false>(law, evaluation);
}

}  // namespace uplift
