#include <fmt/format.h>

#include "uplift/case/build/model.h"
#include "uplift/case/mesh/beam_cells.h"

namespace uplift {
namespace {

/// Adds elements along lines to a model: straight stretches between nodes, each in the same number of elements.
class BeamMaking {
 public:
  BeamMaking(const CaseElement& beam, ModelBuilder& builder, CaseNames& names)
      : beam_(beam), builder_(builder), names_(names), pieces_(beam.pieces) {}

  /// Inner nodes are called stem.1, stem.2, ..., from `first` on. `of`: the line of a group, for messages. Returns all nodes of the
  /// stretch.
  std::vector<int> add(int a, int b, const std::string& stem, int first = 1, const std::string& of = {}) {
    const Place from = names_.positions[static_cast<std::size_t>(a)], to = names_.positions[static_cast<std::size_t>(b)];
    std::vector<int> line{a};
    Place last = from;
    for (int k = 1; k <= pieces_; ++k) {
      const Place next = k == pieces_ ? to : Place(from + (to - from) * (static_cast<double>(k) / pieces_));
      const int node = k == pieces_ ? b : inner_node(fmt::format("{}.{}", stem, first + k - 1), next);
      std::unique_ptr<const Element> element = beam_.entry->make({names_.space, {line.back(), node}, {last, next}, of}, *beam_.table);
      if (element->inextensible()) builder_.inextensible(line.back(), node, beam_.where());
      builder_.add_element(std::move(element), beam_.where());
      line.push_back(node);
      last = next;
    }
    return line;
  }

 private:
  int inner_node(const std::string& name, const Place& place) {
    names_.nodes.add(name, beam_.name.where(), beam_.name.path());
    names_.positions.push_back(place);
    return builder_.add_node(name, place, beam_.where());
  }

  const CaseElement& beam_;
  ModelBuilder& builder_;
  CaseNames& names_;
  int pieces_;
};

std::vector<int> add_between(const CaseElement& beam, ModelBuilder& builder, CaseNames& names) {
  const std::vector<int> ends = names.nodes_of(beam.nodes);
  if (ends.size() != 2) fail(beam, "nodes", "two nodes", fmt::format("{}", ends.size()));
  const Vec3 along = names.positions[static_cast<std::size_t>(ends[1])] - names.positions[static_cast<std::size_t>(ends[0])];
  if (along.norm() == 0) fail(beam, "nodes", "two nodes at different places", "two nodes at the same place");
  return BeamMaking(beam, builder, names).add(ends[0], ends[1], beam.name.name);
}

/// The elements of a group: of every line one stretch, of a line with a node in its middle two.
std::vector<std::vector<int>> add_along(const CaseElement& beam, BeamCells& cells, ModelBuilder& builder, CaseNames& names) {
  const std::vector<BeamCells::Stretch> stretches = cells.take(beam);
  BeamMaking making(beam, builder, names);
  std::vector<std::vector<int>> lines;
  int inner = 0, last = 0;  // inner nodes of the cell so far
  for (const BeamCells::Stretch& stretch : stretches) {
    if (stretch.number != last) inner = 0, last = stretch.number;
    lines.push_back(making.add(names.first_of_mesh + stretch.a, names.first_of_mesh + stretch.b,
                               fmt::format("{}.{}", beam.name.name, stretch.number), inner + 1, cells.name(stretch.cell)));
    inner += beam.pieces - 1;
  }
  return strung(std::move(lines));
}

}  // namespace

void add_beams(const Case& read, ModelBuilder& builder, CaseNames& names) {
  Names beams("beam");
  BeamCells cells(read, names.solids.get());
  for (const CaseElement& beam : read.input->elements_at(ElementPlace::lines)) {
    beams.add(beam.name);
    const int first = builder.num_elements();
    if (beam.group) names.mesh_for(*beam.group);
    std::vector<std::vector<int>> lines;
    if (beam.group)
      lines = add_along(beam, cells, builder, names);
    else
      lines.push_back(add_between(beam, builder, names));
    for (std::vector<int>& line : lines)
      names.beams.push_back({beam.name.name, std::move(line), beam.group.has_value(), first, builder.num_elements()});
  }
}

}  // namespace uplift
