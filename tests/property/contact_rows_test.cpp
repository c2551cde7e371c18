#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "property/contact_laws.h"
#include "unit/contact/contact_support.h"
#include "uplift/contact/newton/row_newton.h"

// Laws on independent rows: Newton's method with a kept factor (RowNewton), against a new factor in every iteration of the general method.
namespace uplift::contact_test::contact_rows_test {
namespace {

constexpr int points = 30, components = 3, rows = points * components, smooth = 16;

/// A regular factor of a compliance that falls with the distance of points [1e-4 m].
Matrix factor_of(std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(0, 1);
  const Matrix mix = Matrix::NullaryExpr(rows, rows, [&] { return 0.1 * (uniform(random) - 0.5); });
  Matrix compliance = mix * mix.transpose();
  for (Index a = 0; a < rows; ++a)
    for (Index b = 0; b < rows; ++b)
      compliance(a, b) += a / points == b / points ? std::exp(-0.5 * std::abs(static_cast<double>(a % points - b % points))) : 0;
  return 1e-4 * Matrix(Cholesky(compliance)->matrixL());
}

/// A base at rest whose points have one law, of normal stiffness k [Pa/m].
void set_base(Own& own, const Law& law, double k, const Matrix& factor, bool average) {
  own.laws.push_back(law_of(law, k));
  Block& block = own.add("base", points, components, std::vector<double>(points, 0.5));
  block.law = own.laws.back().get();
  own.problem.old.setZero(block.law->num_history(components) * points);
  own.set(factor, Vector::Zero(rows));
  own.change().average = average;
  own.change().scale = average ? 2 : 1;
}

}  // namespace

TEST(ContactRows, KeptFactorGivesOpeningsAndForcesOfNewFactors) {
  long factored = 0, factored_anew = 0;  // in the smooth steps
  for (const Law& law : {Law{"springs", 0}, Law{"springs", 0.4}, Law{"sdm", 0}, Law{"sdm", 0.6}})
    for (unsigned seed = 1; seed <= 6; ++seed) {
      std::mt19937 random(seed);
      std::uniform_real_distribution<double> uniform(-1, 1);
      Own anew, kept;
      const Matrix factor = factor_of(random);
      for (Own* own : {&anew, &kept}) set_base(*own, law, std::pow(10.0, 6 + seed % 3), factor, seed % 2 == 0);
      anew.change().solver = InterfaceSolver::direct;
      const auto newton = method("newton");
      const auto anew_work = newton->make_work(), kept_work = newton->make_work();
      InterfaceSolution a, b;
      long opened = 0;
      Vector shape = Vector::Zero(rows);
      const Vector way = Vector::NullaryExpr(rows, [&] { return uniform(random); });
      for (int step = 0; step < 24; ++step) {
        // smooth at first, as under an earthquake, then with leaps
        const Vector leap = Vector::NullaryExpr(rows, [&] { return uniform(random); });
        shape = step < smooth ? Vector(0.8 * std::sin(0.4 * step) * way) : leap;
        Vector moved = 0.6 * (factor * shape);
        moved.tail(points).array() -= 4e-5;
        anew.problem.free_opening = kept.problem.free_opening = moved;
        const Outcome first = newton->solve(anew.problem, *anew_work, a), second = newton->solve(kept.problem, *kept_work, b);
        const std::string what = std::string(law.type) + " seed " + std::to_string(seed) + " step " + std::to_string(step);
        ASSERT_TRUE(first.converged && second.converged) << what << first.why << second.why;
        EXPECT_LT((a.opening - b.opening).norm(), 1e-9 * (moved.norm() + a.opening.norm())) << what;
        EXPECT_LE((a.force - b.force).norm(), 1e-8 * a.force.norm()) << what;
        EXPECT_LE(contact_residual(kept.problem, b), 1e-9) << what;
        if (step == smooth - 1) factored_anew += a.systems.factored, factored += b.systems.factored;
        opened += (b.opening.tail(points).array() > 0).count();
        anew.problem.from = kept.problem.from = a.opening;
        anew.problem.old = kept.problem.old = a.now;
      }
      EXPECT_GT(b.systems.iterated, 0) << "the factor was never kept";
      EXPECT_GT(opened, points) << law.type << seed;
      EXPECT_LT(opened, 23 * points) << law.type << seed;
    }
  EXPECT_LT(factored, factored_anew);
}

/// A base that rocks slowly on springs with bonded shear: what changes are the slopes of the normal rows of the points that open or close.
TEST(ContactRows, FactorsHaveTheRowsThatChangeAlone) {
  for (const bool average : {false, true}) {
    std::mt19937 random(average ? 2 : 1);
    Own anew, kept;
    const Matrix factor = factor_of(random);
    for (Own* own : {&anew, &kept}) set_base(*own, {"springs", 0, "bonded"}, 1e7, factor, average);
    anew.change().solver = InterfaceSolver::direct;
    const auto newton = method("newton");
    const auto anew_work = newton->make_work(), kept_work = newton->make_work();
    InterfaceSolution a, b;
    Index most_open = 0, order = 0;
    for (int step = 0; step < 160; ++step) {
      Vector moved = Vector::Zero(rows);  // opening, falling linearly over the points, and shear
      for (Index i = 0; i < points; ++i) {
        moved[i] = 1e-5 * std::cos(0.1 * step);
        moved[2 * points + i] = 1e-5 * (std::sin(0.17 * step) * (static_cast<double>(2 * i) / points - 1) - 0.3);
      }
      anew.problem.free_opening = kept.problem.free_opening = moved;
      ASSERT_TRUE(newton->solve(anew.problem, *anew_work, a).converged && newton->solve(kept.problem, *kept_work, b).converged) << step;
      EXPECT_LT((a.opening - b.opening).norm(), 1e-9 * (moved.norm() + a.opening.norm())) << step;
      EXPECT_LE(contact_residual(kept.problem, b), 1e-9) << step;
      most_open = std::max<Index>(most_open, (b.opening.tail(points).array() > 0).count());
      if (step >= 80) order = std::max(order, static_cast<const RowNewton&>(*static_cast<const NewtonWork&>(*kept_work).rows).order());
      anew.problem.from = kept.problem.from = a.opening;
      anew.problem.old = kept.problem.old = a.now;
    }
    EXPECT_GT(most_open, points / 3);
    EXPECT_GT(order, 0);
    EXPECT_LE(order, points) << "all rows but those of open points are " << rows - most_open << " at least";
  }
}

/// A pressed base that slides in a circle: what changes are the slopes of the two tangential forces of every point; its pressure keeps the
/// slope of the closed joint.
TEST(ContactRows, SlidingPointsChangeTheirTangentialForcesAlone) {
  for (const bool average : {false, true}) {
    std::mt19937 random(average ? 4 : 3);
    Own anew, kept;
    const Matrix factor = factor_of(random);
    for (Own* own : {&anew, &kept}) set_base(*own, {"springs", 0.4}, 1e7, factor, average);
    anew.change().solver = InterfaceSolver::direct;
    const auto newton = method("newton");
    const auto anew_work = newton->make_work(), kept_work = newton->make_work();
    InterfaceSolution a, b;
    Index order = 0, sliding = 0;
    for (int step = 0; step < 120; ++step) {
      Vector moved = Vector::Zero(rows);
      for (Index i = 0; i < points; ++i) {
        moved[i] = 3e-5 * std::cos(0.1 * step), moved[points + i] = 3e-5 * std::sin(0.1 * step);
        moved[2 * points + i] = -1e-5;
      }
      anew.problem.free_opening = kept.problem.free_opening = moved;
      ASSERT_TRUE(newton->solve(anew.problem, *anew_work, a).converged && newton->solve(kept.problem, *kept_work, b).converged) << step;
      EXPECT_LT((a.opening - b.opening).norm(), 1e-9 * (moved.norm() + a.opening.norm())) << step;
      EXPECT_LE(contact_residual(kept.problem, b), 1e-9) << step;
      if (step >= 60) {
        order = std::max(order, static_cast<const RowNewton&>(*static_cast<const NewtonWork&>(*kept_work).rows).order());
        EXPECT_LT(b.force.tail(points).maxCoeff(), 0) << "some point is open";
        for (Index i = 0; i < points; ++i)
          sliding += std::hypot(b.force[i], b.force[points + i]) > 0.39 * std::abs(b.force[2 * points + i]);
      }
      anew.problem.from = kept.problem.from = a.opening;
      anew.problem.old = kept.problem.old = a.now;
    }
    EXPECT_GT(sliding, 30 * points);
    EXPECT_GT(order, points);
    EXPECT_LE(order, 2 * points);
  }
}

}  // namespace uplift::contact_test::contact_rows_test
