#include "uplift/mesh/cut.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <set>

#include "uplift/base/text.h"
#include "uplift/mesh/absent_group.h"
#include "uplift/mesh/parts.h"
#include "uplift/mesh/sides.h"

namespace uplift {
namespace {

std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

constexpr double on_plane = 1e-8;  // of the shortest edge: nodes so near count as on the plane

/// Which parts of a cell are filled after a cut.
struct Halves {
  bool lower = false, upper = false;
  bool lower_whole = true, upper_whole = true;
  int outline = 0;  // that holds the upper part
};

constexpr CellId no_cell{-1, -1};
struct MadeCells {
  CellId lower = no_cell, upper = no_cell;
};

/// A part of the mesh as it was before the cut: the numbers of nodes and cells change under way.
struct CellBefore {
  Cell cell;
  std::vector<Vec3> corners;
  double tolerance;
};

/// A mesh between two cuts. Empty cells are only marked: `compact` removes them after the last plane.
struct Work {
  Mesh mesh;
  std::vector<std::vector<bool>> removed = {};                    // of each cell
  std::map<CellId, std::vector<ClippedCell::Piece>> pieces = {};  // of the parts
  std::set<CellId> lines = {};                                    // beams and points, no faces of cells
};

/// One plane through a mesh.
class OneCut {
 public:
  OneCut(Work& work, const CutPlane& plane, const Where& where);
  std::vector<CutFace> faces();

 private:
  std::vector<CellId> cells_of_groups();
  CellBefore before(CellId id) const;
  void find_signs();
  /// Of a node: below the plane -1, on it 0, above it 1.
  int sign(int node) const { return sign_[at(node)]; }
  Halves halves_of(CellId id) const;
  Halves halves_of_part(CellId id) const;
  void keep_within(const CellBefore& cell, Halves& halves) const;
  void find_level_faces();
  void find_doubles();
  void find_neighbours();
  bool is_within(const Vec3& place, double tolerance) const;
  void refuse_bond(CellId id, bool below) const;
  void refuse_nothing() const;
  bool has_outline() const { return !plane_.outlines.front().within.empty(); }
  int lower_node(int node) const { return sign(node) > 0 && double_[at(node)] >= 0 ? double_[at(node)] : node; }
  int upper_node(int node) const { return sign(node) <= 0 && double_[at(node)] >= 0 ? double_[at(node)] : node; }
  MadeCells write_cell(CellId id, const Halves& halves);
  void rename(CellId id, bool upper);
  void add_own_doubles(const MadeCells& made);
  CellId add_copy(CellId id);
  void set_part(CellId id, const CellBefore& before, const std::vector<HalfSpace>& within);
  void write_small(CellId id);
  void write_groups();
  std::vector<HalfSpace> above(int outline) const;
  void add_face(std::vector<CutFace>& faces, CutFace face, const CellBefore& of) const;

