#include "uplift/case/schema/interface_sections.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "uplift/case/schema/profile.h"

namespace uplift {
namespace {

using Fields = std::vector<Field>;

const Section& bed_section() {
  static const Section s{
      "bed",
      "elastic ground: under each point of the footing a spring of its own (Winkler), below the joint. It belongs to the model, "
      "so that every interface method sees the same ground",
      Fields{number("stiffness", "Pa/m", "stiffness of the ground per area (subgrade modulus)").positive(),
             number("damping", "Pa s/m", "viscous damping of the ground per area").nonnegative().standard(0.0),
             number("mass", "kg/m2", "mass of the moving ground per area").nonnegative().standard(0.0)}};
  return s;
}

CaseBed case_bed(const Values& table) {
  return {{&table}, table.number("stiffness"), table.number("damping"), table.number("mass")};
}

const Section& footing_section() {
  static const Section s{"footing", "points spread over the width of a rigid footing, in space over its area",
                         Fields{text("body", "node (the master of the footing) that carries the upper side"),
                                number("width", "m", "width of the footing").positive(),
                                number("thickness", "m", "length out of the plane").positive().standard(1.0),
                                number("length", "m", "in space: length across the width").positive().optional(),
                                integer("points", "number of joint points; in space along the width").between(1, 100000),
                                integer("points_across", "in space: number of joint points along the length").between(1, 100000).optional(),
                                number("azimuth", "rad", "in space: angle from the x axis to the width, about the normal").standard(0.0),
                                choice("rule", {"nodal", "midpoint", "gauss"},
                                       "where they stand and what they weigh: trapezoidal rule with points on both edges, "
                                       "middle of equal strips, Gauss points")
                                    .standard("nodal"),
                                vector("offset", "m", "from the node to the middle of the footing's underside").optional(),
                                vector("normal", "1", "from the ground to the structure; absent: up").optional(),
                                table("bed", bed_section(), "elastic ground under the joint; absent: fixed ground").optional(),
                                table("soil", footing_soil_section(),
                                      "the ground of a rectangle width x thickness (in space width x length), in the plane with rock_depth "
                                      "of a strip: makes the joint stiffer towards the edges, so that it has both the vertical and the "
                                      "rocking stiffness, and gives what the law calls \"soil\" (K_n, K_t, c)")
                                    .optional()}};
  return s;
}

CaseFooting case_footing(const Values& table) {
  const std::string& rule = table.text("rule");
  const Values *bed = table_if(table, "bed"), *soil = table_if(table, "soil");
  if (soil && bed) fail(*soil, "", "either soil, which makes the law of the joint the ground, or bed, ground below the joint", "both");
  if (soil && soil->flag("radiation")) fail(*soil, "radiation", "false: the dashpot of a joint is that of its law (c = \"soil\")", "true");
  return {{&table},
          name_used(table, "body"),
          table.number("width"),
          table.number("thickness"),
          number_if(table, "length"),
          table.integer("points"),
          table.has("points_across") ? std::optional(table.integer("points_across")) : std::nullopt,
          table.number("azimuth"),
          rule == "nodal"      ? FootingRule::nodal
          : rule == "midpoint" ? FootingRule::midpoint
                               : FootingRule::gauss,
          vector_used(table, "offset"),
          vector_used(table, "normal"),
          bed ? std::optional(case_bed(*bed)) : std::nullopt,
          soil,
          soil != nullptr && soil->has("rock_depth")};
}

const Section& pairs_section() {
  static const Section s{"pairs", "isolated pairs of nodes",
                         Fields{texts("upper", "nodes of the structure"),
                                texts("lower", "nodes of the ground, in the same order; absent: fixed ground").optional(),
                                vector("normal", "1", "from the ground to the structure; absent: up").optional(),
                                number("area", "m2", "area of each pair").positive()}};
  return s;
}

CasePairs case_pairs(const Values& table) {
  return {{&table}, names_used(table, "upper"), names_used(table, "lower"), vector_used(table, "normal"), table.number("area")};
}

const Section& line_section() {
  static const Section s{
      "line", "joint elements along a line of node pairs",
      Fields{texts("upper", "nodes of the structure in order along the line, the structure to the left of the walking direction"),
             texts("lower", "nodes of the ground, in the same order; absent: fixed ground").optional(),
             integer("nodes_per_element", "2 (linear) or 3 (quadratic)").between(2, 3).standard(2.0),
             choice("quadrature", {"nodal", "gauss"}, "integration points of an element").standard("nodal"),
             number("thickness", "m", "length out of the plane").positive().standard(1.0)}};
  return s;
}

CaseLine case_line(const Values& table) {
  return {{&table},
          names_used(table, "upper"),
          names_used(table, "lower"),
          table.integer("nodes_per_element"),
          table.text("quadrature") == "nodal" ? LineQuadrature::nodal : LineQuadrature::gauss,
          table.number("thickness")};
}

const Section& water_section() {
  static const Section s{
      "water",
      "water in the joint: it pushes both faces apart over the whole area, in contact or not, and does not change in time. The pressures "
      "of "
      "the contact are then those beyond the water's (effective pressures). Static stages apply it like a constant load",
      Fields{
          number("level", "m", "height of the water table: pressure unit_weight x (level - height of the point), zero above; or give head")
              .optional(),
          number("head", "m", "pressure head, the same at every point").nonnegative().optional(),
          number("unit_weight", "Pa/m", "unit weight of the water, 1 Pa/m = 1 N/m3").positive().standard(9810.0)}};
  return s;
}

CaseWater case_water(const Values& table) {
  first_of_two(table, "level", "head");
  return {{&table}, number_if(table, "level"), number_if(table, "head").value_or(0), table.number("unit_weight")};
}

}  // namespace

const Section& foundation_section() {
  static const Section s{
      "foundation",
      "a rigid footing whose ground is one element with displacements and rotations (macro-element), instead of an interface of points",
      Fields{text("name", "name"), text("body", "node (the master of the footing) that the ground carries"),
             choice("shape", {"strip", "rectangle", "disc"}, "plan of the underside").standard("rectangle"),
             number("width", "m", "width of the underside, along the x axis but for azimuth; of a disc its diameter").positive(),
             number("length", "m", "across the width: in the plane out of the plane, absent 1 m; in space needed but for a disc")
                 .positive()
                 .optional(),
             number("azimuth", "rad", "in space: angle from the x axis to the width, about the normal").standard(0.0),
             vector("offset", "m", "from the node to the middle of the footing's underside").optional(),
             table("soil", footing_soil_section(), "gives the stiffnesses that the model leaves out").optional(),
             part("model", foundation_models, "what the ground does")}};
  return s;
}

CaseFoundation case_foundation(const Values& table) {
  const Values* soil = table_if(table, "soil");
  return {{&table},
          name_used(table, "name"),
          name_used(table, "body"),
          *footprint_shape(table.text("shape")),
          table.number("width"),
          number_if(table, "length"),
          table.number("azimuth"),
          vector_used(table, "offset"),
          soil,
          soil != nullptr && soil->flag("radiation"),
          &table.part("model")};
}

const Section& interface_section() {
  static const Section s{
      "interface", "a surface that may open: exactly one of footing, pairs, line, surface and cut says where",
      Fields{
          text("name", "name"), table("footing", footing_section(), "under a rigid footing").optional(),
          table("pairs", pairs_section(), "isolated points").optional(), table("line", line_section(), "along a line").optional(),
          table("surface", surface_section(), "along faces (edges) inside the mesh").optional(),
          table("cut", cut_section(), "on a plane through cells of the mesh").optional(),
          number("gap", "m",
                 "initial gap of every point; geometry: the distance along the normal at which both sides are drawn, of pairs, lines and "
                 "surfaces with two groups")
              .or_word("geometry")
              .standard(0.0),
          table("gap_profile", gap_profile_section(), "initial gaps that vary over the interface, added to gap").optional(),
          table("water", water_section(), "water pressure in the joint; absent: none").optional(),
          choice("role", {"base", "wall"},
                 "base: carries the structure and may lift off; uplift, eccentricity, safeties and the headline are those of bases. wall: "
                 "stands beside it. Absent: by the normals, base within 45 degrees of the direction of gravity (of the vertical axis "
                 "without gravity); a surface with faces of both kinds is divided, the walls of \"soil\" become \"soil walls\"")
              .optional(),
          part("law", interface_behaviours, "what it does: a traction law or a cone (contact by constraint)")}};
  return s;
}

CaseInterface case_interface(const Values& table) {
  CaseInterface made{{&table}, name_used(table, "name"), {}, table.is_word("gap"), 0, table_if(table, "gap_profile"), {},
                     {},       &table.part("law")};
  const auto kinds =
      std::ranges::count_if(std::array{"footing", "pairs", "line", "surface", "cut"}, [&](const char* key) { return table.has(key); });
  if (kinds != 1) fail(table, "", "exactly one of footing, pairs, line, surface and cut", kinds == 0 ? "none" : fmt::format("{}", kinds));
  const auto take = [&](const char* key, auto read) {
    if (table.has(key)) made.place = read(table.table(key));
  };
  take("footing", case_footing);
  take("pairs", case_pairs);
  take("line", case_line);
  take("surface", case_surface);
  take("cut", case_cut);
  if (!made.gap_of_geometry) made.gap = table.number("gap");
  if (const Values* water = table_if(table, "water")) made.water = case_water(*water);
  if (table.has("role")) made.role = table.text("role") == "base" ? Role::base : Role::wall;
  return made;
}

}  // namespace uplift
