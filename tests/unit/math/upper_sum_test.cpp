#include "uplift/math/upper_sum.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>
#include <utility>
#include <vector>

namespace uplift::upper_sum_test {
namespace {

TEST(UpperSum, IsTheUpperTriangleOfTheSumWithThePlacesOfAllTerms) {
  constexpr int n = 30;
  std::mt19937 random(4);
  std::uniform_int_distribution<int> place(0, n - 1);
  std::uniform_real_distribution<double> value(-1, 1);
  std::vector<Sparse> matrices(3, Sparse(n, n));
  for (Sparse& matrix : matrices) {
    std::vector<Triplet> entries;
    for (int k = 0; k < 80; ++k) {
      const int i = place(random), j = place(random);
      const double a = value(random);
      entries.emplace_back(i, j, a), entries.emplace_back(j, i, a);
    }
    matrix.setFromTriplets(entries.begin(), entries.end());
  }
  Sparse of_one_triangle = matrices[2].triangularView<upper_triangle>();
  const Term terms[] = {{1, matrices[0]}, {-0.5, matrices[1]}, {3e4, of_one_triangle}};
  const Sparse sum = upper_sum(terms);
  const Matrix exact = Matrix(matrices[0]) - 0.5 * Matrix(matrices[1]) + 3e4 * Matrix(matrices[2]);
  EXPECT_LE((Matrix(sum) - Matrix(exact.triangularView<upper_triangle>())).cwiseAbs().maxCoeff(), 1e-15 * exact.cwiseAbs().maxCoeff());
  for (int j = 0; j < n; ++j) {
    int before = -1;
    for (Sparse::InnerIterator entry(sum, j); entry; ++entry) {
      EXPECT_GT(entry.row(), before);
      EXPECT_LE(entry.row(), j);
      before = static_cast<int>(entry.row());
    }
  }
  for (const Sparse& matrix : matrices)  // also where the sum is zero
    for (int j = 0; j < n; ++j)
      for (Sparse::InnerIterator entry(matrix, j); entry; ++entry)
        if (entry.row() <= j) {
          bool there = false;
          for (Sparse::InnerIterator own(sum, j); own; ++own) there = there || own.row() == entry.row();
          EXPECT_TRUE(there);
        }
}

TEST(UpperSum, KeepsEmptyColumns) {
  const Sparse empty(4, 4);
  const Term terms[] = {{2, empty}, {1, empty}};
  EXPECT_EQ(upper_sum(terms).nonZeros(), 0);
}

TEST(WholeSum, HasAllPlacesOfMatricesThatAreNotSymmetric) {
  constexpr int n = 25;
  std::mt19937 random(7);
  std::uniform_int_distribution<int> place(0, n - 1);
  std::uniform_real_distribution<double> value(-1, 1);
  std::vector<Sparse> matrices(2, Sparse(n, n));
  std::set<std::pair<Index, Index>> places;  // column, row
  for (Sparse& matrix : matrices) {
    std::vector<Triplet> entries;
    for (int k = 0; k < 90; ++k) entries.emplace_back(place(random), place(random), value(random));
    matrix.setFromTriplets(entries.begin(), entries.end());
    for (const Triplet& entry : entries) places.emplace(entry.col(), entry.row());
  }
  const Term terms[] = {{0.3, matrices[0]}, {2e-3, matrices[1]}};
  const Sparse sum = whole_sum(terms);
  const Matrix exact = 0.3 * Matrix(matrices[0]) + 2e-3 * Matrix(matrices[1]);
  EXPECT_LE((Matrix(sum) - exact).cwiseAbs().maxCoeff(), 1e-15);
  std::vector<std::pair<Index, Index>> in_order;
  for (int j = 0; j < n; ++j)
    for (Sparse::InnerIterator entry(sum, j); entry; ++entry) in_order.emplace_back(j, entry.row());
  EXPECT_TRUE(std::ranges::equal(in_order, places));
}

}  // namespace
}  // namespace uplift::upper_sum_test
