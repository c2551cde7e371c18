#include "uplift/analysis/verdict_quantities.h"

#include <algorithm>
#include <array>

namespace uplift {
namespace {

constexpr bool whole = false, at_least = true;

constexpr std::array<VerdictQuantity, 30> quantities{{
    {"max_top_motion", "m", "largest motion of the top", whole},
    {"change_of_top_motion", "1", "change of the motion of the top against the bonded run", whole},
    {"max_uplifted_ratio", "1", "largest share of the area with a gap"},
    {"uplifted_time", "s", "time with a gap anywhere"},
    {"first_uplift", "s", "when a gap opens first"},
    {"max_opening", "m", "largest gap"},
    {"max_toe_pressure", "Pa", "largest pressure of all points"},
    {"toe_pressure_ratio", "1", "largest pressure over the static mean W/A"},
    {"max_eccentricity", "1", "largest eccentricity over the width, e/B"},
    {"max_eccentricity_1", "1", "in space: largest eccentricity along t1 over the width"},
    {"max_eccentricity_2", "1", "in space: largest eccentricity along t2 over the width"},
    {"min_overturning_safety", "1", "least safety against overturning, stabilising over driving moment about the toe", true, at_least},
    {"min_sliding_safety", "1", "least safety against sliding, (mu N + c A)/V", true, at_least},
    {"full_loss_time", "s", "time without any contact"},
    {"longest_full_loss", "s", "longest interval without any contact"},
    {"max_shear", "N", "largest base shear"},
    {"change_of_shear", "1", "change of the base shear against the bonded run"},
    {"max_moment", "N m", "largest base moment"},
    {"change_of_moment", "1", "change of the base moment against the bonded run"},
    {"max_compression", "N", "largest compression of the base"},
    {"change_of_compression", "1", "change of the largest compression against the bonded run"},
    {"min_compression", "N", "least compression of the base", true, at_least},
    {"linear_tension_ratio", "1", "largest share of the area that pulls in the bonded run"},
    {"predicted_uplifted_ratio", "1", "uplift that this share stands for by equal energy, Winkler strip"},
    {"residual_rotation", "rad", "tilt that is left at the end"},
    {"residual_settlement", "m", "settlement that is left at the end"},
    {"residual_slip", "m", "slip that is left at the end"},
    {"residual_opening", "m", "largest gap at the end"},
    {"residual_uplifted_ratio", "1", "share of the area with a gap at the end"},
    {"max_penetration", "m", "largest interpenetration of closed points"},
}};

}  // namespace

std::span<const VerdictQuantity> verdict_quantities() {
  return quantities;
}

const VerdictQuantity* find_verdict_quantity(std::string_view name) {
  const auto found = std::ranges::find(quantities, name, &VerdictQuantity::name);
  return found == quantities.end() ? nullptr : &*found;
}

}  // namespace uplift
