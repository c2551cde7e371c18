#include "uplift/base/text.h"
#include "uplift/case/ground/ground.h"
#include "uplift/mesh/parts.h"

// Absorbing faces of the mesh and the waves that come in through them.
namespace uplift {

Vec3 incident_motion(const Values& incident, Space space) {
  const std::string& word = incident.text("wave");
  if (space.dimension == 2 && word == "SH") fail(incident, "wave", "P or SV in a plane model", in_quotes(word));
  if (space.dimension == 2 && incident.number("azimuth") != 0) fail(incident, "azimuth", "no azimuth in a plane model", "one");
  return wave_motion(word == "P" ? Wave::p : word == "SV" ? Wave::sv : Wave::sh, space.dimension, incident.number("azimuth"));
}

std::shared_ptr<const TimeFunction> incident_velocity(const Values& incident, const CaseNames& names) {
  // The surface of free rock moves twice as much as the wave that comes up.
  const double incoming = incident.text("kind") == "outcrop" ? 0.5 : 1;
  return scaled(incoming * incident.number("velocity"), names.function(name_used(incident, "function"), MotionKind::velocity));
}

namespace {

/// Null: the face is whole. `made` keeps the rule of a part.
const CellRule* rule_if_part(const CaseSolids& solids, CellId face, CellRule& made) {
  if (!solids.mesh().part(face)) return nullptr;
  made = rule_of_part(solids.mesh(), face);
  return &made;
}

/// The wave that comes in through the faces of a table: their pattern of forces, times its velocity.
void add_incident(const Values& faces, const Values& incident, ModelBuilder& builder, const CaseNames& names) {
  const NameUsed group = name_used(faces, "group");
  const CaseSolids& solids = names.mesh_for(group);
  const Vec3 motion = incident_motion(incident, names.space);
  const int d = names.space.dimension;
  std::vector<std::pair<int, double>> pattern;
  for (const CellId edge : solids.edges(group)) {
    const std::vector<int> nodes = names.nodes_of_cell(edge);
    CellRule part;
    const AbsorbingFace face(solids.mesh().type(edge), nodes, names.coordinates,
                             absorbing_ground(faces, solids.beside(edge)->beside(), names.space), rule_if_part(solids, edge, part));
    const Vector force = face.incident(motion);
    for (Index i = 0; i < force.size(); ++i)
      if (force[i] != 0)
        pattern.emplace_back(names.space.unknowns() * nodes[static_cast<std::size_t>(i / d)] + static_cast<int>(i % d), force[i]);
  }
  builder.add_load(incident.text("name"), std::move(pattern), incident_velocity(incident, names), false, incident.where());
}

}  // namespace

void add_faces(const Values& root, ModelBuilder& builder, const CaseNames& names) {
  for (const ElementEntry* entry : elements_at(ElementPlace::faces))
    for (const Values& table : root.tables(entry->name)) {
      const NameUsed group = name_used(table, "group");
      const CaseSolids& solids = names.mesh_for(group);
      for (const CellId edge : solids.edges(group)) {
        const std::vector<int> nodes = names.nodes_of_cell(edge);
        CellRule part;
        builder.add_element(entry->cover({solids.mesh().type(edge), nodes, names.coordinates, rule_if_part(solids, edge, part)}, table,
                                         solids.beside(edge)->beside(), names.space),
                            table.where());
      }
    }
  for (const Values& absorbing : root.tables("absorbing"))
    if (const Values* incident = table_if(absorbing, "incident")) add_incident(absorbing, *incident, builder, names);
}

}  // namespace uplift
