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

std::vector<Field> foundation_stiffness_fields() {
  return {number("K_v", "N/m", "vertical stiffness of the ground under the whole foundation").positive(),
          number("K_h", "N/m", "horizontal stiffness along the width").positive(),
          number("K_r", "N m/rad", "rocking stiffness for moments that tilt the width").positive(),
          number("K_h2", "N/m", "in space: horizontal stiffness along the length; absent: K_h").positive().optional(),
          number("K_r2", "N m/rad", "in space: rocking stiffness for moments that tilt the length; absent: K_r").positive().optional(),
          number("K_t", "N m/rad", "in space: stiffness against torsion about the normal").positive().optional()};
}

std::vector<double> foundation_stiffness(const Footprint& footprint, const Values& values) {
  const bool space = footprint.dimension == 3;
  for (const char* key : {"K_h2", "K_r2", "K_t"})
    if (!space && values.has(key)) fail(values, key, "K_v, K_h and K_r in the plane", key);
  const double vertical = values.number("K_v"), horizontal = values.number("K_h"), rocking = values.number("K_r");
  if (!space) return {horizontal, vertical, rocking};
  if (!values.has("K_t")) fail(values, "", "K_t, the torsional stiffness, of a foundation in space", "none");
  const auto second = [&](const char* key, double first) { return values.has(key) ? values.number(key) : first; };
  // a moment about t1 tilts the length, one about t2 the width
  return {horizontal, second("K_h2", horizontal), vertical, second("K_r2", rocking), rocking, values.number("K_t")};
}

}  // namespace uplift
