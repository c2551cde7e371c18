#pragma once
#include <span>
#include <vector>

#include "uplift/mesh/split.h"

namespace uplift {

/// Where cells of full dimension lie side by side and are not connected: the middles [m] of the sides at the same place, corner by corner
/// within 1e-6 of their size, that have different nodes (nodes doubled by CAD, cells of first degree beside those of second degree). Sides
/// whose corners all belong to `opened` faces, or to the `joined` nodes of pairs and lines, are meant to be so.
std::vector<Vec3> torn_sides(const Mesh& mesh, const std::vector<std::vector<FacePair>>& opened, std::span<const int> joined = {});

}  // namespace uplift
