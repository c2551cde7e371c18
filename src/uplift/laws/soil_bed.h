#pragma once
#include <optional>

#include "uplift/laws/soil_stiffness.h"
#include "uplift/math/quadrature.h"

// A bed of springs that is stiffer towards the edges, so that it has both the vertical and the rocking stiffness of the ground:
// docs/theory/soil_stiffness.md, eqs (H14) to (H17).
namespace uplift {

/// What the ground of a footing gives to the points of a joint.
struct BedOfSoil {
  double normal = 0, tangential = 0;  // Pa/m: mean K_n and K_t; in space K_t is the mean of both directions
  double damping = 0;                 // Pa s/m: mean c; 0: no formula, or no density
  // Rocking stiffness over that of a uniform bed with the same K_n, for tilting the width and the length; 0: no formula
  double ratio_width = 0, ratio_length = 0;
};
BedOfSoil bed_of_soil(const FootingOnSoil&, int dimension);

/// The stiffest place of a bed has at most this many times the stiffness of the softest.
inline constexpr double most_contrast = 1e9;

/// The ratios that the points of one side can have, ends included.
struct BedReach {
  double least = 0, most = 0;
};
BedReach bed_reach(const Quadrature& points);

/// The exponent c of (H15); none where the points cannot have this ratio.
std::optional<double> bed_exponent(const Quadrature& points, double ratio);
/// Stiffness at the points of one side over its mean (H15), whose sums have the ratio (H16) to round-off; none where the points cannot have
/// it.
std::optional<Vector> bed_distribution(const Quadrature& points, double ratio);

/// Stiffness of a continuous bed over its mean; none where no bed has the ratio.
struct BedProfile {
  double middle = 0, edge = 0;
};
std::optional<BedProfile> bed_profile(double ratio);

}  // namespace uplift
