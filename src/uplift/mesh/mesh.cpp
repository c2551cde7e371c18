#include "uplift/mesh/mesh.h"

#include <algorithm>
#include <cmath>

#include "uplift/base/text.h"
#include "uplift/math/linalg.h"
#include "uplift/mesh/jacobian.h"

namespace uplift {
namespace {

/// Half the sum of cross products around the corners: normal times area, exact also for warped quadrilaterals.
Vec3 area_vector(const std::vector<Vec3>& nodes, std::span<const int> cell, std::span<const int> corners) {
  const auto at = [&](std::size_t i) -> const Vec3& { return nodes[static_cast<std::size_t>(cell[static_cast<std::size_t>(corners[i])])]; };
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) sum += cross(at(i) - at(0), at(i + 1) - at(0));
  return sum / 2;
}

/// Divergence theorem over the triangles from each side's centre: the volume of the cell with bilinear faces.
double volume(const std::vector<Vec3>& nodes, std::span<const int> cell, const CellInfo& linear) {
  const auto at = [&](int corner) -> Vec3 {
    return nodes[static_cast<std::size_t>(cell[static_cast<std::size_t>(corner)])] - nodes[static_cast<std::size_t>(cell[0])];
  };
  double sum = 0;
  std::size_t begin = 0;
  for (const Cell side : linear.sides) {
    const auto n = static_cast<std::size_t>(info(side).nodes);
    const auto corners = linear.side_nodes.subspan(begin, n);
    begin += n;
    Vec3 centre = Vec3::Zero();
    for (const int c : corners) centre += at(c) / static_cast<double>(n);
    for (std::size_t i = 0; i < n; ++i) sum += centre.dot(cross(at(corners[i]), at(corners[(i + 1) % n])));
  }
  return sum / 6;
}

double longest_edge(const std::vector<Vec3>& nodes, std::span<const int> cell, const CellInfo& type) {
  const auto at = [&](std::size_t i) -> const Vec3& {
    return nodes[static_cast<std::size_t>(cell[static_cast<std::size_t>(type.edges[i])])];
  };
  double longest = 0;
  for (std::size_t i = 0; i < type.edges.size(); i += 2) longest = std::max(longest, (at(i + 1) - at(i)).norm());
  return longest;
}

std::string point_text(const Vec3& x) {
  std::string text = "(";
  for (int i = 0; i < 3; ++i) text += (i ? ", " : "") + shortest(std::round(x[i] * 1e6) / 1e6);
  return text + ")";
}

[[noreturn]] void refuse(const Where& where, const std::string& wanted, const std::string& found) {
  throw InputError(where, "mesh", wanted, found);
}

void check_nodes(const Mesh& mesh, const Where& where) {
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    const Vec3& x = mesh.nodes[i];
    const std::string name = "node " + std::to_string(i + 1);
    for (int k = 0; k < 3; ++k)
      if (!std::isfinite(x[k]))
        refuse(where, "finite coordinates", name + " at (" + shortest(x[0]) + ", " + shortest(x[1]) + ", " + shortest(x[2]) + ")");
    if (mesh.dimension == 2 && x.z() != mesh.nodes[0].z())
      refuse(where, "one plane z = " + shortest(mesh.nodes[0].z()), name + " at " + point_text(x));
  }
}

void check_blocks(const Mesh& mesh, const Where& where) {
  std::vector<bool> seen(num_cell_types, false);
  for (const CellBlock& block : mesh.blocks) {
    const CellInfo& type = info(block.cell);
    const std::string name(type.name);
    if (seen[static_cast<std::size_t>(block.cell)]) refuse(where, "one block of a type of cells", "two of " + name);
    seen[static_cast<std::size_t>(block.cell)] = true;
    if (type.dimension > mesh.dimension) refuse(where, "cells of a plane mesh", name);
    if (block.nodes.size() % static_cast<std::size_t>(type.nodes))
      refuse(where, std::to_string(type.nodes) + " nodes for each " + name, std::to_string(block.nodes.size()) + " nodes in all");
    for (std::size_t i = 0; i < block.nodes.size(); ++i)
      if (block.nodes[i] < 0 || static_cast<std::size_t>(block.nodes[i]) >= mesh.nodes.size())
        refuse(where, "nodes from 1 to " + std::to_string(mesh.nodes.size()),
               "node " + std::to_string(static_cast<long long>(block.nodes[i]) + 1) + " in " + name + " " +
                   std::to_string(i / static_cast<std::size_t>(type.nodes) + 1));
  }
}

