#include "uplift/linear/solver.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <thread>

#include "uplift/contact/compliance.h"
#include "uplift/distributed/ranks.h"
#include "uplift/linear/large.h"
#include "uplift/linear/memory.h"
#include "uplift/math/dense.h"

namespace uplift {
namespace {

std::unique_ptr<const LinearSolver> petsc(const std::string& options = "") {
  auto table = std::make_shared<RawTable>();
  table->entries.emplace_back("type", Raw{std::string("petsc"), {"case.toml", 3}, "solver.type"});
  table->entries.emplace_back("options", Raw{options, {"case.toml", 4}, "solver.options"});
  return make_part(solver_catalog(), check_part(Raw{table, {"case.toml", 3}, "solver"}, linear_solvers()));
}

const char* const iterative = "-ksp_type cg -pc_type jacobi";

/// Laplacian of a grid of n x n x n points, held outside of it; `shift` is added to the diagonal.
Sparse laplacian(int n, double shift = 0) {
  std::vector<Triplet> entries;
  const int steps[] = {1, n, n * n};
  for (int i = 0; i < n * n * n; ++i) {
    entries.emplace_back(i, i, 6 + shift);
    const int place[] = {i % n, i / n % n, i / (n * n)};
    for (int axis = 0; axis < 3; ++axis)
      if (place[axis] > 0) {
        entries.emplace_back(i, i - steps[axis], -1);
        entries.emplace_back(i - steps[axis], i, -1);
      }
  }
  Sparse a(n * n * n, n * n * n);
  a.setFromTriplets(entries.begin(), entries.end());
  return a;
}

/// Eigenvalue of the Laplacian for the shape sin(p x) sin(q y) sin(r z): 2 (3 - cos - cos - cos).
double eigenvalue(int n, int p, int q, int r) {
  const double angle = M_PI / (n + 1);
  return 2 * (3 - std::cos(p * angle) - std::cos(q * angle) - std::cos(r * angle));
}

Vector shape(int n, int p, int q, int r) {
  const double angle = M_PI / (n + 1);
  Vector x(n * n * n);
  for (int i = 0; i < x.size(); ++i)
    x[i] = std::sin(p * angle * (i % n + 1)) * std::sin(q * angle * (i / n % n + 1)) * std::sin(r * angle * (i / (n * n) + 1));
  return x;
}

TEST(Petsc, SolvesForEigenvectorsWithTheirEigenvalues) {
  constexpr int n = 9;
  Matrix b(n * n * n, 40), x;  // more columns than are sent at once
  for (int c = 0; c < b.cols(); ++c) b.col(c) = shape(n, 1 + c % 3, 1 + c % 4, 1 + c % 5);
  for (const char* options : {"", iterative, "-ksp_type cg -pc_type bjacobi", "-ksp_type cg -pc_type cholesky", "-pc_type gamg"}) {
    const Sparse a = 1e7 * laplacian(n);
    const Factorisation made = petsc(options)->factorise(a.triangularView<upper_triangle>());
    ASSERT_TRUE(made.factor) << options << made.why;
    made.factor->solve(b, x);
    for (int c = 0; c < b.cols(); ++c) {
      const Vector exact = b.col(c) / (1e7 * eigenvalue(n, 1 + c % 3, 1 + c % 4, 1 + c % 5));
      EXPECT_LE((x.col(c) - exact).norm(), 1e-10 * exact.norm()) << options;
    }
    Matrix same = b.leftCols(1);
    made.factor->solve(same, same);  // in place
    EXPECT_LE((same - x.leftCols(1)).norm(), 1e-10 * same.norm()) << options;
    EXPECT_GT(made.factor->nonzeros(), 0);
  }
}

TEST(Petsc, TakesFewerUnknownsThanRanksAndMatricesOfAnyScale) {
  Sparse a(1, 1);
  a.insert(0, 0) = 4e20;
  Matrix x = Matrix::Constant(1, 1, 8e20);
  const Factorisation one = petsc()->factorise(a);
  ASSERT_TRUE(one.factor) << one.why;
  one.factor->solve(x, x);
  EXPECT_NEAR(x(0, 0), 2, 1e-14);
  Vector sizes(3);
  sizes << 1e-12, 1, 1e15;
  const Factorisation wide = petsc()->factorise(Sparse(sizes.asDiagonal()));
  ASSERT_TRUE(wide.factor) << wide.why;
  x = sizes;
  wide.factor->solve(x, x);
  EXPECT_LE((x - Matrix::Ones(3, 1)).norm(), 1e-14);
}

TEST(Petsc, RefusesWhatIsNotPositiveDefinite) {
  // the shift makes as many eigenvalues negative as lie below it: that of (1, 1, 1), not those of (1, 1, 2)
  constexpr int n = 6;
  const double shift = -0.5 * (eigenvalue(n, 1, 1, 1) + eigenvalue(n, 1, 1, 2));
  const Factorisation indefinite = petsc()->factorise(laplacian(n, shift));
  EXPECT_FALSE(indefinite.factor);
  EXPECT_EQ(indefinite.why, "the matrix is not positive definite: of its pivots 1 are negative and 0 are round-off");
  const Factorisation by_iterations = petsc(iterative)->factorise(laplacian(n, shift));
  EXPECT_FALSE(by_iterations.factor);
  EXPECT_NE(by_iterations.why.find("INDEFINITE"), std::string::npos) << by_iterations.why;

  Sparse loose = laplacian(3);  // an unknown without stiffness
  loose.coeffRef(7, 7) = 0;
  const Factorisation zero = petsc()->factorise(loose);
  EXPECT_EQ(zero.failed_unknown, 7);
  EXPECT_FALSE(zero.factor);

  // two bodies of springs that nothing holds: one vanishing pivot each
  std::vector<Triplet> entries;
  for (const int first : {0, 5})
    for (int i = first; i < first + 4; ++i)
      for (const auto& [row, column, sign] : {std::tuple(i, i, 3.0), std::tuple(i + 1, i + 1, 3.0), std::tuple(i, i + 1, -3.0)})
        entries.emplace_back(row, column, sign);
  Sparse floating(10, 10);
  floating.setFromTriplets(entries.begin(), entries.end());
  const Factorisation rigid = petsc()->factorise(floating);
  EXPECT_FALSE(rigid.factor);
  EXPECT_NE(rigid.why.find("not positive definite"), std::string::npos) << rigid.why;
}

TEST(Petsc, IterationsThatDoNotConvergeAreAReason) {
  // what happens at one end of a chain of springs is felt one spring farther with every iteration
  constexpr int n = 3000;
  std::vector<Triplet> entries;
  for (int i = 0; i < n; ++i) {
    entries.emplace_back(i, i, 2.0);
    if (i > 0) entries.emplace_back(i - 1, i, -1.0);
  }
  Sparse chain(n, n);
  chain.setFromTriplets(entries.begin(), entries.end());
  const Factorisation hard = petsc("-ksp_type cg -ksp_max_it 300")->factorise(chain);
  EXPECT_FALSE(hard.factor);
  EXPECT_EQ(hard.why, "the solver \"cg\" of PETSc did not converge in 300 iterations (DIVERGED_ITS)");
}

/// Beside what the system says that the process holds more of after the factorisation. The forecast is one of the largest need during it.
TEST(Petsc, MemoryOfMumpsIsForetold) {
  const Sparse a = laplacian(32);
  const auto solver = petsc();
  const FactorCost cost = solver->predict(a, {});
  EXPECT_EQ(cost.why, "");
  give_back_free_memory();
  const double before = resident_memory();
  const Factorisation made = solver->factorise(a);
  ASSERT_TRUE(made.factor) << made.why;
  const double taken = resident_memory() - before;
  std::printf("memory of rank 0: %.1f MB foretold, %.1f MB taken; elsewhere %.1f and %.1f MB\n", 1e-6 * cost.bytes, 1e-6 * taken,
              1e-6 * cost.most_elsewhere, 1e-6 * cost.beside);
  EXPECT_NEAR(cost.entries / made.factor->nonzeros(), 1, 0.02);
  EXPECT_GE(cost.bytes, 0.8 * taken);
  EXPECT_LE(cost.bytes, 1.6 * taken);
  int ranks = 1;
  MPI_Comm_size(PETSC_COMM_WORLD, &ranks);
  EXPECT_EQ(cost.most_elsewhere > 0, ranks > 1);
  EXPECT_GE(cost.beside, cost.most_elsewhere);  // all ranks of the test are on one machine
}

TEST(Petsc, MemoryOfConjugateGradientsIsThatOfTheRowsAndSomeVectors) {
  constexpr int n = 20;
  const Sparse a = laplacian(n);
  const FactorCost cost = petsc(iterative)->predict(a, {});
  int ranks = 1;
  MPI_Comm_size(PETSC_COMM_WORLD, &ranks);
  EXPECT_EQ(cost.entries, 0);
  const double entries = 7.0 * n * n * n - 6.0 * n * n;  // both triangles: six neighbours but for the faces
  EXPECT_NEAR(ranks * cost.bytes, 12 * entries + 64.0 * n * n * n, 0.1 * 12 * entries);
}

/// Their number is printed: tests/mpi/test_mpi.py compares it between numbers of ranks.
TEST(Petsc, ConjugateGradientsAreCounted) {
  const Factorisation made = petsc(iterative)->factorise(laplacian(24, 0.01));
  ASSERT_TRUE(made.factor) << made.why;
  const long before = Ranks::all().iterations();
  Matrix x = Vector::LinSpaced(24 * 24 * 24, -1, 2);
  made.factor->solve(x, x);
  const long iterations = Ranks::all().iterations() - before;
  // error bound of conjugate gradients for the condition number of the matrix: 2 ((sqrt(c) - 1) / (sqrt(c) + 1))^k
  const double c = (eigenvalue(24, 24, 24, 24) + 0.01) / (eigenvalue(24, 1, 1, 1) + 0.01), rate = (std::sqrt(c) - 1) / (std::sqrt(c) + 1);
  EXPECT_LE(static_cast<double>(iterations), std::log(1e-12 / (2 * std::sqrt(c))) / std::log(rate) + 1);
  EXPECT_GT(iterations, 12);  // a force at a face is felt in the middle
  std::printf("conjugate gradients: %ld iterations\n", iterations);
}

TEST(Petsc, FactorsLiveSideBySideAndServeSeveralThreads) {
  constexpr int n = 6;
  const auto solver = petsc();
  std::vector<Factorisation> factors;
  for (int k = 0; k < 3; ++k) factors.push_back(solver->factorise((1.0 + k) * laplacian(n)));
  factors.erase(factors.begin());
  const Matrix b = shape(n, 1, 2, 1);
  std::vector<double> errors(4, 1);
  {
    std::vector<std::jthread> threads;
    for (std::size_t t = 0; t < errors.size(); ++t)
      threads.emplace_back([&, t] {
        Matrix x;
        double worst = 0;
        for (int round = 0; round < 10; ++round) {
          factors[t % 2].factor->solve(b, x);
          const double scale = (2.0 + static_cast<double>(t % 2)) * eigenvalue(n, 1, 2, 1);
          worst = std::max(worst, (scale * x - b).norm() / b.norm());
        }
        errors[t] = worst;
      });
  }
  for (const double error : errors) EXPECT_LE(error, 1e-12);
}

TEST(Petsc, HalvesOfABackSolveAreThoseOfAFactorWithTheChosenUnknownsLast) {
  const Sparse a = laplacian(3);
  const std::vector<int> last{20, 3, 11, 4};
  const Matrix inverse = PivotedLdlt(Matrix(a)).solve(Matrix::Identity(27, 27));
  for (const char* options : {"", iterative}) {
    const SplitFactorisation made = petsc(options)->factorise_split(a, last);
    ASSERT_TRUE(made.factor) << made.why;
    const Matrix l = made.factor->last();
    EXPECT_EQ(l.triangularView<Eigen::StrictlyUpper>().toDenseMatrix().norm(), 0);
    Matrix exact(4, 4);
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j) exact(i, j) = inverse(last[static_cast<std::size_t>(i)], last[static_cast<std::size_t>(j)]);
    EXPECT_LE((l.transpose() * exact * l - Matrix::Identity(4, 4)).norm(), 1e-10);  // L^-T L^-1 = (A^-1)_tt
    const Vector b = Vector::LinSpaced(27, -1, 3), force = Vector::LinSpaced(4, 1, 2);
    Vector y, x, on_chosen = Vector::Zero(27);
    made.factor->forward(b, y);
    made.factor->backward(y, x);
    EXPECT_LE((x - inverse * b).norm(), 1e-10 * x.norm());
    // a force on the chosen unknowns, as a change of the tail, with a load and without one
    for (int k = 0; k < 4; ++k) on_chosen[last[static_cast<std::size_t>(k)]] = force[k];
    const Vector tail = l.triangularView<lower_triangle>().solve(force);
    y.tail(4) += tail;
    made.factor->backward(y, x);
    EXPECT_LE((x - inverse * (b + on_chosen)).norm(), 1e-10 * x.norm());
    y.setZero(27);
    y.tail(4) = tail;
    made.factor->backward(y, x);
    EXPECT_LE((x - inverse * on_chosen).norm(), 1e-10 * x.norm());
  }
}

TEST(Petsc, FlexibilityOfMoreUnknownsThanOneBlockHasIsThatOfTheInverse) {
  constexpr int n = 5, count = 70, size = n * n * n;
  Vector sizes(size);
  for (int i = 0; i < size; ++i) sizes[i] = std::pow(10.0, i % 7 - 3);
  const Sparse a = sizes.asDiagonal() * laplacian(n) * sizes.asDiagonal();
  std::vector<int> chosen;
  for (int k = 0; k < count; ++k) chosen.push_back(k * 73 % size);  // all different, on every rank, in no order
  const Matrix inverse = PivotedLdlt(Matrix(laplacian(n))).solve(Matrix::Identity(size, size));
  for (const char* options : {"", iterative}) {
    const SplitFactorisation made = petsc(options)->factorise_split(a, chosen);
    ASSERT_TRUE(made.factor) << made.why;
    const Matrix half = made.factor->last().triangularView<lower_triangle>().solve(Matrix::Identity(count, count));
    const Matrix found = half.transpose() * half;  // L^-T L^-1
    for (int i = 0; i < count; ++i)
      for (int j = 0; j < count; ++j) {
        const int row = chosen[static_cast<std::size_t>(i)], column = chosen[static_cast<std::size_t>(j)];
        EXPECT_NEAR(found(i, j) * sizes[row] * sizes[column], inverse(row, column), 1e-9) << options << i << j;
      }
  }
}

TEST(Petsc, ComplianceOfRowsIsThatOfTheInverse) {
  const Sparse a = laplacian(3);
  Matrix rows = Matrix::Zero(5, 27);
  for (int i = 0; i < 5; ++i) rows(i, 3 * i) = 1 + i, rows(i, 20) = -1;
  const Sparse b = rows.sparseView();
  const Factorisation made = petsc()->factorise(a);
  ASSERT_TRUE(made.factor) << made.why;
  const Spread spread = spread_through(*made.factor, b);
  const Matrix exact = rows * PivotedLdlt(Matrix(a)).solve(rows.transpose());
  EXPECT_LE((spread.factor * spread.factor.transpose() - exact).norm(), 1e-11 * exact.norm());
}

}  // namespace
}  // namespace uplift
