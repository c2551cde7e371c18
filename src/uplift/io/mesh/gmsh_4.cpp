#include "uplift/io/mesh/gmsh_parts.h"

// Format 4.1: Gmsh reference manual, "MSH file format". Text and binary files hold the same numbers in the same order.
namespace uplift {
namespace {

void skip_integers(GmshCursor& at, const char* count, const char* what) {
  for (auto left = at.count(count, 2, 4); left > 0; --left) at.integer(what);
}

int read_dimension(GmshCursor& at) {
  const int dimension = at.integer("the dimension of an entity");
  if (dimension < 0 || dimension > 3) at.fail("a dimension from 0 to 3", std::to_string(dimension));
  return dimension;
}

void read_entity(GmshCursor& at, int dimension, bool partitioned, GmshGroups& groups, GmshEntities& entities) {
  const int tag = at.integer("the tag of an entity");
  if (partitioned) {
    at.integer("the dimension of the parent");
    at.integer("the tag of the parent");
    skip_integers(at, "a number of partitions", "a partition");
  }
  for (int k = 0; k < (dimension == 0 ? 3 : 6); ++k) at.real("a bound of an entity");
  std::vector<int>& own = entities[{dimension, tag}];
  for (auto left = at.count("a number of physical groups", 2, 4); left > 0; --left) {
    const int group = groups.find(dimension, at.integer("the tag of a physical group"));
    if (group >= 0) own.push_back(group);
  }
  if (own.size() > most_groups)
    at.fail("at most " + std::to_string(most_groups) + " physical groups for an entity", std::to_string(own.size()));
  if (dimension > 0) skip_integers(at, "a number of bounding entities", "the tag of a bounding entity");
}

}  // namespace

GmshEntities read_gmsh_entities(GmshCursor at, bool partitioned, GmshGroups& groups) {
  GmshEntities entities;
  if (partitioned) {
    at.size("a number of partitions");
    for (auto left = at.count("a number of ghost entities", 4, 8); left > 0; --left) {
      at.integer("the tag of a ghost entity");
      at.integer("a partition");
    }
  }
  std::int64_t counts[4];
  for (std::int64_t& count : counts) count = at.size("a number of entities");
  for (int dimension = 0; dimension <= 3; ++dimension) {
    at.check_count(counts[dimension], "a number of entities", 10, 36);
    for (auto left = counts[dimension]; left > 0; --left) read_entity(at, dimension, partitioned, groups, entities);
  }
  at.finish(partitioned ? "$EndPartitionedEntities after the last entity" : "$EndEntities after the last entity");
  return entities;
}

GmshNodeList read_gmsh_nodes_4(GmshCursor at) {
  const auto blocks = at.size("a number of blocks of nodes");
  const auto all = at.count("a number of nodes", 8, 32);
  at.size("the lowest tag");
  at.size("the highest tag");
  GmshNodeList list;
  list.tags.reserve(static_cast<std::size_t>(all));
  list.nodes.reserve(static_cast<std::size_t>(all));
  for (std::int64_t b = 0; b < blocks; ++b) {
    const int dimension = read_dimension(at);
    at.integer("the tag of an entity");
    const int parametric = at.integer("0 or 1 (parameters follow)");
    if (parametric != 0 && parametric != 1) at.fail("0 or 1 (parameters follow)", std::to_string(parametric));
    const auto count = at.count("a number of nodes", 8, 32);
    if (count > all - static_cast<std::int64_t>(list.nodes.size()))
      at.fail(std::to_string(all) + " nodes in all, as the section begins", std::to_string(count) + " more");
    for (auto left = count; left > 0; --left) list.tags.push_back(at.size("a node tag"));
    for (auto left = count; left > 0; --left) {
      Vec3& x = list.nodes.emplace_back();
      for (int k = 0; k < 3; ++k) x[k] = at.real("a coordinate");
      for (int k = 0; parametric && k < dimension; ++k) at.real("a parameter of a node");
    }
  }
  if (static_cast<std::int64_t>(list.nodes.size()) != all)
    at.fail(std::to_string(all) + " nodes in all, as the section begins", std::to_string(list.nodes.size()));
  at.finish("$EndNodes after the last node");
  return list;
}

void read_gmsh_elements_4(GmshCursor at, const GmshNodes& nodes, const GmshEntities& entities, GmshGroups& groups, Mesh& mesh) {
  const auto blocks = at.size("a number of blocks of elements");
  const auto all = at.count("a number of elements", 4, 16);
  at.size("the lowest tag");
  at.size("the highest tag");
  auto left_in_all = all;
  for (std::int64_t b = 0; b < blocks; ++b) {
    const int dimension = read_dimension(at), entity = at.integer("the tag of an entity");
    const GmshType& type = wanted_gmsh_type(at.integer("a type of elements"), at);
    const CellInfo& cell = info(type.cell);
    if (cell.dimension != dimension) at.fail("elements of dimension " + std::to_string(dimension), gmsh_type_name(type.number));
    const auto numbers = static_cast<std::size_t>(cell.nodes) + 1;
    const auto count = at.count("a number of elements", 2 * numbers, 8 * numbers);
    left_in_all -= count;
    if (left_in_all < 0) at.fail(std::to_string(all) + " elements in all, as the section begins", "more");
    if (count == 0) continue;
    CellBlock& block = mesh.block(type.cell);
    const auto known = entities.find({dimension, entity});
    const int number = static_cast<int>(&block - mesh.blocks.data());
    for (auto left = count; left > 0; --left) {
      block.file_number.push_back(at.size("the tag of an element"));
      if (known != entities.end())
        for (const int group : known->second) groups.add(group, {number, block.count()});
      read_gmsh_cell(at, true, type, nodes, block);
    }
  }
  if (left_in_all != 0) at.fail(std::to_string(all) + " elements in all, as the section begins", std::to_string(all - left_in_all));
  at.finish("$EndElements after the last element");
}

}  // namespace uplift
