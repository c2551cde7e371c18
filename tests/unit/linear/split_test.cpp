// Chosen unknowns last: the two halves of a back-solve, the last block, and everything that can go wrong with the order.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "uplift/base/declare.h"
#include "uplift/linear/solver.h"
#include "uplift/math/dense.h"

namespace uplift::split_test {
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

/// The matrix with other values in the same places; `diagonal`: added there.
Sparse with_other_values(Sparse a, double diagonal, std::mt19937& random) {
  std::uniform_real_distribution<double> share(0.5, 1);
  for (int column = 0; column < a.outerSize(); ++column)
    for (Sparse::InnerIterator entry(a, column); entry; ++entry)
      entry.valueRef() = entry.row() == column ? 2 * entry.value() + diagonal : share(random) * entry.value();
  return Sparse(0.5 * (a + Sparse(a.transpose())));
}

// Claim: a matrix with entries in the same places is factorised by the analysis of the first one; the answer is that of a dense solver.
TEST(Refactorised, SolvesTheOtherMatrix) {
  std::mt19937 random(11);
  for (const int unknowns : {2, 60, 400})
    for (const int pieces : {1, 3}) {
      const Sparse a = springs(unknowns, pieces, 2.5, random), other = with_other_values(a, 0.3, random);
      const std::vector<int> last = choose(unknowns, std::max(1, unknowns / 9), random);
      const SplitFactorisation split = cholmod()->factorise_split(a, last);
      const Factorisation whole = cholmod()->factorise(a);
      ASSERT_TRUE(split.factor && whole.factor);
      const SplitFactorisation split_again = split.factor->refactorise(other);
      const Factorisation whole_again = whole.factor->refactorise(other);
      ASSERT_TRUE(split_again.factor && whole_again.factor) << split_again.why << whole_again.why;
      const Vector b = Vector::LinSpaced(unknowns, -1, 2), expected = PivotedLdlt(Matrix(other)).solve(b);
      Vector y, x;
      split_again.factor->forward(b, y);
      split_again.factor->backward(y, x);
      EXPECT_LE((x - expected).norm(), 1e-11 * expected.norm()) << unknowns;
      Matrix column = b, solved;
      whole_again.factor->solve(column, solved);
      EXPECT_LE((solved.col(0) - expected).norm(), 1e-11 * expected.norm()) << unknowns;
      // the first factor is as it was
      split.factor->forward(b, y);
      split.factor->backward(y, x);
      EXPECT_LE((Matrix(a) * x - b).norm(), 1e-11 * b.norm()) << unknowns;
    }
}

// Claim: an entry for which the factor has no place is noticed, and a matrix that is not positive definite is named as by a new analysis.
TEST(Refactorised, RefusesWhatDoesNotFit) {
  const int unknowns = 300;
  Sparse chain(unknowns, unknowns);
  std::vector<Triplet> entries;
  for (int i = 0; i < unknowns; ++i) {
    entries.emplace_back(i, i, 2.1);
    if (i > 0) entries.emplace_back(i, i - 1, -1.0), entries.emplace_back(i - 1, i, -1.0);
  }
  chain.setFromTriplets(entries.begin(), entries.end());
  const SplitFactorisation split = cholmod()->factorise_split(chain, {unknowns - 1});
  const Factorisation whole = cholmod()->factorise(chain);
  ASSERT_TRUE(split.factor && whole.factor);
  int refused = 0;
  for (const auto& [i, j] : {std::pair{3, 250}, {10, 130}, {70, 290}, {5, 200}, {140, 299}}) {
    Sparse tied = chain;
    tied.coeffRef(i, j) = tied.coeffRef(j, i) = -0.01;
    for (const std::string& why : {split.factor->refactorise(tied).why, whole.factor->refactorise(tied).why}) EXPECT_EQ(why, "");
    refused += split.factor->refactorise(tied).factor == nullptr && whole.factor->refactorise(tied).factor == nullptr ? 1 : 0;
  }
  EXPECT_GE(refused, 4);  // by chance one may lie inside the fill
  Sparse bad = chain;
  bad.coeffRef(40, 40) = -1;
  const SplitFactorisation broken = split.factor->refactorise(bad);
  EXPECT_EQ(broken.factor, nullptr);
  EXPECT_NE(broken.why.find("not positive definite"), std::string::npos) << broken.why;
  EXPECT_GE(broken.failed_unknown, 0);
  Sparse smaller = chain.topLeftCorner(unknowns - 1, unknowns - 1);
  EXPECT_EQ(split.factor->refactorise(smaller).factor, nullptr);
}

}  // namespace
}  // namespace uplift::split_test
