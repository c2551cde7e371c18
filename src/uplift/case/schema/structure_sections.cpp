#include "uplift/case/schema/structure_sections.h"

#include <array>

#include "uplift/case/build/profile.h"
#include "uplift/model/function.h"

namespace uplift {
namespace {

using Fields = std::vector<Field>;

}  // namespace

const Section& node_section() {
  static const Section s{"node",
                         "NAME = [x, y]: a point of the structure, with the unknowns ux, uy (m) and rz (rad, counter-clockwise); in space "
                         "NAME = [x, y, z] with "
                         "ux, uy, uz, rx, ry, rz",
                         Fields{vector("value", "m", "position [x, y], y points up; in space [x, y, z], z points up")}};
  return s;
}

const Section& mass_section() {
  static const Section s{
      "mass", "a point mass; it acts in all directions",
      Fields{text("name", "name").optional(), text("node", "node that carries it"),
             number("mass", "kg", "mass; or give tuned_frequency").positive().optional(),
             number("tuned_frequency", "Hz",
                    "find the mass for which the model with every interface bonded rigidly to fixed ground has this first frequency")
                 .positive()
                 .optional(),
             number("inertia", "kg m2", "rotary inertia; in space about every axis").nonnegative().standard(0.0),
             numbers("inertias", "kg m2", "in space: about the axes x, y, z, instead of inertia", 3).optional()}};
  return s;
}

const std::vector<Section>& element_sections(ElementPlace place) {
  const auto sections = [](ElementPlace of) {
    std::vector<Section> made;
    for (const ElementEntry* element : elements_at(of)) made.push_back({element->name, element->summary, element->params});
    return made;
  };
  static const std::array all{sections(ElementPlace::nodes), sections(ElementPlace::lines), sections(ElementPlace::cells),
                              sections(ElementPlace::faces)};
  return all[static_cast<std::size_t>(place)];
}

const Section& rigid_section() {
  static const Section s{
      "rigid", "a rigid body (a footing): its nodes follow the master node exactly",
      Fields{text("name", "name of the body, for messages").optional(),
             text("node", "master node; absent: the node of group that is nearest to its middle").optional(),
             texts("slaves", "further nodes of the body").optional(),
             text("group", "group of the mesh whose nodes belong to the body too: a rigid raft of solids, or the foot of a tower of beams")
                 .optional(),
             number("mass", "kg", "mass of the body").nonnegative().standard(0.0),
             number("inertia", "kg m2", "rotary inertia about the centre of mass; in space about every axis").nonnegative().standard(0.0),
             numbers("inertias", "kg m2", "in space: about the axes x, y, z through the centre, instead of inertia", 3).optional(),
             vector("centre", "m", "centre of mass; absent: the master node").optional()}};
  return s;
}

const Section& support_section() {
  static const Section s{
      "support", "unknowns that are held, of a node or of a group of the mesh",
      Fields{text("node", "node; or give group").optional(), text("group", "group of the mesh: all its nodes").optional(),
             texts("fixed", "any of ux, uy, rz; in space of ux, uy, uz, rx, ry, rz. Rotations of a group only where beams are"),
             choice("stages", {"all", "static"},
                    "static: it is released when the first dynamic stage begins; what it has borne goes on as a constant load")
                 .standard("all")}};
  return s;
}

Field amplitude_field() {
  Field field = text("amplitude",
                     "what the function, which has no unit, is multiplied by: a length, or an angle for a rotation, as 0.02, \"2 cm\" or "
                     "\"3 mrad\" (a bare number is in m or rad); of a record, which is a motion itself, a factor without a unit")
                    .standard("1");
  field.unit = "*";
  return field;
}

const Section& motion_section() {
  static const Section s{
      "motion",
      "a prescribed motion of one unknown of a node or of a group of the mesh: amplitude x function. The first static stage applies its "
      "value at t = 0 in proportion to the load factor",
      Fields{text("name", "name").optional(), text("node", "node; or give group").optional(),
             text("group", "group of the mesh: all its nodes").optional(),
             text("direction", "unknown that is moved: ux, uy or rz; in space ux, uy, uz, rx, ry or rz; of a group a translation"),
             amplitude_field(),
             text("function", "name of the function of time; absent: constant, for example a settlement, applied by the first static stage")
                 .optional()}};
  return s;
}

const Section& ground_section() {
  static const Section s{
      "ground_acceleration", "acceleration of the whole ground: inertia forces -M r a(t) in the frame that moves with it",
      Fields{text("name", "name").optional(), vector("direction", "1", "direction, of length 1; absent: the x axis").optional(),
             number("amplitude", "m/s2",
                    "acceleration that the function multiplies; of a record, which is an acceleration itself, a factor without unit")
                 .standard(1.0),
             text("function", "name of the function of time")}};
  return s;
}

const Section& gravity_section() {
  static const Section s{
      "gravity", "weight of all masses, applied by the static stages",
      Fields{vector("acceleration", "m/s2", "for example [0, \"-9.81 m/s2\"]; absent: 9.81 m/s2 downwards (y, in space z)").optional()}};
  return s;
}

const Section& function_section() {
  static const Section s{
      "function", "a function of time that loads and motions refer to",
      Fields{text("name", "name"), part("shape", time_functions, "what it is; without unit: it multiplies an amplitude")}};
  return s;
}

const Section& load_section() {
  static const Section s{
      "load", "a load on a node or on faces (edges) of the mesh; without a function it is constant and applied by the static stages",
      Fields{
          text("name", "name; absent: made from the node or group").optional(), text("node", "node; or give group").optional(),
          text("group", "group of faces (edges) of the mesh").optional(),
          vector("force", "N", "force; on a group: the whole force, spread evenly over its area").optional(),
          vector("traction", "Pa", "force per area of a group").optional(),
          number("pressure", "Pa",
                 "pressure on a group that bounds a solid: above 0 it pushes onto the surface, against its outward normal. Its direction "
                 "and its area do not change when the surface moves")
              .optional(),
          table("profile", load_profile_section(), "factors of pressure or traction over a coordinate; absent: uniform").optional(),
          number("moment", "N m", "moment on a node, counter-clockwise (about z)").optional(),
          numbers("moments", "N m", "in space: moments on a node about x, y, z, instead of moment", 3).optional(),
          text("function", "name of the function of time that multiplies it; absent: constant").optional()}};
  return s;
}

const Section& initial_section() {
  static const Section s{
      "initial",
      "state of a node or of a group of the mesh at the beginning of the first dynamic stage, added to that of the static stages. A group "
      "moves as a rigid body. Values that supports, prescribed motions, rigid bodies or inextensible beams do not allow are refused; "
      "unknowns that no value determines get the smallest possible values",
      Fields{text("node", "node; or give group").optional(), text("group", "group of the mesh: all its nodes").optional(),
             vector("displacement", "m", "displacement").optional(),
             number("rotation", "rad", "rotation, counter-clockwise (about z)").optional(),
             numbers("rotations", "rad", "in space: about x, y, z, instead of rotation", 3).optional(),
             vector("velocity", "m/s", "velocity").optional(), number("angular_velocity", "rad/s", "angular velocity (about z)").optional(),
             numbers("angular_velocities", "rad/s", "in space: about x, y, z, instead of angular_velocity", 3).optional(),
             vector("centre", "m", "of a group that rotates: the point about which it does; absent: the mean position of its nodes")
                 .optional()}};
  return s;
}

}  // namespace uplift
