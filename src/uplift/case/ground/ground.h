#pragma once
#include "uplift/case/build/model.h"
#include "uplift/elements/absorbing.h"
#include "uplift/linear/solver.h"
#include "uplift/run/plan.h"

// The ground beside the model: lateral nodes that move together, and the free field that lateral boundaries follow.
namespace uplift {

/// Tied nodes: every node of a group moves as its partner on the opposite side.
void add_ties(const CaseInput& input, ModelBuilder& builder, const CaseNames& names);

/// Free-field columns beside the absorbing faces that ask for them (`free_field`), marched through the dynamic stages, and what they put
/// on these faces; under several waves the sum of what each puts there. Throws InputError for faces that are not in horizontal rows,
/// without an incident wave below, or with modal damping.
void add_free_field(const CaseInput& input, const std::vector<Stage>& stages, const BulkDamping& damping,
                    const std::shared_ptr<const LinearSolver>& solver, ModelBuilder& builder, const CaseNames& names);

/// For each table [[absorbing]] the first one on the same faces, whose dashpots these faces have: further tables on them only add their
/// waves. Throws InputError where tables share some of their faces, or where one of several on the same faces has no wave.
std::vector<std::size_t> first_on_faces(const CaseInput& input, const CaseSolids& solids);

/// Particle motion of an incident wave [1]; InputError for what a plane model does not have.
Vec3 incident_motion(const CaseIncident& incident, Space space);
/// Velocity of the incoming wave alone [m/s].
std::shared_ptr<const TimeFunction> incident_velocity(const CaseIncident& incident, const CaseNames& names);

}  // namespace uplift
