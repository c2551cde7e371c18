#pragma once
#include "uplift/model/model.h"

namespace uplift {

/// The second order of a static state before elimination.
struct SecondOrder {
  Sparse stiffness;           // full x full
  std::vector<double> axial;  // N, of every element, tension > 0; that of an inextensible beam included
};
SecondOrder second_order(const Model& model, const State& state);

/// Constant geometric stiffness of a static state (P-Delta), free x free [N/m, N, N m], to be added to the model's stiffness.
///
/// Two parts, both second order in the displacements from the state:
///  - beams: N integral (dN/dx)^T (dN/dx) with the axial force N of the state; the axial force of an inextensible beam, which no
///    displacement shows, comes from equilibrium (its constraint force); without a beam element it counts as a string, N/L;
///  - rigid bodies: a dead force f at the offset r from the master moves by theta x (theta x r)/2 when the body turns by theta, potential
///    + (theta^2 (f . r) - (theta . f)(theta . r))/2, so that in the plane f . r is added to the master's rotational stiffness. Forces:
///    weights (also of masses with an offset centre), loads, end forces of elements and forces of the interfaces. A weight W at the height
///    h above the master gives -W h.
/// The state must be in equilibrium under the dead loads; state.force holds the interface forces [N].
Sparse geometric_stiffness(const Model& model, const State& state);
/// The same on the free unknowns of another model of the same nodes: full = reduction * free.
Sparse geometric_stiffness(const Model& model, const State& state, const Sparse& reduction);

/// Forces of the constraints (rows of Assembly::constraints) that hold the state in equilibrium under the dead loads [N, N m]:
/// reactions of supports (acting on the structure), forces of rigid ties on the slave, minus the tension of inextensible beams.
Vector constraint_forces(const Model& model, const State& state);

}  // namespace uplift
