#pragma once
#include <span>
#include <vector>

#include "uplift/mesh/cells.h"
#include "uplift/mesh/half_space.h"

// Sections of cells by planes.
namespace uplift {

/// The section of a cell by a plane: its corners [m], in the plane two, in space in their order round it; those within `tolerance` once.
/// Empty when the plane only touches the cell.
std::vector<Vec3> section(Cell cell, std::span<const Vec3> corners, const HalfSpace& plane, double tolerance);
/// What is left of a section within half-spaces.
std::vector<Vec3> clip_section(std::vector<Vec3> corners, const std::vector<HalfSpace>& within, double tolerance);

}  // namespace uplift
