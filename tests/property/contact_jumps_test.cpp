#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "property/contact_laws.h"
#include "unit/contact/contact_support.h"

// Interfaces whose rows feel the jumps at a few nodes (JumpFactor), against the same interfaces with the filled factor C = W L alone.
namespace uplift::contact_test::contact_jumps_test {
namespace {

constexpr int nodes = 16, points = 60;

/// Every point feels the jumps at four nodes, with weights whose sum is one; jumps [1e-4 m] of a compliance that falls with the distance.
JumpFactor jumps(std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(0, 1);
  std::vector<Triplet> entries;
  for (int i = 0; i < points; ++i) {
    const int first = static_cast<int>(random() % (nodes - 3));
    Vector weight = Vector::NullaryExpr(4, [&] { return uniform(random); });
    weight /= weight.sum();
    for (int k = 0; k < 4; ++k)
      for (int c = 0; c < 3; ++c) entries.emplace_back(c * points + i, 3 * (first + k) + c, weight[k]);
  }
  JumpFactor made;
  made.rows.resize(3 * points, 3 * nodes);
  made.rows.setFromTriplets(entries.begin(), entries.end());
  const Index r = 3 * nodes;
  const Matrix mix = Matrix::NullaryExpr(r, r, [&] { return 0.1 * (uniform(random) - 0.5); });
  Matrix compliance = mix * mix.transpose();
  for (Index a = 0; a < r; ++a)
    for (Index b = 0; b < r; ++b) compliance(a, b) += a % 3 == b % 3 ? std::exp(-0.5 * std::abs(static_cast<double>(a / 3 - b / 3))) : 0;
  made.lower = 1e-4 * Matrix(Cholesky(compliance)->matrixL());
  return made;
}

}  // namespace

TEST(ContactJumps, StepsAreThoseOfTheFilledFactor) {
  for (const Law& law : {Law{"springs", 0}, Law{"springs", 0.4}, Law{"sdm", 0}, Law{"sdm", 0.6}})
    for (unsigned seed = 1; seed <= 6; ++seed) {
      std::mt19937 random(seed);
      std::uniform_real_distribution<double> uniform(-1, 1);
      Own filled, sparse;
      for (Own* own : {&filled, &sparse}) {
        own->laws.push_back(law_of(law, std::pow(10.0, 6 + seed % 3)));
        const int components = 3;
        Block& block = own->add("section", points, components, std::vector<double>(points, 0.5));
        block.law = own->laws.back().get();
        own->problem.old.setZero(block.law->num_history(components) * points);
      }
      const JumpFactor made = jumps(random);
      const Matrix factor = made.rows * made.lower;
      const bool average = seed % 2 == 0;
      for (Own* own : {&filled, &sparse}) {
        own->set(factor, Vector::Zero(factor.rows()));
        own->change().average = average;
        own->change().scale = average ? 2 : 1;
      }
      sparse.change().jumps = made;
      const auto newton = method("newton");
      const auto filled_work = newton->make_work(), sparse_work = newton->make_work();
      InterfaceSolution a, b;
      long kept = 0, opened = 0;
      for (int step = 0; step < 12; ++step) {
        const Vector shape = Vector::NullaryExpr(factor.cols(), [&] { return uniform(random); });
        Vector moved = 0.6 * (factor * shape);
        moved.tail(points).array() -= 2e-5 * (1 + uniform(random));
        filled.problem.free_opening = sparse.problem.free_opening = moved;
        const Outcome first = newton->solve(filled.problem, *filled_work, a), second = newton->solve(sparse.problem, *sparse_work, b);
        const std::string what = std::string(law.type) + " seed " + std::to_string(seed) + " step " + std::to_string(step);
        ASSERT_TRUE(first.converged && second.converged) << what << first.why << second.why;
        EXPECT_LT((a.opening - b.opening).norm(), 1e-9 * (moved.norm() + a.opening.norm())) << what;
        EXPECT_LE((a.force - b.force).norm(), 1e-8 * a.force.norm()) << what;
        EXPECT_NEAR(static_cast<double>(first.iterations), static_cast<double>(second.iterations), 1) << what;  // the same directions
        kept += b.systems.iterated;
        opened += (b.opening.tail(points).array() > 0).count();
        filled.problem.from = sparse.problem.from = a.opening;
        filled.problem.old = sparse.problem.old = a.now;
      }
      EXPECT_GT(kept, 0) << "the factor of a step before was never of use";
      EXPECT_GT(opened, points) << law.type << seed;
      EXPECT_LT(opened, 11 * points) << law.type << seed;
    }
}

}  // namespace uplift::contact_test::contact_jumps_test
