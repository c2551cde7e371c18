#include "uplift/analysis/verdict_quantities.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "uplift/analysis/wording.h"

namespace uplift {
namespace {

constexpr bool whole = false, at_least = true;

constexpr std::array<VerdictQuantity, 38> quantities{{
    {"max_top_motion", "m", "largest horizontal motion of the top, in space of either axis", "top motion", whole},
    {"change_of_top_motion", "1", "change of the motion of the top against the bonded run", "change of top motion", whole},
    {"max_uplifted_ratio", "1", "largest share of the area with a gap", "uplifted area"},
    {"uplifted_time", "s", "time with a gap anywhere", "time with a gap"},
    {"first_uplift", "s", "when a gap opens first", "first opening"},
    {"max_opening", "m", "largest gap", "largest gap"},
    {"max_toe_pressure", "Pa", "largest pressure of all points", "largest pressure"},
    {"toe_pressure_ratio", "1", "largest pressure over the static mean W/A", "pressure over static mean"},
    {"max_eccentricity", "1", "largest eccentricity over the width, e/B", "eccentricity e/B"},
    {"max_eccentricity_1", "1", "in space: largest eccentricity along t1 over the width", "e/B along t1"},
    {"max_eccentricity_2", "1", "in space: largest eccentricity along t2 over the width", "e/B along t2"},
    {"min_overturning_safety", "1", "least safety against overturning, stabilising over driving moment about the toe",
     "safety against overturning", true, at_least},
    {"min_sliding_safety", "1", "least safety against sliding, (mu N + c A)/V", "safety against sliding", true, at_least},
    {"full_loss_time", "s", "time without any contact", "time without contact"},
    {"longest_full_loss", "s", "longest interval without any contact", "longest loss of contact"},
    {"max_shear", "N", "largest base shear", "base shear"},
    {"change_of_shear", "1", "change of the base shear against the bonded run", "change of base shear"},
    {"max_moment", "N m", "largest base moment", "base moment"},
    {"change_of_moment", "1", "change of the base moment against the bonded run", "change of base moment"},
    {"max_compression", "N", "largest compression of the base", "largest compression"},
    {"change_of_compression", "1", "change of the largest compression against the bonded run", "change of compression"},
    {"min_compression", "N", "least compression of the base", "least compression", true, at_least},
    {"linear_tension_ratio", "1", "largest share of the area that pulls in the bonded run", "tension area, bonded run"},
    {"predicted_uplifted_ratio", "1", "uplift that this share stands for by equal energy, Winkler strip", "uplift by equal energy"},
    {"residual_rotation", "rad", "tilt that is left at the end", "tilt left"},
    {"residual_settlement", "m", "settlement that is left at the end", "settlement left"},
    {"residual_slip", "m", "slip that is left at the end", "slip left"},
    {"residual_opening", "m", "largest gap at the end", "gap left"},
    {"residual_uplifted_ratio", "1", "share of the area with a gap at the end", "uplifted area left"},
    {"max_penetration", "m", "largest compression of the joint where it is closed (interpenetration)", "compression of the joint"},
    {"max_beam_compression", "N", "largest compression in a beam with an envelope", "compression of the beam", whole, false, true},
    {"max_beam_tension", "N", "largest tension in a beam", "tension of the beam", whole, false, true},
    {"max_beam_shear", "N", "largest shear force in a beam, in space of both axes together", "shear of the beam", whole, false, true},
    {"change_of_beam_shear", "1", "change of the largest shear force compared with the bonded run", "change of beam shear", whole, false,
     true},
    {"max_beam_moment", "N m", "largest bending moment in a beam, in space of both axes together", "moment of the beam", whole, false,
     true},
    {"change_of_beam_moment", "1", "change of the largest bending moment compared with the bonded run", "change of beam moment", whole,
     false, true},
    {"max_storey_shear", "N", "largest of the storey shears that are recorded", "storey shear", whole},
    {"max_drift_ratio", "1", "largest of the drift ratios that are recorded", "drift ratio", whole},
}};

}  // namespace

std::span<const VerdictQuantity> verdict_quantities() {
  return quantities;
}

bool is_share(const VerdictQuantity& quantity) {
  return quantity.name.starts_with("change_of") || quantity.name.ends_with("uplifted_ratio") || quantity.name == "linear_tension_ratio";
}

bool near_zero(const VerdictQuantity& quantity) {
  return is_share(quantity) || quantity.name.starts_with("residual") || quantity.name == "first_uplift";
}

double nothing_beside(std::string_view unit) {
  if (unit == "m" || unit == "rad") return 1e-9;
  return unit == "1" ? 1e-6 : 0;
}

std::string said(const VerdictQuantity& quantity, double value) {
  if (std::abs(value) < nothing_beside(quantity.unit)) value = 0;
  if (!is_share(quantity)) return spoken(value, quantity.unit);
  if (quantity.name.starts_with("change_of") && std::abs(value) >= 10) return fmt::format("{:.3g} %", 100 * value);  // not "11 times"
  if (std::abs(value) >= 5e-4) return percent(value);
  return std::abs(value) < 5e-5 ? "0 %" : fmt::format("{:.2f} %", 100 * value);
}

const VerdictQuantity* find_verdict_quantity(std::string_view name) {
  const auto found = std::ranges::find(quantities, name, &VerdictQuantity::name);
  return found == quantities.end() ? nullptr : &*found;
}

}  // namespace uplift
