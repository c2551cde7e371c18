#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <optional>
#include <span>

#include "uplift/base/text.h"
#include "uplift/laws/foundation.h"
#include "uplift/laws/macro_element.h"

// [[foundation]] model = "macro_element": the parameters of a report become those of the macro-element.
namespace uplift {
namespace {

/// A width of millimetres, or a stiffness in another unit: the footing would turn over at rotations that mean nothing.
void refuse_magnitudes(const Values& values, const MacroElasticity& ground, int axes) {
  constexpr double most = 1e4;  // of formulas for the ground, with any embedment, up to 50
  for (int i = 0; i < axes; ++i) {
    const double uniform = ground.vertical * ground.length[i] * ground.length[i] / 12, ratio = ground.rocking[i] / uniform;
    if (!(ratio <= most))
      fail(values, "",
           fmt::format("a rocking stiffness of up to {:g} times that of a uniform bed with K_v, {:.3g} N m/rad (ground: 1 to 50 times)",
                       most, uniform),
           fmt::format("{:.3g} N m/rad for a side of {:g} m", ground.rocking[i], ground.length[i]));
  }
}

/// Length out of the plane counts in areas alone: forces of a strip are those of its whole length.
MacroElasticity elasticity_of(const Footprint& footprint, const Values& values, const std::vector<double>& stiffness) {
  MacroElasticity made;
  made.disc = footprint.shape == Footprint::Shape::disc;
  made.shape = values.has("shape_number") ? values.number("shape_number") : footprint.shape == Footprint::Shape::strip ? 4 : 6;
  made.length[0] = footprint.width, made.length[1] = footprint.length;
  if (footprint.dimension == 2) {
    made.vertical = stiffness[1];
    made.horizontal[0] = made.horizontal[1] = stiffness[0];
    made.rocking[0] = made.rocking[1] = stiffness[2];
    refuse_magnitudes(values, made, 1);
    return made;
  }
  made.vertical = stiffness[2];
  made.horizontal[0] = stiffness[0], made.horizontal[1] = stiffness[1];
  made.rocking[0] = stiffness[4], made.rocking[1] = stiffness[3];  // a moment about t2 tilts the width
  if (made.disc && (stiffness[0] != stiffness[1] || stiffness[3] != stiffness[4]))
    fail(values, values.has("K_h2") ? "K_h2" : "K_r2", "the same stiffness in all directions of a disc", "two");
  refuse_magnitudes(values, made, 2);
  return made;
}

/// Keys that belong to one bearing surface, in the order of (M17): a to f.
constexpr const char* power_law_keys[] = {"a", "b", "c", "d", "e", "f"};
constexpr const char* en_1998_5_keys[] = {"soil_type", "soil_inertia", "model_factor"};

/// The standard values of a surface that is not taken: a stored problem states them.
bool has_no_effect(const Values& values, std::string_view key) {
  return (key == "soil_inertia" && values.number(key) == 0) || (key == "model_factor" && values.number(key) == 1);
}

void refuse_keys(const Values& values, std::span<const char* const> keys, const char* surface) {
  for (const char* key : keys)
    if (values.given(key) && !has_no_effect(values, key))
      fail(values, key, fmt::format("surface = \"{}\"", surface), in_quotes(values.text("surface")));
}

MacroPowerLaw power_law_of(const Values& values) {
  for (const char* key : power_law_keys)
    if (!values.has(key)) fail(values, "", fmt::format("{} of the power law: it has no standard value", key), "none");
  const auto value = [&](int i) { return values.number(power_law_keys[i]); };
  return {{value(0), value(2), value(3), 2}, {value(1), value(4), value(5), 2}};
}

En1998Surface en_1998_5_of(const Values& values) {
  if (!values.has("soil_type")) fail(values, "", "soil_type: cohesive or cohesionless", "none");
  const En1998Soil soil = values.text("soil_type") == "cohesive" ? En1998Soil::cohesive : En1998Soil::cohesionless;
  const double inertia = values.number("soil_inertia");
  const std::optional<En1998Surface> made = en_1998_5_surface(soil, inertia);
  if (!made)
    fail(values, "soil_inertia",
         fmt::format("less than {:.4g}, where the inertia of the soil leaves no capacity", en_1998_5_largest_inertia(soil)),
         fmt::format("{:.4g}", inertia));
  return *made;
}

/// Chooses the bearing surface; that of EN 1998-5 reduces the vertical capacity by the model factor and the inertia of the soil.
void choose_surface(const Values& values, MacroStrength& made) {
  const std::string& surface = values.text("surface");
  if (surface != "power_law") refuse_keys(values, power_law_keys, "power_law");
  if (surface != "en_1998_5") refuse_keys(values, en_1998_5_keys, "en_1998_5");
  if (surface == "effective_width") return;
  if (!values.has("V_s")) fail(values, "surface", "V_s too", "none");
  if (made.flow == MacroStrength::Flow::associated)
    fail(values, "flow", "settling with this surface: it is not convex for all parameters, and the ground could then give energy back",
         "associated");
  if (surface == "power_law") {
    made.power_law = power_law_of(values);
    return;
  }
  const En1998Surface standard = en_1998_5_of(values);
  made.power_law = standard.law;
  const double share = standard.capacity_share / values.number("model_factor");
  made.service *= share, made.ultimate *= share;
}

MacroStrength strength_of(const Footprint& footprint, const Values& values) {
  constexpr double none = std::numeric_limits<double>::infinity();
  MacroStrength made;
  made.flow = values.text("flow") == "associated" ? MacroStrength::Flow::associated : MacroStrength::Flow::settling;
  made.service = values.has("V_s") ? values.number("V_s") : none;
  made.ultimate = values.has("V_u") ? values.number("V_u") : made.service;
  for (const char* key : {"V_u", "w_ref"})
    if (values.has(key) && !values.has("V_s")) fail(values, key, "V_s too", "none");
  if (values.has("w_ref") && !values.has("V_u")) fail(values, "w_ref", "V_u too", "none");
  if (made.ultimate < made.service) fail(values, "V_u", "an ultimate load of at least V_s", "a smaller one");
  if (made.ultimate > made.service && !values.has("w_ref"))
    fail(values, "", "w_ref, the settlement over which V_s grows towards V_u", "none");
  made.reference = values.has("w_ref") ? values.number("w_ref") : 1;
  if (values.has("cohesion") && !values.has("friction_angle")) fail(values, "cohesion", "friction_angle too (0 without friction)", "none");
  made.friction = values.has("friction_angle") ? std::tan(values.number("friction_angle")) : none;
  made.cohesion = values.has("cohesion") ? values.number("cohesion") * footprint.area() : 0;
  if (values.has("dilatancy") && made.flow == MacroStrength::Flow::associated)
    fail(values, "dilatancy", "settling flow: associated flow dilates by the angle of friction", "associated flow");
  const double dilatancy = values.has("dilatancy") ? values.number("dilatancy") : 0;
  if (dilatancy > (values.has("friction_angle") ? values.number("friction_angle") : 0))
    fail(values, "dilatancy", "an angle up to friction_angle", values.has("friction_angle") ? "a larger one" : "no friction_angle");
  made.dilation = std::tan(dilatancy);
  made.settlement_share = values.number("settlement_factor");
  choose_surface(values, made);
  return made;
}

}  // namespace

const FoundationEntry& entry_foundation_macro_element() {
  static const FoundationEntry entry = [] {
    FoundationEntry made;
    made.name = "macro_element";
    made.summary = "uplift, bearing capacity and sliding of a shallow foundation in one element: footing and ground near it";
    made.equations =
        "M0 = N D/alpha: uplift begins; M/M0 = alpha/2 - (alpha/2 - 1) x^(-1/(alpha/2 - 1)), x = theta K_r/M0 > 1\n"
        "effective_width: f2 = N - V (1 - |H|/N)^3 (1 - 2 |M1|/(N D1)) (1 - 2 |M2|/(N D2)) <= 0\n"
        "power_law, n = N/V: (|H|/(a V n^c (1 - n)^d))^2 + (|M|/(b D V n^e (1 - n)^f))^2 <= 1; n < 0.05: c, e <= 0.9\n"
        "en_1998_5: (F.1) of EN 1998-5:2004 with N_max = V, F = soil_inertia, gamma_Rd = model_factor; n < 0.05 as above\n"
        "V = V_s + (V_u - V_s) p/(p + w_ref), p: sum of |plastic settlement|\n"
        "f1 = |H| - N tan(friction_angle) - cohesion A (1 - 2 |M1|/(N D1)) (1 - 2 |M2|/(N D2)) <= 0";
    made.source =
        "docs/theory/macro_element.md; effective width and sliding: code_aster's law FONDATION (R5.03.31); power law: Crémer, Pecker & "
        "Davenne 2001; EN 1998-5:2004, Annex F; uplift: Chatzigogos, Pecker & Salençon 2011";
    made.params = foundation_stiffness_fields();
    for (const Field& field :
         {number(
              "shape_number", "1",
              "alpha: 4 strip on the half-space, 6 disc on the half-space and strip or rectangle on springs (Winkler), 8 disc on springs; "
              "absent: 4 of a strip, else 6")
              .between(4, 8)
              .optional(),
          choice(
              "surface", {"effective_width", "power_law", "en_1998_5"},
              "bearing capacity under shear and moment: effective_width: Meyerhof's, with the inclination of code_aster; power_law: form "
              "of Crémer and Grange with your a to f; en_1998_5: Annex F of the standard (strip on homogeneous soil)")
              .standard("effective_width"),
          number("V_s", "N",
                 "vertical load at which the ground first yields (serviceability), N_max of en_1998_5; absent: the ground does not yield")
              .positive()
              .optional(),
          number("a", "1", "power_law: size of the largest shear, |H|/V <= a n^c (1 - n)^d, n = N/V").positive().optional(),
          number("b", "1", "power_law: size of the largest moment, |M|/(D V) <= b n^e (1 - n)^f").positive().optional(),
          number("c", "1", "power_law: exponent of n in the largest shear").between(0, 1.2).optional(),
          number("d", "1", "power_law: exponent of 1 - n in the largest shear").between(0.1, 1.5).optional(),
          number("e", "1", "power_law: exponent of n in the largest moment").between(0, 1.2).optional(),
          number("f", "1", "power_law: exponent of 1 - n in the largest moment").between(0.1, 1.5).optional(),
          choice("soil_type", {"cohesive", "cohesionless"}, "en_1998_5: column of Table F.1").optional(),
          number("soil_inertia", "1",
                 "en_1998_5: F, inertia of the soil: rho a_g S B/c of cohesive soil, a_g/(g tan(phi)) of cohesionless soil")
              .nonnegative()
              .standard(0.0),
          number("model_factor", "1", "en_1998_5: gamma_Rd, by which the capacity is divided").positive().standard(1.0),
          number("V_u", "N", "vertical load that it bears after large settlements; absent: V_s").positive().optional(),
          number("w_ref", "m", "plastic settlement that brings half of V_u - V_s").positive().optional(),
          number("friction_angle", "rad", "friction between footing and ground; absent: no sliding").between(0, 1.4).optional(),
          number("cohesion", "Pa", "shear strength without pressure; absent: 0").nonnegative().optional(),
          number("dilatancy", "rad", "angle at which a sliding footing rises; settling flow; absent: 0").between(0, 1.4).optional(),
          choice(
              "flow", {"settling", "associated"},
              "where yielding ground goes: settling: always down, as in tests; associated: along the normal of the surface, for comparison "
              "(a footing with a safety above 2 rises with every cycle)")
              .standard("settling"),
          number("settlement_factor", "1", "of settling flow: more settlement for the same rotation above 1").positive().standard(1.0)})
      made.params.push_back(field);
    made.make = [](const Footprint& footprint, const Values& values) -> std::unique_ptr<const InterfaceLaw> {
      const std::vector<double> stiffness = foundation_stiffness(footprint, values);
      return std::make_unique<MacroElement>(MacroParameters{elasticity_of(footprint, values, stiffness), strength_of(footprint, values),
                                                            footprint.dimension == 3 ? stiffness.back() : 0});
    };
    return made;
  }();
  return entry;
}

}  // namespace uplift
