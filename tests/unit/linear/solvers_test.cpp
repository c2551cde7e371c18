#include <gtest/gtest.h>

#include <thread>

#include "unit/linear/local_solvers.h"
#include "unit/model/model_support.h"
#include "uplift/contact/compliance.h"
#include "uplift/linear/solver.h"
#include "uplift/math/dense.h"
#include "uplift/math/vibration.h"

namespace uplift::solvers_test {
namespace {

using std::numbers::pi;

/// Five-point Laplacian on an n x n grid: positive definite.
Sparse laplacian(int n) {
  std::vector<Triplet> entries;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const int here = i * n + j;
      entries.emplace_back(here, here, 4.0);
      if (i > 0) entries.emplace_back(here, here - n, -1), entries.emplace_back(here - n, here, -1);
      if (j > 0) entries.emplace_back(here, here - 1, -1), entries.emplace_back(here - 1, here, -1);
    }
  Sparse a(n * n, n * n);
  a.setFromTriplets(entries.begin(), entries.end());
  return a;
}

/// Chain of springs k between n masses; `held`: also from ground to the first one.
Sparse chain(int n, double k, bool held) {
  std::vector<Triplet> entries;
  for (int i = 0; i + 1 < n; ++i)
    for (const auto& [a, b, v] : {std::tuple(i, i, k), std::tuple(i + 1, i + 1, k), std::tuple(i, i + 1, -k), std::tuple(i + 1, i, -k)})
      entries.emplace_back(a, b, v);
  if (held) entries.emplace_back(0, 0, k);
  Sparse a(n, n);
  a.setFromTriplets(entries.begin(), entries.end());
  return a;
}

Sparse diagonal(const Vector& values) {
  Sparse a(values.size(), values.size());
  for (Index i = 0; i < values.size(); ++i)
    if (values[i] != 0) a.insert(i, i) = values[i];
  return a;
}

Matrix random_spd(Index n, double condition) {
  const Matrix q = columns_of_q(Qr(Matrix::Random(n, n)), n);
  const Vector values = (Vector::LinSpaced(n, 0, std::log(condition))).array().exp();
  return q * values.asDiagonal() * q.transpose();
}

TEST(Solvers, AreInTheirCatalogAndAgree) {
  ASSERT_EQ(solver_catalog().size(), 4u);
  EXPECT_EQ(solver_catalog()[3]->name, "petsc");
  EXPECT_EQ(solver_catalog()[0]->name, "cholmod");
  EXPECT_EQ(linear_solvers().size(), 4u);
  for (const Sparse& a :
       {laplacian(17), Sparse(random_spd(40, 1e6).sparseView()), diagonal(Vector::LinSpaced(5, 1, 9)), Sparse(1e7 * laplacian(3))})
    for (const Entry<LinearSolver>* entry : local_solvers()) {
      const auto solver = entry->make(Values());
      const Factorisation result = solver->factorise(a);
      ASSERT_TRUE(result.factor) << entry->name << result.why;
      EXPECT_EQ(result.failed_unknown, -1);
      EXPECT_GT(result.factor->nonzeros(), 0);
      const Matrix exact = Matrix::Random(a.rows(), 7), b = a * exact;
      Matrix x;
      result.factor->solve(b, x);
      EXPECT_LE((a * x - b).norm(), 1e-12 * b.norm()) << entry->name;
      EXPECT_LE((x - exact).norm(), 1e-9 * exact.norm()) << entry->name;
      Matrix same = b.col(2);
      result.factor->solve(same, same);  // in place, another number of columns
      EXPECT_LE((same - exact.col(2)).norm(), 1e-9 * exact.norm()) << entry->name;
      const Factorisation half = solver->factorise(a.triangularView<upper_triangle>());
      ASSERT_TRUE(half.factor) << entry->name << half.why;
      half.factor->solve(b, x);
      EXPECT_LE((x - exact).norm(), 1e-9 * exact.norm()) << entry->name;
    }
}

TEST(Solvers, PetscNeedsItsProgram) {
  try {
    make_part(solver_catalog(), check_part(Raw{std::string("petsc"), {"case.toml", 7}, "solver"}, linear_solvers()));
    FAIL();
  } catch (const InputError& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("case.toml:7"), std::string::npos) << text;
    EXPECT_NE(text.find("needs the program uplift-mpi"), std::string::npos) << text;
  }
}

