// Many right-hand sides through a factor in two halves, beside one at a time.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "two_boxes.h"
#include "uplift/dynamics/bulk.h"

namespace uplift::split_columns_test {
namespace {

/// The matrix of a step of 5 ms of a block on soil, and its factor with the unknowns under the block last.
struct Factored {
  explicit Factored(int dimension) {
    TwoBoxesPlan plan;
    plan.dimension = dimension;
    if (dimension == 3) plan.soil = {8, 8, 4}, plan.block_width = 3, plan.block_height = 3;
    const TwoBoxes boxes = two_boxes(plan);
    matrix = boxes.stiffness + 4 / (5e-3 * 5e-3) * boxes.mass;
    factor = solver_catalog()[0]->make(Values())->factorise_split(matrix, touched_unknowns(boxes.b)).factor;
  }
  Sparse matrix;
  std::unique_ptr<const SplitFactor> factor;
};

std::vector<Vector> loads(Index unknowns, int count, std::mt19937& random) {
  std::normal_distribution<double> normal;
  std::vector<Vector> all;
  for (int k = 0; k < count; ++k) all.push_back(Vector::NullaryExpr(unknowns, [&](Index) { return normal(random); }));
  return all;
}

using Half = void (SplitFactor::*)(std::span<const Vector* const>, std::span<Vector* const>) const;

std::vector<Vector> together(const SplitFactor& factor, Half half, const std::vector<Vector>& given) {
  std::vector<Vector> made(given.size());
  std::vector<const Vector*> from;
  std::vector<Vector*> to;
  for (std::size_t k = 0; k < given.size(); ++k) from.push_back(&given[k]), to.push_back(&made[k]);
  (factor.*half)(from, to);
  return made;
}

// Claim: both halves are those of single solves to round-off, together they solve the equations, for any number of columns.
TEST(SplitColumns, AreTheSingleSolves) {
  std::mt19937 random(5);
  for (const int dimension : {2, 3}) {
    const Factored soil(dimension);
    ASSERT_TRUE(soil.factor);
    for (int count = 1; count <= 33; ++count) {
      const std::vector<Vector> b = loads(soil.matrix.rows(), count, random);
      const std::vector<Vector> y = together(*soil.factor, &SplitFactor::forward_all, b),
                                x = together(*soil.factor, &SplitFactor::backward_all, y);
      for (std::size_t k = 0; k < b.size(); ++k) {
        Vector half, solution;
        soil.factor->forward(b[k], half);
        EXPECT_LE((y[k] - half).norm(), 1e-13 * half.norm()) << dimension << " " << count;
        soil.factor->backward(y[k], solution);
        EXPECT_LE((x[k] - solution).norm(), 1e-13 * solution.norm()) << dimension << " " << count;
        EXPECT_LE((soil.matrix * x[k] - b[k]).norm(), 1e-11 * b[k].norm()) << dimension << " " << count;
      }
    }
  }
}

// Claim: what becomes of a column does not depend on its place, on the others, or on their number; not even where another one is infinite.
TEST(SplitColumns, DependOnNoOtherColumn) {
  std::mt19937 random(6);
  for (const int dimension : {2, 3}) {
    const Factored soil(dimension);
    std::vector<Vector> b = loads(soil.matrix.rows(), 21, random);
    for (const Half half : {&SplitFactor::forward_all, &SplitFactor::backward_all}) {
      const std::vector<Vector> all = together(*soil.factor, half, b);
      for (std::size_t k = 0; k < b.size(); ++k) EXPECT_TRUE(together(*soil.factor, half, {b[k]})[0] == all[k]) << k;
      std::vector<Vector> turned(b.rbegin(), b.rend());
      turned[3].setConstant(INFINITY);
      const std::vector<Vector> other = together(*soil.factor, half, turned);
      for (std::size_t k = 0; k < b.size(); ++k)
        if (k != 3) EXPECT_TRUE(other[k] == all[b.size() - 1 - k]) << k;
    }
  }
}

// Claim: no column, an empty system of columns, and a zero column are what they are.
TEST(SplitColumns, ZeroAndNone) {
  const Factored soil(2);
  EXPECT_TRUE(together(*soil.factor, &SplitFactor::forward_all, {}).empty());
  const Vector zero = Vector::Zero(soil.matrix.rows());
  EXPECT_TRUE(together(*soil.factor, &SplitFactor::backward_all, {zero})[0] == zero);
}

}  // namespace
}  // namespace uplift::split_columns_test
