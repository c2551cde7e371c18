#include "uplift/case/schema/verdict_quantities.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "uplift/base/format.h"

namespace uplift {
namespace {

constexpr bool whole = false, at_least = true, wall_too = true, of_beam = true;

constexpr std::array<VerdictQuantity, 53> quantities{{
    {"max_top_motion", "m", "largest horizontal motion of the top, over all directions", "top motion", whole},
    {"change_of_top_motion", "1", "change of the motion of the top compared with the bonded reference run", "change of top motion", whole},
    {"max_drift", "m", "largest horizontal motion of the top relative to the base, rotation of the base included", "drift of the top",
     whole},
    {"max_drift_without_rotation", "m", "the same without the rotation of the base: deformation of the structure", "drift without rotation",
     whole},
    {"max_total_shear", "N", "largest horizontal force of bases and walls together", "total horizontal force", whole},
    {"max_total_moment", "N m", "largest moment of bases and walls together about the middle of the base", "total moment", whole},
    {"full_loss_of_contact", "s", "time with full loss of contact: no base has any contact", "full loss of contact", whole},
    {"max_uplifted_ratio", "1", "largest share of the area with a gap", "uplifted area"},
    {"uplifted_time", "s", "time with a gap anywhere", "time with a gap"},
    {"first_uplift", "s", "when a gap opens first", "first opening"},
    {"max_opening", "m", "largest gap", "largest gap", true, false, true, wall_too},
    {"max_slip", "m", "largest slip", "largest slip", true, false, false, wall_too},
    {"max_toe_pressure", "Pa", "largest pressure of all points", "largest pressure", true, false, true, wall_too},
    {"toe_pressure_ratio", "1", "largest pressure over the static mean W/A", "pressure over static mean"},
    {"max_eccentricity", "1", "largest eccentricity over the width, e/B", "eccentricity e/B"},
    {"max_eccentricity_1", "1", "in space: largest eccentricity along x over the width, along the side nearest to x of a turned rectangle",
     "e/B along t1"},
    {"max_eccentricity_2", "1", "in space: the same along y", "e/B along t2"},
    {"min_overturning_safety", "1", "least safety against overturning, stabilising over driving moment about the toe",
     "safety against overturning", true, at_least},
    {"min_sliding_safety", "1", "least safety against sliding, (mu N + c A)/V", "safety against sliding", true, at_least},
    {"max_bearing_utilisation", "1", "largest vertical force of a foundation over the bearing capacity under its shear and moment",
     "use of bearing capacity"},
    {"max_sliding_utilisation", "1", "largest shear of a foundation over its resistance to sliding", "use of sliding resistance"},
    {"full_loss_time", "s", "time without any contact", "time without contact"},
    {"longest_full_loss", "s", "longest interval without any contact", "longest loss of contact"},
    {"max_shear", "N", "largest base shear", "base shear"},
    {"change_of_shear", "1", "change of the base shear compared with the bonded reference run", "change of base shear"},
    {"max_moment", "N m", "largest base moment", "base moment"},
    {"change_of_moment", "1", "change of the base moment compared with the bonded reference run", "change of base moment"},
    {"max_compression", "N", "largest compression of the base", "largest compression"},
    {"change_of_compression", "1", "change of the largest compression compared with the bonded reference run", "change of compression"},
    {"max_impulse", "N s", "largest momentum that an impact of constraints transfers in one step", "impulse of an impact"},
    {"min_compression", "N", "least compression of the base", "least compression", true, at_least},
    {"linear_tension_ratio", "1", "largest share of the area that pulls in the bonded run", "tension area, bonded run"},
    {"predicted_uplifted_ratio", "1", "uplift that this share stands for by equal energy, Winkler strip", "uplift by equal energy"},
    {"residual_rotation", "rad", "residual rotation of the base", "residual rotation"},
    {"residual_settlement", "m", "residual settlement of the base", "residual settlement"},
    {"residual_slip", "m", "residual slip", "residual slip"},
    {"residual_opening", "m", "residual largest gap", "residual gap"},
    {"residual_uplifted_ratio", "1", "residual share of the area with a gap", "residual uplifted area"},
    {"max_penetration", "m", "largest compression of the joint where it is closed (interpenetration)", "compression of the joint", true,
     false, true, wall_too},
    {"share_of_horizontal_force", "1", "share of the total horizontal force that the walls carry when it is largest",
     "share of horizontal force", true, false, false, wall_too},
    {"share_of_base_moment", "1", "share of the total moment that the walls carry when it is largest", "share of base moment", true, false,
     false, wall_too},
    {"max_beam_compression", "N", "largest compression in a beam with an envelope", "compression of the beam", whole, false, true, false,
     of_beam},
    {"max_beam_tension", "N", "largest tension in a beam", "tension of the beam", whole, false, true, false, of_beam},
    {"max_beam_shear", "N", "largest shear force in a beam, in space of both axes together", "shear of the beam", whole, false, true, false,
     of_beam},
    {"change_of_beam_shear", "1", "change of the largest shear force compared with the bonded run", "change of beam shear", whole, false,
     true, false, of_beam},
    {"max_beam_moment", "N m", "largest bending moment in a beam, in space of both axes together", "moment of the beam", whole, false, true,
     false, of_beam},
    {"change_of_beam_moment", "1", "change of the largest bending moment compared with the bonded run", "change of beam moment", whole,
     false, true, false, of_beam},
    {"max_storey_shear_x", "N", "in space: largest of the storey shears along x that are recorded", "storey shear along x", whole},
    {"max_storey_shear_y", "N", "in space: the same along y", "storey shear along y", whole},
    {"max_storey_shear", "N", "largest of the storey shears that are recorded, in space of both axes together", "storey shear", whole},
    {"max_drift_ratio_x", "1", "in space: largest of the drift ratios along x that are recorded", "drift ratio along x", whole},
    {"max_drift_ratio_y", "1", "in space: the same along y", "drift ratio along y", whole},
    {"max_drift_ratio", "1", "largest of the drift ratios that are recorded, in space of both axes together", "drift ratio", whole},
}};

}  // namespace

std::span<const VerdictQuantity> verdict_quantities() {
  return quantities;
}

bool is_share(const VerdictQuantity& quantity) {
  return quantity.name.starts_with("change_of") || quantity.name.starts_with("share_of") || quantity.name.ends_with("uplifted_ratio") ||
         quantity.name == "linear_tension_ratio";
}

bool near_zero(const VerdictQuantity& quantity) {
  return is_share(quantity) || quantity.name.starts_with("residual") || quantity.name == "first_uplift";
}

double nothing_beside(std::string_view unit) {
  if (unit == "m" || unit == "rad" || unit == "N" || unit == "N m" || unit == "N s" || unit == "Pa") return 1e-9;
  return unit == "1" ? 1e-6 : 0;
}

std::string format_value(const VerdictQuantity& quantity, double value) {
  if (std::abs(value) < nothing_beside(quantity.unit)) value = 0;
  if (!is_share(quantity)) return format_quantity(value, quantity.unit);
  if (quantity.name.starts_with("change_of") && std::abs(value) >= 10) return fmt::format("{:.3g} %", 100 * value);  // not "11 times"
  if (std::abs(value) >= 5e-4) return percent(value);
  return std::abs(value) < 5e-5 ? "0 %" : fmt::format("{:.2f} %", 100 * value);
}

const VerdictQuantity* find_verdict_quantity(std::string_view name) {
  const auto found = std::ranges::find(quantities, name, &VerdictQuantity::name);
  return found == quantities.end() ? nullptr : &*found;
}

}  // namespace uplift
