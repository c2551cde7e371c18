#include "uplift/case/schema/mesh_sections.h"

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

const Section& tie_section() {
  static const Section s{
      "tie",
      "nodes of one side of the mesh that move as those at the same place of the opposite side, as in ground that goes on "
      "the same",
      Fields{text("group", "group of the mesh"), text("to", "group of the opposite side"),
             texts("unknowns", "any of ux, uy; in space of ux, uy, uz")}};
  return s;
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

}  // namespace uplift
