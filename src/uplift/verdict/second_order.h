#pragma once
#include <optional>
#include <string>

#include "uplift/verdict/numbers.h"

namespace uplift {

/// What the weight adds to the base moment because the structure has moved: second-order effects, which a run without p_delta leaves out,
/// and any run of solids (docs/theory, eq 31b).
struct SecondOrderMoment {
  double weight = 0;                                       // N, see swaying_weight()
  double drift = 0;                                        // m, of the top relative to the base, its largest
  double base_moment = 0;                                  // N m, the largest without second-order effects
  double least_left = 0;                                   // N m: least of stabilising less driving moment; infinite where nothing drives
  double stabilising = 0;                                  // N m: at that instant
  bool forced = false;                                     // forces on the structure act, and nothing moves the ground
  bool p_delta = false;                                    // the run has second-order effects, and solids have none
  bool solids = false;                                     // a part that counts stands on solids
  double moment() const { return weight * drift; }         // N m
  double ratio() const { return moment() / base_moment; }  // 1
  /// A warning is due: more than a tenth of the base moment, the limit of EN 1998-1, 4.4.2.2, and more than 1e-4 of the stabilising
  /// moment. Where less tilts the base, the base moment is what the ground's unevenness or round-off makes of the weight.
  bool counts() const;
  bool exceeds_what_is_left() const { return counts() && moment() > least_left; }
  /// Where forces act, which do not give way: more than is left of the capacity. Where the ground moves: more than half of the stabilising
  /// moment, from which on the rotation that was reached has more energy than the way over the edge takes.
  bool overturns() const;
  /// The warning, and what stands behind the headline; empty where there is nothing to say.
  std::string warning() const;
  std::string clause() const;
};

/// The weight that, at the height of the top, has the same moment under a drift which grows in proportion to the height as all dead loads
/// on what stands on the first base: sum of W_i h_i/H [N], heights from the base node. 0 without a height.
double swaying_weight(const BuiltCase& built);

/// Of a run on one base; with p_delta what stands on solids, which have no geometric stiffness. Nothing on several bases, without a drift
/// or a base moment that is more than noise.
std::optional<SecondOrderMoment> second_order_of(const BuiltCase& built, const RunResult& run, const VerdictNumbers& numbers);

}  // namespace uplift
