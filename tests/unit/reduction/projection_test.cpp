// Bases, and structures in the coordinates of a basis.
#include "uplift/reduction/projection.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "uplift/linear/singular_values.h"
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

// A = Q diag(s) R^T with more rows than columns, and with fewer.
TEST(SingularValues, OfTallWideAndEmptyMatrices) {
  const Vector singular{{3.0, 2.0, 1e-3, 1e-9}};
  for (const auto& [rows, columns] : {std::pair<Index, Index>{9, 4}, {4, 9}, {4, 4}, {9, 7}, {7, 9}}) {
    const Matrix a = with_singular_values(singular, Vector::Ones(rows), columns);
    const SingularValues found(a);
    const Index count = std::min(rows, columns);
    ASSERT_EQ(found.values().size(), count);
    ASSERT_EQ(found.left().rows(), rows);
    ASSERT_EQ(found.left().cols(), count);
    for (Index k = 0; k < count; ++k) EXPECT_NEAR(found.values()[k], k < 4 ? singular[k] : 0, 1e-14) << rows << "x" << columns;
    EXPECT_LT((found.left().transpose() * found.left() - Matrix::Identity(count, count)).cwiseAbs().maxCoeff(), 1e-14);
    // U^T A has rows of these lengths, at right angles to one another
    const Matrix turned = found.left().transpose() * a;
    const Vector squares = found.values().cwiseAbs2();
    EXPECT_LT((turned * turned.transpose() - Matrix(squares.asDiagonal())).cwiseAbs().maxCoeff(), 1e-13);
  }
  EXPECT_EQ(SingularValues(Matrix(0, 5)).values().size(), 0);
  EXPECT_EQ(SingularValues(Matrix(5, 0)).left().cols(), 0);
}

void add(Matrix displacements, Pod& pod) {
  pod.add(displacements);
}

TEST(Pod, FindsSingularValuesOverTwelveDecadesBatchByBatch) {
  const Index rows = 60, columns = 45, count = 13;
  Vector singular(count), weights(rows);
  for (Index k = 0; k < count; ++k) singular[k] = std::pow(10.0, -static_cast<double>(k));
  for (Index i = 0; i < rows; ++i) weights[i] = 1 + static_cast<double>(i);
  const Matrix x = with_singular_values(singular, weights, columns);
  const EnergyProduct product(diagonal(weights), Sparse(rows, rows), 0);
  const Matrix nothing(rows, 0);
  Pod pod(product, nothing, 1e-10, 100);
  for (const auto& [first, width] : {std::pair<Index, Index>{0, 10}, {10, 1}, {11, 30}, {41, 4}}) add(x.middleCols(first, width), pod);
  ASSERT_GE(pod.values().size(), 9);
  for (Index k = 0; k < 9; ++k) EXPECT_NEAR(pod.values()[k], singular[k], 1e-5 * singular[k]) << k;
  const Matrix gram = pod.basis().transpose() * product.times(pod.basis());
  EXPECT_LT((gram - Matrix::Identity(gram.rows(), gram.cols())).cwiseAbs().maxCoeff(), 1e-12);
  const Matrix rest = x - pod.basis() * (pod.basis().transpose() * product.times(x));
  EXPECT_LT((weights.cwiseSqrt().asDiagonal() * rest).norm(), 1e-9);
}

TEST(Pod, KeepsNothingOfNothingAndNoMoreThanItMay) {
  const EnergyProduct product(diagonal(Vector::Ones(8)), Sparse(8, 8), 0);
  const Matrix nothing(8, 0);
  Pod pod(product, nothing, 1e-9, 3);
  add(Matrix::Zero(8, 4), pod);
  EXPECT_EQ(pod.basis().cols(), 0);
  add(random_matrix(8, 20, 3), pod);
  EXPECT_EQ(pod.basis().cols(), 3);
  add(Matrix(8, 0), pod);
  EXPECT_EQ(pod.basis().cols(), 3);
}

