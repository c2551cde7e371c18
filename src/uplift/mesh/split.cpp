#include "uplift/mesh/split.h"

#include <algorithm>
#include <cassert>
#include <numeric>

#include "uplift/base/text.h"
#include "uplift/mesh/absent_group.h"
#include "uplift/mesh/index.h"
#include "uplift/mesh/sides.h"

namespace uplift {
namespace {

/// A set of cells.
class CellMarks {
 public:
  explicit CellMarks(const Mesh& mesh) {
    for (const CellBlock& block : mesh.blocks) marks_.emplace_back(at(block.count()), false);
  }
  void add(const Group& group) {
    for (const CellId id : group.cells) marks_[at(id.block)][at(id.index)] = true;
  }
  bool has(CellId id) const { return marks_[at(id.block)][at(id.index)]; }

 private:
  std::vector<std::vector<bool>> marks_;
};

const Group& group_named(const Mesh& mesh, const std::string& name, const std::string& wanted, const Where& where) {
  const auto found = mesh.groups.find(name);
  if (found != mesh.groups.end()) return found->second;
  throw absent_group(mesh, name, where, "", wanted);
}

/// One face of a surface: the surface's cell, and the sides of the cells below and above it.
struct SplitFace {
  CellId cell;
  int lower, upper;
};

/// The cells around the surfaces and which of their nodes become new ones.
class Cut {
 public:
  Cut(const Mesh& mesh, const std::vector<std::string>& surfaces, const std::vector<std::string>& lower, const Where& where);
  std::vector<std::vector<SplitFace>> faces;  // of each surface
  std::vector<int> doubled;                   // nodes that get a double, ascending
  CellMarks on_surface, lower_side;

  /// The node of a touching cell (number in `sides().cells()`) after the split.
  int node_for(int node, int cell) const;
  /// The double of a node, -1: none.
  int double_of(int node) const { return local_[at(node)] < 0 ? -1 : double_[at(local_[at(node)])]; }
  const Sides& sides() const { return sides_; }

 private:
  std::vector<CellId> touching_cells(const Mesh& mesh);
  void find_faces(const Mesh& mesh, const std::vector<std::string>& surfaces, const Where& where);
  SplitFace cut_face(const Mesh& mesh, CellId id, std::string& reason) const;
  void connect_nodes(const Mesh& mesh);
  void join_around(const Mesh& mesh, int node, std::span<const int> cells, std::vector<int>& sector);
  bool decide(const Mesh& mesh, int local, std::vector<int>& sector);
  bool is_lower(int side) const { return lower_side.has(sides_.cells()[at(side / Sides::stride)]); }

