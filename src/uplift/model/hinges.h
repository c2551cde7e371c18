#pragma once
#include <string>
#include <vector>

#include "uplift/model/model.h"

namespace uplift {

/// Nodes of solids where a beam ends in a hinge, ascending: no other beam, no support and no rigid body holds its rotation, and the beam
/// does not come along the edges of the solids.
std::vector<int> hinges(const Model& model);

/// The foot of a beam that runs on into solids, along the edges of their cells. The solids hold its nodes and not its rotation, so that
/// between them it bends like a continuous beam on hinged supports: under the moment M the foot turns by M f/(E I) more than the solids do,
/// with f from the far end on f = l/3, then f = l/3 - l^2/(36 (l/3 + f)) (three-moment equation): 0.333 l for one cell of the length l,
/// 0.292 l for two, 0.289 l for many.
struct EmbeddedFoot {
  int node = 0;
  double flexibility = 0;  // f [m]
  int cells = 0;
  double cell = 0;         // m, length of the first one
  double free_length = 0;  // m, of the beam outside, up to its end or the next joint
};
/// Those of beams that the solids would hold more firmly than that: E l^2 thickness (in space E l^3) of the solid is above E I/f of the
/// beam. Piles in soil are not among them.
std::vector<EmbeddedFoot> embedded_feet(const Model& model);

/// "mesh.7" at (2, 0) m, ... and how many more.
std::string named_places(const Model& model, const std::vector<int>& nodes);

}  // namespace uplift