void check_group(const Mesh& mesh, const std::string& name, const Group& group, const Where& where) {
  const auto wrong = [&](const std::string& wanted, const std::string& found) {
    throw InputError(where, "group " + in_quotes(name), wanted, found);
  };
  for (std::size_t i = 0; i < group.cells.size(); ++i) {
    const CellId id = group.cells[i];
    const bool known = id.block >= 0 && static_cast<std::size_t>(id.block) < mesh.blocks.size() && id.index >= 0 &&
                       id.index < mesh.blocks[static_cast<std::size_t>(id.block)].count();
    if (!known) wrong("cells of the mesh", "cell " + std::to_string(id.index) + " of block " + std::to_string(id.block));
    if (info(mesh.type(id)).dimension != group.dimension)
      wrong("cells of dimension " + std::to_string(group.dimension), "a " + std::string(info(mesh.type(id)).name));
    if (i && !(group.cells[i - 1] < id)) wrong("cells in ascending order, each once", describe_cell(mesh, id) + " out of order");
  }
  for (std::size_t i = 0; i < group.nodes.size(); ++i) {
    const int node = group.nodes[i];
    if (node < 0 || static_cast<std::size_t>(node) >= mesh.nodes.size()) wrong("nodes of the mesh", "node " + std::to_string(node));
    if (i && group.nodes[i - 1] >= node) wrong("nodes in ascending order, each once", "node " + std::to_string(node + 1) + " out of order");
  }
}

bool has_node_twice(std::span<const int> nodes) {
  for (std::size_t i = 1; i < nodes.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (nodes[i] == nodes[j]) return true;
  return false;
}

/// What is wrong with a cell; empty when nothing is.
std::string_view trouble(const Mesh& mesh, CellId id) {
  const CellInfo& type = info(mesh.type(id));
  if (type.dimension == 0) return {};
  const auto nodes = mesh.cell(id);
  if (has_node_twice(nodes)) return "has a node twice";
  constexpr double zero = 1e-12;
  const double size = signed_size(mesh, id), least = zero * std::pow(longest_edge(mesh.nodes, nodes, type), type.dimension);
  if (size < -least) return "is inside out";
  return size > least ? std::string_view{} : "has no size";
}

void check_cells(const Mesh& mesh, const Where& where) {
  int count = 0;
  CellId first;
  for (int b = 0; b < static_cast<int>(mesh.blocks.size()); ++b)
    for (int i = 0; i < mesh.blocks[static_cast<std::size_t>(b)].count(); ++i)
      if (!trouble(mesh, {b, i}).empty() && count++ == 0) first = {b, i};
  if (count == 0) return;
  refuse(where, "cells with different nodes and a positive size",
         describe_cell(mesh, first) + " that " + std::string(trouble(mesh, first)) +
             (count > 1 ? ", and " + std::to_string(count - 1) + " more such cells" : ""));
}

/// Where the Jacobian of a cell is not positive, in words.
std::string inverted_text(const Mesh& mesh, CellId id, const LeastJacobian& least) {
  const bool corner = least.corner >= 0;
  return describe_cell(mesh, id) + " with a scaled Jacobian of " + shortest(std::round(least.value * 1e4) / 1e4) +
         (corner ? " at its corner " + std::to_string(least.corner + 1) + " at " : " at the integration point ") +
         point_text(least.position) + " m";
}

/// A cell that is folded or turned over in part would get a negative stiffness there.
void check_jacobians(const Mesh& mesh, const Where& where) {
  constexpr double zero = 1e-12;
  int count = 0;
  std::string found;
  for (int b = 0; b < static_cast<int>(mesh.blocks.size()); ++b) {
    if (info(mesh.blocks[static_cast<std::size_t>(b)].cell).dimension != mesh.dimension) continue;
    for (int i = 0; i < mesh.blocks[static_cast<std::size_t>(b)].count(); ++i) {
      const LeastJacobian least = least_jacobian(mesh, {b, i});
      if (!(least.value > zero) && count++ == 0) found = inverted_text(mesh, {b, i}, least);
    }
  }
  if (count == 0) return;
  refuse(where, "cells with a positive Jacobian at every corner and integration point",
         found + (count > 1 ? ", and " + std::to_string(count - 1) + " more such cells" : "") +
             "; such a cell is folded or turned over in part");
}

}  // namespace

CellBlock& Mesh::block(Cell cell) {
  const int found = find_block(cell);
  if (found >= 0) return blocks[static_cast<std::size_t>(found)];
  blocks.push_back({cell, {}});
  return blocks.back();
}

int Mesh::find_block(Cell cell) const {
  for (std::size_t i = 0; i < blocks.size(); ++i)
    if (blocks[i].cell == cell) return static_cast<int>(i);
  return -1;
}

int Mesh::cells() const {
  int sum = 0;
  for (const CellBlock& b : blocks) sum += b.count();
  return sum;
}

int Mesh::number(int node) const {
  const int known = static_cast<int>(places.size());
  if (node < known) return places[static_cast<std::size_t>(node)] + 1;
  return known == 0 ? node + 1 : places.back() + 2 + node - known;
}

const CellPart* Mesh::part(CellId id) const {
  return parts.find(id);
}

