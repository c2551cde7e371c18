#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "uplift/base/text.h"
#include "uplift/case/ground/ground.h"
#include "uplift/mesh/parts.h"

// Absorbing faces of the mesh and the waves that come in through them.
namespace uplift {

Vec3 incident_motion(const CaseIncident& incident, Space space) {
  if (space.dimension == 2 && incident.wave == Wave::sh) fail(incident, "wave", "P or SV in a plane model", in_quotes(incident.wave_word));
  if (space.dimension == 2 && incident.azimuth != 0) fail(incident, "azimuth", "no azimuth in a plane model", "one");
  return wave_motion(incident.wave, space.dimension, incident.azimuth);
}

std::shared_ptr<const TimeFunction> incident_velocity(const CaseIncident& incident, const CaseNames& names) {
  return scaled(incident.velocity, names.function(incident.function, MotionKind::velocity));
}

namespace {

using FaceNodes = std::vector<int>;

/// A face by its nodes, whatever its cell in the mesh is: two groups may have cells of their own on it.
std::set<FaceNodes> faces_of(const CaseAbsorbing& table, const CaseSolids& solids) {
  std::set<FaceNodes> faces;
  for (const CellId face : solids.edges(table.group)) {
    const std::span<const int> nodes = solids.mesh().cell(face);
    FaceNodes sorted(nodes.begin(), nodes.end());
    std::ranges::sort(sorted);
    faces.insert(std::move(sorted));
  }
  return faces;
}

std::string place_of(const CaseAbsorbing& table) {
  return fmt::format("{}:{}, group {}", table.where().file, table.where().line, in_quotes(table.group.name));
}

/// Whether a table on the faces of another one may add its wave to them.
void check_further(const CaseAbsorbing& first, const CaseAbsorbing& table) {
  const std::string same = "the faces of the [[absorbing]] of " + place_of(first);
  for (const CaseAbsorbing* each : {&table, &first})
    if (!each->incident)
      fail(table, "group",
           "faces that no other [[absorbing]] has; for several waves on the same faces, an incident in each of their tables",
           same + (each == &first ? ", which has no incident" : ", and no incident"));
  if (table.lumped != first.lumped) fail(table, "lumped", first.lumped ? "true" : "false, as on " + same, table.lumped ? "true" : "false");
}

/// The rule of a face that is filled in part.
std::optional<CellRule> rule_if_part(const CaseSolids& solids, CellId face) {
  return solids.mesh().part(face) ? std::optional(rule_of_part(solids.mesh(), face)) : std::nullopt;
}

/// The wave that comes in through the faces of a table: their pattern of forces, times its velocity.
void add_incident(const CaseAbsorbing& faces, const CaseIncident& incident, ModelBuilder& builder, const CaseNames& names) {
  const CaseSolids& solids = names.mesh_for(faces.group);
  const Vec3 motion = incident_motion(incident, names.space);
  const int d = names.space.dimension;
  std::vector<std::pair<int, double>> pattern;
  for (const CellId edge : solids.edges(faces.group)) {
    const std::vector<int> nodes = names.nodes_of_cell(edge);
    const std::optional<CellRule> part = rule_if_part(solids, edge);
    const AbsorbingFace face(solids.mesh().type(edge), nodes, names.coordinates,
                             absorbing_ground(*faces.table, solids.beside(edge)->beside(), names.space), part ? &*part : nullptr);
    const Vector force = face.incident(motion);
    for (Index i = 0; i < force.size(); ++i)
      if (force[i] != 0)
        pattern.emplace_back(names.space.unknowns() * nodes[static_cast<std::size_t>(i / d)] + static_cast<int>(i % d), force[i]);
  }
  builder.add_load(incident.name, std::move(pattern), incident_velocity(incident, names), false, incident.where());
}

}  // namespace

std::vector<std::size_t> first_on_faces(const CaseInput& input, const CaseSolids& solids) {
  const std::vector<CaseAbsorbing>& tables = input.absorbing;
  std::vector<std::size_t> first(tables.size(), 0);
  if (tables.size() < 2) return first;
  std::map<FaceNodes, std::size_t> known;
  std::vector<std::size_t> count(tables.size(), 0);  // of faces
  for (std::size_t k = 0; k < tables.size(); ++k) {
    first[k] = k;
    std::set<FaceNodes> faces = faces_of(tables[k], solids);
    std::map<std::size_t, std::size_t> shared;  // faces of other tables
    for (const FaceNodes& face : faces)
      if (const auto found = known.find(face); found != known.end()) ++shared[found->second];
    if (shared.empty()) {
      count[k] = faces.size();
      for (const FaceNodes& face : faces) known.emplace(face, k);
      continue;
    }
    const auto [owner, common] = *shared.begin();
    if (common != faces.size() || common != count[owner])
      fail(tables[k], "group", "faces that no other [[absorbing]] has, or exactly those of another one, to which it adds its wave",
           fmt::format("{} of its {} faces among the {} of the [[absorbing]] of {}", common, faces.size(), count[owner],
                       place_of(tables[owner])));
    check_further(tables[owner], tables[k]);
    first[k] = owner;
  }
  return first;
}

void add_faces(const Case& read, ModelBuilder& builder, const CaseNames& names) {
  const std::vector<CaseAbsorbing>& absorbing = read.input->absorbing;
  const std::vector<std::size_t> first =
      absorbing.empty() ? std::vector<std::size_t>() : first_on_faces(*read.input, names.mesh_for(absorbing.front().group));
  const auto only_adds_wave = [&](const CaseElement& faces) {
    const auto found = std::ranges::find(absorbing, faces.table, &CaseAbsorbing::table);
    return found != absorbing.end() &&
           first[static_cast<std::size_t>(found - absorbing.begin())] != static_cast<std::size_t>(found - absorbing.begin());
  };
  for (const CaseElement& faces : read.input->elements_at(ElementPlace::faces)) {
    if (only_adds_wave(faces)) continue;
    const CaseSolids& solids = names.mesh_for(*faces.group);
    for (const CellId edge : solids.edges(*faces.group)) {
      const std::vector<int> nodes = names.nodes_of_cell(edge);
      const std::optional<CellRule> part = rule_if_part(solids, edge);
      builder.add_element(faces.entry->cover({solids.mesh().type(edge), nodes, names.coordinates, part ? &*part : nullptr}, *faces.table,
                                             solids.beside(edge)->beside(), names.space),
                          faces.where());
    }
  }
  for (const CaseAbsorbing& each : absorbing)
    if (each.incident) add_incident(each, *each.incident, builder, names);
}

}  // namespace uplift
