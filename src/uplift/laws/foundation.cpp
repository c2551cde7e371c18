#include "uplift/laws/foundation.h"

#include <array>
#include <numbers>

namespace uplift {

#define FOUNDATION(name) const FoundationEntry& entry_foundation_##name();
#include "uplift/parts.def"

std::span<const FoundationEntry* const> foundation_catalog() {
  static const std::array models{
#define FOUNDATION(name) &entry_foundation_##name(),
#include "uplift/parts.def"
  };
  return models;
}

std::span<const PartInfo* const> foundation_models() {
  static const std::array models{
#define FOUNDATION(name) static_cast<const PartInfo*>(&entry_foundation_##name()),
#include "uplift/parts.def"
  };
  return models;
}

std::unique_ptr<const InterfaceLaw> make_law(const Values& behaviour, const std::optional<Footprint>& footprint) {
  return footprint ? make_part(foundation_catalog(), behaviour, *footprint) : make_part(law_catalog(), behaviour);
}

std::string_view to_string(Footprint::Shape shape) {
  return shape == Footprint::Shape::strip ? "strip" : shape == Footprint::Shape::disc ? "disc" : "rectangle";
}

std::optional<Footprint::Shape> footprint_shape(std::string_view name) {
  for (const auto shape : {Footprint::Shape::strip, Footprint::Shape::rectangle, Footprint::Shape::disc})
    if (name == to_string(shape)) return shape;
  return {};
}

double Footprint::area() const {
  return shape == Shape::disc ? std::numbers::pi / 4 * width * width : width * length;
}

std::span<const char* const> foundation_stiffness_keys(int components) {
  static constexpr std::array plane{"K_h", "K_v", "K_r"};
  static constexpr std::array space{"K_h", "K_h2", "K_v", "K_r2", "K_r", "K_t"};  // a moment about t1 tilts the length
  if (components == 3) return plane;
  return space;
}

std::vector<Field> foundation_stiffness_fields() {
  return {number("K_v", "N/m", "vertical stiffness of the ground under the whole foundation; absent: of [foundation.soil], as the others")
              .positive()
              .optional(),
          number("K_h", "N/m", "horizontal stiffness along the width").positive().optional(),
          number("K_r", "N m/rad", "rocking stiffness for moments that tilt the width").positive().optional(),
          number("K_h2", "N/m", "in space: horizontal stiffness along the length; absent: of the soil, else K_h").positive().optional(),
          number("K_r2", "N m/rad", "in space: rocking stiffness for moments that tilt the length; absent: of the soil, else K_r")
              .positive()
              .optional(),
          number("K_t", "N m/rad", "in space: stiffness against torsion about the normal").positive().optional()};
}

std::vector<double> foundation_stiffness(const Footprint& footprint, const Values& values) {
  const bool space = footprint.dimension == 3;
  for (const char* key : {"K_h2", "K_r2", "K_t"})
    if (!space && values.has(key)) fail(values, key, "K_v, K_h and K_r in the plane", key);
  using enum SoilMotion;
  std::optional<SoilSprings> soil;
  if (footprint.soil) soil = soil_springs(*footprint.soil);
  const auto stiffness = [&](const char* key, SoilMotion motion) {
    if (values.has(key)) return values.number(key);
    if (!soil) fail(values, "", std::string(key) + ", or [foundation.soil], which gives it", "neither");
    return (*soil)[motion].stiffness();
  };
  const double vertical_one = stiffness("K_v", vertical), along = stiffness("K_h", along_width), tilting = stiffness("K_r", tilting_width);
  if (!space) return {along, vertical_one, tilting};
  // what is not given in the second direction is that of the soil; without one, and of a disc, as in the first
  const bool same = !soil || footprint.shape == Footprint::Shape::disc;
  const auto second = [&](const char* key, double first, SoilMotion motion) {
    return same && !values.has(key) ? first : stiffness(key, motion);
  };
  return {along,        second("K_h2", along, along_length),
          vertical_one, second("K_r2", tilting, tilting_length),
          tilting,      stiffness("K_t", torsion)};
}

std::vector<double> radiation_damping(const Footprint& footprint) {
  if (!footprint.soil || !footprint.soil->radiation) return {};
  using enum SoilMotion;
  std::vector<SoilMotion> rows{along_width, vertical, tilting_width};
  if (footprint.dimension == 3) rows = {along_width, along_length, vertical, tilting_length, tilting_width, torsion};
  const SoilSprings springs = soil_springs(*footprint.soil);
  std::vector<double> damping;
  for (const SoilMotion motion : rows) damping.push_back(springs[motion].damping);
  return damping;
}

}  // namespace uplift
