// Impulses on the base of a large bulk: the mass matrix with the touched unknowns last against the dense spread of its inverse.
#include <gtest/gtest.h>

#include <random>

#include "two_boxes.h"
#include "uplift/base/declare.h"
#include "uplift/contact/impact/impact.h"
#include "uplift/dynamics/bulk.h"
#include "uplift/math/dense.h"

namespace uplift::impulse_test {
namespace {

struct Corrected {
  Vector velocity, acceleration, impulse;
};

Corrected apply(const char* rule, const Spread& mass, const Spread& dynamic, const TwoBoxes& boxes, const Vector& velocity,
                const Vector& acceleration, const Vector& force) {
  auto table = std::make_shared<RawTable>();
  table->entries.emplace_back("type", Raw{std::string(rule), {}, ""});
  const auto impact_rule = make_part(impact_catalog(), check_part(Raw{table, {}, ""}, impact_rules()));
  const int rows = static_cast<int>(boxes.b.rows()), points = rows / 2;
  Impact impact;
  impact.mass = &mass;
  impact.dynamic = &dynamic;
  impact.sparse_b = &boxes.b;
  impact.force = &force;
  impact.area = &boxes.area;
  impact.step = 2e-3;
  impact.velocity_weight = 1e-3;
  Vector pressed = Vector::Zero(rows);
  impact.pressed = &pressed;
  std::vector<int> sticking;
  for (int p = 0; p < points; ++p)
    if (force[points + p] < 0) {
      pressed[points + p] = boxes.area[points + p];
      if (p % 3 == 0) sticking.push_back(p);
    }
  impact.tangents = sticking;
  Corrected result{velocity, acceleration, Vector::Zero(rows)};
  ImpactScratch scratch;
  impact_rule->apply(impact, result.velocity, result.impulse, scratch);
  impact_rule->hold(impact, result.acceleration, scratch);
  return result;
}

double difference(const Vector& a, const Vector& b) {
  return (a - b).norm() / b.norm();
}

TEST(Impulse, SplitMassMatrixSpreadsAsTheDenseInverse) {
  std::mt19937 random(11);
  std::normal_distribution<double> normal;
  const auto noise = [&](Index n) {
    Vector v(n);
    for (double& value : v) value = normal(random);
    return v;
  };
  const auto solver = solver_catalog()[0]->make(Values());
  const Model nameless;
  for (const int dimension : {2, 3})
    for (const auto kind : {SolidSection::Mass::consistent, SolidSection::Mass::lumped}) {
      TwoBoxesPlan plan;
      plan.dimension = dimension;
      plan.mass = kind;
      if (dimension == 3) plan.soil = {7, 7, 3}, plan.block_width = plan.block_height = 3;
      const TwoBoxes boxes = two_boxes(plan);
      ASSERT_GT(boxes.mass.rows(), small_bulk);
      const double dt = 2e-3;
      const Sparse step = boxes.stiffness + 4 / (dt * dt) * boxes.mass;
      LinearCounts counts;
      const BulkFactor split(boxes.mass, &boxes.b, false, *solver, nameless, counts),
          whole(boxes.mass, nullptr, false, *solver, nameless, counts), step_split(step, &boxes.b, false, *solver, nameless, counts),
          step_whole(step, nullptr, false, *solver, nameless, counts);
      ASSERT_TRUE(split.ok() && whole.ok() && step_split.ok() && step_whole.ok());
      ASSERT_NE(split.split(), nullptr);
      const Spread thin = split.spread(boxes.b, counts), dense = whole.spread(boxes.b, counts),
                   thin_step = step_split.spread(boxes.b, counts), dense_step = step_whole.spread(boxes.b, counts);
      EXPECT_EQ(thin.spread.size(), 0);  // nothing of the size of the bulk is kept
      ASSERT_EQ(dense.spread.rows(), boxes.mass.rows());

      // both are M^-1 B^T, by an independent factorisation
      const Matrix answer = PivotedLdlt(Matrix(boxes.mass)).solve(Matrix(boxes.b.transpose())), compliance = boxes.b * answer;
      for (const Spread* spread : {&thin, &dense}) {
        EXPECT_LE((spread->factor * spread->factor.transpose() - compliance).norm(), 1e-12 * compliance.norm());
        const Vector p = noise(boxes.b.rows());
        Vector x = Vector::Ones(boxes.mass.rows());
        spread->add(2, spread->factor.transpose() * p, x);
        EXPECT_LE(difference(x - Vector::Ones(x.size()), 2 * answer * p), 1e-10);
      }

      for (const char* rule : {"project", "project_hold", "reflect", "propagate"})
        for (int round = 0; round < 3; ++round) {
          const Vector velocity = noise(boxes.mass.rows()), acceleration = 1e2 * noise(boxes.mass.rows());
          Vector force = 1e5 * noise(boxes.b.rows());
          for (Index row = 0; row < force.size(); row += 2) force[row] = -std::abs(force[row]);  // half of them closed at least
          const Corrected a = apply(rule, thin, thin_step, boxes, velocity, acceleration, force),
                          b = apply(rule, dense, dense_step, boxes, velocity, acceleration, force);
          EXPECT_LE(difference(a.velocity, b.velocity), 1e-10) << rule << " " << dimension;
          EXPECT_LE(difference(a.acceleration, b.acceleration), 1e-10) << rule << " " << dimension;
          EXPECT_LE(difference(a.impulse, b.impulse), 1e-10) << rule << " " << dimension;
          EXPECT_GT(difference(a.velocity, velocity), 1e-3) << rule;  // something was corrected
        }
    }
}

}  // namespace
}  // namespace uplift::impulse_test
