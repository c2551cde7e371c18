#include "uplift/elements/beam.h"

#include <fmt/format.h>

#include <functional>

#include "uplift/case/build/model.h"
#include "uplift/case/mesh/beam_cells.h"
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

/// Makes the elements of a beam, one after another.
using MakeBeam = std::function<std::unique_ptr<Element>(int a, int b, const Place& from, const Place& to)>;

MakeBeam beam_maker(const Values& beam, Space space) {
  if (space.dimension == 2) {
    const BeamSection section = plane_section(beam);
    return [section](int a, int b, const Place& from, const Place& to) {
      return std::make_unique<Beam>(a, b, from.head<2>(), to.head<2>(), section);
    };
  }
  const SpaceBeamSection section = space_section(beam);
  std::optional<Vec3> up;
  if (beam.has("up")) up = vector_of(beam, "up", space);
  return
      [section, up](int a, int b, const Place& from, const Place& to) { return std::make_unique<SpaceBeam>(a, b, from, to, section, up); };
}

/// Adds beams to a model: straight stretches between nodes, each in the same number of elements.
class BeamMaking {
 public:
  BeamMaking(const Values& beam, ModelBuilder& builder, CaseNames& names)
      : beam_(beam), builder_(builder), names_(names), make_(beam_maker(beam, names.space)), pieces_(beam.integer("elements")) {}

  /// Inner nodes are called stem.1, stem.2, ..., from `first` on. Returns all nodes of the stretch.
  std::vector<int> add(int a, int b, const std::string& stem, int first = 1) {
    const Place from = names_.positions[static_cast<std::size_t>(a)], to = names_.positions[static_cast<std::size_t>(b)];
    std::vector<int> line{a};
    Place last = from;
    for (int k = 1; k <= pieces_; ++k) {
      const Place next = k == pieces_ ? to : Place(from + (to - from) * (static_cast<double>(k) / pieces_));
      const int node = k == pieces_ ? b : inner_node(fmt::format("{}.{}", stem, first + k - 1), next);
      auto element = make_(line.back(), node, last, next);
      element->beta = beam_.number("damping_beta");
      if (!beam_.has("A")) builder_.inextensible(line.back(), node, beam_.where());
      builder_.add_element(std::move(element), beam_.where());
      line.push_back(node);
      last = next;
    }
    return line;
  }

 private:
  int inner_node(const std::string& name, const Place& place) {
    names_.nodes.add(name, beam_.where("name"), beam_.path("name"));
    names_.positions.push_back(place);
    return builder_.add_node(name, place, beam_.where());
  }

  const Values& beam_;
  ModelBuilder& builder_;
  CaseNames& names_;
  MakeBeam make_;
  int pieces_;
};

/// Whether `up` says something of a beam along this direction.
bool up_fits(const Values& beam, const Vec3& along, Space space) {
  return space.dimension == 2 || !beam.has("up") || beam_axes(along, vector_of(beam, "up", space));
}

std::vector<int> add_between(const Values& beam, ModelBuilder& builder, CaseNames& names) {
  const std::vector<int> ends = names.nodes_of(beam, "nodes");
  if (ends.size() != 2) fail(beam, "nodes", "two nodes", fmt::format("{}", ends.size()));
  const Vec3 along = names.positions[static_cast<std::size_t>(ends[1])] - names.positions[static_cast<std::size_t>(ends[0])];
  if (along.norm() == 0) fail(beam, "nodes", "two nodes at different places", "two nodes at the same place");
  BeamMaking making(beam, builder, names);
  if (!up_fits(beam, along, names.space)) fail(beam, "up", "a direction that is not along the beam", "one along it");
  return making.add(ends[0], ends[1], beam.text("name"));
}

/// The elements of a group: of every line one stretch, of a line with a node in its middle two.
std::vector<std::vector<int>> add_along(const Values& beam, BeamCells& cells, ModelBuilder& builder, CaseNames& names) {
  const std::vector<BeamCells::Stretch> stretches = cells.take(beam);
  BeamMaking making(beam, builder, names);
  std::vector<std::vector<int>> lines;
  int inner = 0, last = 0;  // inner nodes of the cell so far
  for (const BeamCells::Stretch& stretch : stretches) {
    if (!up_fits(beam, stretch.along, names.space))
      fail(beam, "up", "a direction that is along none of its lines", "one along " + cells.name(stretch.cell));
    if (stretch.number != last) inner = 0, last = stretch.number;
    lines.push_back(making.add(names.first_of_mesh + stretch.a, names.first_of_mesh + stretch.b,
                               fmt::format("{}.{}", beam.text("name"), stretch.number), inner + 1));
    inner += beam.integer("elements") - 1;
  }
  return strung(std::move(lines));
}

}  // namespace

void add_beams(const Values& root, ModelBuilder& builder, CaseNames& names) {
  Names beams("beam");
  BeamCells cells(root, names.solids.get());
  for (const Values& beam : root.tables("beam")) {
    beams.add(beam, "name");
    const int first = builder.num_elements();
    const bool between = first_of_two(beam, "nodes", "group");
    if (!between) names.mesh_for(beam);
    std::vector<std::vector<int>> lines;
    if (between)
      lines.push_back(add_between(beam, builder, names));
    else
      lines = add_along(beam, cells, builder, names);
    for (std::vector<int>& line : lines)
      names.beams.push_back({beam.text("name"), std::move(line), !between, first, builder.num_elements()});
  }
}

}  // namespace uplift
