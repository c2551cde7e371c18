#include "uplift/case/mesh/beam_cells.h"

#include <algorithm>

#include "uplift/base/text.h"
#include "uplift/case/build/model.h"

namespace uplift {

BeamCells::BeamCells(const Case& read, const CaseSolids* solids) : read_(read), solids_(solids) {}

void BeamCells::check_use(const CaseElement& beam, CellId cell) const {
  const auto refuse_in = [&](const std::string& group, const std::string& use) {
    const auto found = solids_->mesh().groups.find(group);
    if (found != solids_->mesh().groups.end() && std::ranges::binary_search(found->second.cells, cell))
      fail(beam, "group", "lines that are beams alone", name(cell) + ", " + use);
  };
  for (const CaseInterface& interface : read_.input->interfaces)
    if (const CaseSurface* surface = interface.surface())
      for (const std::string& group : {surface->group ? surface->group->name : surface->lower_group->name,
                                       surface->group ? surface->group->name + "_upper" : surface->upper_group->name})
        refuse_in(group, "where the interface " + in_quotes(interface.name.name) + " opens");
  for (const CaseAbsorbing& face : read_.input->absorbing)
    refuse_in(face.group.name, "which is absorbing too (" + in_quotes(face.group.name) + ")");
}

void BeamCells::claim(const CaseElement& beam, const Stretch& stretch) {
  if (stretch.along.norm() == 0)
    fail(beam, "group", "lines between different places", name(stretch.cell) + ", a part of which has no length");
  const auto [other, free] = taken_.emplace(std::minmax(stretch.a, stretch.b), &beam);
  if (!free)
    fail(beam, "group", "lines without another beam",
         name(stretch.cell) + (other->second == &beam ? ", between whose nodes the group has another line"
                                                      : ", which is the beam " + in_quotes(other->second->name.name) + " already"));
}

std::vector<BeamCells::Stretch> BeamCells::take(const CaseElement& beam) {
  const Mesh& mesh = solids_->mesh();
  std::vector<Stretch> stretches;
  int number = 0;
  for (const CellId cell : solids_->lines(*beam.group)) {
    check_use(beam, cell);
    ++number;
    const std::span<const int> nodes = mesh.cell(cell);
    const auto add = [&](int a, int b) {
      stretches.push_back({cell, number, a, b, Vec3(mesh.nodes[static_cast<std::size_t>(b)] - mesh.nodes[static_cast<std::size_t>(a)])});
      claim(beam, stretches.back());
    };
    if (nodes.size() == 2) {
      add(nodes[0], nodes[1]);
    } else {
      add(nodes[0], nodes[2]);
      add(nodes[2], nodes[1]);
    }
  }
  return stretches;
}

std::vector<std::vector<int>> strung(std::vector<std::vector<int>> lines) {
  std::map<int, std::vector<std::size_t>> ending;  // at a node
  for (std::size_t i = 0; i < lines.size(); ++i) {
    ending[lines[i].front()].push_back(i);
    ending[lines[i].back()].push_back(i);
  }
  std::vector<char> used(lines.size(), 0);
  const auto from = [&](int node, std::size_t next) {
    std::vector<int> line{node};
    while (!used[next]) {
      used[next] = 1;
      if (lines[next].front() != line.back()) std::ranges::reverse(lines[next]);
      line.insert(line.end(), lines[next].begin() + 1, lines[next].end());
      const std::vector<std::size_t>& here = ending[line.back()];
      if (here.size() == 2) next = here[0] == next ? here[1] : here[0];
    }
    return line;
  };
  std::vector<std::vector<int>> made;
  for (const auto& [node, here] : ending)
    for (const std::size_t i : here)
      if (here.size() != 2 && !used[i]) made.push_back(from(node, i));
  for (std::size_t i = 0; i < lines.size(); ++i)
    if (!used[i]) made.push_back(from(lines[i].front(), i));
  return made;
}

}  // namespace uplift