  std::vector<int> local_;         // of each node of the mesh: its number among the nodes of the surfaces, -1 elsewhere
  std::vector<int> nodes_;         // nodes of the surfaces, ascending
  Sides sides_;                    // of all cells that touch one of them
  std::vector<bool> cut_;          // of each side
  std::vector<int> first_, cell_;  // cells around node i of nodes_: cell_[first_[i]] to cell_[first_[i + 1] - 1]
  std::vector<bool> moves_;        // like cell_: that cell gets the new node
  std::vector<int> double_;        // like nodes_
  std::vector<int> place_;         // of each touching cell: its place among the cells around the node looked at
};

/// Marks the nodes of the surfaces and lists the cells of full dimension with at least one of them.
std::vector<CellId> Cut::touching_cells(const Mesh& mesh) {
  for (int b = 0; b < static_cast<int>(mesh.blocks.size()); ++b)
    for (int i = 0; i < mesh.blocks[at(b)].count(); ++i)
      if (on_surface.has({b, i}))
        for (const int node : mesh.cell({b, i})) local_[at(node)] = 0;
  for (int node = 0; node < static_cast<int>(local_.size()); ++node)
    if (local_[at(node)] == 0) {
      local_[at(node)] = static_cast<int>(nodes_.size());
      nodes_.push_back(node);
    }
  std::vector<CellId> cells;
  for (int b = 0; b < static_cast<int>(mesh.blocks.size()); ++b) {
    const CellBlock& block = mesh.blocks[at(b)];
    if (info(block.cell).dimension != mesh.dimension) continue;
    for (int i = 0; i < block.count(); ++i) {
      const auto nodes = block[i];
      if (std::any_of(nodes.begin(), nodes.end(), [&](int node) { return local_[at(node)] >= 0; })) cells.push_back({b, i});
    }
  }
  return cells;
}

CellMarks marks(const Mesh& mesh, const std::vector<std::string>& names, const std::string& wanted, const Where& where) {
  CellMarks result(mesh);
  for (const std::string& name : names) result.add(group_named(mesh, name, wanted, where));
  return result;
}

Cut::Cut(const Mesh& mesh, const std::vector<std::string>& surfaces, const std::vector<std::string>& lower, const Where& where)
    : on_surface(marks(mesh, surfaces, "the surface to open", where)),
      lower_side(marks(mesh, lower, "the lower side of the surface", where)),
      local_(mesh.nodes.size(), -1),
      sides_(mesh, touching_cells(mesh)),
      cut_(sides_.cells().size() * Sides::stride, false),
      place_(sides_.cells().size(), -1) {
  find_faces(mesh, surfaces, where);
  connect_nodes(mesh);
  std::vector<int> sector;
  double_.assign(nodes_.size(), -1);
  moves_.assign(cell_.size(), false);
  for (int i = 0; i < static_cast<int>(nodes_.size()); ++i) {
    if (!decide(mesh, i, sector)) {
      const Vec3& x = mesh.nodes[at(nodes_[at(i)])];
      throw InputError(where, "group " + in_quotes(surfaces.front()), "a surface with two sides at each of its nodes",
                       "one that branches at (" + shortest(x[0]) + ", " + shortest(x[1]) + ", " + shortest(x[2]) + ")");
    }
    if (std::find(moves_.begin() + first_[at(i)], moves_.begin() + first_[at(i + 1)], true) == moves_.begin() + first_[at(i + 1)]) continue;
    double_[at(i)] = static_cast<int>(mesh.nodes.size() + doubled.size());
    doubled.push_back(nodes_[at(i)]);
  }
}

SplitFace Cut::cut_face(const Mesh& mesh, CellId id, std::string& reason) const {
  const int side = sides_.find(mesh.type(id), mesh.cell(id)), twin = side < 0 ? -1 : sides_.twin(side);
  if (side < 0)
    reason = "belongs to no cell of dimension " + std::to_string(mesh.dimension);
  else if (twin < 0)
    reason = "lies on the outer boundary";
  else if (is_lower(side) && is_lower(twin))
    reason = "has the lower side on both sides";
  else if (!is_lower(side) && !is_lower(twin))
    reason = "has the upper side on both sides";
  else if (cut_[at(side)])
    reason = "lies on another one of them";
  return reason.empty() && is_lower(side) ? SplitFace{id, side, twin} : SplitFace{id, twin, side};
}

void Cut::find_faces(const Mesh& mesh, const std::vector<std::string>& surfaces, const Where& where) {
  if (sides_.crowded() >= 0)
    throw InputError(where, "group " + in_quotes(surfaces.front()), "faces between two cells",
                     "more than two cells at a face of " + describe_cell(mesh, sides_.cells()[at(sides_.crowded() / Sides::stride)]));
  for (const std::string& name : surfaces) {
    std::string first_reason;
    CellId first;
    int wrong = 0;
    faces.emplace_back();
    for (const CellId id : mesh.groups.at(name).cells) {
      std::string reason;
      const SplitFace face = cut_face(mesh, id, reason);
      if (!reason.empty()) {
        if (wrong++ == 0) first = id, first_reason = reason;
        continue;
      }
      faces.back().push_back(face);
      cut_[at(face.lower)] = cut_[at(face.upper)] = true;
    }
    if (wrong)
      throw InputError(where, "group " + in_quotes(name), "faces between a cell of the lower side and one of the upper side",
                       std::to_string(wrong) + " of " + std::to_string(mesh.groups.at(name).cells.size()) + " elsewhere; the first, " +
                           describe_cell(mesh, first) + ", " + first_reason);
  }
}

/// Lists the touching cells around each node of the surfaces.
void Cut::connect_nodes(const Mesh& mesh) {
  const auto visit = [&](auto&& act) {
    for (int k = 0; k < static_cast<int>(sides_.cells().size()); ++k)
      for (const int node : mesh.cell(sides_.cells()[at(k)]))
        if (local_[at(node)] >= 0) act(at(local_[at(node)]), k);
  };
  first_.assign(nodes_.size() + 1, 0);
  visit([&](std::size_t i, int) { ++first_[i + 1]; });
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  cell_.resize(at(first_.back()));
  std::vector<int> next = first_;
  visit([&](std::size_t i, int k) { cell_[at(next[i]++)] = k; });
}

int root(std::vector<int>& parent, int i) {
  while (parent[at(i)] != i) i = parent[at(i)] = parent[at(parent[at(i)])];
  return i;
}

/// Joins cells around a node that share a face with that node which is not cut: afterwards sector[i] is the same for such cells.
void Cut::join_around(const Mesh& mesh, int node, std::span<const int> cells, std::vector<int>& sector) {
  sector.resize(cells.size());
  std::iota(sector.begin(), sector.end(), 0);
  for (std::size_t i = 0; i < cells.size(); ++i) place_[at(cells[i])] = static_cast<int>(i);
  std::vector<int> nodes;
  for (std::size_t i = 0; i < cells.size(); ++i)
    for (int s = 0; s < sides_.count(cells[i]); ++s) {
      const int side = cells[i] * Sides::stride + s, twin = sides_.twin(side);
      if (twin < side || cut_[at(side)]) continue;
      sides_.nodes_of(mesh, side, nodes);
      if (std::find(nodes.begin(), nodes.end(), node) == nodes.end()) continue;
      sector[at(root(sector, static_cast<int>(i)))] = root(sector, place_[at(twin / Sides::stride)]);
    }
  for (std::size_t i = 0; i < cells.size(); ++i) sector[i] = root(sector, static_cast<int>(i));
}

/// Which cells around a node get its double. A sector (cells joined around the node) is of the lower side, of the upper side, or of both
/// when the surface ends at the node. False: three kinds of sectors meet, so a pair of nodes does not tell them apart.
bool Cut::decide(const Mesh& mesh, int local, std::vector<int>& sector) {
  const auto begin = at(first_[at(local)]), end = at(first_[at(local + 1)]);
  const std::span<const int> cells = std::span(cell_).subspan(begin, end - begin);
  join_around(mesh, nodes_[at(local)], cells, sector);
  bool open = false;                       // a face of the surface has different sectors on its sides
  std::vector<int> kind(cells.size(), 0);  // of each sector: 1 lower, 2 upper, 3 both
  std::vector<int> nodes;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    kind[at(sector[i])] |= lower_side.has(sides_.cells()[at(cells[i])]) ? 1 : 2;
    for (int s = 0; s < sides_.count(cells[i]) && !open; ++s) {
      const int side = cells[i] * Sides::stride + s;
      if (!cut_[at(side)]) continue;
      sides_.nodes_of(mesh, side, nodes);
      if (std::find(nodes.begin(), nodes.end(), nodes_[at(local)]) == nodes.end()) continue;
      open = sector[i] != sector[at(place_[at(sides_.twin(side) / Sides::stride)])];
    }
  }
  if (!open) return true;
  const auto count = [&](int wanted) { return std::count(kind.begin(), kind.end(), wanted); };
  const auto both = count(3);
  if (both > 1 || (both == 1 && count(1) && count(2))) return false;
  const bool both_moves = both == 1 && count(2) == 0;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const int k = kind[at(sector[i])];
    moves_[begin + i] = k == 2 || (k == 3 && both_moves);
  }
  return true;
}

