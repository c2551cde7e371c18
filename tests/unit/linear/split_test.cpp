// Chosen unknowns last: the two halves of a back-solve, the last block, and everything that can go wrong with the order.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "uplift/base/declare.h"
#include "uplift/linear/solver.h"
#include "uplift/math/dense.h"

namespace uplift {
namespace {

/// Springs along random pairs, a weak one to ground on every unknown: positive definite. `pieces` groups are not connected to each other.
Sparse springs(int unknowns, int pieces, double links, std::mt19937& random) {
  std::vector<Triplet> entries;
  for (int i = 0; i < unknowns; ++i) entries.emplace_back(i, i, 0.1);
  std::uniform_int_distribution<int> pick(0, unknowns - 1);
  std::uniform_real_distribution<double> stiffness(0.5, 2);
  for (int k = 0; k < links * unknowns; ++k) {
    const int i = pick(random), j = pick(random);
    if (i == j || i % pieces != j % pieces) continue;
    const double c = stiffness(random);
    entries.emplace_back(i, i, c);
    entries.emplace_back(j, j, c);
    entries.emplace_back(i, j, -c);
    entries.emplace_back(j, i, -c);
  }
  Sparse a(unknowns, unknowns);
  a.setFromTriplets(entries.begin(), entries.end());
  return a;
}

std::vector<int> choose(int unknowns, int count, std::mt19937& random) {
  std::vector<int> all(static_cast<std::size_t>(unknowns));
  for (int i = 0; i < unknowns; ++i) all[static_cast<std::size_t>(i)] = i;
  std::shuffle(all.begin(), all.end(), random);
  all.resize(static_cast<std::size_t>(count));
  return all;
}

std::unique_ptr<const LinearSolver> cholmod() {
  return solver_catalog()[0]->make(Values());
}

TEST(SplitFactor, HalvesMakeTheWholeAndTheLastBlockIsTheFlexibility) {
  std::mt19937 random(7);
  for (const int unknowns : {1, 2, 9, 60, 300})
    for (const int pieces : {1, 4})
      for (const double share : {0.0, 0.1, 0.5, 1.0}) {
        const int count = std::max(1, static_cast<int>(share * unknowns));
        const Sparse a = springs(unknowns, pieces, 2.5, random);
        const std::vector<int> last = choose(unknowns, count, random);
        const SplitFactorisation result = cholmod()->factorise_split(a, last);
        ASSERT_TRUE(result.factor) << result.why;
        const Matrix dense = Matrix(a);
        const Matrix inverse = PivotedLdlt(dense).solve(Matrix::Identity(unknowns, unknowns));
        const Vector b = Vector::LinSpaced(unknowns, -1, 2);
        Vector y, x;
        result.factor->forward(b, y);
        result.factor->backward(y, x);
        EXPECT_LE((x - inverse * b).norm(), 1e-11 * (1 + x.norm())) << unknowns << " " << pieces << " " << count;

        // (A^-1)_bb = L_bb^-T L_bb^-1, and the forward solve's tail is L_bb^T x_b
        const Matrix block = result.factor->last();
        ASSERT_EQ(block.rows(), count);
        EXPECT_TRUE(block.isLowerTriangular());
        const Matrix flexibility = PivotedLdlt(block * block.transpose()).solve(Matrix::Identity(count, count));
        Matrix wanted(count, count);
        Vector at_last(count);
        for (int i = 0; i < count; ++i) {
          at_last[i] = x[last[static_cast<std::size_t>(i)]];
          for (int j = 0; j < count; ++j) wanted(i, j) = inverse(last[static_cast<std::size_t>(i)], last[static_cast<std::size_t>(j)]);
        }
        EXPECT_LE((flexibility - wanted).norm(), 1e-10 * wanted.norm());
        EXPECT_LE((y.tail(count) - block.transpose() * at_last).norm(), 1e-10 * (1 + y.norm()));
      }
}

TEST(SplitFactor, SaysWhichUnknownIsLoose) {
  std::mt19937 random(3);
  Sparse a = springs(40, 1, 3, random);
  for (int k = 0; k < 40; ++k) {
    if (k != 17) a.coeffRef(k, 17) = a.coeffRef(17, k) = 0;
  }
  a.coeffRef(17, 17) = 0;
  for (const std::vector<int>& last : {std::vector<int>{17, 3}, std::vector<int>{3, 5}}) {
    const SplitFactorisation result = cholmod()->factorise_split(a, last);
    EXPECT_FALSE(result.factor);
    EXPECT_EQ(result.failed_unknown, 17);
  }
}

}  // namespace
}  // namespace uplift
