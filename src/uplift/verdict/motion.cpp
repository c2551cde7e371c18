#include "uplift/verdict/motion.h"

#include <algorithm>
#include <cmath>

#include "uplift/case/build/output.h"

namespace uplift {
namespace {

using Column = Request::Kind;
using History = std::vector<double>;

int find_index(const RunResult& result, Column kind, int of) {
  for (std::size_t k = 0; k < result.columns.size(); ++k) {
    const Request& column = result.columns[k];
    const bool node =
        kind == Column::displacement || kind == Column::velocity || kind == Column::acceleration || kind == Column::absolute_acceleration;
    if (column.kind == kind && (node ? column.unknown : column.interface) == of) return static_cast<int>(k);
  }
  return -1;
}

std::size_t rows_of(const RunResult& result) {
  return result.table.empty() ? 0 : result.table.front().size();
}

/// The displacement of an unknown; zero where it is held, nothing where it moves and was not recorded.
std::optional<History> displacement(const BuiltCase& built, const RunResult& result, int node, Dof dof) {
  const int unknown = built.model.at(node, dof);
  if (const History* column = find_column(result, Column::displacement, unknown)) return *column;
  return moves(built.model, unknown) ? std::nullopt : std::optional(History(rows_of(result), 0.0));
}

/// Rotations of the base: in the plane one, in space about x and y.
std::vector<std::optional<History>> base_rotations(const BuiltCase& built, const RunResult& result) {
  std::vector<std::optional<History>> made;
  const bool plane = built.model.space.dimension == 2, of_nodes = built.facts.front().upper.size() > 1;
  for (int k = 0; k < (plane ? 1 : 2); ++k) {
    const History* tilt = find_column(result, k == 0 ? Column::tilt_1 : Column::tilt_2, 0);
    if (tilt)
      made.emplace_back(*tilt);
    else
      made.push_back(of_nodes ? std::nullopt : displacement(built, result, built.base, plane ? rz : k == 0 ? rx : ry));
  }
  return made;
}

/// Horizontal components that move the top like a rigid body on the base, height above it `h`.
std::optional<History> turned(const BuiltCase& built, const std::vector<std::optional<History>>& rotations, int axis, double h) {
  const bool plane = built.model.space.dimension == 2;
  const std::optional<History>& about = rotations[plane ? 0 : axis == 0 ? 1 : 0];  // along x: about y
  if (!about) return std::nullopt;
  History made = *about;
  for (double& value : made) value *= !plane && axis == 0 ? h : -h;
  return made;
}

/// The largest of a vector history; in the plane with its sign.
std::optional<Peak> peak_of(const std::vector<History>& components, const History& time, const char* name) {
  Peak peak{name, "m", 0, 0};
  for (std::size_t i = 0; i < time.size(); ++i) {
    double value = components.front()[i];
    for (std::size_t k = 1; k < components.size(); ++k) value = std::hypot(value, components[k][i]);
    if (std::abs(value) > std::abs(peak.value)) peak.value = value, peak.time = time[i];
  }
  return time.empty() ? std::nullopt : std::optional(peak);
}

}  // namespace

const std::vector<double>* find_column(const RunResult& result, Column kind, int of) {
  const int index = find_index(result, kind, of);
  return index < 0 || static_cast<std::size_t>(index) + 1 >= result.table.size() ? nullptr
                                                                                 : &result.table[static_cast<std::size_t>(index) + 1];
}

const Peak* find_peak(const RunResult& result, Column kind, int of) {
  const int index = find_index(result, kind, of);
  return index < 0 || static_cast<std::size_t>(index) >= result.peaks.size() ? nullptr : &result.peaks[static_cast<std::size_t>(index)];
}

std::optional<Peak> top_motion(const BuiltCase& built, const RunResult& result) {
  if (built.top < 0) return std::nullopt;
  std::optional<Peak> largest;
  std::vector<History> components;
  for (int axis = 0; axis < built.model.space.dimension; ++axis) {
    if (axis == built.model.space.up()) continue;
    const int unknown = built.model.at(built.top, built.model.space.dof(axis));
    const Peak* peak = find_peak(result, Column::displacement, unknown);
    if (peak && (!largest || std::abs(peak->value) > std::abs(largest->value))) largest = *peak;
    if (const History* column = find_column(result, Column::displacement, unknown)) components.push_back(*column);
  }
  // peaks are those of every step; with output.every > 1 the rows are fewer, and the resultant never less than one of its components
  if (components.size() < 2) return largest;
  const std::optional<Peak> resultant = peak_of(components, result.table.front(), "top");
  if (largest) largest->value = std::abs(largest->value);
  return resultant && (!largest || resultant->value > largest->value) ? resultant : largest;
}

std::optional<Peak> largest_drift(const BuiltCase& built, const RunResult& result, Drift rotation) {
  if (built.top < 0 || built.base < 0 || built.top == built.base || built.facts.empty() || rows_of(result) == 0) return std::nullopt;
  const Space space = built.model.space;
  const auto height = [&](int node) { return built.model.nodes[static_cast<std::size_t>(node)].position[space.up()]; };
  const std::vector<std::optional<History>> rotations = base_rotations(built, result);
  std::vector<History> components;
  for (int axis = 0; axis < space.dimension; ++axis) {
    if (axis == space.up()) continue;
    std::optional<History> top = displacement(built, result, built.top, space.dof(axis)),
                           base = displacement(built, result, built.base, space.dof(axis)),
                           rigid = turned(built, rotations, axis, height(built.top) - height(built.base));
    if (!top || !base || (rotation == Drift::without_rotation && !rigid)) return std::nullopt;
    for (std::size_t i = 0; i < top->size(); ++i) (*top)[i] -= (*base)[i] + (rotation == Drift::without_rotation ? (*rigid)[i] : 0);
    components.push_back(std::move(*top));
  }
  return peak_of(components, result.table.front(), "drift");
}

double range_of_top(const BuiltCase& built, const RunResult& result) {
  double range = 0;
  for (int axis = 0; built.top >= 0 && axis < built.model.space.dimension; ++axis) {
    const History* column = find_column(result, Column::displacement, built.model.at(built.top, built.model.space.dof(axis)));
    if (!column || column->empty()) continue;
    const auto [least, most] = std::ranges::minmax_element(*column);
    range = std::max(range, (*most - *least) / 2);
  }
  return range;
}

}  // namespace uplift
