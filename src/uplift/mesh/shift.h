#pragma once
#include <string>
#include <vector>

#include "uplift/mesh/cut.h"

// Moves a mesh against a plane that will cut it, without moving what the mesh describes.
namespace uplift {

/// Moves the nodes near the plane along its normal: by `share` of the least height along the normal of the cells at the node, and less with
/// the distance from the plane, nothing from three heights of the cells that the plane crosses. What the mesh describes keeps its place:
/// nodes on the boundary of the groups `through` move only where the normal lies in it; nodes of other cells, of groups of nodes and of
/// `lines` stay. |share| < 1/2. Groups that are absent or of something else are left to cut().
void shift_nodes(Mesh& mesh, const CutPlane& plane, double share, const std::vector<std::string>& lines = {});

}  // namespace uplift