int Cut::node_for(int node, int cell) const {
  const int local = local_[at(node)];
  if (local < 0 || double_[at(local)] < 0) return node;
  const auto begin = cell_.begin() + first_[at(local)], end = cell_.begin() + first_[at(local + 1)];
  const auto found = std::lower_bound(begin, end, cell);  // connect_nodes lists them in ascending order
  assert(found != end && *found == cell);
  return moves_[at(static_cast<int>(found - cell_.begin()))] ? double_[at(local)] : node;
}

/// New nodes for a cell of lower dimension that is not on the surfaces.
void renumber_small(const Cut& cut, Cell cell, std::span<int> nodes, bool lower) {
  if (std::none_of(nodes.begin(), nodes.end(), [&](int node) { return cut.double_of(node) >= 0; })) return;
  const Sides& sides = cut.sides();
  const int side = info(cell).corners > 1 ? sides.find(cell, nodes) : -1, twin = side < 0 ? -1 : sides.twin(side);
  for (int& node : nodes) {
    if (cut.double_of(node) < 0) continue;
    const int one = side < 0 ? node : cut.node_for(node, side / Sides::stride);
    const bool known = side >= 0 && (twin < 0 || cut.node_for(node, twin / Sides::stride) == one);
    node = known ? one : lower ? node : cut.double_of(node);
  }
}

void renumber_cut(Mesh& mesh, const Cut& cut) {
  for (int b = 0; b < static_cast<int>(mesh.blocks.size()); ++b) {
    CellBlock& block = mesh.blocks[at(b)];
    if (info(block.cell).dimension == mesh.dimension) continue;
    const auto n = at(info(block.cell).nodes);
    for (int i = 0; i < block.count(); ++i)
      if (!cut.on_surface.has({b, i}))
        renumber_small(cut, block.cell, std::span(block.nodes).subspan(at(i) * n, n), cut.lower_side.has({b, i}));
  }
  for (int k = 0; k < static_cast<int>(cut.sides().cells().size()); ++k) {
    const CellId id = cut.sides().cells()[at(k)];
    CellBlock& block = mesh.blocks[at(id.block)];
    const auto n = at(info(block.cell).nodes);
    for (int& node : std::span(block.nodes).subspan(at(id.index) * n, n)) node = cut.node_for(node, k);
  }
}

