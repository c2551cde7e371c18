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

void add_faces(const Case& read, ModelBuilder& builder, const CaseNames& names) {
  for (const CaseElement& faces : read.input->elements_at(ElementPlace::faces)) {
    const CaseSolids& solids = names.mesh_for(*faces.group);
    for (const CellId edge : solids.edges(*faces.group)) {
      const std::vector<int> nodes = names.nodes_of_cell(edge);
      const std::optional<CellRule> part = rule_if_part(solids, edge);
      builder.add_element(faces.entry->cover({solids.mesh().type(edge), nodes, names.coordinates, part ? &*part : nullptr}, *faces.table,
                                             solids.beside(edge)->beside(), names.space),
                          faces.where());
    }
  }
  for (const CaseAbsorbing& absorbing : read.input->absorbing)
    if (absorbing.incident) add_incident(absorbing, *absorbing.incident, builder, names);
}

}  // namespace uplift
