#include <fmt/format.h>

#include "uplift/elements/element_entry.h"
#include "uplift/elements/space_beam.h"

// [[beam]]: Euler-Bernoulli and Timoshenko beams, in the plane and in space.
namespace uplift {
namespace {

/// Mass of a beam by its table; density times area.
template <typename Section>
void add_beam_mass(const Values& beam, Section& section) {
  if (beam.text("mass") == "none") return;
  if (!beam.has("density") || !beam.has("A")) fail(beam, "mass", "density and A of the beam", !beam.has("density") ? "no density" : "no A");
  section.mass = beam.text("mass") == "consistent" ? BeamSection::Mass::consistent : BeamSection::Mass::lumped;
  section.mass_per_length = beam.number("density") * beam.number("A");
}

/// Shear stiffness G A_s [N]; nothing for Euler-Bernoulli beams.
std::optional<double> shear_of(const Values& beam) {
  if (beam.text("theory") != "timoshenko") return {};
  if (!beam.has("shear_area")) fail(beam, "", "shear_area for theory = \"timoshenko\"", "none");
  return beam.number("E") / (2 * (1 + beam.number("poisson"))) * beam.number("shear_area");
}

/// Whether the cross-sections have rotary inertia: those of lumped masses always, since the rotations of the nodes would be massless
/// otherwise; consistent masses with the theory that has it (Timoshenko).
bool turns_with_inertia(BeamSection::Mass mass, bool timoshenko) {
  return mass == BeamSection::Mass::lumped || (mass == BeamSection::Mass::consistent && timoshenko);
}

BeamSection plane_section(const Values& beam) {
  for (const char* key : {"I_y", "I_z", "J", "up"})
    if (beam.has(key)) fail(beam, key, "I alone in a plane model", fmt::format("{}", key));
  if (!beam.has("I")) fail(beam, "I", "a second moment of area > 0 m4", "nothing");
  BeamSection section;
  section.bending = beam.number("E") * beam.number("I");
  if (beam.has("A")) section.axial = beam.number("E") * beam.number("A");
  add_beam_mass(beam, section);
  const auto shear = shear_of(beam);
  if (shear) section.shear = *shear;
  if (turns_with_inertia(section.mass, shear.has_value())) section.rotary_per_length = beam.number("density") * beam.number("I");
  return section;
}

SpaceBeamSection space_section(const Values& beam) {
  const bool one = beam.has("I"), two = beam.has("I_y") && beam.has("I_z");
  if (one == two || (one && (beam.has("I_y") || beam.has("I_z")))) fail(beam, "", "either I, or I_y and I_z", one ? "both" : "neither");
  if (!beam.has("J")) fail(beam, "", "J, the torsion constant, in a model in space", "none");
  const double young = beam.number("E"), about_y = beam.number(one ? "I" : "I_y"), about_z = beam.number(one ? "I" : "I_z");
  SpaceBeamSection section;
  section.bending_y = young * about_y;
  section.bending_z = young * about_z;
  section.torsion = young / (2 * (1 + beam.number("poisson"))) * beam.number("J");
  if (beam.has("A")) section.axial = young * beam.number("A");
  add_beam_mass(beam, section);
  if (section.mass != BeamSection::Mass::none) section.polar = beam.number("density") * (about_y + about_z);
  const auto shear = shear_of(beam);
  if (shear) section.shear_y = section.shear_z = *shear;
  if (turns_with_inertia(section.mass, shear.has_value())) {
    section.rotary_y = beam.number("density") * about_y;
    section.rotary_z = beam.number("density") * about_z;
  }
  return section;
}

std::unique_ptr<const Element> made(const ElementSite& site, const Values& beam) {
  std::unique_ptr<Element> element;
  const int a = site.nodes[0], b = site.nodes[1];
  const Vec3 &from = site.positions[0], &to = site.positions[1];
  if (site.space.dimension == 2) {
    element = std::make_unique<Beam>(a, b, from.head<2>(), to.head<2>(), plane_section(beam));
  } else {
    const SpaceBeamSection section = space_section(beam);
    std::optional<Vec3> up;
    if (beam.has("up")) up = vector_of(beam, "up", site.space);
    if (!beam_axes(to - from, up)) {
      if (site.line.empty()) fail(beam, "up", "a direction that is not along the beam", "one along it");
      fail(beam, "up", "a direction that is along none of its lines", "one along " + site.line);
    }
    element = std::make_unique<SpaceBeam>(a, b, from, to, section, up);
  }
  element->beta = beam.number("damping_beta");
  return element;
}

}  // namespace

bool has_idle_density(const Values& beam) {
  return beam.items().contains("density") && beam.given("density") && !beam.given("mass");
}

const ElementEntry& entry_element_beam() {
  static const ElementEntry entry{
      {{.name = "beam",
        .summary = "a straight beam between two nodes, or the lines of a group of the mesh. Beams that share a node are rigidly connected. "
                   "Solids hold no rotation: a beam that ends at their node is hinged there, unless a [[rigid]] group clamps it or it runs "
                   "on along their edges (softer)",
        .equations = "plane: EI w'''' (theory = \"timoshenko\": with the shear stiffness G A_s), EA u'', exact in statics for end loads\n"
                     "space: the same about both principal axes, and Saint-Venant's torsion G J\n"
                     "P-Delta: geometric stiffness of the axial force",
        .source = "Przemieniecki, Theory of Matrix Structural Analysis (1968), sections 5.6 and 11.4; docs/theory, section 13",
        .params =
            {text("name",
                  "name; inner nodes of a subdivided beam are called NAME.1, NAME.2, ..., of the n-th line of a group NAME.n.1, ..."),
             texts("nodes", "the two end nodes; or give group").optional(),
             text("group", "group of lines of the mesh; one with a node in its middle becomes two straight beams").optional(),
             number("E", "Pa", "Young's modulus").positive(),
             number("I", "m4", "second moment of area of the cross-section; in space about both axes").positive().optional(),
             number("I_y", "m4", "in space: second moment of area about the local y axis; with I_z instead of I").positive().optional(),
             number("I_z", "m4", "in space: about the local z axis").positive().optional(),
             number("J", "m4", "in space: torsion constant").positive().optional(),
             vector("up", "1",
                    "in space: local z lies in the plane of the beam and this direction; absent: the vertical, of vertical beams x (each "
                    "line of a group by itself)")
                 .optional(),
             number("A", "m2", "area of the cross-section; absent: the beam is inextensible (eliminated exactly)").positive().optional(),
             choice("theory", {"euler_bernoulli", "timoshenko"}, "bending only, or with shear").standard("euler_bernoulli"),
             number("poisson", "1", "Poisson's ratio (shear modulus of a Timoshenko beam)").between(0, 0.5).standard(0.3),
             number("shear_area", "m2", "effective shear area of a Timoshenko beam").positive().optional(),
             choice("mass", {"none", "consistent", "lumped"},
                    "mass matrix of the beam. consistent: with rotary inertia of the cross-section for theory = \"timoshenko\"; lumped: "
                    "half of the mass and of the rotary inertia density x I x length at each end")
                 .standard("none"),
             number("density", "kg/m3", "density; needed unless mass = \"none\", and then A too").positive().optional(),
             integer("elements", "number of equal elements, of a group between two nodes of the mesh").between(1, 10000).standard(1.0),
             number("damping_beta", "s", "stiffness-proportional damping factor of this beam alone").nonnegative().standard(0.0)}},
       made},
      "",
      ElementPlace::lines};
  return entry;
}

}  // namespace uplift