const CellPart* CellParts::find(CellId id) const {
  const int found = number(id);
  return found < 0 ? nullptr : &parts_[static_cast<std::size_t>(found)];
}

int CellParts::number(CellId id) const {
  const auto block = static_cast<std::size_t>(id.block), index = static_cast<std::size_t>(id.index);
  return block < number_.size() && index < number_[block].size() ? number_[block][index] : -1;
}

CellPart& CellParts::operator[](CellId id) {
  const auto block = static_cast<std::size_t>(id.block), index = static_cast<std::size_t>(id.index);
  if (number_.size() <= block) number_.resize(block + 1);
  if (number_[block].size() <= index) number_[block].resize(index + 1, -1);
  int& number = number_[block][index];
  if (number < 0) {
    number = static_cast<int>(parts_.size());
    parts_.emplace_back();
    ++count_;
  }
  return parts_[static_cast<std::size_t>(number)];
}

std::vector<CellId> CellParts::cells() const {
  std::vector<CellId> cells;
  cells.reserve(static_cast<std::size_t>(count_));
  for (std::size_t b = 0; b < number_.size(); ++b)
    for (std::size_t i = 0; i < number_[b].size(); ++i)
      if (number_[b][i] >= 0) cells.push_back({static_cast<int>(b), static_cast<int>(i)});
  return cells;
}

void CellParts::erase(CellId id) {
  const int found = number(id);
  if (found < 0) return;
  number_[static_cast<std::size_t>(id.block)][static_cast<std::size_t>(id.index)] = -1;
  parts_[static_cast<std::size_t>(found)] = {};
  --count_;
}

void CellParts::renumber(const std::vector<std::vector<int>>& now) {
  const std::vector<CellId> before = cells();
  std::vector<int> numbers;
  numbers.reserve(before.size());
  for (const CellId id : before) numbers.push_back(number(id));
  for (std::vector<int>& of_block : number_) std::fill(of_block.begin(), of_block.end(), -1);
  for (std::size_t k = 0; k < before.size(); ++k) {
    const auto block = static_cast<std::size_t>(before[k].block);
    const auto index = static_cast<std::size_t>(now[block][static_cast<std::size_t>(before[k].index)]);
    number_[block][index] = numbers[k];  // no cell moves up
  }
}

std::vector<int> nodes_of(const Mesh& mesh, const Group& group) {
  std::vector<int> nodes = group.nodes;
  for (const CellId id : group.cells) {
    const auto cell = mesh.cell(id);
    nodes.insert(nodes.end(), cell.begin(), cell.end());
  }
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

double signed_size(const Mesh& mesh, CellId id) {
  const CellInfo& linear = info(info(mesh.type(id)).linear);
  const auto cell = mesh.cell(id);
  if (linear.dimension == 0) return 0;
  if (linear.dimension == 1) return longest_edge(mesh.nodes, cell, linear);
  if (linear.dimension == 3) return volume(mesh.nodes, cell, linear);
  constexpr int corners[] = {0, 1, 2, 3};
  const Vec3 area = area_vector(mesh.nodes, cell, std::span(corners).first(static_cast<std::size_t>(linear.corners)));
  return mesh.dimension == 2 ? area.z() : area.norm();
}

std::string describe_cell(const Mesh& mesh, CellId id) {
  const CellInfo& type = info(mesh.type(id));
  Vec3 centre = Vec3::Zero();
  for (const int node : mesh.cell(id).first(static_cast<std::size_t>(type.corners)))
    centre += mesh.nodes[static_cast<std::size_t>(node)] / type.corners;
  const CellBlock& block = mesh.blocks[static_cast<std::size_t>(id.block)];
  std::string shape(type.name);
  if (!block.file_number.empty())
    shape += ", number " + std::to_string(block.file_number[static_cast<std::size_t>(id.index)]) + " in the mesh file,";
  for (const auto& [name, group] : mesh.groups) {
    const auto at = std::lower_bound(group.cells.begin(), group.cells.end(), id);
    if (at == group.cells.end() || *at != id) continue;
    return "cell " + std::to_string(at - group.cells.begin() + 1) + " of group " + in_quotes(name) + " (" + shape + " at " +
           point_text(centre) + ")";
  }
  if (!block.file_number.empty()) return "the cell " + shape + " at " + point_text(centre) + ", in no group";
  return shape + " " + std::to_string(id.index + 1) + " (at " + point_text(centre) + ", in no group)";
}

void check_mesh(const Mesh& mesh, const Where& where) {
  if (mesh.dimension != 2 && mesh.dimension != 3) refuse(where, "dimension 2 or 3", std::to_string(mesh.dimension));
  check_nodes(mesh, where);
  check_blocks(mesh, where);
  for (const auto& [name, group] : mesh.groups) check_group(mesh, name, group, where);
  check_cells(mesh, where);
  check_jacobians(mesh, where);
}

}  // namespace uplift
