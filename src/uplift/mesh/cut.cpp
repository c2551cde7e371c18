#include "uplift/mesh/cut.h"

#include <algorithm>
#include <cassert>
#include <optional>

#include "uplift/base/text.h"
#include "uplift/mesh/cut_filling.h"
#include "uplift/mesh/index.h"
#include "uplift/mesh/parts.h"
#include "uplift/mesh/section.h"

namespace uplift {
namespace {

constexpr CellId no_cell{-1, -1};
struct MadeCells {
  CellId lower = no_cell, upper = no_cell;
};

/// One plane through a mesh: the second part, which makes the doubles and the parts.
class OneCut {
 public:
  OneCut(CutWork& work, const CutPlane& plane, const Where& where);
  std::vector<CutFace> faces();
  /// After `faces`.
  std::vector<FreeFace> free_faces() { return std::move(free_); }

 private:
  void find_doubles();
  std::size_t reserve();
  void find_neighbours();
  void refuse_bond(CellId id, bool below) const;
  int sign(int node) const { return filling_.sign(node); }
  bool keeps(int node, bool upper) const { return double_[at(node)] < 0 || upper == (sign(node) > 0 && !beyond_[at(node)]); }
  int lower_node(int node) const { return keeps(node, false) ? node : double_[at(node)]; }
  int upper_node(int node) const { return keeps(node, true) ? node : double_[at(node)]; }
  MadeCells write_cell(CellId id, const Halves& halves, double tolerance);
  void rename(CellId id, bool upper);
  MadeCells made_small(CellId id) const;
  void add_own_doubles(const MadeCells& made);
  CellId add_copy(CellId id);
  void write_small(CellId id);
  void write_groups();
  void add_face(std::vector<CutFace>& faces, CutFace face, const CellBefore& of, const PlacedCell* placed, bool whole) const;
  void add_beside(CellId cell, std::vector<Vec3> corners, const CutOutline* outline, double tolerance);