  Work& work_;
  Mesh& mesh_;
  std::vector<std::vector<bool>>& removed_;
  const CutPlane& plane_;
  const Where& where_;
  std::vector<std::vector<int>> number_;  // of each cell of the mesh: its number in sides_.cells(), -1 for none
  Sides sides_;                           // of the cells of the groups `through`
  std::vector<Halves> halves_;            // of each of sides_.cells(), as made_
  std::vector<MadeCells> made_;
  std::vector<std::pair<CellId, bool>> neighbours_;  // other cells at doubled nodes, and whether they are of the upper side
  std::map<CellId, MadeCells> made_small_;           // of lower dimension
  std::vector<signed char> sign_;
  std::vector<double> edge_;         // m: the shortest edge of cells of the groups at each node
  std::vector<bool> below_, above_;  // nodes of lower and of upper parts
  std::vector<int> double_;
  struct LevelFace {
    int lower, upper;  // numbers of the cells
    std::vector<Vec3> corners;
  };
  std::vector<LevelFace> level_;
};

std::vector<CellId> OneCut::cells_of_groups() {
  for (const CellBlock& block : mesh_.blocks) number_.emplace_back(at(block.count()), -1);
  for (const std::string& name : plane_.through) {
    const auto group = mesh_.groups.find(name);
    if (group == mesh_.groups.end()) throw absent_group(mesh_, name, where_, "", "the cells that the plane cuts");
    if (group->second.dimension != mesh_.dimension || group->second.cells.empty())
      throw InputError(where_, "group " + in_quotes(name), "a group of cells of dimension " + std::to_string(mesh_.dimension),
                       group->second.cells.empty() ? "no cells" : "cells of dimension " + std::to_string(group->second.dimension));
    for (const CellId id : group->second.cells) number_[at(id.block)][at(id.index)] = 0;
  }
  std::vector<CellId> cells;
  for (int b = 0; b < static_cast<int>(mesh_.blocks.size()); ++b)
    for (int i = 0; i < mesh_.blocks[at(b)].count(); ++i) {
      int& number = number_[at(b)][at(i)];
      if (number < 0 || removed_[at(b)][at(i)]) continue;
      number = static_cast<int>(cells.size());
      cells.push_back({b, i});
    }
  return cells;
}

CellBefore OneCut::before(CellId id) const {
  CellBefore cell{mesh_.type(id), {}, std::numeric_limits<double>::infinity()};
  for (const int node : mesh_.cell(id).first(at(info(cell.cell).corners))) {
    cell.corners.push_back(mesh_.nodes[at(node)]);
    cell.tolerance = std::min(cell.tolerance, on_plane * edge_[at(node)]);
  }
  return cell;
}

std::vector<HalfSpace> OneCut::above(int outline) const {
  std::vector<HalfSpace> spaces{plane_.below.other_side()};
  const std::vector<HalfSpace>& within = plane_.outlines[at(outline)].within;
  spaces.insert(spaces.end(), within.begin(), within.end());
  return spaces;
}

void OneCut::find_signs() {
  edge_.assign(mesh_.nodes.size(), std::numeric_limits<double>::infinity());
  for (const CellId id : sides_.cells()) {
    const std::span<const int> edges = info(mesh_.type(id)).edges, nodes = mesh_.cell(id);
    for (std::size_t e = 0; e + 1 < edges.size(); e += 2) {
      const int a = nodes[at(edges[e])], b = nodes[at(edges[e + 1])];
      const double length = (mesh_.nodes[at(a)] - mesh_.nodes[at(b)]).norm();
      for (const int node : {a, b}) edge_[at(node)] = std::min(edge_[at(node)], length);
    }
  }
  for (std::size_t node = 0; node < mesh_.nodes.size(); ++node) {
    const double distance = plane_.below.distance(mesh_.nodes[node]), near = std::isinf(edge_[node]) ? 0 : on_plane * edge_[node];
    sign_.push_back(distance > near ? 1 : distance < -near ? -1 : 0);
  }
}

/// Whether an outline holds all of the corners, none of what is between them or a part.
PlaneSide side_of_outline(const CutOutline& outline, std::span<const Vec3> corners, double tolerance) {
  PlaneSide found = PlaneSide::inside;
  for (const HalfSpace& space : outline.within) {
    const PlaneSide side = side_of_cell(space, corners, tolerance);
    if (side == PlaneSide::outside) return side;
    if (side == PlaneSide::both) found = side;
  }
  return found;
}

/// What an earlier plane has left of a cell lies on one side of this one, and within its outline or outside of it.
Halves OneCut::halves_of_part(CellId id) const {
  std::vector<Vec3> corners;
  for (const ClippedCell::Piece& piece : work_.pieces.at(id)) corners.insert(corners.end(), piece.corners.begin(), piece.corners.end());
  const double tolerance = before(id).tolerance;
  const PlaneSide side = side_of_cell(plane_.below, corners, tolerance);
  Halves halves{side == PlaneSide::inside, false};
  bool cut = side == PlaneSide::both;
  for (int k = 0; k < static_cast<int>(plane_.outlines.size()) && side == PlaneSide::outside; ++k) {
    const PlaneSide within = side_of_outline(plane_.outlines[at(k)], corners, tolerance);
    cut = cut || within == PlaneSide::both;
    if (within == PlaneSide::inside) halves.upper = true, halves.outline = k;
  }
  if (cut) throw InputError(where_, "", "planes that do not cut the same cell", "two of them in " + describe_cell(mesh_, id));
  return halves;
}

/// The upper part lies within an outline.
void OneCut::keep_within(const CellBefore& cell, Halves& halves) const {
  const bool curved = info(cell.cell).nodes != info(cell.cell).corners;  // is refused
  halves.upper = false;
  for (int k = 0; k < static_cast<int>(plane_.outlines.size()); ++k) {
    const PlaneSide side = side_of_outline(plane_.outlines[at(k)], cell.corners, cell.tolerance);
    if (side == PlaneSide::outside) continue;
    const bool whole = halves.upper_whole && side == PlaneSide::inside;
    if (!whole && !curved && clip_cell(cell.cell, cell.corners, above(k), cell.tolerance).pieces.empty()) continue;
    if (halves.upper)
      throw InputError(where_, "", "outlines on one plane that are at least a cell apart",
                       fmt::format("two of them in the {} at ({:g}, {:g}, {:g})", info(cell.cell).name, cell.corners[0].x(),
                                   cell.corners[0].y(), cell.corners[0].z()));
    halves.upper = true, halves.outline = k;
  }
  if (halves.upper && side_of_outline(plane_.outlines[at(halves.outline)], cell.corners, cell.tolerance) == PlaneSide::both)
    halves.upper_whole = false;
}

Halves OneCut::halves_of(CellId id) const {
  if (mesh_.part(id)) return halves_of_part(id);
  const auto nodes = mesh_.cell(id);
  const bool below = std::ranges::any_of(nodes, [&](int node) { return sign(node) < 0; });
  const bool above = std::ranges::any_of(nodes, [&](int node) { return sign(node) > 0; });
  Halves halves{below, above, !above, !below};
  if (above) keep_within(before(id), halves);
  const bool whole = (!below || halves.lower_whole) && (!halves.upper || halves.upper_whole);
  if (!whole && info(mesh_.type(id)).nodes != info(mesh_.type(id)).corners)
    throw InputError(where_, "", "cells of the first degree (tri3, quad4, tet4, wedge6, hex8) where a plane cuts",
                     describe_cell(mesh_, id));
  return halves;
}

/// Faces on the plane between a cell below and one above it.
void OneCut::find_level_faces() {
  std::vector<int> nodes;
  for (int k = 0; k < static_cast<int>(halves_.size()); ++k) {
    if (!halves_[at(k)].lower || halves_[at(k)].upper) continue;
    for (int s = 0; s < sides_.count(k); ++s) {
      const int side = Sides::stride * k + s, twin = sides_.twin(side);
      if (twin < 0 || !halves_[at(twin / Sides::stride)].upper) continue;
      sides_.nodes_of(mesh_, side, nodes);
      if (std::ranges::any_of(nodes, [&](int node) { return sign(node) != 0; })) continue;
      LevelFace& face = level_.emplace_back(LevelFace{k, twin / Sides::stride, {}});
      const int corners = info(info(mesh_.type(sides_.cells()[at(k)])).sides[at(s)]).corners;
      for (int c = 0; c < corners; ++c) face.corners.push_back(mesh_.nodes[at(nodes[at(c)])]);
    }
  }
}

void OneCut::refuse_nothing() const {
  if (!level_.empty() || std::ranges::any_of(halves_, [](const Halves& halves) { return halves.lower && halves.upper; })) return;
  double least = std::numeric_limits<double>::infinity(), most = -least;
  for (const CellId id : sides_.cells())
    for (const int node : mesh_.cell(id)) {
      least = std::min(least, plane_.below.distance(mesh_.nodes[at(node)]));
      most = std::max(most, plane_.below.distance(mesh_.nodes[at(node)]));
    }
  throw InputError(where_, "", "a plane with cells of the groups on both sides",
                   fmt::format("none: they reach from {:g} m to {:g} m above it{}", least, most,
                               has_outline() ? ", and what lies above must lie within the outline" : ""));
}

void OneCut::find_doubles() {
  below_.assign(mesh_.nodes.size(), false);
  above_.assign(mesh_.nodes.size(), false);
  double_.assign(mesh_.nodes.size(), -1);
  if (plane_.own_doubles) {
    for (const CellId id : sides_.cells())
      if (std::ranges::any_of(mesh_.cell(id), [&](int node) { return sign(node) == 0; }))
        throw InputError(where_, "", "a plane that meets no node, since the jump is not linear",
                         "a node of the " + describe_cell(mesh_, id) + " on it");
    return;
  }
  for (std::size_t k = 0; k < halves_.size(); ++k)
    for (const int node : mesh_.cell(sides_.cells()[k])) {
      if (halves_[k].lower) below_[at(node)] = true;
      if (halves_[k].upper) above_[at(node)] = true;
    }
  const std::size_t count = mesh_.nodes.size();
  for (std::size_t node = 0; node < count; ++node)
    if (below_[node] && above_[node]) {
      double_[node] = static_cast<int>(mesh_.nodes.size());
      mesh_.nodes.push_back(Vec3(mesh_.nodes[node]));
    }
}

bool OneCut::is_within(const Vec3& place, double tolerance) const {
  return std::ranges::any_of(plane_.outlines, [&](const CutOutline& outline) {
    return std::ranges::all_of(outline.within, [&](const HalfSpace& space) { return space.distance(place) <= tolerance; });
  });
}

/// A cell of another group that meets those of the groups in the plane would stay bonded to them there.
void OneCut::refuse_bond(CellId id, bool below) const {
  const CellInfo& type = info(mesh_.type(id));
  const auto nodes = mesh_.cell(id);
  std::vector<int> face;
  for (int s = 0; s < static_cast<int>(type.sides.size()); ++s) {
    face.clear();
    for (const int k : side_of(mesh_.type(id), s)) face.push_back(nodes[at(k)]);
    if (std::ranges::any_of(face, [&](int node) { return sign(node) != 0; })) continue;
    const int side = sides_.find(type.sides[at(s)], face);
    if (side < 0 || (below ? halves_[at(side / Sides::stride)].lower : !halves_[at(side / Sides::stride)].lower)) continue;
    Vec3 middle = Vec3::Zero();
    for (const int node : face) middle += mesh_.nodes[at(node)] / static_cast<double>(face.size());
    if (is_within(middle, 0))
      throw InputError(where_, "", "the groups of all cells that meet in the plane, in `through`",
                       describe_cell(mesh_, id) + " in none of them");
  }
}

/// Cells that are not cut but touch doubled nodes go with their side.
void OneCut::find_neighbours() {
  for (int b = 0; b < static_cast<int>(mesh_.blocks.size()); ++b) {
    if (info(mesh_.blocks[at(b)].cell).dimension != mesh_.dimension) continue;
    for (int i = 0; i < mesh_.blocks[at(b)].count(); ++i) {
      if (number_[at(b)][at(i)] >= 0 || removed_[at(b)][at(i)]) continue;
      const CellId id{b, i};
      const auto any = [&](auto&& wanted) { return std::ranges::any_of(mesh_.cell(id), wanted); };
      const bool below = any([&](int node) { return sign(node) < 0; });
      if (!below && any([&](int node) { return sign(node) > 0 && below_[at(node)] && !above_[at(node)]; }))
        throw InputError(where_, "", "an outline that holds what stands above the plane", describe_cell(mesh_, id) + " outside of it");
      if (!below && any([&](int node) { return above_[at(node)] && !is_within(mesh_.nodes[at(node)], on_plane * edge_[at(node)]); }))
        throw InputError(where_, "", "an outline that holds what stands above the plane", describe_cell(mesh_, id) + " outside of it");
      refuse_bond(id, below);
      if (!any([&](int node) { return double_[at(node)] >= 0; })) continue;
      if (below && !mesh_.part(id) && any([&](int node) { return sign(node) > 0; }))
        throw InputError(where_, "", "the groups of all cells that the plane cuts", describe_cell(mesh_, id) + " in none of them");
      neighbours_.emplace_back(id, !below);
    }
  }
}

OneCut::OneCut(Work& work, const CutPlane& plane, const Where& where)
    : work_(work), mesh_(work.mesh), removed_(work.removed), plane_(plane), where_(where), sides_(mesh_, cells_of_groups()) {
  find_signs();
  for (const CellId id : sides_.cells()) halves_.push_back(halves_of(id));
  find_level_faces();
  refuse_nothing();
  find_doubles();
  find_neighbours();
}

CellId OneCut::add_copy(CellId id) {
  CellBlock& block = mesh_.blocks[at(id.block)];
  const CellId copy{id.block, block.count()};
  const std::vector<int> nodes(block[id.index].begin(), block[id.index].end());
  block.nodes.insert(block.nodes.end(), nodes.begin(), nodes.end());
  if (!block.file_number.empty()) block.file_number.push_back(block.file_number[at(id.index)]);
  removed_[at(id.block)].push_back(false);
  return copy;
}

void OneCut::rename(CellId id, bool upper) {
  CellBlock& block = mesh_.blocks[at(id.block)];
  const auto n = at(info(block.cell).nodes);
  for (int& node : std::span(block.nodes).subspan(at(id.index) * n, n)) node = upper ? upper_node(node) : lower_node(node);
}

/// The nodes of both parts of a cell beyond the plane become nodes that no other cell has.
void OneCut::add_own_doubles(const MadeCells& made) {
  if (made.lower == no_cell || made.upper == no_cell) return;
  for (const CellId id : {made.lower, made.upper}) {
    CellBlock& block = mesh_.blocks[at(id.block)];
    const auto n = at(info(block.cell).nodes);
    for (int& node : std::span(block.nodes).subspan(at(id.index) * n, n))
      if (sign(node) == (id == made.lower ? 1 : -1)) {
        mesh_.nodes.push_back(Vec3(mesh_.nodes[at(node)]));
        node = static_cast<int>(mesh_.nodes.size()) - 1;
      }
  }
}

void OneCut::set_part(CellId id, const CellBefore& before, const std::vector<HalfSpace>& within) {
  ClippedCell clipped = clip_cell(before.cell, before.corners, within, before.tolerance);
  mesh_.parts[id] = {std::move(clipped.rule), {}};
  work_.pieces[id] = std::move(clipped.pieces);
}

MadeCells OneCut::write_cell(CellId id, const Halves& halves) {
  MadeCells made;
  if (halves.lower) made.lower = id;
  if (halves.upper) made.upper = halves.lower ? add_copy(id) : id;
  if (!halves.lower && !halves.upper) {
    removed_[at(id.block)][at(id.index)] = true;
    mesh_.parts.erase(id);
    work_.pieces.erase(id);
    return made;
  }
  const bool cut = (halves.lower && !halves.lower_whole) || (halves.upper && !halves.upper_whole);
  const CellBefore cell = cut ? before(id) : CellBefore{};
  if (halves.lower && !halves.lower_whole) set_part(made.lower, cell, {plane_.below});
  if (halves.upper && !halves.upper_whole) set_part(made.upper, cell, above(halves.outline));
  if (halves.upper) rename(made.upper, true);
  if (halves.lower) rename(made.lower, false);
  return made;
}

/// A cell of lower dimension: a face of cells of the groups, else a beam or a point. On the plane, faces stay with the lower side, others
/// go with the upper one.
void OneCut::write_small(CellId id) {
  const auto nodes = mesh_.cell(id);
  const bool below = std::ranges::any_of(nodes, [&](int node) { return sign(node) < 0; });
  const bool above = std::ranges::any_of(nodes, [&](int node) { return sign(node) > 0; });
  const bool may_be_face = info(mesh_.type(id)).dimension == mesh_.dimension - 1 && mesh_.dimension > 1 && !work_.lines.contains(id);
  const int side = may_be_face ? sides_.find(mesh_.type(id), nodes) : -1, twin = side < 0 ? -1 : sides_.twin(side);
  if (side < 0) {
    if (!below) rename(id, true);
    return;
  }
  const Halves &one = halves_[at(side / Sides::stride)], &other = twin < 0 ? one : halves_[at(twin / Sides::stride)];
  const bool lower = one.lower || other.lower, upper = one.upper || other.upper;
  Halves halves{lower && (below || !above), upper && (above || (!below && !lower)), !above, !below};
  if (above && halves.upper) keep_within(before(id), halves);
  made_small_[id] = write_cell(id, halves);
}

/// The parts below the plane stay in the groups of their cell, those above as well, or leave the groups `through` for `upper`.
void OneCut::write_groups() {
  for (auto& [name, group] : mesh_.groups) {
    const bool may_leave = std::ranges::find(plane_.through, name) != plane_.through.end();
    std::vector<CellId> cells;
    for (const CellId id : group.cells) {
      const int number = number_[at(id.block)][at(id.index)];
      const auto small = number < 0 ? made_small_.find(id) : made_small_.end();
      const MadeCells made = number >= 0 ? made_[at(number)] : small != made_small_.end() ? small->second : MadeCells{id, no_cell};
      if (made.lower != no_cell) cells.push_back(made.lower);
      const bool leaves = may_leave && number >= 0 && !plane_.outlines[at(halves_[at(number)].outline)].upper.empty();
      if (made.upper != no_cell && !leaves) cells.push_back(made.upper);
    }
    group.cells = std::move(cells);
    const std::size_t count = group.nodes.size();
    for (std::size_t i = 0; i < count; ++i)
      if (const int twin = double_[at(group.nodes[i])]; twin >= 0) group.nodes.push_back(twin);
  }
  for (int k = 0; k < static_cast<int>(plane_.outlines.size()); ++k) {
    const std::string& name = plane_.outlines[at(k)].upper;
    if (name.empty()) continue;
    Group& group = mesh_.groups[name];
    if (group.dimension != mesh_.dimension && !(group.cells.empty() && group.nodes.empty()))
      throw InputError(where_, "group " + in_quotes(name), "a new name, or that of a group of cells",
                       "a group of dimension " + std::to_string(group.dimension));
    group.dimension = mesh_.dimension;
    for (std::size_t i = 0; i < made_.size(); ++i)
      if (made_[i].upper != no_cell && halves_[i].outline == k) group.cells.push_back(made_[i].upper);
  }
  for (auto& [name, group] : mesh_.groups) {
    std::ranges::sort(group.cells);
    group.cells.erase(std::unique(group.cells.begin(), group.cells.end()), group.cells.end());
  }
}

/// Adds what lies within its outline.
void OneCut::add_face(std::vector<CutFace>& faces, CutFace face, const CellBefore& of) const {
  const std::vector<HalfSpace>& within = plane_.outlines[at(face.outline)].within;
  face.corners = clip_section(std::move(face.corners), within, of.tolerance);
  if (static_cast<int>(face.corners.size()) < mesh_.dimension) return;
  const bool faceted = mesh_.dimension == 3 && info(of.cell).corners > 4;  // a hexahedron or a wedge
  face.level = is_level(of.cell, of.corners, plane_.below) && (!faceted || face.corners.size() == 4);
  for (const HalfSpace& space : within) {
    if (side_of_cell(space, of.corners, of.tolerance) != PlaneSide::both) continue;
    face.clipped = true;
    face.level = face.level && (!faceted || is_level(of.cell, of.corners, space));
  }
  faces.push_back(std::move(face));
}

std::vector<CutFace> OneCut::faces() {
  const std::size_t blocks = mesh_.blocks.size();
  std::vector<int> counts;
  for (const CellBlock& block : mesh_.blocks) counts.push_back(block.count());
  std::map<int, CellBefore> cells;
  for (int k = 0; k < static_cast<int>(halves_.size()); ++k)
    if (halves_[at(k)].lower && halves_[at(k)].upper) cells.emplace(k, before(sides_.cells()[at(k)]));
  for (const LevelFace& face : level_) cells.emplace(face.upper, before(sides_.cells()[at(face.upper)]));
  for (std::size_t b = 0; b < blocks; ++b) {
    if (info(mesh_.blocks[b].cell).dimension == mesh_.dimension) continue;
    for (int i = 0; i < counts[b]; ++i)
      if (!removed_[b][at(i)]) write_small({static_cast<int>(b), i});
  }
  for (std::size_t k = 0; k < halves_.size(); ++k) made_.push_back(write_cell(sides_.cells()[k], halves_[k]));
  if (plane_.own_doubles)
    for (const MadeCells& made : made_) add_own_doubles(made);
  for (const auto& [id, upper] : neighbours_) rename(id, upper);
  write_groups();
  std::vector<CutFace> found;
  for (const auto& [k, cell] : cells)
    if (const Halves& halves = halves_[at(k)]; halves.lower && halves.upper)
      add_face(found,
               {.lower = made_[at(k)].lower,
                .upper = made_[at(k)].upper,
                .corners = section(cell.cell, cell.corners, plane_.below, cell.tolerance),
                .outline = halves.outline},
               cell);
  for (const LevelFace& face : level_)
    add_face(found,
             {.lower = made_[at(face.lower)].lower,
              .upper = made_[at(face.upper)].upper,
              .corners = face.corners,
              .outline = halves_[at(face.upper)].outline},
             cells.at(face.upper));
  if (found.empty()) throw InputError(where_, "", "an interface on the plane", "none: nothing above the plane lies within the outline");
  return found;
}

/// Removes marked cells and nodes that nothing uses.
void compact(Work& work, std::vector<std::vector<CutFace>>& faces) {
  Mesh& mesh = work.mesh;
  std::vector<std::vector<int>> index;
  for (std::size_t b = 0; b < mesh.blocks.size(); ++b) {
    CellBlock& block = mesh.blocks[b];
    CellBlock kept{block.cell, {}};
    std::vector<int>& of_block = index.emplace_back(at(block.count()), -1);
    for (int i = 0; i < block.count(); ++i) {
      if (work.removed[b][at(i)]) continue;
      of_block[at(i)] = kept.count();
      kept.nodes.insert(kept.nodes.end(), block[i].begin(), block[i].end());
      if (!block.file_number.empty()) kept.file_number.push_back(block.file_number[at(i)]);
    }
    block = std::move(kept);
  }
  const auto moved = [&](CellId id) { return CellId{id.block, index[at(id.block)][at(id.index)]}; };
  for (auto& [name, group] : mesh.groups) {
    std::erase_if(group.cells, [&](CellId id) { return moved(id).index < 0; });
    for (CellId& id : group.cells) id = moved(id);
  }
  const auto move_keys = [&](auto& map) {
    std::remove_reference_t<decltype(map)> renumbered;
    for (auto& [id, value] : map) renumbered.emplace(moved(id), std::move(value));
    map = std::move(renumbered);
  };
  move_keys(mesh.parts);
  move_keys(work.pieces);
  for (std::vector<CutFace>& of_plane : faces)
    for (CutFace& face : of_plane) face.lower = moved(face.lower), face.upper = moved(face.upper);

  std::vector<int> number(mesh.nodes.size(), -1);
  for (const CellBlock& block : mesh.blocks)
    for (const int node : block.nodes) number[at(node)] = 0;
  std::vector<Vec3> nodes;
  mesh.places.clear();
  for (std::size_t node = 0; node < number.size(); ++node)
    if (number[node] == 0) {
      number[node] = static_cast<int>(nodes.size());
      nodes.push_back(mesh.nodes[node]);
      mesh.places.push_back(static_cast<int>(node));
    }
  mesh.nodes = std::move(nodes);
  for (CellBlock& block : mesh.blocks)
    for (int& node : block.nodes) node = number[at(node)];
  for (auto& [name, group] : mesh.groups) {
    std::erase_if(group.nodes, [&](int node) { return number[at(node)] < 0; });
    for (int& node : group.nodes) node = number[at(node)];
    std::ranges::sort(group.nodes);
  }
  std::erase_if(mesh.groups, [&](const auto& group) {
    const bool empty = group.second.cells.empty() && group.second.nodes.empty();
    if (empty) mesh.emptied.push_back(group.first);
    return empty;
  });
}

}  // namespace

std::vector<std::vector<CutFace>> cut(Mesh& mesh, const std::vector<CutPlane>& planes, const std::vector<Where>& where,
                                      const std::vector<std::string>& lines) {
  assert(planes.size() == where.size());
  Work work{mesh};
  for (const std::string& name : lines)
    if (const auto group = mesh.groups.find(name); group != mesh.groups.end() && group->second.dimension < mesh.dimension)
      work.lines.insert(group->second.cells.begin(), group->second.cells.end());
  for (const CellBlock& block : mesh.blocks) work.removed.emplace_back(at(block.count()), false);
  std::vector<std::vector<CutFace>> faces;
  for (std::size_t k = 0; k < planes.size(); ++k) faces.push_back(OneCut(work, planes[k], where[k]).faces());
  compact(work, faces);
  add_pieces(work.pieces, work.mesh);
  mesh = std::move(work.mesh);
  return faces;
}

}  // namespace uplift