TEST(Solvers, NameTheUnknownThatIsLoose) {
  Sparse singular = chain(6, 3.0, true);  // unknown 6 has nothing
  singular.conservativeResize(7, 7);
  singular.insert(6, 6) = 0;
  Sparse indefinite = laplacian(4);
  indefinite.coeffRef(9, 9) = -2;
  const Sparse floating = chain(6, 3.0, false);
  for (const Entry<LinearSolver>* entry : local_solvers()) {
    const auto solver = entry->make(Values());
    const Factorisation empty = solver->factorise(singular), negative = solver->factorise(indefinite), loose = solver->factorise(floating);
    EXPECT_FALSE(empty.factor) << entry->name;
    EXPECT_EQ(empty.failed_unknown, 6) << entry->name;
    EXPECT_EQ(empty.why, "the matrix is not positive definite at unknown 6") << entry->name;
    EXPECT_FALSE(negative.factor) << entry->name;
    EXPECT_GE(negative.failed_unknown, 0) << entry->name;
    EXPECT_FALSE(loose.factor) << entry->name;  // singular by cancellation: only round-off is left in the last pivot
    EXPECT_GE(loose.failed_unknown, 0) << entry->name;
    EXPECT_LT(loose.failed_unknown, 6) << entry->name;
  }
}

TEST(Solvers, FactorsServeSeveralThreads) {
  const Sparse a = laplacian(30);
  for (const Entry<LinearSolver>* entry : local_solvers()) {
    const Factorisation result = entry->make(Values())->factorise(a);
    std::vector<double> errors(4, 1);
    std::vector<std::jthread> threads;
    for (int t = 0; t < 4; ++t)
      threads.emplace_back([&, t] {
        double worst = 0;
        for (int round = 0; round < 20; ++round) {
          const Matrix exact = Matrix::Constant(a.rows(), 1 + (t + round) % 3, t + 0.1 * round), b = a * exact;
          Matrix x;
          result.factor->solve(b, x);
          worst = std::max(worst, (x - exact).norm() / (1 + exact.norm()));
        }
        errors[t] = worst;
      });
    threads.clear();
    for (const double error : errors) EXPECT_LE(error, 1e-10) << entry->name;
  }
}

// ---- modes ----

TEST(Modes, ChainsInClosedForm) {
  const double k = 3e4, m = 7;
  for (const int n : {12, 700})  // dense, and Lanczos
    for (const bool held : {true, false}) {
      const auto found = modes(chain(n, k, held), diagonal(Vector::Constant(n, m)), 6);
      ASSERT_EQ(found.size(), 6u);
      for (int i = 0; i < 6; ++i) {
        const double w = 2 * std::sqrt(k / m) * std::sin(held ? (2 * i + 1) * pi / (2 * (2 * n + 1)) : i * pi / (2 * n));
        EXPECT_NEAR(found[i].frequency, w / (2 * pi), 1e-8 * w) << n << held << i;
        if (!held && i == 0) {
          EXPECT_EQ(found[i].frequency, 0);
        }
        EXPECT_NEAR(m * found[i].shape.squaredNorm(), 1, 1e-9);
        EXPECT_LE((chain(n, k, held) * found[i].shape - m * w * w * found[i].shape).norm(), 1e-8 * k * found[i].shape.norm())
            << n << held << i;
      }
    }
}

TEST(Modes, MasslessUnknownsAreCondensed) {
  // every second unknown of the chain has no mass: two springs in line, half the stiffness
  const double k = 3e4, m = 7;
  for (const int n : {11, 1201}) {
    Vector mass = Vector::Zero(2 * n);
    for (Index i = 1; i < 2 * n; i += 2) mass[i] = m;
    const auto found = modes(chain(2 * n, k, true), diagonal(mass), 5),
               condensed = modes(chain(n, k / 2, true), diagonal(Vector::Constant(n, m)), 5);
    ASSERT_EQ(found.size(), 5u);
    for (int i = 0; i < 5; ++i) {
      EXPECT_NEAR(found[i].frequency, condensed[i].frequency, 1e-9 * condensed[i].frequency);
      EXPECT_NEAR(found[i].shape[2], (found[i].shape[1] + found[i].shape[3]) / 2, 1e-9);  // the massless one lies between its neighbours
    }
  }
}

