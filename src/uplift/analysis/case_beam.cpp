#include <fmt/format.h>

#include <functional>

#include "uplift/analysis/case_model.h"
#include "uplift/elements/beam.h"
#include "uplift/elements/space_beam.h"

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

BeamSection plane_section(const Values& beam) {
  for (const char* key : {"I_y", "I_z", "J", "up"})
    if (beam.has(key)) fail(beam, key, "I alone in a plane model", fmt::format("{}", key));
  if (!beam.has("I")) fail(beam, "I", "a second moment of area > 0 m4", "nothing");
  BeamSection section;
  section.bending = beam.number("E") * beam.number("I");
  if (beam.has("A")) section.axial = beam.number("E") * beam.number("A");
  add_beam_mass(beam, section);
  if (const auto shear = shear_of(beam)) {
    section.shear = *shear;
    if (section.mass != BeamSection::Mass::none) section.rotary_per_length = beam.number("density") * beam.number("I");
  }
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
  if (const auto shear = shear_of(beam)) {
    section.shear_y = section.shear_z = *shear;
    if (section.mass != BeamSection::Mass::none) {
      section.rotary_y = beam.number("density") * about_y;
      section.rotary_z = beam.number("density") * about_z;
    }
  }
  return section;
}

/// Makes the elements of a beam, one after another.
using MakeBeam = std::function<std::unique_ptr<Element>(int a, int b, const Place& from, const Place& to)>;

MakeBeam beam_maker(const Values& beam, const Vec3& along, Space space) {
  if (space.dimension == 2) {
    const BeamSection section = plane_section(beam);
    return [section](int a, int b, const Place& from, const Place& to) {
      return std::make_unique<Beam>(a, b, from.head<2>(), to.head<2>(), section);
    };
  }
  const SpaceBeamSection section = space_section(beam);
  std::optional<Vec3> up;
  if (beam.has("up")) up = vector_of(beam, "up", space);
  if (!beam_axes(along, up)) fail(beam, "up", "a direction that is not along the beam", "one along it");
  return
      [section, up](int a, int b, const Place& from, const Place& to) { return std::make_unique<SpaceBeam>(a, b, from, to, section, up); };
}

void add_beam(const Values& beam, ModelBuilder& builder, CaseNames& names, Names& beams) {
  beams.add(beam, "name");
  const std::vector<int> ends = names.nodes_of(beam, "nodes");
  if (ends.size() != 2) fail(beam, "nodes", "two nodes", fmt::format("{}", ends.size()));
  const Place a = names.positions[ends[0]], b = names.positions[ends[1]];
  if ((b - a).norm() == 0) fail(beam, "nodes", "two nodes at different places", "two nodes at the same place");
  const MakeBeam make = beam_maker(beam, b - a, names.space);
  const int pieces = beam.integer("elements");
  int last = ends[0];
  Place from = a;
  for (int k = 1; k <= pieces; ++k) {
    const Place to = k == pieces ? b : Place(a + (b - a) * (static_cast<double>(k) / pieces));
    int next = ends[1];
    if (k < pieces) {
      const std::string name = fmt::format("{}.{}", beam.text("name"), k);
      next = builder.add_node(name, to, beam.where());
      names.nodes.add(name, beam.where("name"), beam.path("name"));
      names.positions.push_back(to);
    }
    auto element = make(last, next, from, to);
    element->beta = beam.number("damping_beta");
    if (!beam.has("A")) builder.inextensible(last, next, beam.where());
    builder.add_element(std::move(element), beam.where());
    last = next;
    from = to;
  }
}

}  // namespace

void add_beams(const Values& root, ModelBuilder& builder, CaseNames& names) {
  Names beams("beam");
  for (const Values& beam : root.tables("beam")) add_beam(beam, builder, names, beams);
}

}  // namespace uplift
