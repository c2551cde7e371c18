#include <fmt/format.h>

#include <cmath>

#include "uplift/laws/foundation.h"
#include "uplift/laws/soil_stiffness.h"

// [foundation.soil]: its keys, and what they say about the ground.
namespace uplift {
namespace {

std::vector<Field> ground_fields() {
  return {number("G", "Pa", "shear modulus at the strains of the earthquake; or give shear_wave_velocity").positive().optional(),
          number("shear_wave_velocity", "m/s", "the same from the velocity: G = density x velocity^2").positive().optional(),
          number("poisson", "1", "Poisson's ratio").between(0, 0.5).optional(),
          number("density", "kg/m3", "density; needed with layers, shear_wave_velocity, frequency and radiation").positive().optional()};
}

const Section& ground_layer_section() {
  static const Section section = [] {
    Section made{"layer", "a layer of the ground", {number("thickness", "m", "thickness; the last layer goes on").positive().optional()}};
    for (const Field& field : ground_fields()) made.fields.push_back(field);
    return made;
  }();
  return section;
}

Ground ground_of(const Values& table, bool density_needed) {
  Ground ground;
  const bool modulus = first_of_two(table, "G", "shear_wave_velocity");
  if (!table.has("poisson")) fail(table, "", "poisson, Poisson's ratio of the ground", "none");
  ground.poisson = table.number("poisson");
  if ((density_needed || !modulus) && !table.has("density")) fail(table, "", "the density of the ground", "none");
  if (table.has("density")) ground.density = table.number("density");
  ground.shear_modulus = modulus ? table.number("G") : ground.density * std::pow(table.number("shear_wave_velocity"), 2);
  return ground;
}

std::vector<GroundLayer> layers_of(const Values& soil, bool density_needed) {
  const std::vector<Values>& tables = soil.tables("layers");
  if (tables.empty() && soil.given("layers")) fail(soil, "layers", "at least one layer", "none");
  if (tables.empty()) return {{ground_of(soil, density_needed)}};
  for (const char* key : {"G", "shear_wave_velocity", "poisson", "density"})
    if (soil.has(key)) fail(soil, key, "the ground in layers, or here", "both");
  std::vector<GroundLayer> layers;
  for (const Values& table : tables) {
    layers.push_back({ground_of(table, true)});
    const bool last = &table == &tables.back();
    if (table.has("thickness")) layers.back().thickness = table.number("thickness");
    if (!last && !table.has("thickness")) fail(table, "", "the thickness of every layer but the last", "none");
  }
  return layers;
}

/// Layers that end above the ground that the formulas need.
void refuse_shallow(const FootingOnSoil& footing, const Values& soil) {
  double depth = -footing.embedment, needed = 0;
  for (const GroundLayer& layer : footing.layers) depth += layer.thickness;
  const SoilSprings springs = soil_springs(footing);
  for (const SoilMotion motion : soil_motions) needed = std::max(needed, springs[motion].depth);
  if (depth < needed)
    fail(soil, "layers", fmt::format("layers down to {:.4g} m below the underside (a last layer without thickness goes on)", needed),
         depth > 0 ? fmt::format("layers down to {:.4g} m", depth) : fmt::format("layers that end {:.4g} m above it", -depth));
}

SoilFormulas formulas_of(const Values& soil, const Footprint& footprint) {
  if (footprint.shape == Footprint::Shape::rectangle)
    return soil.has("formulas") && soil.text("formulas") == "gazetas" ? SoilFormulas::gazetas : SoilFormulas::pais_kausel;
  if (soil.has("formulas")) fail(soil, "formulas", "formulas of a rectangle: a disc and a strip have their own", "a choice");
  return footprint.shape == Footprint::Shape::disc ? SoilFormulas::disc : SoilFormulas::strip;
}

/// Each key with the formulas that know it.
void refuse_unknown(const Values& soil, SoilFormulas formulas) {
  const auto only = [&](const char* key, bool known, const char* wanted, bool given) {
    if (given && !known) fail(soil, key, wanted, "one");
  };
  only("frequency", formulas == SoilFormulas::pais_kausel, "no frequency: only the formulas pais_kausel of a rectangle know one",
       soil.has("frequency"));
  only("rock_depth", formulas == SoilFormulas::strip, "no rock_depth: only a strip has formulas with rock", soil.has("rock_depth"));
  only("sidewall", formulas == SoilFormulas::gazetas, "no sidewall: only the formulas gazetas know walls in part contact",
       soil.has("sidewall"));
  only("embedment", formulas != SoilFormulas::strip, "no embedment of a strip", soil.number("embedment") > 0);
  only("layers", formulas != SoilFormulas::strip, "homogeneous ground under a strip", !soil.tables("layers").empty());
  if (formulas == SoilFormulas::strip && soil.flag("radiation"))
    fail(soil, "radiation", "false: a layer over rock radiates nothing below its own frequency", "true");
  if (formulas == SoilFormulas::strip && !soil.has("rock_depth"))
    fail(soil, "", "rock_depth: a strip on a half-space has no static vertical and no horizontal stiffness", "none");
}

}  // namespace

const Section& footing_soil_section() {
  static const Section section = [] {
    Section made{"soil", "the ground under a rigid footing: its stiffness, and its radiation damping, from published formulas", {}};
    for (const Field& field : ground_fields()) made.fields.push_back(field);
    for (const Field& field :
         {tables("layers", ground_layer_section(), "layers from the surface down, instead of homogeneous ground"),
          choice("formulas", {"pais_kausel", "gazetas"}, "of a rectangle; absent: pais_kausel").optional(),
          number("embedment", "m", "depth of the underside below the surface").nonnegative().standard(0.0),
          number("sidewall", "m", "formulas gazetas: height of the walls in contact with the ground; absent: embedment")
              .nonnegative()
              .optional(),
          number("rock_depth", "m", "of a strip: from the underside down to rock").positive().optional(),
          number("frequency", "Hz",
                 "formulas pais_kausel: the stiffness and the dashpots of rotations are those at this frequency; absent: "
                 "static stiffness, no dashpots of rotations")
              .positive()
              .optional(),
          flag("radiation",
               "dashpots beside the ground, for the waves that the footing radiates; they act also while it is open. The forces of the "
               "foundation contain theirs")
              .standard(false)})
      made.fields.push_back(field);
    return made;
  }();
  return section;
}

FootingOnSoil footing_on_soil(const Values& soil, const Footprint& footprint) {
  FootingOnSoil footing;
  footing.formulas = formulas_of(soil, footprint);
  refuse_unknown(soil, footing.formulas);
  footing.width = footprint.width, footing.length = footprint.length;
  footing.embedment = soil.number("embedment");
  if (footing.embedment > 2 * std::min(footing.width, footing.length))
    fail(soil, "embedment", "an embedment of at most twice the width (a deeper foundation is a caisson or a pile)", "a deeper one");
  footing.sidewall = soil.has("sidewall") ? soil.number("sidewall") : footing.embedment;
  if (footing.sidewall > footing.embedment) fail(soil, "sidewall", "at most the embedment", "more");
  if (soil.has("rock_depth")) footing.rock_depth = soil.number("rock_depth");
  if (footing.rock_depth < 0.5 * footing.width) fail(soil, "rock_depth", "at least half of the width", "less");
  if (soil.has("frequency")) footing.frequency = soil.number("frequency");
  footing.radiation = soil.flag("radiation");
  const double ratio = std::max(footing.width, footing.length) / std::min(footing.width, footing.length);
  if (footprint.shape == Footprint::Shape::rectangle && ratio > 20)
    fail(soil, "", "a rectangle with sides of up to 1 to 20 (a longer one is a strip)", fmt::format("1 to {:.4g}", ratio));
  footing.layers = layers_of(soil, footing.frequency > 0 || footing.radiation);
  refuse_shallow(footing, soil);
  return footing;
}

}  // namespace uplift
