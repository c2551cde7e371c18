#include "uplift/case/build/bed.h"

#include <fmt/format.h>

#include <array>

#include "uplift/case/build/behaviours.h"
#include "uplift/case/build/model.h"

namespace uplift {
namespace {

constexpr std::array soil_keys{"K_n", "K_t", "c"};

bool says_soil(const Values& law, const char* key) {
  return law.items().contains(key) && law.is_word(key);
}

double number_of_soil(const Values& law, std::string_view key, const BedOfSoil& bed) {
  const double value = key == "K_n" ? bed.normal : key == "K_t" ? bed.tangential : bed.damping;
  if (!(value > 0)) fail(law, key, "a number: the dashpot of the soil needs its density, and a strip has none", "\"soil\"");
  return value;
}

/// The ratio, for footing_points; refused where the points of this side cannot have it.
double checked_ratio(const Values& soil, const char* side, FootingRule rule, int points, double ratio) {
  if (!(ratio > 0)) fail(soil, "", "formulas with a rocking stiffness about every axis", "none about one of them");
  const Quadrature along = footing_rule(rule, points);
  if (bed_distribution(along, ratio)) return ratio;
  const BedReach reach = bed_reach(along);
  fail(soil, "",
       fmt::format("a ground that is {:.3g} to {:.3g} times as stiff in rocking as a uniform bed with its vertical stiffness (what the {} "
                   "points along the {} can have; no bed has more than 3, all of it at the edges); a [[foundation]] has both stiffnesses",
                   reach.least, reach.most, points, side),
       fmt::format("{:.4g} times", ratio));
}

}  // namespace

std::unique_ptr<const FootingOnSoil> soil_of(const CaseFooting& footing) {
  if (!footing.soil) return nullptr;
  Footprint footprint;
  footprint.dimension = footing.length ? 3 : 2;
  footprint.shape = footing.soil_on_rock && !footing.length ? Footprint::Shape::strip : Footprint::Shape::rectangle;
  footprint.width = footing.width;
  footprint.length = footing.length.value_or(footing.thickness);
  return std::make_unique<const FootingOnSoil>(footing_on_soil(*footing.soil, footprint));
}

void spread_soil(const Values& soil, const FootingOnSoil& ground, Footing& footing) {
  const bool space = footing.length > 0;
  const BedOfSoil bed = bed_of_soil(ground, space ? 3 : 2);
  footing.ratio = checked_ratio(soil, "width", footing.rule, footing.points, bed.ratio_width);
  if (space) footing.ratio_across = checked_ratio(soil, "length", footing.rule, footing.points_across, bed.ratio_length);
}

std::unique_ptr<const Values> law_on_soil(const Values& law, const FootingOnSoil* soil, int dimension) {
  std::unique_ptr<const Values> made;
  for (const char* key : soil_keys) {
    if (!says_soil(law, key)) continue;
    if (!soil) fail(law, key, "a number, or [interface.footing.soil], which gives it", "\"soil\" without one");
    const double value = number_of_soil(law, key, bed_of_soil(*soil, dimension));
    made = std::make_unique<const Values>(with_number(made ? *made : law, key, value));
  }
  return made;
}

}  // namespace uplift
