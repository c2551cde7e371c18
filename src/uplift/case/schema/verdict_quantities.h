#pragma once
#include <array>
#include <string>
#include <string_view>

namespace uplift {

class QuantityName;

/// A number that the verdict gives. Its name is the one in summary.json and in [[verdict.criterion]].
struct VerdictQuantity {
  /// What it is a number of: the run as a whole, an interface, or a beam with a [[output.beam_envelope]].
  enum class Of { run, base, wall, base_and_wall, beam };

  std::string_view name, unit, meaning;
  std::string_view brief;  // a few words for tables
  Of of = Of::base;
  bool at_least = false;  // a criterion asks for at least its limit; else for at most

  bool of_base() const { return of == Of::base || of == Of::base_and_wall; }
  bool of_wall() const { return of == Of::wall || of == Of::base_and_wall; }
  bool of_interface() const { return of_base() || of_wall(); }
  bool of_beam() const { return of == Of::beam; }
  bool is(QuantityName) const;
};

/// All of them, in the order in which they are shown.
inline constexpr auto verdict_quantities = [] {
  using enum VerdictQuantity::Of;
  constexpr bool at_least = true;
  return std::to_array<VerdictQuantity>({
      {"max_top_motion", "m", "largest horizontal motion of the top, over all directions", "top motion", run},
      {"change_of_top_motion", "1", "change of the motion of the top compared with the bonded reference run", "change of top motion", run},
      {"max_drift", "m", "largest horizontal motion of the top relative to the base, rotation of the base included", "drift of the top",
       run},
      {"max_drift_without_rotation", "m", "largest drift without the rotation of the base: deformation of a structure on one base",
       "drift without rotation", run},
      {"max_total_shear", "N", "largest horizontal force of all bases and walls together", "total horizontal force", run},
      {"max_total_moment", "N m", "largest moment of all bases and walls together about the middle of the bases", "total moment", run},
      {"full_loss_of_contact", "s", "time with full loss of contact: no base has any contact", "full loss of contact", run},
      {"max_uplifted_ratio", "1", "largest share of the area with a gap", "uplifted area"},
      {"uplifted_time", "s", "time with a gap anywhere", "time with a gap"},
      {"first_uplift", "s", "when a gap opens first", "first opening", base, at_least},
      {"max_opening", "m", "largest gap", "largest gap", base_and_wall},
      {"max_slip", "m", "largest slip", "largest slip", wall},
      {"max_toe_pressure", "Pa", "largest pressure of all points", "largest pressure", base_and_wall},
      {"toe_pressure_ratio", "1", "largest pressure over the static mean W/A", "pressure over static mean"},
      {"max_eccentricity", "1", "largest eccentricity over the width, e/B: along one side, of a round base |e|/D in all directions",
       "eccentricity e/B"},
      {"max_eccentricity_1", "1",
       "in space: largest eccentricity along x over the width, along the side nearest to x of a turned rectangle", "e/B along t1"},
      {"max_eccentricity_2", "1", "in space: the same along y", "e/B along t2"},
      {"max_eccentricity_sum", "1",
       "in space, of a rectangle: largest sum of both at one time; a rigid base on springs without tension is in full contact up to 1/6",
       "e1/B1 + e2/B2"},
      {"min_overturning_safety", "1", "least safety against overturning, stabilising over driving moment about the toe",
       "safety against overturning", base, at_least},
      {"min_sliding_safety", "1", "least safety against sliding, (mu N + c A)/V", "safety against sliding", base, at_least},
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
      {"min_compression", "N", "least compression of the base", "least compression", base, at_least},
      {"linear_tension_ratio", "1", "largest share of the area that pulls in the bonded run", "tension area, bonded run"},
      {"predicted_uplifted_ratio", "1", "uplift that this share stands for by equal energy, Winkler strip", "uplift by equal energy"},
      {"residual_rotation", "rad", "residual rotation of the base", "residual rotation"},
      {"residual_settlement", "m", "residual settlement of the base", "residual settlement"},
      {"residual_slip", "m", "residual slip", "residual slip"},
      {"residual_opening", "m", "residual largest gap", "residual gap"},
      {"residual_uplifted_ratio", "1", "residual share of the area with a gap", "residual uplifted area"},
      {"max_penetration", "m", "largest compression of the joint where it is closed (interpenetration)", "compression of the joint",
       base_and_wall},
      {"share_of_horizontal_force", "1", "share of the total horizontal force that the walls carry when it is largest",
       "share of horizontal force", wall},
      {"share_of_base_moment", "1", "share of the total moment that the walls carry when it is largest", "share of base moment", wall},
      {"max_beam_compression", "N", "largest compression in a beam with an envelope", "compression of the beam", beam},
      {"max_beam_tension", "N", "largest tension in a beam", "tension of the beam", beam},
      {"max_beam_shear", "N", "largest shear force in a beam, in space of both axes together", "shear of the beam", beam},
      {"change_of_beam_shear", "1", "change of the largest shear force compared with the bonded run", "change of beam shear", beam},
      {"max_beam_moment", "N m", "largest bending moment in a beam, in space of both axes together", "moment of the beam", beam},
      {"change_of_beam_moment", "1", "change of the largest bending moment compared with the bonded run", "change of beam moment", beam},
      {"max_storey_shear_x", "N", "in space: largest of the storey shears along x that are recorded", "storey shear along x", run},
      {"max_storey_shear_y", "N", "in space: the same along y", "storey shear along y", run},
      {"max_storey_shear", "N", "largest of the storey shears that are recorded, in space of both axes together", "storey shear", run},
      {"max_drift_ratio_x", "1", "in space: largest of the drift ratios along x that are recorded", "drift ratio along x", run},
      {"max_drift_ratio_y", "1", "in space: the same along y", "drift ratio along y", run},
      {"max_drift_ratio", "1", "largest of the drift ratios that are recorded, in space of both axes together", "drift ratio", run},
  });
}();

/// The one of this name; null when there is none.
constexpr const VerdictQuantity* find_verdict_quantity(std::string_view name) {
  for (const VerdictQuantity& each : verdict_quantities)
    if (each.name == name) return &each;
  return nullptr;
}

/// A quantity by its name in the source: one that there is not does not compile.
class QuantityName {
 public:
  consteval QuantityName(const char* name) : quantity_(verdict_quantities.data() + place_of(name)) {}
  QuantityName(const VerdictQuantity& quantity) : quantity_(&quantity) {}
  QuantityName(VerdictQuantity&&) = delete;
  constexpr operator const VerdictQuantity*() const { return quantity_; }

 private:
  // not by comparing addresses: with -fsanitize=undefined g++ 12 takes them for no constants
  static consteval std::size_t place_of(std::string_view name) {
    for (std::size_t i = 0; i < verdict_quantities.size(); ++i)
      if (verdict_quantities[i].name == name) return i;
    throw "no number of the verdict has this name";
  }

  const VerdictQuantity* quantity_;
};
inline bool VerdictQuantity::is(QuantityName other) const {
  return this == other;
}

/// Whether it is a share of one or a change, which is said in per cent.
bool is_share(const VerdictQuantity&);
/// Whether it can be near zero beside what it is a number of: shares, changes, instants, residuals. A band of such a number is from ... to.
bool near_zero(const VerdictQuantity&);
/// Below this a number of the unit is nothing beside the precision of a run.
double nothing_beside(std::string_view unit);
/// A number as an engineer says it: shares and changes in per cent; what is nothing beside the precision of a run as 0.
std::string format_value(const VerdictQuantity&, double value);

}  // namespace uplift
