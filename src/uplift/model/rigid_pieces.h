#pragma once
#include <vector>

#include "uplift/model/model.h"

// Solids are stiff and heavy in every motion but those of a rigid body: what is loose or without mass is seen on a few unknowns.
namespace uplift {

bool is_solid(const Element& element);
/// How many translations of each node are free unknowns.
std::vector<int> kept_translations(const Model& model);
/// The piece of connected solids that each node belongs to; -1 for nodes of no solid and of pieces with few nodes that move freely.
std::vector<int> solid_pieces(const Model& model);

/// Columns span the free motions in which every piece moves as a rigid body; nothing else is held. A free motion without strain energy is
/// one of them. Motions that the supports leave nothing of are left out.
Sparse rigid_motions(const Model& model, const std::vector<int>& pieces);

/// Whether each free unknown is a translation of a node with a part of a solid's mass matrix, which is positive definite.
std::vector<char> moved_by_solid_mass(const Model& model);

}  // namespace uplift