TEST(Modes, SemidefiniteMassBlocks) {
  // a mass m at the distance r from its node on a rotational and a translational spring: one mode, 1/w^2 = m/k + m r^2/k_r
  const double m = 5, r = 0.7, k = 1e4, k_r = 3e3;
  Matrix mass(2, 2), stiffness(2, 2);
  mass << m, m * r, m * r, m * r * r;
  stiffness << k, 0, 0, k_r;
  const Vibration found = vibration(stiffness, mass, 5);
  ASSERT_EQ(found.omega_squared.size(), 1);
  EXPECT_NEAR(1 / found.omega_squared[0], m / k + m * r * r / k_r, 1e-14);
  EXPECT_EQ(modes(Sparse(stiffness.sparseView()), Sparse(mass.sparseView()), 5).size(), 1u);
}

TEST(Modes, SlowModesAreToldFromRigidOnes) {
  // two bodies with a spring 1e-9 times softer than the one inside a body, floating: 0, slow, fast
  Matrix stiffness = Matrix::Zero(3, 3), mass = Matrix::Identity(3, 3);
  const auto spring = [&](int a, int b, double k) {
    stiffness(a, a) += k, stiffness(b, b) += k;
    stiffness(a, b) -= k, stiffness(b, a) -= k;
  };
  spring(0, 1, 1e-3);
  spring(1, 2, 1e6);
  const Vibration found = vibration(stiffness, mass, 3);
  EXPECT_EQ(found.omega_squared[0], 0);
  EXPECT_NEAR(found.omega_squared[1], 1.5e-3, 1e-8);  // 1 kg against 2 kg
  EXPECT_NEAR(found.omega_squared[2], 2e6, 10);
}

TEST(Modes, MasslessMechanismGivesNone) {
  const Sparse one_mass = diagonal(Vector::Unit(4, 1));
  EXPECT_TRUE(modes(diagonal(Vector::Unit(4, 1)), one_mass, 3).empty());
  EXPECT_TRUE(modes(chain(4, 1.0, false), diagonal(Vector::Zero(4)), 3).empty());  // nothing moves without mass
  EXPECT_TRUE(modes(chain(4, 1.0, true), diagonal(Vector::Zero(4)), 3).empty());
}

TEST(Modes, SemidefiniteRoot) {
  const Matrix w = Matrix::Random(9, 4), a = w * w.transpose(), root = semidefinite_root(a);
  EXPECT_EQ(root.cols(), 4);
  EXPECT_LE((root * root.transpose() - a).norm(), 1e-13 * a.norm());
}

TEST(Modes, FreeFreeBeamOfManyElements) {
  // slender and floating: three rigid motions, then beta L of cos x cosh x = 1; the stiffest unknown is 1e14 times stiffer than the first
  // mode
  const double EI = 1e6, rho_a = 200, length = 50;
  const int n = 300;
  ModelBuilder builder;
  for (int i = 0; i <= n; ++i) builder.add_node("n" + std::to_string(i), {length * i / n, 0}, support::here);
  for (int i = 0; i < n; ++i)
    support::add_beam(builder, i, i + 1, {length * i / n, 0}, {length * (i + 1) / n, 0}, support::general(EI, 1e9));
  const Model model = builder.finish();
  const auto found = modes(model.stiffness, model.mass, 6);
  ASSERT_EQ(found.size(), 6u);
  const double exact[] = {0, 0, 0, 4.730040744862704, 7.853204624095838, 10.995607838001671};
  for (int i = 0; i < 6; ++i) {
    const double w = exact[i] * exact[i] / (length * length) * std::sqrt(EI / rho_a);
    EXPECT_NEAR(2 * pi * found[i].frequency, w, 2e-6 * w) << i;
  }
}

// ---- spread ----

/// Counts the right-hand sides.
class CountedFactor : public Factor {
 public:
  explicit CountedFactor(const Factor& factor) : factor_(factor) {}
  void solve(const Matrix& b, Matrix& x) const override {
    columns += b.cols();
    factor_.solve(b, x);
  }
  double nonzeros() const override { return factor_.nonzeros(); }
  mutable Index columns = 0;

