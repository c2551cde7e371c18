#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "uplift/case/build/model.h"
#include "uplift/case/build/surface_load.h"

// Loads on nodes and on surfaces of the mesh, weight, ground accelerations.
namespace uplift {
namespace {

using Pattern = std::vector<std::pair<int, double>>;

/// Along the translations, or about the rotations.
void add_force(int node, const Vec3& force, bool moment, Space space, Pattern& pattern) {
  for (int i = 0; i < space.unknowns(); ++i)
    if (const double value = force.dot(space.axis(i)); space.is_rotation(i) == moment && value != 0)
      pattern.emplace_back(space.unknowns() * node + i, value);
}

Pattern node_load(const CaseLoad& load, int node, Space space) {
  Pattern pattern;
  if (load.force) add_force(node, *load.force, false, space, pattern);
  add_force(node, load.moment, true, space, pattern);
  return pattern;
}

/// The faces of a pressure must bound one solid: elsewhere no side is the outer one.
void check_outer(const NameUsed& group, const CaseSolids& solids, const std::vector<CellId>& faces) {
  for (const CellId face : faces)
    if (solids.outward_nodes(face).empty())
      fail(group, solids.mesh().dimension == 2 ? "edges on the surface of a solid" : "faces on the surface of a solid",
           describe_cell(solids.mesh(), face) + " between two cells");
}

std::vector<Vec3> places_of(const Mesh& mesh, const std::vector<CellId>& faces, const std::vector<FreeFace>* free) {
  std::vector<Vec3> places;
  for (const CellId face : faces)
    for (const int node : mesh.cell(face)) places.push_back(mesh.nodes[static_cast<std::size_t>(node)]);
  if (free)
    for (const FreeFace& face : *free) places.insert(places.end(), face.corners.begin(), face.corners.end());
  return places;
}

/// Consistent forces of a pressure, a traction or an evenly spread force on edges or faces of the mesh.
Pattern surface_load(const CaseLoad& load, const CaseNames& names) {
  const NameUsed& group = *load.of.group;
  const CaseSolids& solids = names.mesh_for(group);
  const std::vector<FreeFace>* free = solids.free_surface(group.name);
  const std::vector<CellId> faces = free ? std::vector<CellId>{} : solids.edges(group);
  const std::optional<Profile>& profile = load.profile;
  if (profile) profile->require_overlap(places_of(solids.mesh(), faces, free));
  const auto shares = [&] {
    const Profile* factor = profile ? &*profile : nullptr;
    return free ? surface_shares(solids, *free, factor) : surface_shares(solids, faces, factor);
  };
  Pattern pattern;
  if (load.pressure) {
    check_outer(group, solids, faces);
    for (const SurfaceShare& share : shares())
      add_force(names.first_of_mesh + share.node, -*load.pressure * share.outward, false, names.space, pattern);
    return pattern;
  }
  Vec3 per_area = load.force ? *load.force : *load.traction;
  if (profile) {
    for (const SurfaceShare& share : shares())
      add_force(names.first_of_mesh + share.node, share.area * per_area, false, names.space, pattern);
    return pattern;
  }
  std::vector<std::pair<int, double>> areas;
  if (free)
    for (const SurfaceShare& share : shares()) areas.emplace_back(share.node, share.area);
  else
    areas = tributary_areas(solids, faces);
  double area = 0;
  for (const auto& [node, share] : areas) area += share;
  if (load.force) per_area /= area;
  for (const auto& [node, share] : areas) add_force(names.first_of_mesh + node, share * per_area, false, names.space, pattern);
  return pattern;
}

}  // namespace

Vec3 resultant_of_load(const CaseLoad& load, const Model& model) {
  Vec3 sum = Vec3::Zero();
  const auto time_load = std::ranges::find(model.time_loads, load.name, &TimeLoad::name);
  if (time_load == model.time_loads.end()) return sum;
  const SparseVector& pattern = model.assembly.loads[static_cast<std::size_t>(time_load - model.time_loads.begin())];
  for (SparseVector::InnerIterator entry(pattern); entry; ++entry)
    if (const int k = model.space.index_of(static_cast<int>(entry.index())); !model.space.is_rotation(k)) sum[k] += entry.value();
  return sum;
}

void add_loads(const CaseInput& input, ModelBuilder& builder, const CaseNames& names) {
  for (const CaseLoad& load : input.loads) {
    Pattern pattern = load.of.node ? node_load(load, names.node(*load.of.node), names.space) : surface_load(load, names);
    builder.add_load(load.name, std::move(pattern), names.function(load.function), !load.function, load.where());
  }
  if (input.gravity) builder.set_gravity(input.gravity->acceleration, input.gravity->where());
  for (const CaseGround& ground : input.grounds)
    builder.add_ground_acceleration(ground.direction, names.function(ground.function, MotionKind::acceleration, ground.amplitude),
                                    ground.name, ground.where());
}

}  // namespace uplift