/// Nodes of a side of a renumbered cell, in the order of the same side before.
void write_face(Mesh& mesh, const Cut& cut, const std::vector<int>& nodes, int side, CellId opened) {
  CellBlock& block = mesh.blocks[at(opened.block)];
  const auto n = nodes.size();
  for (std::size_t i = 0; i < n; ++i) block.nodes[at(opened.index) * n + i] = cut.node_for(nodes[i], side / Sides::stride);
}

OpenedSurface open_surface(Mesh& mesh, const Cut& cut, const std::string& name, const std::vector<SplitFace>& faces,
                           const std::vector<std::vector<int>>& lists) {
  OpenedSurface surface{name, {}, {}};
  Group upper{mesh.dimension - 1, {}, {}};
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const SplitFace& face = faces[f];
    CellBlock& block = mesh.blocks[at(face.cell.block)];
    const CellId opened{face.cell.block, block.count()};
    block.nodes.resize(block.nodes.size() + lists[f].size());
    if (!block.file_number.empty()) block.file_number.push_back(block.file_number[at(face.cell.index)]);
    write_face(mesh, cut, lists[f], face.lower, face.cell);
    write_face(mesh, cut, lists[f], face.upper, opened);
    surface.faces.push_back({face.cell, opened});
    upper.cells.push_back(opened);
  }
  std::sort(upper.cells.begin(), upper.cells.end());
  mesh.groups[name + "_upper"] = std::move(upper);
  surface.pairs = pairs_of(mesh, surface.faces);
  return surface;
}

void check_names(const Mesh& mesh, const std::vector<std::string>& surfaces, const std::vector<std::string>& lower, const Where& where) {
  const bool has_cells = std::any_of(lower.begin(), lower.end(), [&](const std::string& name) {
    return group_named(mesh, name, "the lower side of the surface", where).dimension == mesh.dimension;
  });
  if (!has_cells)
    throw InputError(where, "", "a group of the lower side with cells of dimension " + std::to_string(mesh.dimension),
                     lower.empty() ? "no group" : "none in " + in_quotes(lower.front()));
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    const Group& group = group_named(mesh, surfaces[i], "the surface to open", where);
    const std::string path = "group " + in_quotes(surfaces[i]);
    if (group.dimension != mesh.dimension - 1 || group.cells.empty())
      throw InputError(where, path, mesh.dimension == 2 ? "a group of lines" : "a group of faces",
                       group.cells.empty() ? "no cells" : "cells of dimension " + std::to_string(group.dimension));
    if (mesh.groups.contains(surfaces[i] + "_upper"))
      throw InputError(where, path, "a surface that is not open yet", "the group " + in_quotes(surfaces[i] + "_upper") + " in the mesh");
    for (std::size_t j = 0; j < i; ++j)
      if (surfaces[j] == surfaces[i]) throw InputError(where, path, "each surface once", "it twice");
  }
}

}  // namespace

std::vector<NodePair> pairs_of(const Mesh& mesh, const std::vector<FacePair>& faces) {
  std::vector<NodePair> pairs;
  for (const FacePair& face : faces) {
    const auto lower = mesh.cell(face.lower), upper = mesh.cell(face.upper);
    for (std::size_t i = 0; i < lower.size(); ++i)
      if (lower[i] != upper[i]) pairs.push_back({lower[i], upper[i]});
  }
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  return pairs;
}

std::vector<OpenedSurface> split(Mesh& mesh, const std::vector<std::string>& surfaces, const std::vector<std::string>& lower,
                                 const Where& where) {
  assert(!surfaces.empty());
  check_names(mesh, surfaces, lower, where);
  const Cut cut(mesh, surfaces, lower, where);
  if (cut.doubled.empty())
    throw InputError(where, "group " + in_quotes(surfaces.front()), "a surface that can be opened",
                     "one whose nodes all lie on its rim inside the mesh");
  std::vector<std::vector<std::vector<int>>> lists(surfaces.size());  // nodes of each face before, seen from the lower cell
  for (std::size_t s = 0; s < surfaces.size(); ++s)
    for (const SplitFace& face : cut.faces[s]) cut.sides().nodes_of(mesh, face.lower, lists[s].emplace_back());

  renumber_cut(mesh, cut);
  for (const int node : cut.doubled) mesh.nodes.push_back(Vec3(mesh.nodes[at(node)]));
  for (auto& [name, group] : mesh.groups) {
    const std::size_t before = group.nodes.size();
    for (std::size_t i = 0; i < before; ++i)
      if (cut.double_of(group.nodes[i]) >= 0) group.nodes.push_back(cut.double_of(group.nodes[i]));
  }
  std::vector<OpenedSurface> opened;
  for (std::size_t s = 0; s < surfaces.size(); ++s) opened.push_back(open_surface(mesh, cut, surfaces[s], cut.faces[s], lists[s]));
  return opened;
}

}  // namespace uplift