 private:
  const Factor& factor_;
};

TEST(Spread, IdentitiesWithRedundantRows) {
  std::srand(4);
  for (const auto& [n, rows, touched, rank] : {std::tuple(9, 4, 9, 4), std::tuple(9, 40, 3, 3), std::tuple(12, 7, 6, 2),
                                               std::tuple(12, 30, 12, 5), std::tuple(6, 1, 2, 1), std::tuple(5, 5, 5, 5)}) {
    const Matrix a = random_spd(n, 1e4);
    Matrix b = Matrix::Zero(rows, n);
    b.leftCols(touched) = Matrix::Random(rows, rank) * Matrix::Random(rank, touched);
    if (rank == touched) b.leftCols(touched) = Matrix::Random(rows, touched);
    const Sparse sparse = b.sparseView();
    for (const Entry<LinearSolver>* entry : local_solvers()) {
      const Factorisation result = entry->make(Values())->factorise(a.sparseView());
      const Spread spread = spread_through(*result.factor, sparse);
      ASSERT_EQ(spread.factor.cols(), rank) << n << " " << rows;
      ASSERT_EQ(spread.spread.cols(), rank);
      const Matrix answer = PivotedLdlt(a).solve(b.transpose()), compliance = b * answer;
      EXPECT_LE((spread.factor * spread.factor.transpose() - compliance).norm(), 1e-11 * compliance.norm());
      EXPECT_LE((spread.spread * spread.factor.transpose() - answer).norm(), 1e-11 * answer.norm());
    }
  }
}

/// An unknown that redundant rows touch by the round-off of their normals only adds no direction.
TEST(Spread, ColumnsOfRoundOffAddNoDirection) {
  std::srand(6);
  const Index n = 20, rows = 14, touched = 18, rank = 5;
  const Matrix a = random_spd(n, 1e4);
  Matrix b = Matrix::Zero(rows, n);
  b.leftCols(touched) = Matrix::Random(rows, rank) * Matrix::Random(rank, touched);
  b.col(touched) = 1e-17 * Vector::Random(rows);
  const Factorisation result = solver_catalog()[0]->make(Values())->factorise(a.sparseView());
  const Spread spread = spread_through(*result.factor, b.sparseView());
  ASSERT_EQ(spread.factor.cols(), rank);
  const Matrix answer = PivotedLdlt(a).solve(b.transpose());
  EXPECT_LE((spread.spread * spread.factor.transpose() - answer).norm(), 1e-11 * answer.norm());
}

TEST(Spread, RigidFootingNeedsThreeColumnsAndThreeSolves) {
  ModelBuilder builder;
  builder.add_node("base", {0, 0}, support::here);
  builder.add_node("top", {0, 5}, support::here);
  BeamSection column;
  column.bending = 4e9;
  column.axial = 1e10;
  support::add_beam(builder, 0, 1, {0, 0}, {0, 5}, column);
  builder.add_element(std::make_unique<PointMass>(0, 1e4, 7500.0), support::here);
  builder.add_element(std::make_unique<PointMass>(1, 2e4, 100.0), support::here);
  builder.add_interface(support::linear_interface("soil", footing_points({.body = 0, .width = 3, .points = 40}, support::here), {1e8, 2e8}),
                        support::here);
  const Model model = builder.finish();
  const Sparse a = model.stiffness + 4e6 * model.mass;
  const Factorisation result = solver_catalog()[0]->make(Values())->factorise(a);
  const CountedFactor counted(*result.factor);
  const Sparse& b = model.interfaces[0].b;
  const Spread spread = spread_through(counted, b);
  EXPECT_EQ(spread.factor.cols(), 3);
  EXPECT_EQ(counted.columns, 3);
  const Matrix answer = PivotedLdlt(Matrix(a)).solve(Matrix(b.transpose()));
  EXPECT_LE((spread.spread * spread.factor.transpose() - answer).norm(), 1e-12 * answer.norm());
  // without an interface nothing is spread
  EXPECT_EQ(spread_through(*result.factor, Sparse(0, model.free())).factor.cols(), 0);
}

}  // namespace
}  // namespace uplift::solvers_test
