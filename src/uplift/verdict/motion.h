#pragma once
#include <optional>

#include "uplift/case/case.h"

// How the top of a structure moves, at every step.
namespace uplift {

/// Column of a result: by kind and by unknown or interface. Null when it was not recorded.
const std::vector<double>* find_column(const RunResult& result, Request::Kind kind, int unknown_or_interface);
/// Peak of a column of a result; null like find_column.
const Peak* find_peak(const RunResult& result, Request::Kind kind, int unknown_or_interface);

/// The largest horizontal motion of the top. In the plane with its sign, in space the length of the resultant, over all horizontal
/// directions. Nothing when it was not recorded.
std::optional<Peak> top_motion(const BuiltCase&, const RunResult&);

/// Horizontal motion of the top relative to the base. `rotation`: including what the rotation of the base alone would make of it (rigid
/// body); without it the deformation of the structure is left.
enum class Drift { with_rotation, without_rotation };
/// Its largest value, with its sign in the plane. Nothing without a base or without the columns it needs.
std::optional<Peak> largest_drift(const BuiltCase&, const RunResult&, Drift rotation);

/// Half of the range over which the top moves, the largest of all directions, the vertical one too [m]: what its motion is compared with.
double range_of_top(const BuiltCase&, const RunResult&);

}  // namespace uplift
