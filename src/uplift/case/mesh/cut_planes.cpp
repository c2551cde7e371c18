#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "uplift/base/text.h"
#include "uplift/case/build/model.h"
#include "uplift/case/mesh/mesh.h"
#include "uplift/mesh/shift.h"

// The planes of [interface.cut]: what the case says of them, and which of them are one.
namespace uplift {
namespace {

/// Least and largest coordinate along an axis as half-spaces.
void add_limits(const std::optional<CaseCut::Range>& range, const Vec3& axis, std::vector<HalfSpace>& within) {
  if (!range) return;
  within.push_back({-axis, -range->front()});
  within.push_back({axis, range->back()});
}

CutPlane plane_of(const CaseCut& cut, int dimension) {
  const Vec3 normal = normal_of_cut(cut, dimension), up = dimension == 2 ? Vec3::UnitY() : Vec3::UnitZ();
  CutPlane plane{cut.through, {}};
  CutOutline& outline = plane.outlines.front();
  const double level = cut.level ? normal.dot(up) * *cut.level : normal.dot(cut.point->in({dimension}));
  plane.below = {normal, level};
  outline.upper = cut.upper;
  if (dimension == 2 && cut.y) fail(cut, "y", "no y in a plane mesh: height limits the outline", "one");
  add_limits(cut.x, Vec3::UnitX(), outline.within);
  add_limits(cut.y, Vec3::UnitY(), outline.within);
  if (dimension == 2 && cut.ground_y) fail(cut, "ground_y", "ground_x alone in a plane mesh", "one");
  add_limits(cut.ground_x, Vec3::UnitX(), plane.extent);
  add_limits(cut.ground_y, Vec3::UnitY(), plane.extent);
  if (cut.height) outline.within.push_back({normal, level + *cut.height});
  plane.own_doubles = cut.jump != CaseCut::Jump::linear;
  if (plane.own_doubles && dimension == 3) fail(cut, "jump", "linear in space", in_quotes(cut.jump_word));
  if (plane.own_doubles && !(outline.within.empty() && plane.extent.empty()))
    fail(cut, "jump", "linear, since the ground has a free surface beside the outline", in_quotes(cut.jump_word));
  return plane;
}

void shift_mesh(const CaseCut& cut, const CutPlane& plane, const std::vector<std::string>& lines, Mesh& mesh) {
  const double share = cut.mesh_shift;
  if (share == 0) return;
  shift_nodes(mesh, plane, share, lines);
  try {
    check_mesh(mesh, cut.where());
  } catch (const InputError&) {
    fail(cut, "mesh_shift", "a smaller shift, or 0", fmt::format("{:g}, which turns cells inside out", share));
  }
}

/// Whether two planes through the same groups are one, on which several outlines stand.
bool is_same_plane(const CutPlane& one, const CutPlane& other) {
  const auto groups = [](const CutPlane& plane) { return std::set<std::string>(plane.through.begin(), plane.through.end()); };
  const double level = one.below.level;
  const auto same_limits = [](const HalfSpace& a, const HalfSpace& b) { return a.normal == b.normal && a.level == b.level; };
  return groups(one) == groups(other) && std::ranges::equal(one.extent, other.extent, same_limits) &&
         (one.below.normal - other.below.normal).norm() < 1e-12 &&
         std::abs(level - other.below.level) <= 1e-9 * std::max(1.0, std::abs(level)) && !one.outlines.front().within.empty() &&
         !other.outlines.front().within.empty();
}

/// Parallel planes from the lowest one on: what a lower plane leaves unfilled is no part of a structure on a higher one.
void sort_by_level(std::vector<CutPlane>& planes, std::vector<std::vector<std::size_t>>& of) {
  const Vec3 normal = planes.front().below.normal;
  if (std::ranges::any_of(planes, [&](const CutPlane& plane) { return (plane.below.normal - normal).norm() > 1e-12; })) return;
  std::vector<std::size_t> order(planes.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t i) { return planes[i].below.level; });
  std::vector<CutPlane> sorted;
  std::vector<std::vector<std::size_t>> of_sorted;
  for (const std::size_t i : order) sorted.push_back(std::move(planes[i])), of_sorted.push_back(std::move(of[i]));
  planes = std::move(sorted), of = std::move(of_sorted);
}

/// In a triangle one node is alone on its side: the other side can turn about it without any strain.
void refuse_undetermined_jumps(const CaseCut& cut, const std::vector<CutFace>& faces, const Mesh& mesh) {
  if (cut.jump != CaseCut::Jump::rigid) return;
  for (const CutFace& face : faces)
    if (mesh.type(face.lower) != Cell::quad4)
      fail(cut, "jump", "constant or linear in triangles, where one node alone leaves the rotation of a rigid jump undetermined",
           in_quotes("rigid"));
}

/// Gives the surface beside the outlines of a plane the name that its interfaces have for it.
void name_free_surface(const std::vector<CaseInterface>& interfaces, const std::vector<std::size_t>& of, const std::vector<FreeFace>& faces,
                       CaseMesh& made) {
  const std::string* name = nullptr;
  for (const std::size_t k : of) {
    const std::optional<NameUsed>& free = interfaces[k].cut()->free;
    if (!free) continue;
    const std::string& own = free->name;
    if (name != nullptr && own != *name) fail(*free, in_quotes(*name) + ", as of the other outline on this plane", in_quotes(own));
    if (name != nullptr) continue;
    name = &own;
    if (made.mesh.groups.contains(own)) fail(*free, "a new name", in_quotes(own) + ", which is a group of the mesh");
    if (faces.empty()) fail(*free, "a surface of the ground beside the outline", "none: the structure covers all of the plane");
    std::vector<FreeFace>& all = made.free[own];
    all.insert(all.end(), faces.begin(), faces.end());
  }
}

}  // namespace

