#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <random>

#include "unit/contact/contact_support.h"

// The impact projection on random bodies: the optimality conditions written out, and no energy from nothing.
namespace uplift::contact_test::contact_impact_test {
namespace {

struct RandomImpact {
  Matrix m, b;
  Spread inertia;
  Vector v, force, pressed;
  std::vector<int> normals, sticking;
  Impact impact;
  bool friction = false;
  explicit RandomImpact(unsigned seed) {
    std::mt19937 engine(seed);
    std::normal_distribution<double> normal;
    const auto dice = [&](int least, int most) { return std::uniform_int_distribution<int>(least, most)(engine); };
    const auto random = [&](Index rows, Index columns) {
      Matrix result(rows, columns);
      for (Index i = 0; i < result.size(); ++i) result.data()[i] = normal(engine);
      return result;
    };
    const int unknowns = dice(1, 8), points = dice(1, 6);
    friction = dice(0, 2) == 0;
    const Matrix root = random(unknowns, unknowns);
    m = std::pow(10.0, dice(-2, 5)) * (root * root.transpose() + Matrix::Identity(unknowns, unknowns));
    b = random(2 * points, unknowns);
    for (int i = 1; i < points; ++i)
      if (dice(0, 3) == 0) b.row(points + i) = b.row(points + i - 1);  // redundant
    inertia = spread_of(m, b);
    v = random(unknowns, 1);
    force = pressed = Vector::Zero(2 * points);
    for (int i = 0; i < points; ++i) {
      if (dice(0, 3) == 0) continue;
      normals.push_back(points + i);
      pressed[points + i] = 1;
      force[points + i] = -m.norm() * 100 * std::abs(normal(engine)) * dice(0, 1);
      if (friction && dice(0, 2) == 0) sticking.push_back(i);
    }
    impact.tangents = sticking;
    impact.mass = &inertia;
    impact.b = &b;
    impact.force = &force;
    impact.pressed = &pressed;
    impact.velocity_weight = 1e-3;
    v -= impact.velocity_weight * inverse(m) * b.transpose() * force;  // as the displacement solve leaves it
  }
  double energy(const Vector& velocity) const { return 0.5 * velocity.dot(m * velocity); }
};

RC_GTEST_PROP(Impact, projection_is_optimal, ()) {
  RandomImpact setup(*rc::gen::arbitrary<unsigned>());
  const Vector w = setup.v + setup.impact.velocity_weight * inverse(setup.m) * setup.b.transpose() * setup.force;
  Vector after = setup.v, impulse = Vector::Zero(setup.force.size());
  ImpactScratch scratch;
  rule("project")->apply(setup.impact, after, impulse, scratch);
  const Vector total = impulse + setup.impact.velocity_weight * setup.force, rate = setup.b * after;
  const double speed = (setup.b * w).norm() + w.norm(), push = (setup.m * w).norm();
  RC_ASSERT((setup.m * (after - w) + setup.b.transpose() * total).norm() <= 1e-8 * (push + total.norm()));
  for (const int row : setup.normals) {
    RC_ASSERT(rate[row] >= -1e-8 * speed);
    RC_ASSERT(total[row] <= 1e-8 * push);
    RC_ASSERT(std::abs(rate[row] * total[row]) <= 1e-7 * speed * push);
  }
  for (const int row : setup.sticking) RC_ASSERT(std::abs(rate[row]) <= 1e-8 * speed);
  RC_ASSERT(setup.energy(after) <= setup.energy(w) * (1 + 1e-9));
}

RC_GTEST_PROP(Impact, reflection_keeps_the_kinetic_energy, ()) {
  RandomImpact setup(*rc::gen::arbitrary<unsigned>());
  Vector after = setup.v, impulse = Vector::Zero(setup.force.size());
  ImpactScratch scratch;
  rule("reflect")->apply(setup.impact, after, impulse, scratch);
  RC_ASSERT(std::abs(setup.energy(after) - setup.energy(setup.v)) <= 1e-9 * setup.energy(setup.v));
  for (const int row : setup.normals) RC_ASSERT(std::abs((setup.b.row(row) * (after + setup.v))(0)) <= 1e-7 * (setup.b * setup.v).norm());
}

RC_GTEST_PROP(Impact, held_rows_have_no_acceleration_into_the_ground, ()) {
  RandomImpact setup(*rc::gen::arbitrary<unsigned>());
  Vector velocity = setup.v, acceleration = 50 * setup.v.reverse(), impulse = Vector::Zero(setup.force.size());
  ImpactScratch scratch;
  rule("project_hold")->apply(setup.impact, velocity, impulse, scratch);
  rule("project_hold")->hold(setup.impact, acceleration, scratch);
  const Vector rate = setup.b * velocity, change = setup.b * acceleration;
  const double speed = (setup.b * setup.v).norm(), size = change.norm() + 50 * setup.v.norm() + setup.force.norm() / setup.m.norm();
  for (const int row : setup.normals)
    if (rate[row] <= 1e-11 * speed) RC_ASSERT(change[row] >= -1e-7 * size);
}

}  // namespace
}  // namespace uplift::contact_test::contact_impact_test
