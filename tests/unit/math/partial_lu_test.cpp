#include "uplift/math/partial_lu.h"

#include <gtest/gtest.h>

#include <random>

#include "uplift/math/columns.h"
#include "uplift/math/dense.h"

namespace uplift::partial_lu_test {
namespace {

Matrix random_matrix(Index n, std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  return Matrix::NullaryExpr(n, n, [&] { return uniform(random); });
}

}  // namespace

/// Orders up to some panels and some blocks, one after another in the same room, against a solution that is known.
TEST(PartialLu, SolvesSystemsOfEveryOrder) {
  std::mt19937 random(5);
  LuInPlace lu;
  constexpr Index most = 641;
  lu.size(most);
  for (Index n : {75, 1, 2, 3, 7, 8, 9, 15, 16, 17, 18, 23, 24, 31, 33, 40, 47, 64, 65, 74, 512, 513, 641}) {
    Matrix a = random_matrix(n, random);
    for (Index i = 0; i < n; i += 3) a(i, i) = 0;  // rows have to be exchanged
    const Vector x = Vector::LinSpaced(n, -1, 2);
    Vector b = a * x;
    for (Index j = 0; j < n; ++j) std::copy_n(a.col(j).data(), n, lu.column(j));
    if (n == 1) {
      EXPECT_FALSE(lu.factorise(n)) << "seed 5";  // 0
      continue;
    }
    ASSERT_TRUE(lu.factorise(n)) << "seed 5, order " << n;
    lu.solve(b.data());
    const double condition = a.norm() * inverse(a).norm();
    EXPECT_LT((b - x).norm(), 1e-15 * condition * x.norm()) << "seed 5, order " << n;
    const Matrix several = Matrix::NullaryExpr(n, 3, [](Index i, Index j) { return std::cos(static_cast<double>(i + 2 * j)); });
    Matrix right = a * several;
    lu.solve(right);
    EXPECT_LT((right - several).norm(), 1e-15 * condition * several.norm()) << "seed 5, order " << n;
  }
}

TEST(PartialLu, SingularAndInfiniteMatricesHaveNoFactor) {
  std::mt19937 random(6);
  LuInPlace lu;
  lu.size(600);
  for (const Index n : {30, 600})
    for (const bool singular : {true, false}) {
      Matrix a = random_matrix(n, random);
      if (singular)
        a.col(20) = a.col(3) - 2 * a.col(11);
      else
        a(25, 4) = HUGE_VAL;
      for (Index j = 0; j < n; ++j) std::copy_n(a.col(j).data(), n, lu.column(j));
      EXPECT_FALSE(lu.factorise(n)) << "seed 6, order " << n << ", singular " << singular;
    }
}

/// Rows beyond the matrix, which whole registers carry along, hold nothing of matrices before: it would grow, or be too small for normal
/// numbers.
TEST(PartialLu, RowsBeyondTheMatrixAreForgotten) {
  std::mt19937 random(8);
  LuInPlace lu;
  constexpr Index most = 60, n = 41;
  lu.size(most);
  for (const double left : {HUGE_VAL, 1e300, 1e-310}) {
    const Matrix a = random_matrix(n, random);
    for (Index j = 0; j < n; ++j) {
      std::fill_n(lu.column(j), most, left);
      std::copy_n(a.col(j).data(), n, lu.column(j));
    }
    ASSERT_TRUE(lu.factorise(n)) << "seed 8";
    for (Index j = 0; j < n; ++j) EXPECT_EQ(lu.column(j)[n], 0) << "seed 8, column " << j << ", " << left;
  }
}

TEST(Columns, SumOfChosenColumns) {
  std::mt19937 random(7);
  for (Index rows = 1; rows < 90; ++rows) {
    const Matrix a = random_matrix(90, random).topRows(rows);
    const Vector x = a.row(0);
    const std::vector<Index> chosen{3, 4, 40, 89};
    Vector y = Vector::Constant(rows, 0.5), expected = y;
    for (const Index j : chosen) expected -= 2 * x[j] * a.col(j);
    add_columns_of(a, -2, chosen, x.data(), y.data());
    EXPECT_LT((y - expected).norm(), 1e-14 * (1 + expected.norm())) << "seed 7, rows " << rows;
  }
}

}  // namespace uplift::partial_lu_test