Vec3 normal_of_cut(const CaseCut& cut, int dimension) {
  if (cut.level) return dimension == 2 ? Vec3::UnitY() : Vec3::UnitZ();
  const Vec3 normal = cut.normal->in({dimension});
  if (normal.norm() == 0) fail(cut, "normal", "a direction", "one of length zero");
  return normal.normalized();
}

void cut_planes(const Case& read, CaseMesh& made) {
  const std::vector<CaseInterface>& interfaces = read.input->interfaces;
  made.cut.resize(interfaces.size());
  std::vector<CutPlane> planes;
  std::vector<std::vector<std::size_t>> of;  // interfaces of each plane, in the order of its outlines
  for (std::size_t k = 0; k < interfaces.size(); ++k)
    if (const CaseCut* cut = interfaces[k].cut()) {
      CutPlane plane = plane_of(*cut, made.mesh.dimension);
      const auto same = std::ranges::find_if(planes, [&](const CutPlane& other) { return is_same_plane(plane, other); });
      if (same == planes.end()) {
        planes.push_back(std::move(plane));
        of.push_back({k});
      } else {
        same->outlines.push_back(std::move(plane.outlines.front()));
        of[static_cast<std::size_t>(same - planes.begin())].push_back(k);
      }
    }
  if (planes.empty()) return;
  sort_by_level(planes, of);
  std::vector<std::string> lines;
  for (const CaseElement& beam : read.input->elements_at(ElementPlace::lines))
    if (beam.group) lines.push_back(beam.group->name);
  std::vector<Where> where;
  for (std::size_t i = 0; i < of.size(); ++i) {
    const CaseCut& first = *interfaces[of[i].front()].cut();
    where.push_back(first.where());
    for (const std::size_t k : of[i])
      if (const CaseCut& cut = *interfaces[k].cut(); cut.mesh_shift != first.mesh_shift)
        fail(cut, "mesh_shift", fmt::format("{:g}, as of the other outline on this plane", first.mesh_shift),
             fmt::format("{:g}", cut.mesh_shift));
    shift_mesh(first, planes[i], lines, made.mesh);
  }
  std::vector<std::vector<FreeFace>> free;
  const std::vector<std::vector<CutFace>> faces = cut(made.mesh, planes, where, lines, &free);
  for (std::size_t i = 0; i < of.size(); ++i) {
    for (const CutFace& face : faces[i]) made.cut[of[i][static_cast<std::size_t>(face.outline)]].push_back(face);
    for (const std::size_t k : of[i])
      if (made.cut[k].empty())
        fail(*interfaces[k].cut(), "", "an interface on the plane", "none: nothing above the plane lies within the outline");
    name_free_surface(interfaces, of[i], free[i], made);
    refuse_undetermined_jumps(*interfaces[of[i].front()].cut(), faces[i], made.mesh);
  }
}

}  // namespace uplift
