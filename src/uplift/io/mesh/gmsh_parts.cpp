#include "uplift/io/mesh/gmsh_parts.h"

#include <algorithm>
#include <cstdlib>

namespace uplift {

void GmshGroups::name(int dimension, int tag, std::string name) {
  const int group = find(dimension, tag);
  if (group >= 0 && !name.empty()) groups_[static_cast<std::size_t>(group)].name = std::move(name);
}

int GmshGroups::find(int dimension, int tag) {
  if (tag == 0) return -1;
  if (tag < 0) tag = -std::max(tag, -2147483647);
  const auto [at, fresh] = numbers_.try_emplace({dimension, tag}, static_cast<int>(groups_.size()));
  if (fresh) groups_.push_back({"physical_" + std::to_string(dimension) + "_" + std::to_string(tag), dimension, {}, {}});
  return at->second;
}

GmshNodes::GmshNodes(const std::vector<std::int64_t>& tags, const GmshCursor& at) {
  const auto twice = [&](std::int64_t tag) { at.fail("each node once", "node " + std::to_string(tag) + " twice"); };
  const auto highest = tags.empty() ? 0 : *std::max_element(tags.begin(), tags.end());
  constexpr std::int64_t sparse = 8;  // a table may be so many times longer than the list
  if (highest < sparse * static_cast<std::int64_t>(tags.size())) {
    table_.assign(static_cast<std::size_t>(highest) + 1, -1);
    for (std::size_t i = 0; i < tags.size(); ++i) {
      int& entry = table_[static_cast<std::size_t>(tags[i])];
      if (entry >= 0) twice(tags[i]);
      entry = static_cast<int>(i);
    }
    return;
  }
  sorted_.reserve(tags.size());
  for (std::size_t i = 0; i < tags.size(); ++i) sorted_.emplace_back(tags[i], static_cast<int>(i));
  std::sort(sorted_.begin(), sorted_.end());
  for (std::size_t i = 1; i < sorted_.size(); ++i)
    if (sorted_[i].first == sorted_[i - 1].first) twice(sorted_[i].first);
}

int GmshNodes::find(std::int64_t tag) const {
  if (!table_.empty()) return tag >= 0 && static_cast<std::uint64_t>(tag) < table_.size() ? table_[static_cast<std::size_t>(tag)] : -1;
  const auto at = std::lower_bound(sorted_.begin(), sorted_.end(), std::pair<std::int64_t, int>(tag, 0));
  return at != sorted_.end() && at->first == tag ? at->second : -1;
}

const GmshType& wanted_gmsh_type(int number, const GmshCursor& at) {
  const GmshType* type = gmsh_type(number);
  if (!type)
    at.fail(
        "points, lines of 2 or 3 nodes, triangles of 3 or 6, quadrilaterals of 4, 8 or 9, tetrahedra of 4 or 10, wedges of 6 or 15 or "
        "hexahedra of 8, 20 or 27 nodes",
        gmsh_type_name(number));
  return *type;
}

void read_gmsh_cell(GmshCursor& at, bool wide, const GmshType& type, const GmshNodes& nodes, CellBlock& block) {
  const auto count = static_cast<std::size_t>(info(type.cell).nodes), begin = block.nodes.size();
  int read[27];
  for (std::size_t k = 0; k < count; ++k) {
    const std::int64_t tag = wide ? at.size("a node tag") : at.integer("a node tag");
    read[k] = nodes.find(tag);
    if (read[k] < 0) at.fail("the tag of a node", std::to_string(tag));
  }
  block.nodes.resize(begin + count);
  for (std::size_t k = 0; k < count; ++k) block.nodes[begin + k] = read[type.from.empty() ? k : static_cast<std::size_t>(type.from[k])];
}

}  // namespace uplift
