#include "uplift/mesh/cut_filling.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "uplift/base/text.h"
#include "uplift/mesh/absent_group.h"
#include "uplift/mesh/index.h"
#include "uplift/mesh/parts.h"

namespace uplift {
namespace {

constexpr double on_plane = 1e-8;  // of the shortest edge: nodes so near count as on the plane
constexpr double thinnest = 1e-4;  // of the shortest edge: a body less thick than this

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

std::vector<std::vector<HalfSpace>> limits_above(const CutPlane& plane) {
  std::vector<std::vector<HalfSpace>> limits;
  for (const CutOutline& outline : plane.outlines) {
    limits.push_back({plane.below.other_side()});
    limits.back().insert(limits.back().end(), outline.within.begin(), outline.within.end());
  }
  return limits;
}

}  // namespace

CutFilling::CutFilling(const CutWork& work, const CutPlane& plane, const Where& where)
    : work_(work), mesh_(work.mesh), plane_(plane), where_(where), above_(limits_above(plane)), sides_(mesh_, cells_of_groups()) {
  find_signs();
  halves_.reserve(sides_.cells().size());
  for (const CellId id : sides_.cells()) halves_.push_back(halves_of(id));
  find_level_faces();
  refuse_nothing();
}

std::vector<CellId> CutFilling::cells_of_groups() {
  for (const CellBlock& block : mesh_.blocks) number_.emplace_back(at(block.count()), no_number);
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
      if (number < 0 || work_.removed[at(b)][at(i)]) continue;
      if (!is_in_extent({b, i})) {
        number = beyond_extent;
        beyond_.push_back({b, i});
        continue;
      }
      number = static_cast<int>(cells.size());
      cells.push_back({b, i});
    }
  return cells;
}

/// A cell belongs where its centre is. What is below the plane may reach across the limits: there the ground goes on.
bool CutFilling::is_in_extent(CellId id) const {
  if (plane_.extent.empty()) return true;
  std::vector<Vec3> corners;
  Vec3 centre = Vec3::Zero();
  for (const int node : mesh_.cell(id)) corners.push_back(mesh_.nodes[at(node)]), centre += corners.back();
  centre /= static_cast<double>(corners.size());
  const double tolerance = 1e-6 * (corners.front() - centre).norm();
  for (const HalfSpace& space : plane_.extent)
    if (side_of_cell(space, corners, tolerance) == PlaneSide::both && side_of_cell(plane_.below, corners, tolerance) != PlaneSide::inside)
      throw InputError(
          where_, "", "limits of the ground of this level along faces of cells",
          fmt::format("one through the {} at ({:g}, {:g}, {:g})", info(mesh_.type(id)).name, centre.x(), centre.y(), centre.z()));
  return std::ranges::all_of(plane_.extent, [&](const HalfSpace& space) { return space.distance(centre) <= 0; });
}

CellBefore CutFilling::before(CellId id) const {
  CellBefore cell{mesh_.type(id), std::numeric_limits<double>::infinity()};
  for (const int node : mesh_.cell(id).first(at(info(cell.cell).corners))) {
    cell.places[cell.count++] = mesh_.nodes[at(node)];
    cell.tolerance = std::min(cell.tolerance, on_plane * edge_[at(node)]);
  }
  return cell;
}

bool CutFilling::is_within(const Vec3& place, double tolerance) const {
  return std::ranges::any_of(plane_.outlines, [&](const CutOutline& outline) {
    return std::ranges::all_of(outline.within, [&](const HalfSpace& space) { return space.distance(place) <= tolerance; });
  });
}

bool CutFilling::is_within(int node) const {
  return is_within(mesh_.nodes[at(node)], on_plane * edge_[at(node)]);
}

