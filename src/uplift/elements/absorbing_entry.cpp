#include "uplift/base/text.h"
#include "uplift/elements/absorbing.h"
#include "uplift/elements/element_entry.h"

// The table [[absorbing]]: faces of the mesh behind which the ground goes on.
namespace uplift {

AbsorbingSection absorbing_ground(const Values& absorbing, const FillingBeside& beside, Space space) {
  const std::string sides = space.dimension == 2 ? "edges" : "faces";
  const auto refuse = [&](const char* wanted, const char* found) {
    fail(absorbing, "group", sides + " of a solid " + wanted, sides + " of the solid " + in_quotes(beside.group) + " " + found);
  };
  if (!(beside.section.material.density > 0)) refuse("with a density", "without one");
  if (space.dimension == 2 && beside.section.plane != PlaneState::strain) refuse("in plane strain", "in plane stress");
  return {beside.section.material, beside.section.thickness, absorbing.flag("lumped")};
}

namespace {

const Section& incident_section() {
  static const Section s{
      "incident",
      "a plane wave that comes up through the face; the face then carries 2 rho c times its velocity, and absorbs what comes back",
      std::vector<Field>{
          choice("wave", {"P", "SV", "SH"}, "P: the particles move upwards; SV: along x; SH (in space): along y"),
          number("azimuth", "rad", "in space: turns the motion of S waves about the vertical, from x to y").standard(0.0),
          choice("kind", {"outcrop", "incoming"},
                 "what the function is: the motion that the free surface of the same rock would have (twice the incoming wave), or that of "
                 "the incoming wave alone. A motion recorded within the ground holds what comes down again: it is no incident wave but "
                 "a prescribed motion, [[motion]] with the group of the base, and the base then reflects"),
          number("velocity", "m/s", "velocity that the function multiplies").standard(1.0),
          text("function", "name of the function of time: a velocity"), text("name", "name").standard("incident wave")}};
  return s;
}

}  // namespace

const ElementEntry& entry_element_absorbing() {
  static const ElementEntry entry{
      {{.name = "absorbing",
        .summary =
            "a viscous boundary: edges (faces) of the mesh through which waves leave (Lysmer & Kuhlemeyer), with the material of the "
            "solid beside them. It holds nothing at rest: static stages need supports elsewhere",
        .equations = "t = -(rho Vp (n . v) n + rho Vs (v - (n . v) n)) on the velocity v, n: normal; material of the solid beside",
        .source = "Lysmer & Kuhlemeyer, J. Eng. Mech. Div. ASCE 95 (1969) 859-877; docs/theory, section 8, eq (21)",
        .params =
            {text("group", "group of edges (faces) of the mesh"), flag("lumped", "diagonal damping matrix").standard(false),
             flag(
                 "free_field",
                 "for sides: the boundary follows a column of level ground (the layers beside it) under the incident wave at its foot, and "
                 "absorbs only what differs from it")
                 .standard(false),
             table("incident", incident_section(),
                   "a wave that comes in; absent: none. Several waves: several tables [[absorbing]] with the same group, an incident in "
                   "each; the "
                   "boundary is there once, and the waves add up")
                 .optional()}},
       nullptr},
      "",
      ElementPlace::faces,
      nullptr,
      [](const CellSite& site, const Values& absorbing, const FillingBeside& beside, Space space) -> std::unique_ptr<Element> {
        return std::make_unique<AbsorbingFace>(site.cell, site.nodes, site.coordinates, absorbing_ground(absorbing, beside, space),
                                               site.part);
      }};
  return entry;
}

}  // namespace uplift
