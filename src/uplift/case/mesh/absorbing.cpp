#include "uplift/base/text.h"
#include "uplift/case/ground/ground.h"

// Absorbing faces of the mesh and the waves that come in through them.
namespace uplift {

AbsorbingSection absorbing_ground(const Values& absorbing, const CaseSolids::Solid& solid, Space space) {
  const std::string sides = space.dimension == 2 ? "edges" : "faces";
  const auto refuse = [&](const char* wanted, const char* found) {
    fail(absorbing, "group", sides + " of a solid " + wanted,
         sides + " of the solid " + in_quotes(solid.table->text("group")) + " " + found);
  };
  if (!(solid.section.material.density > 0)) refuse("with a density", "without one");
  if (space.dimension == 2 && solid.section.plane != PlaneState::strain) refuse("in plane strain", "in plane stress");
  return {solid.section.material, solid.section.thickness, absorbing.flag("lumped")};
}

Vec3 incident_motion(const Values& incident, Space space) {
  const std::string& word = incident.text("wave");
  if (space.dimension == 2 && word == "SH") fail(incident, "wave", "P or SV in a plane model", in_quotes(word));
  if (space.dimension == 2 && incident.number("azimuth") != 0) fail(incident, "azimuth", "no azimuth in a plane model", "one");
  return wave_motion(word == "P" ? Wave::p : word == "SV" ? Wave::sv : Wave::sh, space.dimension, incident.number("azimuth"));
}

std::shared_ptr<const TimeFunction> incident_velocity(const Values& incident, const CaseNames& names) {
  // The surface of free rock moves twice as much as the wave that comes up.
  const double incoming = incident.text("kind") == "outcrop" ? 0.5 : 1;
  return scaled(incoming * incident.number("velocity"), names.function(incident, MotionKind::velocity));
}

void add_absorbing(const Values& root, ModelBuilder& builder, const CaseNames& names) {
  for (const Values& absorbing : root.tables("absorbing")) {
    const CaseSolids& solids = names.mesh_for(absorbing);
    const Values* incident = table_if(absorbing, "incident");
    const Vec3 motion = incident ? incident_motion(*incident, names.space) : Vec3::Zero();
    const int d = names.space.dimension;
    std::vector<std::pair<int, double>> pattern;
    for (const CellId edge : solids.edges(absorbing, "group")) {
      std::vector<int> nodes;
      for (const int node : solids.mesh().cell(edge)) nodes.push_back(names.first_of_mesh + node);
      auto face = std::make_unique<AbsorbingFace>(solids.mesh().type(edge), nodes, names.coordinates,
                                                  absorbing_ground(absorbing, *solids.beside(edge), names.space));
      const Vector force = incident ? face->incident(motion) : Vector();
      for (Index i = 0; i < force.size(); ++i)
        if (force[i] != 0)
          pattern.emplace_back(names.space.unknowns() * nodes[static_cast<std::size_t>(i / d)] + static_cast<int>(i % d), force[i]);
      builder.add_element(std::move(face), absorbing.where());
    }
    if (!incident) continue;
    builder.add_load(incident->text("name"), std::move(pattern), incident_velocity(*incident, names), false, incident->where());
  }
}

}  // namespace uplift
