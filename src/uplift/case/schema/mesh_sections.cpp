#include "uplift/case/schema/mesh_sections.h"

#include <fmt/format.h>

#include <algorithm>

#include "uplift/base/text.h"
#include "uplift/mesh/cells.h"

namespace uplift {
namespace {

using Fields = std::vector<Field>;

const Section& layer_section() {
  static const Section s{"layer", "a layer of the soil, from top to bottom; its cells are the group soil_1, soil_2, ...",
                         Fields{number("thickness", "m", "thickness").positive(),
                                number("size", "m", "largest height of an element").positive().standard(1.0)}};
  return s;
}

const Section& soil_section() {
  static const Section s{"soil", "the soil, its surface at y = 0 (in space z = 0)",
                         Fields{number("width", "m", "width along x").positive(),
                                number("length", "m", "length along y: this makes the mesh one in space").positive().optional(),
                                number("size", "m", "largest width of an element away from the foundation").positive().standard(4.0),
                                tables("layers", layer_section(), "layers from top to bottom; at least one")}};
  return s;
}

Field part_width() {
  return number("width", "m", "width along x").positive();
}
Field part_length() {
  return number("length", "m", "in space: length along y; absent: as the width").positive().optional();
}
Field part_height() {
  return number("height", "m", "height").positive();
}
Field part_size() {
  return number("size", "m", "largest size of an element").positive().standard(1.0);
}

const Section& raft_section() {
  static const Section s{"raft", "the foundation, in the middle of the soil (x = 0, in space y = 0)",
                         Fields{part_width(), part_length(), part_height(), part_size()}};
  return s;
}

const Section& block_section() {
  static const Section s{"block", "the building, on the raft (without one: on the soil)",
                         Fields{part_width(), part_length(), part_height(), part_size(),
                                number("offset", "m", "of its middle from the middle of the soil, along x").standard(0.0),
                                number("offset_y", "m", "in space: the same along y").standard(0.0)}};
  return s;
}

const Section& soil_box_section() {
  static const Section s{
      "soil_box",
      "layered soil with a building on it, or level ground. Groups of cells: soil_1, soil_2, ..., raft, block; of edges (faces): "
      "soil_left, soil_right, "
      "in space soil_front, soil_back, soil_bottom, soil_top, the same of raft_ and block_, and interface (between soil and building)",
      Fields{table("soil", soil_section(), "the soil"), table("raft", raft_section(), "the foundation; absent: none").optional(),
             table("block", block_section(), "the building; absent: none").optional(),
             number("embedment", "m", "depth of the foundation's underside below the soil surface").nonnegative().standard(0.0),
             number("growth", "1", "growth of the elements away from the foundation, one to the next").between(1.01, 2).standard(1.25),
             choice("cell", {"quad4", "quad8", "quad9", "tri3", "tri6", "hex8", "hex20", "hex27", "tet4", "tet10", "wedge6", "wedge15"},
                    "type of the elements; absent: quad4, in space hex8")
                 .optional()}};
  return s;
}

Cell cell_named(const std::string& name) {
  return std::ranges::find(all_cells(), name, &CellInfo::name)->cell;
}

SoilBox::Part part_from(const Values* table) {
  SoilBox::Part part;
  if (!table) return part;
  part.width = {table->number("width"), table->number(table->has("length") ? "length" : "width")};
  part.height = table->number("height");
  part.size = table->number("size");
  if (table->items().contains("offset")) part.offset = {table->number("offset"), table->number("offset_y")};
  return part;
}

SoilBox soil_box_of(const Values& box) {
  SoilBox made;
  const Values& soil = box.table("soil");
  made.dimension = soil.has("length") ? 3 : 2;
  made.soil.width = {soil.number("width"), soil.number(soil.has("length") ? "length" : "width")};
  made.soil.size = soil.number("size");
  made.soil.layers.clear();
  for (const Values& layer : soil.tables("layers")) made.soil.layers.push_back({layer.number("thickness"), layer.number("size")});
  if (made.soil.layers.empty()) fail(soil, "layers", "at least one layer", "none");
  for (const char* part : {"raft", "block"})
    if (const Values* table = table_if(box, part); table && table->has("length") && made.dimension == 2)
      fail(*table, "length", "no length in a mesh in the plane (a length of mesh.soil_box.soil makes it one in space)",
           fmt::format("{:g} m", table->number("length")));
  made.raft = part_from(table_if(box, "raft"));
  made.block = part_from(table_if(box, "block"));
  made.embedment = box.number("embedment");
  made.growth = box.number("growth");
  made.cell = box.has("cell") ? cell_named(box.text("cell")) : made.dimension == 2 ? Cell::quad4 : Cell::hex8;
  if (info(made.cell).dimension != made.dimension)
    fail(box, "cell",
         made.dimension == 2 ? "a cell of the plane (soil.length makes the mesh one in space)" : "a cell of space, for example hex8",
         in_quotes(box.text("cell")));
  return made;
}

}  // namespace

const Section& mesh_section() {
  static const Section s{"mesh",
                         "mesh of solids and beams, in the plane or in space: either a file or a soil box. Its nodes are called mesh.1, "
                         "mesh.2, ...; a node that "
                         "is a group of its own has the name of the group",
                         Fields{text("file", "mesh of Gmsh (.msh) or MED (.med), in metres; in the plane where all z are equal").optional(),
                                text("name", "the mesh to take when a MED file holds several").optional(),
                                table("soil_box", soil_box_section(), "a made mesh").optional()}};
  return s;
}

CaseMeshSource case_mesh_source(const Values& table) {
  const bool file = table.has("file");
  const Values* box = table_if(table, "soil_box");
  if (file == (box != nullptr)) fail(table, "", "either file or soil_box", file ? "both" : "neither");
  return {
      {&table}, name_if(table, "file"), text_or(table, "name", ""), box != nullptr ? std::optional(soil_box_of(*box)) : std::nullopt, box};
}

CaseAbsorbing case_absorbing(const Values& table) {
  CaseAbsorbing made{{&table}, name_used(table, "group"), table.flag("free_field"), table.flag("lumped"), {}};
  if (const Values* incident = table_if(table, "incident")) {
    const std::string& wave = incident->text("wave");
    // The surface of free rock moves twice as much as the wave that comes up.
    const double incoming = incident->text("kind") == "outcrop" ? 0.5 : 1;
    made.incident = {{incident},
                     incident->text("name"),
                     wave == "P"    ? Wave::p
                     : wave == "SV" ? Wave::sv
                                    : Wave::sh,
                     wave,
                     incident->number("azimuth"),
                     incoming * incident->number("velocity"),
                     incident->number("velocity"),
                     name_used(*incident, "function")};
  }
  return made;
}

const Section& tie_section() {
  static const Section s{
      "tie",
      "nodes of one side of the mesh that move as those at the same place of the opposite side, as in ground that goes on "
      "the same",
      Fields{text("group", "group of the mesh"), text("to", "group of the opposite side"),
             texts("unknowns", "any of ux, uy; in space of ux, uy, uz")}};
  return s;
}

CaseTie case_tie(const Values& table) {
  return {{&table}, name_used(table, "group"), name_used(table, "to"), names_used(table, "unknowns")};
}

const Section& surface_section() {
  static const Section s{
      "surface",
      "edges (faces) inside the mesh, which is opened there (group and lower), or two groups of edges (faces) that are drawn apart and lie "
      "opposite to each other node by node (lower_group and upper_group)",
      Fields{text("group", "group of edges (faces) at which the mesh is opened").optional(),
             texts("lower", "groups of cells of the lower side (soil); all other cells are the upper side").optional(),
             text("lower_group", "group of edges (faces) on the surface of the lower side, instead of group").optional(),
             text("upper_group", "group of edges (faces) of the upper side opposite to lower_group").optional(),
             choice("quadrature", {"nodal", "gauss"}, "where the joint points stand: at the pairs of nodes, or at Gauss points")
                 .standard("nodal"),
             number("thickness", "m", "length out of the plane (plane meshes); absent: that of the solids (the smaller one)")
                 .positive()
                 .optional()}};
  return s;
}

CaseSurface case_surface(const Values& table) {
  CaseSurface surface{{&table},
                      name_if(table, "group"),
                      table.texts("lower"),
                      name_if(table, "lower_group"),
                      name_if(table, "upper_group"),
                      table.text("quadrature") == "nodal",
                      number_if(table, "thickness")};
  const bool lower = table.has("lower");
  const bool apart = surface.lower_group && surface.upper_group, opened = surface.group && lower;
  const int given = surface.lower_group.has_value() + surface.upper_group.has_value() + surface.group.has_value() + lower;
  if (given != 2 || !(apart || opened))
    fail(table, "", "group and lower, or lower_group and upper_group",
         given == 0  ? "none of them"
         : given < 2 ? "one of them"
                     : fmt::format("{} of them", given));
  return surface;
}

const Section& cut_section() {
  static const Section s{
      "cut",
      "a plane through cells of the mesh that ignore it: level, or point and normal. Below it the groups stay as they are. Above it they "
      "are filled within the outline alone (x, y, height), or everywhere without one",
      Fields{
          texts("through", "groups of cells that the plane cuts"),
          number("level", "m", "height of a horizontal plane (y in the plane, z in space); or give point and normal").optional(),
          vector("point", "m", "a point of the plane").optional(),
          vector("normal", "1", "its normal, from the ground to the structure").optional(),
          text("upper", "group of the cells above the plane, a new name or a group of the mesh; absent: they stay in their groups")
              .optional(),
          vector("x", "m", "outline above the plane: least and largest x; absent: no limit").optional(),
          vector("y", "m", "in space: least and largest y of the outline; absent: no limit").optional(),
          number("height", "m", "height of the outline above the plane; absent: no limit").positive().optional(),
          text("free",
               "name for the surface that the ground has in the plane beside the outlines, where nothing stands on it: the group of loads "
               "on it, of no other table. Absent: it carries none")
              .optional(),
          vector("ground_x", "m",
                 "ground with bases at several levels: least and largest x of the part that has this one, along faces of cells; absent: "
                 "all of the groups")
              .optional(),
          vector("ground_y", "m", "in space: least and largest y of that part").optional(),
          choice("jump", {"linear", "constant", "rigid"},
                 "how the opening varies within a cell: linear, as the displacements, each side with strains of its own; constant or "
                 "rigid: the element-condensed form of the literature, one strain for both sides (plane meshes, to compare with it)")
              .standard("linear"),
          number("mesh_shift", "1",
                 "the nodes near the plane are moved along its normal by this share of the height of the cells there, to see whether it "
                 "matters how the plane lies in the mesh (trust)")
              .between(-0.45, 0.45)
              .standard(0.0),
          number("thickness", "m", "length out of the plane (plane meshes); absent: that of the solids (the smaller one)")
              .positive()
              .optional()}};
  return s;
}

std::optional<VectorUsed> vector_used(const Values& table, std::string_view key) {
  return table.has(key) ? std::optional(VectorUsed{&table, key}) : std::nullopt;
}

CaseCut case_cut(const Values& table) {
  using enum CaseCut::Jump;
  const auto range = [&](const char* key) -> std::optional<CaseCut::Range> {
    if (!table.has(key)) return std::nullopt;
    const std::vector<double>& ends = table.numbers(key);
    if (ends.size() != 2 || !(ends[0] < ends[1]))
      fail(table, key, "two numbers, the least and the largest",
           ends.size() == 2 ? fmt::format("{:g} and {:g}", ends[0], ends[1]) : fmt::format("{} numbers", ends.size()));
    return CaseCut::Range{ends[0], ends[1]};
  };
  const std::string& jump = table.text("jump");
  CaseCut cut{{&table},
              table.texts("through"),
              number_if(table, "level"),
              vector_used(table, "point"),
              vector_used(table, "normal"),
              text_or(table, "upper", ""),
              range("x"),
              range("y"),
              range("ground_x"),
              range("ground_y"),
              number_if(table, "height"),
              name_if(table, "free"),
              jump == "linear"     ? linear
              : jump == "constant" ? constant
                                   : rigid,
              jump,
              table.number("mesh_shift"),
              number_if(table, "thickness")};
  if (cut.level.has_value() == cut.point.has_value() || (cut.point && !cut.normal))
    fail(table, "", "either level, or point and normal", cut.level ? "both" : cut.point ? "no normal" : "neither");
  if (cut.level && cut.normal) fail(table, "normal", "either level, or point and normal", "level and normal");
  if (cut.through.empty()) fail(table, "through", "at least one group of cells", "none");
  if (std::ranges::find(cut.through, cut.upper) != cut.through.end())
    fail(table, "upper", "another group than those of `through`, or none", in_quotes(cut.upper));
  return cut;
}

}  // namespace uplift
