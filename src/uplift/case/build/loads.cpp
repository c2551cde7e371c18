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

Pattern node_load(const Values& load, int node, Space space) {
  for (const char* key : {"traction", "pressure", "profile"})
    if (load.has(key)) fail(load, key, "force or moment on a node", key);
  if (!load.has("force") && !load.has("moment") && !load.has("moments")) fail(load, "", "force or moment", "neither");
  Pattern pattern;
  if (load.has("force")) add_force(node, vector_of(load, "force", space), false, space, pattern);
  add_force(node, about_axes(load, "moment", "moments", false, space), true, space, pattern);
  return pattern;
}

/// Exactly one of these keys must be given.
const char* one_of(const Values& load, std::initializer_list<const char*> keys) {
  const char* found = nullptr;
  for (const char* key : keys) {
    if (!load.has(key)) continue;
    if (found != nullptr) fail(load, key, fmt::format("only one of {}", fmt::join(keys, ", ")), fmt::format("{} and {}", found, key));
    found = key;
  }
  if (found == nullptr) fail(load, "", fmt::format("one of {} on a group", fmt::join(keys, ", ")), "none");
  return found;
}

/// The faces of a pressure must bound one solid: elsewhere no side is the outer one.
void check_outer(const Values& load, const CaseSolids& solids, const std::vector<CellId>& faces) {
  for (const CellId face : faces)
    if (solids.outward_nodes(face).empty())
      fail(load, "group", solids.mesh().dimension == 2 ? "edges on the surface of a solid" : "faces on the surface of a solid",
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
Pattern surface_load(const Values& load, const CaseNames& names) {
  for (const char* key : {"moment", "moments"})
    if (load.has(key)) fail(load, key, "pressure, traction or force on a group", "a moment");
  const std::string key = one_of(load, {"pressure", "traction", "force"});
  const CaseSolids& solids = names.mesh_for(load);
  const std::vector<FreeFace>* free = solids.free_surface(load.text("group"));
  const std::vector<CellId> faces = free ? std::vector<CellId>{} : solids.edges(load, "group");
  const Values* table = table_if(load, "profile");
  if (table && key == "force") fail(*table, "", "profile with pressure or traction", "profile with force");
  std::optional<Profile> profile;
  if (table) {
    profile.emplace(*table, "factors", names.space);
    profile->require_overlap(*table, places_of(solids.mesh(), faces, free));
  }
  const auto shares = [&] {
    const Profile* factor = profile ? &*profile : nullptr;
    return free ? surface_shares(solids, *free, factor) : surface_shares(solids, faces, factor);
  };
  Pattern pattern;
  if (key == "pressure") {
    check_outer(load, solids, faces);
    for (const SurfaceShare& share : shares())
      add_force(names.first_of_mesh + share.node, -load.number("pressure") * share.outward, false, names.space, pattern);
    return pattern;
  }
  Vec3 per_area = vector_of(load, key, names.space);
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
  if (key == "force") per_area /= area;
  for (const auto& [node, share] : areas) add_force(names.first_of_mesh + node, share * per_area, false, names.space, pattern);
  return pattern;
}

}  // namespace

std::string name_of_load(const Values& load) {
  return load.has("name") ? load.text("name") : "load on " + load.text(load.has("node") ? "node" : "group");
}

Vec3 resultant_of_load(const Values& load, const Model& model) {
  Vec3 sum = Vec3::Zero();
  const auto time_load = std::ranges::find(model.time_loads, name_of_load(load), &TimeLoad::name);
  if (time_load == model.time_loads.end()) return sum;
  const Vector& pattern = model.assembly.loads[static_cast<std::size_t>(time_load - model.time_loads.begin())];
  for (Index i = 0; i < pattern.size(); ++i)
    if (const int k = model.space.index_of(static_cast<int>(i)); !model.space.is_rotation(k)) sum[k] += pattern[i];
  return sum;
}

Vec3 gravity_of(const Values& root, Space space) {
  const Values* gravity = table_if(root, "gravity");
  if (gravity == nullptr) return Vec3::Zero();
  if (gravity->has("acceleration")) return vector_of(*gravity, "acceleration", space);
  return -9.81 * space.axis(space.up());
}

/// A direction alone: its length would be a factor on the earthquake that nobody has asked for.
Vec3 direction_of_ground(const Values& ground, Space space) {
  constexpr double rounded = 0.01;  // [0.71, 0.71]
  if (!ground.has("direction")) return space.axis(0);
  const Vec3 direction = vector_of(ground, "direction", space);
  if (const double length = direction.norm(); std::abs(length - 1) > rounded)
    fail(ground, "direction", "a direction of length 1 (the amplitude is the factor)", fmt::format("one of length {:.4g}", length));
  return direction;
}

void add_loads(const Values& root, ModelBuilder& builder, const CaseNames& names) {
  for (const Values& load : root.tables("load")) {
    std::vector<std::pair<int, double>> pattern =
        first_of_two(load, "node", "group") ? node_load(load, names.node(load, "node"), names.space) : surface_load(load, names);
    builder.add_load(name_of_load(load), std::move(pattern), names.function(load), !load.has("function"), load.where());
  }
  if (const Values* gravity = table_if(root, "gravity")) builder.set_gravity(gravity_of(root, names.space), gravity->where());
  for (const Values& ground : root.tables("ground_acceleration")) {
    const std::string name = ground.has("name") ? ground.text("name") : "ground acceleration";
    builder.add_ground_acceleration(direction_of_ground(ground, names.space),
                                    names.function(ground, MotionKind::acceleration, ground.number("amplitude")), name, ground.where());
  }
}

}  // namespace uplift