// What is given beside the basis takes its part: the rest is decomposed, and both together are orthonormal.
TEST(Pod, LeavesOutWhatOtherVectorsRepresent) {
  const Index rows = 40;
  const Vector weights = Vector::LinSpaced(rows, 1, 9), singular{{1.0, 1e-2, 1e-4}};
  const EnergyProduct product(diagonal(weights), Sparse(rows, rows), 0);
  Matrix beside = random_matrix(rows, 5, 5), of_rest = with_singular_values(singular, weights, 12);
  EXPECT_EQ(orthonormalise(product, Matrix(rows, 0), 1e-10, beside), 5);
  of_rest -= beside * (beside.transpose() * product.times(of_rest));
  const Matrix nothing(rows, 0);
  Pod alone(product, nothing, 1e-9, 20), pod(product, beside, 1e-9, 20);
  add(of_rest, alone);
  const Matrix all = of_rest + 100 * beside * random_matrix(5, 12, 6);
  add(all, pod);
  ASSERT_EQ(pod.values().size(), 3);
  for (Index k = 0; k < 3; ++k) EXPECT_NEAR(pod.values()[k], alone.values()[k], 1e-8 * alone.values()[k]) << k;
  EXPECT_NEAR(pod.energy(), all.cwiseProduct(product.times(all)).sum(), 1e-12 * pod.energy());
  EXPECT_LT((beside.transpose() * product.times(pod.basis())).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(Orthonormalise, KeepsWhatIsNewBesideABasis) {
  const EnergyProduct product(diagonal(Vector::LinSpaced(12, 1, 5)), Sparse(12, 12), 0);
  Matrix basis = random_matrix(12, 4, 7);
  ASSERT_EQ(orthonormalise(product, Matrix(12, 0), 1e-10, basis), 4);
  const Matrix fresh = random_matrix(12, 3, 8);
  Matrix vectors(12, 5);
  vectors << fresh.leftCols(2), basis * Vector::LinSpaced(4, 1, 2), fresh.leftCols(2) * Vector::Ones(2), fresh.col(2);
  ASSERT_EQ(orthonormalise(product, basis, 1e-10, vectors), 3);
  Matrix both(12, 7);
  both << basis, vectors;
  EXPECT_LT((both.transpose() * product.times(both) - Matrix::Identity(7, 7)).cwiseAbs().maxCoeff(), 1e-13);
  EXPECT_LT((fresh - both * (both.transpose() * product.times(fresh))).norm(), 1e-12 * fresh.norm());
}

TEST(SymmetricProduct, OfAnyNumberOfColumnsIsThatOfTheFullMatrix) {
  const Index n = 33;
  Matrix full = random_matrix(n, n, 9);
  for (double& value : full.reshaped())
    if (std::abs(value) < 1) value = 0;
  full = (full + full.transpose()).eval();
  const Sparse sparse = full.sparseView();
  for (const Index columns : {0, 1, 3, 4, 5, 16, 17, 20, 21, 37}) {
    const Matrix x = random_matrix(n, columns, 10), begun = random_matrix(n, columns, 11);
    Matrix y = begun;
    add_symmetric_product(-2.5, sparse, x, y);
    EXPECT_LE((y - (begun - 2.5 * full * x)).norm(), 1e-13 * full.norm() * (1 + x.norm())) << columns;
  }
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
// The modes of a reduced model are its natural modes: the same frequencies, in the same space of displacements. Rayleigh damping is
// diagonal in them, a dashpot is not.
TEST(ProjectOnModes, GivesTheFrequenciesOfTheReducedModelAndKeepsItsSpace) {
  const Index n = 40, k = 9;
  const double w = 3;
  for (const bool dashpot : {false, true}) {
    Model plain, turned;
    const Matrix spread = random_matrix(n, n, 5);
    for (Model* model : {&plain, &turned}) {
      model->stiffness = Sparse(Matrix(spread * spread.transpose()).sparseView());
      model->mass = diagonal(random_matrix(n, 1, 6).cwiseAbs().array() + 0.1);
      model->damping = 0.03 * model->stiffness + 0.2 * model->mass;
      if (dashpot) model->damping.coeffRef(7, 7) += 5;
      model->expansion = diagonal(Vector::Ones(n));
    }
    const Sparse damping = plain.damping;
    const EnergyProduct product(plain.stiffness, plain.mass, w);
    Matrix basis = random_matrix(n, k, 7);
    ASSERT_EQ(orthonormalise(product, Matrix(n, 0), 1e-10, basis), k);
    const Matrix before = basis;
    project(plain, before);
    project_on_modes(turned, w, basis);
    EXPECT_EQ(turned.stiffness.nonZeros(), k);
    EXPECT_EQ(turned.mass.nonZeros(), k);
    EXPECT_EQ(turned.damping.nonZeros(), dashpot ? k * k : k);
    const Vector squared = GeneralisedEigen(Matrix(plain.stiffness), Matrix(plain.mass)).eigenvalues();
    Vector own = turned.stiffness.diagonal().cwiseQuotient(turned.mass.diagonal());
    std::ranges::sort(own);
    EXPECT_LT((own - squared).cwiseQuotient(squared).cwiseAbs().maxCoeff(), 1e-11);
    EXPECT_LT((basis - before * (before.transpose() * product.times(basis))).norm(), 1e-12 * basis.norm());
    const Matrix exact = basis.transpose() * Matrix(damping) * basis;
    EXPECT_LT((Matrix(turned.damping) - exact).norm(), 1e-12 * exact.norm());
    EXPECT_LT((Matrix(turned.reduction()) - basis).norm(), 1e-15 * basis.norm());
  }
}

}  // namespace uplift::projection_test
