#pragma once
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

// Samples that were not all run under the same conditions, compared with each other: docs/theory/fragility.md.
namespace uplift {

/// The logarithm of a response of one sample (column) under one condition (row), such as a motion at an intensity.
struct LayoutCell {
  std::size_t row = 0, column = 0;
  double value = 0;
};

/// Fit of value = effect of the row + effect of the column by least squares over the cells that are known.
struct ColumnMeans {
  /// Of every column: the mean of the fit over the rows that are used. Nothing for a column without a cell in them.
  std::vector<std::optional<double>> mean;
  long columns = 0, cells = 0;  // that are used
};
/// Columns are compared along rows that they share. Of several groups of columns without a common row, the one with the most columns is
/// used (then that with the most cells). Rows with one cell compare nothing and are not used. Complete rows give the plain means.
ColumnMeans column_means(std::span<const LayoutCell>, std::size_t rows, std::size_t columns);

}  // namespace uplift
