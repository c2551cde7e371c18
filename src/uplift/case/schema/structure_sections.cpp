#include "uplift/case/schema/structure_sections.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "uplift/model/function.h"

namespace uplift {
namespace {

using Fields = std::vector<Field>;

/// Something about the three axes: `plural` in space, else `single`, which is about z, or with `everywhere` about all axes of space. Zero
/// when neither is there.
Vec3 about_axes(const Values& table, std::string_view single, std::string_view plural, bool everywhere, Space space) {
  if (table.has(plural)) {
    if (space.dimension == 2) fail(table, plural, fmt::format("{} in a plane model", single), "three numbers");
    if (table.has(single) && table.number(single) != 0) fail(table, single, fmt::format("either {} or {}", single, plural), "both");
    const std::vector<double>& numbers = table.numbers(plural);
    return {numbers[0], numbers[1], numbers[2]};
  }
  const double value = table.has(single) ? table.number(single) : 0;
  return everywhere && space.dimension == 3 ? Vec3(value, value, value) : Vec3(0, 0, value);
}

}  // namespace

const Section& node_section() {
  static const Section s{"node",
                         "NAME = [x, y]: a point of the structure, with the unknowns ux, uy (m) and rz (rad, counter-clockwise); in space "
                         "NAME = [x, y, z] with "
                         "ux, uy, uz, rx, ry, rz",
                         Fields{vector("value", "m", "position [x, y], y points up; in space [x, y, z], z points up")}};
  return s;
}

CaseNode case_node(const Values& table, Space space) {
  return {{&table}, table.key(), vector_of(table, "value", space)};
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

CaseMass case_mass(const Values& table, Space space) {
  first_of_two(table, "mass", "tuned_frequency");
  return {{&table},
          name_used(table, "node"),
          number_if(table, "mass"),
          number_if(table, "tuned_frequency").value_or(0),
          about_axes(table, "inertia", "inertias", true, space)};
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

CaseElement case_element(const Values& table, const ElementEntry& entry) {
  using enum ElementPlace;
  if (entry.place == nodes) return {{&table}, &entry, names_used(table, "nodes"), {}, {}};
  if (entry.place != lines) return {{&table}, &entry, {}, name_used(table, "group"), {}};
  first_of_two(table, "nodes", "group");
  return {{&table}, &entry, names_used(table, "nodes"), name_if(table, "group"), name_used(table, "name"), table.integer("elements")};
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

CaseBody case_body(const Values& table, Space space) {
  return {{&table},
          name_if(table, "name"),
          name_if(table, "node"),
          name_if(table, "group"),
          names_used(table, "slaves"),
          table.number("mass"),
          about_axes(table, "inertia", "inertias", true, space),
          vector_if(table, "centre", space)};
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

CaseSupport case_support(const Values& table) {
  return {{&table}, node_or_group(table), names_used(table, "fixed"), table.text("stages") == "static"};
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

CaseMotion case_motion(const Values& table) {
  const NodeOrGroup of = node_or_group(table);
  const NameUsed direction = name_used(table, "direction");
  return {{&table},
          of,
          text_or(table, "name", "motion of " + of.name()),
          direction,
          direction.name.starts_with('r'),
          table.text("amplitude"),
          name_if(table, "function")};
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

/// A direction alone: its length would be a factor on the earthquake that nobody has asked for.
CaseGround case_ground(const Values& table, Space space) {
  constexpr double rounded = 0.01;  // [0.71, 0.71]
  const Vec3 direction = vector_if(table, "direction", space).value_or(space.axis(0));
  if (const double length = direction.norm(); std::abs(length - 1) > rounded)
    fail(table, "direction", "a direction of length 1 (the amplitude is the factor)", fmt::format("one of length {:.4g}", length));
  return {{&table}, text_or(table, "name", "ground acceleration"), direction, table.number("amplitude"), name_used(table, "function")};
}

const Section& gravity_section() {
  static const Section s{
      "gravity", "weight of all masses, applied by the static stages",
      Fields{vector("acceleration", "m/s2", "for example [0, \"-9.81 m/s2\"]; absent: 9.81 m/s2 downwards (y, in space z)").optional()}};
  return s;
}

CaseGravity case_gravity(const Values& table, Space space) {
  return {{&table}, vector_if(table, "acceleration", space).value_or(-9.81 * space.axis(space.up()))};
}

const Section& function_section() {
  static const Section s{
      "function", "a function of time that loads and motions refer to",
      Fields{text("name", "name"), part("shape", time_functions, "what it is; without unit: it multiplies an amplitude")}};
  return s;
}

CaseFunction case_function(const Values& table) {
  const Values& shape = table.part("shape");
  return {{&table}, name_used(table, "name"), &shape, shape.items().contains("file") ? name_if(shape, "file") : std::nullopt};
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

CaseLoad case_load(const Values& table, Space space) {
  CaseLoad load{{&table},
                node_or_group(table),
                {},
                vector_if(table, "force", space),
                vector_if(table, "traction", space),
                number_if(table, "pressure"),
                about_axes(table, "moment", "moments", false, space),
                {},
                name_if(table, "function")};
  load.name = text_or(table, "name", "load on " + load.of.name());
  const auto refuse = [&](std::initializer_list<const char*> keys, const char* wanted, const char* found) {
    for (const char* key : keys)
      if (table.has(key)) fail(table, key, wanted, found != nullptr ? found : key);
  };
  if (load.of.node) {
    refuse({"traction", "pressure", "profile"}, "force or moment on a node", nullptr);
    if (!load.force && !table.has("moment") && !table.has("moments")) fail(table, "", "force or moment", "neither");
    return load;
  }
  refuse({"moment", "moments"}, "pressure, traction or force on a group", "a moment");
  std::string found;
  for (const char* key : {"pressure", "traction", "force"}) {
    if (!table.has(key)) continue;
    if (!found.empty()) fail(table, key, "only one of pressure, traction, force", fmt::format("{} and {}", found, key));
    found = key;
  }
  if (found.empty()) fail(table, "", "one of pressure, traction, force on a group", "none");
  if (const Values* profile = table_if(table, "profile")) {
    if (load.force) fail(*profile, "", "profile with pressure or traction", "profile with force");
    load.profile = load_profile(*profile, space);
  }
  return load;
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

CaseInitial case_initial(const Values& table, Space space) {
  const auto motion = [&](const char* translation, const char* rotation, const char* rotations) {
    CaseInitial::Motion made{vector_if(table, translation, space), {}};
    if (table.has(rotation) || table.has(rotations)) made.rotation = about_axes(table, rotation, rotations, false, space);
    return made;
  };
  CaseInitial initial{{&table},
                      node_or_group(table),
                      motion("displacement", "rotation", "rotations"),
                      motion("velocity", "angular_velocity", "angular_velocities"),
                      vector_if(table, "centre", space)};
  if (initial.centre && !(initial.of.group && (initial.displacement.rotation || initial.velocity.rotation)))
    fail(table, "centre", "centre with a group that rotates", "centre without a group or without a rotation");
  return initial;
}

}  // namespace uplift
