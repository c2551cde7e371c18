#include "uplift/statistics/sample_effects.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace uplift {
namespace {

/// Numbers of groups of columns that rows connect, after union and find.
std::vector<std::size_t> connected_columns(std::span<const LayoutCell> cells, std::size_t rows, std::size_t columns) {
  std::vector<std::size_t> parent(rows + columns);
  std::iota(parent.begin(), parent.end(), std::size_t{0});
  const auto root = [&](std::size_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  for (const LayoutCell& cell : cells) parent[root(rows + cell.column)] = root(cell.row);
  std::vector<std::size_t> group;
  for (std::size_t c = 0; c < columns; ++c) group.push_back(root(rows + c));
  return group;
}

/// Cells of the group with the most columns, in rows with two cells or more.
std::vector<LayoutCell> comparable(std::span<const LayoutCell> cells, std::size_t rows, std::size_t columns) {
  const std::vector<std::size_t> group = connected_columns(cells, rows, columns);
  std::vector<long> in_row(rows);
  for (const LayoutCell& cell : cells) ++in_row[cell.row];
  std::vector<std::pair<long, long>> size(rows + columns);  // columns and cells of a group
  for (const std::size_t each : group) ++size[each].first;
  for (const LayoutCell& cell : cells) ++size[group[cell.column]].second;
  const auto largest = static_cast<std::size_t>(std::ranges::max_element(size) - size.begin());
  std::vector<LayoutCell> used;
  for (const LayoutCell& cell : cells)
    if (group[cell.column] == largest && in_row[cell.row] > 1) used.push_back(cell);
  return used;
}

}  // namespace

// The effects of the rows are eliminated: row = mean over its cells of value - column. What is left for the columns, A e = b, is the
// Laplacian of the graph that rows make of columns: singular for equal effects alone, and definite beside them. Conjugate gradients from
// 0 stay where the effects sum to 0, but for round-off, which is taken out: it would grow without bounds. Where all rows are complete, A is
// the identity there times their number, and one step ends.
ColumnMeans column_means(std::span<const LayoutCell> cells, std::size_t rows, std::size_t columns) {
  const std::vector<LayoutCell> used = comparable(cells, rows, columns);
  std::vector<double> in_row(rows), in_column(columns);
  for (const LayoutCell& cell : used) ++in_row[cell.row], ++in_column[cell.column];
  const auto row_means = [&](const auto& value) {
    std::vector<double> mean(rows);
    for (const LayoutCell& cell : used) mean[cell.row] += value(cell) / in_row[cell.row];
    return mean;
  };
  /// Sum over the cells of a column of value - mean of the row.
  const auto deviations = [&](const auto& value) {
    const std::vector<double> mean = row_means(value);
    std::vector<double> sum(columns);
    for (const LayoutCell& cell : used) sum[cell.column] += value(cell) - mean[cell.row];
    return sum;
  };
  const auto dot = [](const std::vector<double>& a, const std::vector<double>& b) {
    return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
  };
  const double count_columns = static_cast<double>(std::ranges::count_if(in_column, [](double n) { return n > 0; }));
  const auto centre = [&](std::vector<double>& values) {
    const double mean = std::accumulate(values.begin(), values.end(), 0.0) / std::max(1.0, count_columns);
    for (std::size_t c = 0; c < columns; ++c)
      if (in_column[c] > 0) values[c] -= mean;
  };
  std::vector<double> effect(columns), rest = deviations([](const LayoutCell&cell) { return cell.value; });
  centre(rest);
  std::vector<double> direction = rest;
  double squares = dot(rest, rest);
  const double enough = 1e-28 * squares;
  for (std::size_t step = 0; step < 10 * columns && squares > enough; ++step) {
    const std::vector<double> there = deviations([&](const LayoutCell& cell) { return direction[cell.column]; });
    const double curvature = dot(direction, there);
    if (!(curvature > 0)) break;
    const double length = squares / curvature, before = squares;
    for (std::size_t c = 0; c < columns; ++c) effect[c] += length * direction[c], rest[c] -= length * there[c];
    centre(rest);
    squares = dot(rest, rest);
    for (std::size_t c = 0; c < columns; ++c) direction[c] = rest[c] + squares / before * direction[c];
  }
  const std::vector<double> of_row = row_means([&](const LayoutCell& cell) { return cell.value - effect[cell.column]; });
  double level = 0, count = 0;
  for (std::size_t r = 0; r < rows; ++r)
    if (in_row[r] > 0) level += of_row[r], ++count;
  ColumnMeans made{std::vector<std::optional<double>>(columns), 0, static_cast<long>(used.size())};
  for (std::size_t c = 0; c < columns; ++c)
    if (in_column[c] > 0) made.mean[c] = level / count + effect[c], ++made.columns;
  return made;
}

}  // namespace uplift
