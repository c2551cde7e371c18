#include "uplift/math/symmetric_pair.h"

#include <gtest/gtest.h>

#include <random>

namespace uplift::symmetric_pair_test {
namespace {

Sparse symmetric(int size, int entries, std::mt19937& random) {
  std::uniform_int_distribution<int> place(0, size - 1);
  std::uniform_real_distribution<double> value(-1, 1);
  std::vector<Triplet> triplets;
  for (int k = 0; k < entries; ++k) {
    const int i = place(random), j = place(random);
    const double v = value(random);
    triplets.emplace_back(i, j, v);
    if (i != j) triplets.emplace_back(j, i, v);
  }
  Sparse matrix(size, size);
  matrix.setFromTriplets(triplets.begin(), triplets.end());
  return matrix;
}

/// Any two patterns: equal, different, empty, without diagonals.
TEST(SymmetricPair, ProductsAreThoseOfTheFullMatrices) {
  std::mt19937 random(11);
  for (const int size : {1, 2, 5, 40})
    for (const int of_a : {0, 1, size, 6 * size})
      for (const int of_b : {0, 2 * size}) {
        const Sparse a = symmetric(size, of_a, random), b = symmetric(size, of_b, random);
        const Vector x = Vector::LinSpaced(size, -1, 3), y = Vector::LinSpaced(size, 2, -5);
        Vector ax = Vector::Constant(size, 7), by = Vector::Constant(size, 7);  // old values play no part
        SymmetricPair(a, b).multiply(x, y, ax, by);
        EXPECT_LE((ax - Matrix(a) * x).norm(), 1e-14 * (1 + 6 * size));
        EXPECT_LE((by - Matrix(b) * y).norm(), 1e-14 * (1 + 6 * size));
      }
}

}  // namespace
}  // namespace uplift::symmetric_pair_test