  CutWork& work_;
  Mesh& mesh_;
  std::vector<std::vector<bool>>& removed_;
  const CutPlane& plane_;
  const Where& where_;
  const CutFilling filling_;
  const int limits_;                   // of the lower side in Mesh::limits; those of the outlines follow
  const Sides& sides_;                 // of the cells of the groups `through` in the extent
  const Sides sides_beyond_;           // of those beyond it
  const std::vector<Halves>& halves_;  // of each of sides_.cells(), as made_
  std::vector<MadeCells> made_;
  std::vector<std::pair<CellId, bool>> neighbours_;       // other cells at doubled nodes, and whether they are of the upper side
  std::vector<std::pair<CellId, MadeCells>> made_small_;  // of lower dimension, ascending
  std::vector<bool> below_, above_;                       // nodes of lower and of upper parts
  std::vector<bool> beyond_;                              // nodes of cells beyond the extent: the lower side keeps them
  std::vector<int> double_;
  std::vector<FreeFace> free_;
};

void OneCut::find_doubles() {
  below_.assign(mesh_.nodes.size(), false);
  above_.assign(mesh_.nodes.size(), false);
  beyond_.assign(mesh_.nodes.size(), false);
  double_.assign(mesh_.nodes.size(), -1);
  for (const CellId id : filling_.beyond())
    for (const int node : mesh_.cell(id)) beyond_[at(node)] = true;
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
  mesh_.nodes.reserve(count + at(static_cast<int>(std::ranges::count(above_, true))));
  for (std::size_t node = 0; node < count; ++node)
    if ((below_[node] || beyond_[node]) && above_[node]) {
      double_[node] = static_cast<int>(mesh_.nodes.size());
      mesh_.nodes.push_back(Vec3(mesh_.nodes[node]));
    }
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
    if (filling_.is_within(middle, 0))
      throw InputError(where_, "", "the groups of all cells that meet in the plane, in `through`",
                       describe_cell(mesh_, id) + " in none of them");
  }
}

/// Cells that are not cut but touch doubled nodes go with their side.
void OneCut::find_neighbours() {
  for (int b = 0; b < static_cast<int>(mesh_.blocks.size()); ++b) {
    if (info(mesh_.blocks[at(b)].cell).dimension != mesh_.dimension) continue;
    for (int i = 0; i < mesh_.blocks[at(b)].count(); ++i) {
      if (filling_.number({b, i}) >= 0 || filling_.is_beyond({b, i}) || removed_[at(b)][at(i)]) continue;
      const CellId id{b, i};
      const auto any = [&](auto&& wanted) { return std::ranges::any_of(mesh_.cell(id), wanted); };
      const bool below = any([&](int node) { return sign(node) < 0; });
      if (!below && any([&](int node) { return sign(node) > 0 && below_[at(node)] && !above_[at(node)]; }))
        throw InputError(where_, "", "an outline that holds what stands above the plane", describe_cell(mesh_, id) + " outside of it");
      if (!below && any([&](int node) { return above_[at(node)] && !filling_.is_within(node); }))
        throw InputError(where_, "", "an outline that holds what stands above the plane", describe_cell(mesh_, id) + " outside of it");
      refuse_bond(id, below);
      if (!any([&](int node) { return double_[at(node)] >= 0; })) continue;
      if (below && !mesh_.part(id) && any([&](int node) { return sign(node) > 0; }))
        throw InputError(where_, "", "the groups of all cells that the plane cuts", describe_cell(mesh_, id) + " in none of them");
      neighbours_.emplace_back(id, !below);
    }
  }
}

OneCut::OneCut(CutWork& work, const CutPlane& plane, const Where& where)
    : work_(work),
      mesh_(work.mesh),
      removed_(work.removed),
      plane_(plane),
      where_(where),
      filling_(work, plane, where),
      limits_(static_cast<int>(work.mesh.limits.size())),
      sides_(filling_.sides()),
      sides_beyond_(mesh_, filling_.beyond()),
      halves_(filling_.halves()) {
  mesh_.limits.push_back({plane.below});
  for (int k = 0; k < static_cast<int>(plane.outlines.size()); ++k) {
    const std::span<const HalfSpace> above = filling_.above(k);
    mesh_.limits.emplace_back(above.begin(), above.end());
  }
  find_doubles();
  find_neighbours();
}

CellId OneCut::add_copy(CellId id) {
  CellBlock& block = mesh_.blocks[at(id.block)];
  const CellId copy{id.block, block.count()};
  const std::size_t n = block[id.index].size(), before = block.nodes.size();
  block.nodes.resize(before + n);
  std::ranges::copy(block[id.index], block.nodes.begin() + static_cast<std::ptrdiff_t>(before));
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

MadeCells OneCut::write_cell(CellId id, const Halves& halves, double tolerance) {
  MadeCells made;
  if (halves.lower) made.lower = id;
  if (halves.upper) made.upper = halves.lower ? add_copy(id) : id;
  if (!halves.lower && !halves.upper) {
    removed_[at(id.block)][at(id.index)] = true;
    mesh_.parts.erase(id);
    return made;
  }
  if (halves.lower && !halves.lower_whole) mesh_.parts[made.lower] = {.limits = limits_, .tolerance = tolerance};
  if (halves.upper && !halves.upper_whole) mesh_.parts[made.upper] = {.limits = limits_ + 1 + halves.outline, .tolerance = tolerance};
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
  if (may_be_face && sides_beyond_.find(mesh_.type(id), nodes) >= 0) return;
  const int side = may_be_face ? sides_.find(mesh_.type(id), nodes) : -1, twin = side < 0 ? -1 : sides_.twin(side);
  if (side < 0) {
    if (!below && std::ranges::any_of(nodes, [&](int node) { return !beyond_[at(node)]; })) rename(id, true);
    return;
  }
  const Halves &one = halves_[at(side / Sides::stride)], &other = twin < 0 ? one : halves_[at(twin / Sides::stride)];
  const bool lower = one.lower || other.lower, upper = one.upper || other.upper;
  Halves halves{lower && (below || !above), upper && (above || (!below && !lower)), !above, !below};
  const CellBefore before = filling_.before(id);
  if (above && halves.upper) filling_.keep_within(before, halves);
  made_small_.emplace_back(id, write_cell(id, halves, before.tolerance));
}

/// What was made of a cell of lower dimension; itself when nothing was.
MadeCells OneCut::made_small(CellId id) const {
  const auto found = std::ranges::lower_bound(made_small_, id, {}, &std::pair<CellId, MadeCells>::first);
  return found != made_small_.end() && found->first == id ? found->second : MadeCells{id, no_cell};
}

/// The parts below the plane stay in the groups of their cell, those above as well, or leave the groups `through` for `upper`.
void OneCut::write_groups() {
  for (auto& [name, group] : mesh_.groups) {
    const bool may_leave = std::ranges::find(plane_.through, name) != plane_.through.end();
    std::vector<CellId> cells;
    for (const CellId id : group.cells) {
      const int number = filling_.number(id);
      const MadeCells made = number >= 0 ? made_[at(number)] : made_small(id);
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
    if (!std::ranges::is_sorted(group.cells)) std::ranges::sort(group.cells);
    group.cells.erase(std::unique(group.cells.begin(), group.cells.end()), group.cells.end());
  }
}

/// Adds what lies within its outline. `placed`: the same cell as `of`, null for one of the second degree. `whole`: it is a face of two
/// cells.
void OneCut::add_face(std::vector<CutFace>& faces, CutFace face, const CellBefore& of, const PlacedCell* placed, bool whole) const {
  const std::vector<HalfSpace>& within = plane_.outlines[at(face.outline)].within;
  face.corners = clip_section(std::move(face.corners), within, of.tolerance);
  if (static_cast<int>(face.corners.size()) < mesh_.dimension) return;
  const bool faceted = mesh_.dimension == 3 && info(of.cell).corners > 4;  // a hexahedron or a wedge
  const auto level = [&](const HalfSpace& space) {
    return placed != nullptr ? is_level(*placed, space) : is_simplex(info(of.cell).linear);
  };
  face.level = level(plane_.below) && (!faceted || face.corners.size() == 4);
  for (const HalfSpace& space : within) {
    if (side_of_cell(space, of.corners(), of.tolerance) != PlaneSide::both) continue;
    face.clipped = true;
    face.level = face.level && (!faceted || level(space));
  }
  if (whole && !face.clipped) face.level = true;
  face.level = face.level && info(of.cell).linear == of.cell;  // corners alone are no rule for cells of the second degree
  faces.push_back(std::move(face));
}

/// Adds what lies outside of the outline, in convex pieces: beyond its first limit, within that and beyond its second one, and so on.
void OneCut::add_beside(CellId cell, std::vector<Vec3> corners, const CutOutline* outline, double tolerance) {
  const auto add = [&](std::vector<Vec3> piece) {
    if (static_cast<int>(piece.size()) >= mesh_.dimension) free_.push_back({cell, std::move(piece), plane_.below.normal});
  };
  if (outline == nullptr) return add(std::move(corners));
  for (const HalfSpace& space : outline->within) {
    add(clip_section(corners, {space.other_side()}, tolerance));
    corners = clip_section(std::move(corners), {space}, tolerance);
  }
}

/// Room for what the cut makes of the cells, since it may be more than half of the mesh; returns the number of cells that become two.
std::size_t OneCut::reserve() {
  std::size_t parts = 0, faces = 0;
  std::vector<std::size_t> copies(mesh_.blocks.size(), 0);
  for (std::size_t k = 0; k < halves_.size(); ++k) {
    const CellId id = sides_.cells()[k];
    parts += static_cast<std::size_t>(halves_[k].lower && !halves_[k].lower_whole) + (halves_[k].upper && !halves_[k].upper_whole);
    if (!halves_[k].lower || !halves_[k].upper) continue;
    ++faces, ++copies[at(id.block)];
  }
  for (std::size_t b = 0; b < copies.size(); ++b) {
    CellBlock& block = mesh_.blocks[b];
    const std::size_t count = at(block.count()) + copies[b];
    block.nodes.reserve(count * at(info(block.cell).nodes));
    removed_[b].reserve(count);
  }
  mesh_.parts.reserve(parts);
  return faces;
}

std::vector<CutFace> OneCut::faces() {
  const std::size_t blocks = mesh_.blocks.size();
  std::vector<int> counts;
  for (const CellBlock& block : mesh_.blocks) counts.push_back(block.count());
  const std::vector<CutFilling::BareFace> bare = filling_.bare_faces();
  std::vector<CellBefore> on_level;  // the cells above the faces of filling_.level_faces()
  for (const CutFilling::LevelFace& face : filling_.level_faces()) on_level.push_back(filling_.before(sides_.cells()[at(face.upper)]));
  for (std::size_t b = 0; b < blocks; ++b) {
    if (info(mesh_.blocks[b].cell).dimension == mesh_.dimension) continue;
    for (int i = 0; i < counts[b]; ++i)
      if (!removed_[b][at(i)]) write_small({static_cast<int>(b), i});
  }
  std::vector<CutFace> found;
  const auto add = [&](int lower, int upper, std::vector<Vec3> corners, const CellBefore& of, const PlacedCell* placed, bool whole) {
    const CutOutline& outline = plane_.outlines[at(halves_[at(upper)].outline)];
    if (!outline.within.empty()) add_beside(made_[at(lower)].lower, corners, &outline, of.tolerance);
    add_face(found,
             {.lower = made_[at(lower)].lower,
              .upper = made_[at(upper)].upper,
              .corners = std::move(corners),
              .outline = halves_[at(upper)].outline},
             of, placed, whole);
  };
  made_.reserve(halves_.size());
  found.reserve(reserve());
  for (int k = 0; k < static_cast<int>(halves_.size()); ++k) {
    const Halves& halves = halves_[at(k)];
    const CellBefore cell = filling_.before(sides_.cells()[at(k)]);
    made_.push_back(write_cell(sides_.cells()[at(k)], halves, cell.tolerance));
    if (!halves.lower || halves.lower_whole) continue;
    std::vector<Vec3> corners = section(cell.cell, cell.corners(), plane_.below, cell.tolerance);
    if (halves.upper) {
      const PlacedCell placed(cell.cell, cell.corners());
      add(k, k, std::move(corners), cell, &placed, false);
    } else
      add_beside(made_[at(k)].lower, std::move(corners), nullptr, cell.tolerance);
  }
  if (plane_.own_doubles)
    for (const MadeCells& made : made_) add_own_doubles(made);
  for (const auto& [id, upper] : neighbours_) rename(id, upper);
  write_groups();
  const std::vector<CutFilling::LevelFace>& level = filling_.level_faces();
  for (std::size_t k = 0; k < level.size(); ++k) {
    const CellBefore& cell = on_level[k];
    std::optional<PlacedCell> placed;
    if (info(cell.cell).nodes == info(cell.cell).corners) placed.emplace(cell.cell, cell.corners());
    add(level[k].lower, level[k].upper, level[k].corners, cell, placed ? &*placed : nullptr, true);
  }
  for (const CutFilling::BareFace& face : bare) add_beside(made_[at(face.lower)].lower, face.corners, nullptr, 0);
  if (found.empty()) throw InputError(where_, "", "an interface on the plane", "none: nothing above the plane lies within the outline");
  return found;
}

}  // namespace

std::vector<std::vector<CutFace>> cut(Mesh& mesh, const std::vector<CutPlane>& planes, const std::vector<Where>& where,
                                      const std::vector<std::string>& lines, std::vector<std::vector<FreeFace>>* free) {
  assert(planes.size() == where.size());
  CutWork work{mesh};
  for (const std::string& name : lines)
    if (const auto group = mesh.groups.find(name); group != mesh.groups.end() && group->second.dimension < mesh.dimension)
      work.lines.insert(group->second.cells.begin(), group->second.cells.end());
  for (const CellBlock& block : mesh.blocks) work.removed.emplace_back(at(block.count()), false);
  std::vector<std::vector<CutFace>> faces;
  std::vector<std::vector<FreeFace>> beside;
  for (std::size_t k = 0; k < planes.size(); ++k) {
    OneCut one(work, planes[k], where[k]);
    faces.push_back(one.faces());
    beside.push_back(one.free_faces());
  }
  compact(work, faces, beside);
  if (free != nullptr) *free = std::move(beside);
  add_pieces(work.mesh);
  mesh = std::move(work.mesh);
  return faces;
}

}  // namespace uplift
