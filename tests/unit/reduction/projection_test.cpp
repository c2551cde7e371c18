// Bases, and structures in the coordinates of a basis.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "uplift/linear/solver.h"
#include "uplift/math/dense.h"
#include "uplift/reduction/linear_march.h"
#include "uplift/reduction/pod.h"

namespace uplift::projection_test {
namespace {

Matrix random_matrix(Index rows, Index columns, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  Matrix made(rows, columns);
  for (double& value : made.reshaped()) value = normal(random);
  return made;
}

Sparse diagonal(const Vector& values) {
  return Sparse(Matrix(values.asDiagonal()).sparseView());
}

/// Displacements x = sum of s_k q_k r_k^T with known singular values in the product with the weights w.
Matrix with_singular_values(const Vector& singular, const Vector& weights, Index columns) {
  const Index rows = weights.size(), count = singular.size();
  const Matrix q = columns_of_q(Qr(random_matrix(rows, count, 1)), count), r = columns_of_q(Qr(random_matrix(columns, count, 2)), count);
  return weights.cwiseSqrt().cwiseInverse().asDiagonal() * (q * singular.asDiagonal() * r.transpose());
}

TEST(Pod, FindsSingularValuesOverTwelveDecadesBatchByBatch) {
  const Index rows = 60, columns = 45, count = 13;
  Vector singular(count), weights(rows);
  for (Index k = 0; k < count; ++k) singular[k] = std::pow(10.0, -static_cast<double>(k));
  for (Index i = 0; i < rows; ++i) weights[i] = 1 + static_cast<double>(i);
  const Matrix x = with_singular_values(singular, weights, columns);
  const EnergyProduct product(diagonal(weights), Sparse(rows, rows), 0);
  Pod pod(product, rows, 1e-10, 100);
  for (const auto& [first, width] : {std::pair<Index, Index>{0, 10}, {10, 1}, {11, 30}, {41, 4}}) pod.add(x.middleCols(first, width));
  ASSERT_GE(pod.values().size(), 9);
  for (Index k = 0; k < 9; ++k) EXPECT_NEAR(pod.values()[k], singular[k], 1e-5 * singular[k]) << k;
  const Matrix gram = pod.basis().transpose() * product.times(pod.basis());
  EXPECT_LT((gram - Matrix::Identity(gram.rows(), gram.cols())).cwiseAbs().maxCoeff(), 1e-12);
  const Matrix rest = x - pod.basis() * (pod.basis().transpose() * product.times(x));
  EXPECT_LT((weights.cwiseSqrt().asDiagonal() * rest).norm(), 1e-9);
}

TEST(Pod, KeepsNothingOfNothingAndNoMoreThanItMay) {
  const EnergyProduct product(diagonal(Vector::Ones(8)), Sparse(8, 8), 0);
  Pod pod(product, 8, 1e-9, 3);
  pod.add(Matrix::Zero(8, 4));
  EXPECT_EQ(pod.basis().cols(), 0);
  pod.add(random_matrix(8, 20, 3));
  EXPECT_EQ(pod.basis().cols(), 3);
  pod.add(Matrix(8, 0));
  EXPECT_EQ(pod.basis().cols(), 3);
}

TEST(Append, TakesWhatIsNewAndLeavesTheRest) {
  const EnergyProduct product(diagonal(Vector::LinSpaced(6, 1, 6)), Sparse(6, 6), 0);
  const Matrix given = random_matrix(6, 3, 4);
  Matrix basis(6, 0);
  for (Index k = 0; k < 3; ++k) append(product, given.col(k), 1e-10, basis);
  append(product, given * Vector::LinSpaced(3, -1, 1), 1e-10, basis);  // nothing new
  append(product, Vector::Zero(6), 1e-10, basis);
  ASSERT_EQ(basis.cols(), 3);
  const Matrix gram = basis.transpose() * product.times(basis);
  EXPECT_LT((gram - Matrix::Identity(3, 3)).cwiseAbs().maxCoeff(), 1e-13);
}

// After a load the trapezoidal rule swings with the frequency 2/h atan(w h/2): u(n + 1) + u(n - 1) = 2 cos(2 atan(w h/2)) u(n).
TEST(LinearMarch, SwingsWithTheFrequencyOfTheTrapezoidalRule) {
  const double h = 0.02;
  const Vector stiffness{{400.0, 9e3}}, mass{{2.0, 3.0}};
  const Sparse k = diagonal(stiffness), c(2, 2), m = diagonal(mass);
  const std::unique_ptr<const LinearSolver> solver =
      solver_catalog().front()->make(check_part(Raw{std::string("dense"), {}, "solver"}, linear_solvers()));
  LinearMarch march(k, c, m, h, *solver);
  ASSERT_EQ(march.why(), "");
  march.start(2);
  std::vector<Matrix> u;
  for (int step = 0; step < 40; ++step) {
    march.advance([](double time, Matrix& load) { load = time < 0.05 ? Matrix(Matrix::Identity(2, 2)) : Matrix(Matrix::Zero(2, 2)); });
    u.push_back(march.displacement());
  }
  for (Index i = 0; i < 2; ++i) {
    const double w = std::sqrt(stiffness[i] / mass[i]), factor = 2 * std::cos(2 * std::atan(0.5 * w * h));
    EXPECT_GT(std::abs(u[10](i, i)), 1e-6);
    EXPECT_EQ(u[10](i, 1 - i), 0);
    for (std::size_t n = 10; n + 1 < u.size(); ++n)
      EXPECT_NEAR(u[n + 1](i, i) + u[n - 1](i, i), factor * u[n](i, i), 1e-12 * std::abs(u[10](i, i)) + 1e-14);
  }
}

}  // namespace
}  // namespace uplift::projection_test