void CutFilling::find_signs() {
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

/// What an earlier plane has left of a cell lies on one side of this one, and within its outline or outside of it.
Halves CutFilling::halves_of_part(CellId id) const {
  const CellBefore cell = before(id);
  const CellPart& part = *mesh_.part(id);
  DrawnPart drawn;
  draw_within({cell.cell, cell.corners()}, mesh_.limits[at(part.limits)], part.tolerance, drawn);
  const std::span<const Vec3> corners = drawn.corners;
  const double tolerance = cell.tolerance;
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
void CutFilling::keep_within(const CellBefore& cell, Halves& halves) const {
  halves.upper = false;
  for (int k = 0; k < static_cast<int>(plane_.outlines.size()); ++k) {
    const PlaneSide side = side_of_outline(plane_.outlines[at(k)], cell.corners(), cell.tolerance);
    if (side == PlaneSide::outside) continue;
    const bool whole = halves.upper_whole && side == PlaneSide::inside;
    if (!whole && is_empty(cell, above(k))) continue;
    if (halves.upper)
      throw InputError(where_, "", "outlines on one plane that are at least a cell apart",
                       fmt::format("two of them in the {} at ({:g}, {:g}, {:g})", info(cell.cell).name, cell.places[0].x(),
                                   cell.places[0].y(), cell.places[0].z()));
    halves.upper = true, halves.outline = k;
  }
  if (halves.upper && side_of_outline(plane_.outlines[at(halves.outline)], cell.corners(), cell.tolerance) == PlaneSide::both)
    halves.upper_whole = false;
}

/// Whether the part within has no volume, as that of a corner so near the plane that nothing would hold doubles that belong to it alone.
/// The first limit is the plane.
bool CutFilling::is_empty(const CellBefore& cell, std::span<const HalfSpace> within) const {
  constexpr double no_tip = 0.1;                                       // of the shortest edge: a part as deep as this has volume
  if (info(cell.cell).nodes != info(cell.cell).corners) return false;  // is refused
  double deepest = 0;
  for (const Vec3& corner : cell.corners()) deepest = std::min(deepest, within.front().distance(corner));
  const auto holds_cell = [&](const HalfSpace& space) { return side_of_cell(space, cell.corners(), 0) == PlaneSide::inside; };
  if (-deepest > no_tip / on_plane * cell.tolerance && std::ranges::all_of(within.subspan(1), holds_cell)) return false;
  return is_clipped_away({cell.cell, cell.corners()}, within, cell.tolerance);
}

Halves CutFilling::halves_of(CellId id) const {
  if (mesh_.part(id)) return halves_of_part(id);
  const auto nodes = mesh_.cell(id);
  const bool below = std::ranges::any_of(nodes, [&](int node) { return sign(node) < 0; });
  const bool above = std::ranges::any_of(nodes, [&](int node) { return sign(node) > 0; });
  Halves halves{below, above, !above, !below};
  if (above) {
    const CellBefore cell = before(id);
    if (below && is_empty(cell, {&plane_.below, 1})) halves.lower = false, halves.upper_whole = true;
    keep_within(cell, halves);
  }
  const bool whole = (!below || halves.lower_whole) && (!halves.upper || halves.upper_whole);
  if (!whole && info(mesh_.type(id)).nodes != info(mesh_.type(id)).corners)
    throw InputError(where_, "", "cells of the first degree (tri3, quad4, tet4, wedge6, hex8) where a plane cuts",
                     describe_cell(mesh_, id));
  return halves;
}

/// Faces on the plane between a cell below and one above it.
void CutFilling::find_level_faces() {
  std::vector<int> nodes;
  for (int k = 0; k < static_cast<int>(halves_.size()); ++k) {
    if (!halves_[at(k)].lower || halves_[at(k)].upper) continue;
    for (int s = 0; s < sides_.count(k); ++s) {
      const int twin = sides_.twin(Sides::stride * k + s);
      if (twin < 0 || !halves_[at(twin / Sides::stride)].upper) continue;
      if (std::vector<Vec3> corners = corners_on_plane(k, s, nodes); !corners.empty())
        level_.push_back({k, twin / Sides::stride, std::move(corners)});
    }
  }
}

/// Corners of a side of a cell all of whose nodes are on the plane; else none.
std::vector<Vec3> CutFilling::corners_on_plane(int cell, int s, std::vector<int>& nodes) const {
  sides_.nodes_of(mesh_, Sides::stride * cell + s, nodes);
  std::vector<Vec3> corners;
  if (std::ranges::any_of(nodes, [&](int node) { return sign(node) != 0; })) return corners;
  const int count = info(info(mesh_.type(sides_.cells()[at(cell)])).sides[at(s)]).corners;
  for (int c = 0; c < count; ++c) corners.push_back(mesh_.nodes[at(nodes[at(c)])]);
  return corners;
}

std::vector<CutFilling::BareFace> CutFilling::bare_faces() const {
  std::vector<BareFace> found;
  std::vector<int> nodes;
  for (int k = 0; k < static_cast<int>(halves_.size()); ++k) {
    if (!halves_[at(k)].lower || !halves_[at(k)].lower_whole || mesh_.part(sides_.cells()[at(k)])) continue;
    for (int s = 0; s < sides_.count(k); ++s) {
      const int twin = sides_.twin(Sides::stride * k + s);
      if (twin >= 0 && (halves_[at(twin / Sides::stride)].upper || halves_[at(twin / Sides::stride)].lower)) continue;
      if (std::vector<Vec3> corners = corners_on_plane(k, s, nodes); !corners.empty()) found.push_back({k, std::move(corners)});
    }
  }
  return found;
}

void CutFilling::refuse_nothing() const {
  double least = std::numeric_limits<double>::infinity(), most = -least, edge = least;
  for (const CellId id : sides_.cells())
    for (const int node : mesh_.cell(id)) {
      least = std::min(least, plane_.below.distance(mesh_.nodes[at(node)]));
      most = std::max(most, plane_.below.distance(mesh_.nodes[at(node)]));
      edge = std::min(edge, edge_[at(node)]);
    }
  if (!level_.empty() || std::ranges::any_of(halves_, [](const Halves& halves) { return halves.lower && halves.upper; })) {
    if (std::min(most, -least) < thinnest * edge && std::min(most, -least) > 0)
      throw InputError(where_, "", "a plane with cells of the groups on both sides",
                       fmt::format("a layer of {:.2g} m {} it, whose cells have edges of {:.2g} m", std::min(most, -least),
                                   most < -least ? "above" : "below", edge));
    return;
  }
  std::string outlined;
  if (!plane_.outlines.front().within.empty())
    outlined = ", and what lies above must lie within the outline; bases at several levels need `ground_x` or `ground_y` each";
  throw InputError(where_, "", "a plane with cells of the groups on both sides",
                   sides_.cells().empty() ? "no cells between the limits of its ground"
                                          : fmt::format("none: they reach from {:g} m to {:g} m above it{}", least, most, outlined));
}

}  // namespace uplift
