#include <fmt/format.h>

#include "uplift/case/build/model.h"
#include "uplift/case/mesh/beam_cells.h"

namespace uplift {
namespace {

/// Adds elements along lines to a model: straight stretches between nodes, each in the same number of elements.
class BeamMaking {
 public:
  BeamMaking(const ElementEntry& entry, const Values& beam, ModelBuilder& builder, CaseNames& names)
      : entry_(entry), beam_(beam), builder_(builder), names_(names), pieces_(beam.integer("elements")) {}

  /// Inner nodes are called stem.1, stem.2, ..., from `first` on. `of`: the line of a group, for messages. Returns all nodes of the
  /// stretch.
  std::vector<int> add(int a, int b, const std::string& stem, int first = 1, const std::string& of = {}) {
    const Place from = names_.positions[static_cast<std::size_t>(a)], to = names_.positions[static_cast<std::size_t>(b)];
    std::vector<int> line{a};
    Place last = from;
    for (int k = 1; k <= pieces_; ++k) {
      const Place next = k == pieces_ ? to : Place(from + (to - from) * (static_cast<double>(k) / pieces_));
      const int node = k == pieces_ ? b : inner_node(fmt::format("{}.{}", stem, first + k - 1), next);
      std::unique_ptr<const Element> element = entry_.make({names_.space, {line.back(), node}, {last, next}, of}, beam_);
      if (element->inextensible()) builder_.inextensible(line.back(), node, beam_.where());
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

  const ElementEntry& entry_;
  const Values& beam_;
  ModelBuilder& builder_;
  CaseNames& names_;
  int pieces_;
};

std::vector<int> add_between(const ElementEntry& entry, const Values& beam, ModelBuilder& builder, CaseNames& names) {
  const std::vector<int> ends = names.nodes_of(names_used(beam, "nodes"));
  if (ends.size() != 2) fail(beam, "nodes", "two nodes", fmt::format("{}", ends.size()));
  const Vec3 along = names.positions[static_cast<std::size_t>(ends[1])] - names.positions[static_cast<std::size_t>(ends[0])];
  if (along.norm() == 0) fail(beam, "nodes", "two nodes at different places", "two nodes at the same place");
  return BeamMaking(entry, beam, builder, names).add(ends[0], ends[1], beam.text("name"));
}

/// The elements of a group: of every line one stretch, of a line with a node in its middle two.
std::vector<std::vector<int>> add_along(const ElementEntry& entry, const Values& beam, BeamCells& cells, ModelBuilder& builder,
                                        CaseNames& names) {
  const std::vector<BeamCells::Stretch> stretches = cells.take(beam);
  BeamMaking making(entry, beam, builder, names);
  std::vector<std::vector<int>> lines;
  int inner = 0, last = 0;  // inner nodes of the cell so far
  for (const BeamCells::Stretch& stretch : stretches) {
    if (stretch.number != last) inner = 0, last = stretch.number;
    lines.push_back(making.add(names.first_of_mesh + stretch.a, names.first_of_mesh + stretch.b,
                               fmt::format("{}.{}", beam.text("name"), stretch.number), inner + 1, cells.name(stretch.cell)));
    inner += beam.integer("elements") - 1;
  }
  return strung(std::move(lines));
}

}  // namespace

void add_beams(const Case& read, ModelBuilder& builder, CaseNames& names) {
  Names beams("beam");
  BeamCells cells(read, names.solids.get());
  for (const ElementEntry* entry : elements_at(ElementPlace::lines)) {
    for (const Values& beam : read.values.tables(entry->name)) {
      beams.add(beam, "name");
      const int first = builder.num_elements();
      const bool between = first_of_two(beam, "nodes", "group");
      if (!between) names.mesh_for(name_used(beam, "group"));
      std::vector<std::vector<int>> lines;
      if (between)
        lines.push_back(add_between(*entry, beam, builder, names));
      else
        lines = add_along(*entry, beam, cells, builder, names);
      for (std::vector<int>& line : lines)
        names.beams.push_back({beam.text("name"), std::move(line), !between, first, builder.num_elements()});
    }
  }
}

}  // namespace uplift
