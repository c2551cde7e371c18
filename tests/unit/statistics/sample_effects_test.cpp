#include "uplift/statistics/sample_effects.h"

#include <gtest/gtest.h>

namespace uplift::sample_effects_test {
namespace {

TEST(SampleEffects, CompleteRowsGiveMeans) {
  const double table[3][4] = {{0.3, -1.2, 2.5, 0.7}, {1.1, 0.4, -0.6, 2.2}, {-0.9, 0.8, 1.6, -2.4}};
  std::vector<LayoutCell> cells;
  for (std::size_t r = 0; r < 3; ++r)
    for (std::size_t c = 0; c < 4; ++c) cells.push_back({r, c, table[r][c]});
  const ColumnMeans found = column_means(cells, 3, 4);
  EXPECT_EQ(found.columns, 4);
  EXPECT_EQ(found.cells, 12);
  for (std::size_t c = 0; c < 4; ++c) EXPECT_NEAR(*found.mean[c], (table[0][c] + table[1][c] + table[2][c]) / 3, 1e-14);
}

// Two rows, three columns; (1, 2) is missing: the normal equations by hand. Column 2 has y02 alone, so that row 0 fits it exactly and
// columns 0 and 1 differ by the mean of their differences.
TEST(SampleEffects, AMissingCellIsNotComparedWithOtherRows) {
  const std::vector<LayoutCell> cells{{0, 0, 1.0}, {0, 1, 1.5}, {0, 2, 4.0}, {1, 0, 3.0}, {1, 1, 3.1}};
  const ColumnMeans found = column_means(cells, 2, 3);
  EXPECT_NEAR(*found.mean[1] - *found.mean[0], 0.3, 1e-13);                // mean of 0.5 and 0.1
  EXPECT_NEAR(*found.mean[2] - *found.mean[0], 4.0 - 1.25 + 0.15, 1e-13);  // against the mean of both in row 0
  EXPECT_NEAR((*found.mean[0] + *found.mean[1]) / 2, (1.25 + 3.05) / 2, 1e-13);
}

// No row is complete, and values are sums of both effects: they are found exactly. Columns 5 and 6 share no row with the others.
TEST(SampleEffects, ColumnsApartAreLeftOut) {
  const double row[6] = {0.2, 1.4, -0.8, 2.1, 0.5, 7}, column[7] = {0.1, -0.4, 0.9, 0.3, 1.2, 0, 3};
  std::vector<LayoutCell> cells;
  for (std::size_t r = 0; r < 5; ++r)
    for (std::size_t c = 0; c < 5; ++c)
      if (c != r) cells.push_back({r, c, row[r] + column[c]});
  cells.push_back({5, 5, row[5] + column[5]});
  const ColumnMeans found = column_means(cells, 6, 7);
  EXPECT_EQ(found.columns, 5);
  EXPECT_EQ(found.cells, 20);
  for (std::size_t c = 0; c < 5; ++c) EXPECT_NEAR(*found.mean[c], column[c] + (0.2 + 1.4 - 0.8 + 2.1 + 0.5) / 5, 1e-12) << c;
  EXPECT_FALSE(found.mean[5]);
  EXPECT_FALSE(found.mean[6]);
  EXPECT_EQ(column_means({}, 0, 3).columns, 0);
}

}  // namespace
}  // namespace uplift::sample_effects_test
