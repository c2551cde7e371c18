#include <algorithm>
#include <numeric>

#include "uplift/io/mesh/gmsh_parts.h"

// Formats 2.0 to 2.2: Gmsh reference manual, "MSH file format version 2 (Legacy)". Text only.
namespace uplift {
namespace {

std::int64_t read_node_tag(GmshCursor& at) {
  const int tag = at.integer("a node tag");
  if (tag < 0) at.fail("a node tag (not negative)", std::to_string(tag));
  return tag;
}

/// Of a node in $ParametricNodes: dimension and tag of its entity, one parameter on a curve, two on a surface.
void skip_parameters(GmshCursor& at) {
  const int dimension = at.integer("the dimension of an entity");
  if (dimension < 0 || dimension > 3) at.fail("a dimension from 0 to 3", std::to_string(dimension));
  at.integer("the tag of an entity");
  for (int k = 0; dimension < 3 && k < dimension; ++k) at.real("a parameter of a node");
}

/// An element's tags: its physical group, its entity, its partitions. Returns the group's tag; 0 when there is none.
int read_tags(GmshCursor& at, std::int64_t count) {
  int physical = 0;
  for (std::int64_t k = 0; k < count; ++k) {
    const int tag = at.integer("a tag of an element");
    if (k == 0) physical = tag;
  }
  return physical;
}

void add_element(GmshCursor& at, int number, std::int64_t tags, const GmshType& type, const GmshNodes& nodes, GmshGroups& groups,
                 Mesh& mesh) {
  const int group = groups.find(info(type.cell).dimension, read_tags(at, tags));
  CellBlock& block = mesh.block(type.cell);
  if (group >= 0) groups.add(group, {static_cast<int>(&block - mesh.blocks.data()), block.count()});
  block.file_number.push_back(number);
  read_gmsh_cell(at, false, type, nodes, block);
}

std::int64_t tag_count(GmshCursor& at) {
  const int tags = at.integer("a number of tags");
  at.check_count(tags, "a number of tags", 2, 4);
  return tags;
}

/// For each cell of a block the number it has when each set of nodes is taken once.
std::vector<int> number_each_once(CellBlock& block) {
  const auto count = static_cast<std::size_t>(block.count()), n = static_cast<std::size_t>(info(block.cell).nodes);
  const auto begin = [&](int cell) { return block.nodes.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(cell) * n); };
  const auto end = [&](int cell) { return begin(cell) + static_cast<std::ptrdiff_t>(n); };
  std::vector<int> order(count), number(count);
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return std::lexicographical_compare(begin(a), end(a), begin(b), end(b)); });
  std::iota(number.begin(), number.end(), 0);  // the first of equal cells, then its place among those kept
  for (std::size_t i = 1; i < count; ++i)
    if (std::equal(begin(order[i - 1]), end(order[i - 1]), begin(order[i])))
      number[static_cast<std::size_t>(order[i])] = number[static_cast<std::size_t>(order[i - 1])];
  int kept = 0;
  for (std::size_t i = 0; i < count; ++i) {
    if (number[i] != static_cast<int>(i)) {
      number[i] = number[static_cast<std::size_t>(number[i])];
      continue;
    }
    std::copy(begin(static_cast<int>(i)), end(static_cast<int>(i)), begin(kept));
    block.file_number[static_cast<std::size_t>(kept)] = block.file_number[i];
    number[i] = kept++;
  }
  block.nodes.resize(static_cast<std::size_t>(kept) * n);
  block.file_number.resize(static_cast<std::size_t>(kept));
  return number;
}

/// A cell of several physical groups is written once for each of them.
void merge_equal_cells(Mesh& mesh, GmshGroups& groups) {
  std::vector<std::vector<int>> numbers;
  for (CellBlock& block : mesh.blocks) numbers.push_back(number_each_once(block));
  for (DraftGroup& group : groups.groups())
    for (CellId& id : group.cells) id.index = numbers[static_cast<std::size_t>(id.block)][static_cast<std::size_t>(id.index)];
}

}  // namespace

GmshNodeList read_gmsh_nodes_2(GmshCursor at, bool parametric) {
  const auto count = at.count("a number of nodes", 8, 8);
  GmshNodeList list;
  list.tags.reserve(static_cast<std::size_t>(count));
  list.nodes.reserve(static_cast<std::size_t>(count));
  for (auto left = count; left > 0; --left) {
    list.tags.push_back(read_node_tag(at));
    Vec3& x = list.nodes.emplace_back();
    for (int k = 0; k < 3; ++k) x[k] = at.real("a coordinate");
    if (parametric) skip_parameters(at);
  }
  at.finish(parametric ? "$EndParametricNodes after the last node" : "$EndNodes after the last node");
  return list;
}

void read_gmsh_elements_2(GmshCursor at, const GmshNodes& nodes, GmshGroups& groups, Mesh& mesh) {
  const auto count = at.count("a number of elements", 8, 8);
  for (auto left = count; left > 0; --left) {
    const int number = at.integer("the number of an element");
    const GmshType& type = wanted_gmsh_type(at.integer("a type of elements"), at);
    add_element(at, number, tag_count(at), type, nodes, groups, mesh);
  }
  at.finish("$EndElements after the last element");
  merge_equal_cells(mesh, groups);
}

}  // namespace uplift
