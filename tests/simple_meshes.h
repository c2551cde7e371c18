#pragma once
#include <algorithm>
#include <string>
#include <vector>

#include "uplift/mesh/grid.h"

// Shared by tests and benchmarks: meshes of one part on straight lines.
namespace uplift {

/// `cells` equal cells; both ends are met exactly.
inline std::vector<double> uniform_lines(double from, double to, int cells) {
  std::vector<double> lines;
  for (int i = 0; i < cells; ++i) lines.push_back(from + (to - from) * i / cells);
  lines.push_back(to);
  return lines;
}

/// Uniform cells of at most `size` in [fine_from, fine_to], growing away from it by at most `growth` up to `largest` at `from` and `to`.
inline std::vector<double> refined_lines(double from, double fine_from, double fine_to, double to, double size, double largest,
                                         double growth) {
  std::vector<Stretch> stretches;
  if (fine_from > from) stretches.push_back({fine_from, std::max(size, largest)});
  stretches.push_back({fine_to, size});
  if (to > fine_to) stretches.push_back({to, std::max(size, largest)});
  return graded_lines(from, stretches, growth);
}

/// All cells of the grid. Groups: "volume", and its sides by their names.
inline Mesh whole_grid(const Grid& lines, Cell cell) {
  const auto side = [](int, Direction direction, int) { return std::string(name_of(direction)); };
  return with_cells(grid(
                        lines, [](int, int, int) { return 0; }, {"volume"}, side),
                    cell);
}

/// Rectangle of any surface type. Groups: "volume", "left", "right", "bottom", "top".
inline Mesh rectangle(const std::vector<double>& x, const std::vector<double>& y, Cell cell = Cell::quad4) {
  return whole_grid({x, y, {}}, cell);
}
/// Box of any volume type. Groups: "volume", "left", "right" (x), "front", "back" (y), "bottom", "top" (z).
inline Mesh box(const std::vector<double>& x, const std::vector<double>& y, const std::vector<double>& z, Cell cell = Cell::hex8) {
  return whole_grid({x, y, z}, cell);
}

}  // namespace uplift
