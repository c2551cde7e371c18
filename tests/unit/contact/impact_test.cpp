#include <numbers>

#include "unit/contact/contact_support.h"

// Impact rules on systems small enough to be written down here: a bar on a wall and a rocking block.
namespace uplift::contact_test::impact_test {
namespace {

// ---- the bar on a rigid wall: E = 900, rho = 1, A = 1, L = 10, v0 = -10, gap 1, lumped mass, trapezoidal rule, dt = h/c ----

struct BarResult {
  double mean = 0, deviation = 0, energy = 0, contact = 0;
  int switches = 0;
  double first = 0;
};

class Bar {
 public:
  explicit Bar(int elements) : n_(elements + 1), h_(10.0 / elements), dt_(h_ / 30) {
    stiffness_ = Matrix::Zero(n_, n_);
    for (int e = 0; e < elements; ++e) stiffness_.block<2, 2>(e, e) += 900 / h_ * (Matrix(2, 2) << 1, -1, -1, 1).finished();
    mass_ = Vector::Constant(n_, h_);
    mass_[0] = mass_[n_ - 1] = h_ / 2;
    b_ = Matrix::Zero(1, n_);
    b_(0, 0) = 1;
    effective_ = Cholesky(stiffness_ + Matrix((4 / (dt_ * dt_) * mass_).asDiagonal()));
    const Vector column = effective_.solve(Vector(b_.transpose()));
    contact_.factor = Matrix::Constant(1, 1, std::sqrt(column[0]));
    contact_.spread = column / std::sqrt(column[0]);
    inertia_.factor = Matrix::Constant(1, 1, 1 / std::sqrt(mass_[0]));
    inertia_.spread = Vector(b_.transpose()) / std::sqrt(mass_[0]);
  }

  BarResult run(const std::string& name, double duration, double gap_tolerance = 1e-9) const {
    const auto lagrange = method("lagrange", {{"gap_tolerance", gap_tolerance}});
    const auto impact_rule = rule(name);
    Own own;
    own.add_cone("wall", 1, 1, 0);
    own.set(contact_.factor, Vector::Zero(1));
    InterfaceSolution solution;
    ImpactScratch scratch;
    Vector u = Vector::Zero(n_), v = Vector::Constant(n_, -10), a = Vector::Zero(n_), impulse = Vector::Zero(1);
    std::vector<double> time, force;
    BarResult result;
    bool was = false;
    const int steps = static_cast<int>(std::lround(duration / dt_));
    for (int step = 1; step <= steps; ++step) {
      const Vector history = mass_.cwiseProduct(4 / (dt_ * dt_) * u + 4 / dt_ * v + a);
      const Vector free = effective_.solve(history);
      own.problem.free_opening[0] = free[0] + 1;
      EXPECT_TRUE(lagrange->solve(own.problem, solution).converged);
      const Vector next = free + contact_.spread * solution.z;
      const Vector next_a = 4 / (dt_ * dt_) * (next - u - dt_ * v) - a;
      v += dt_ / 2 * (a + next_a);
      u = next;
      a = next_a;
      const bool active = solution.force[0] < 0;
      if (active != was) ++result.switches;
      was = active;
      if (active && impact_rule->acts()) {
        Impact impact;
        impact.mass = &inertia_;
        impact.dynamic = &contact_;  // the trapezoidal rule's matrix is that of eq 5
        impact.b = &b_;
        const Vector pressed = Vector::Ones(1);
        impact.pressed = &pressed;
        impact.force = &solution.force;
        impact.velocity_weight = dt_ / 2;
        impulse.setZero();
        impact_rule->apply(impact, v, impulse, scratch);
        impact_rule->hold(impact, a, scratch);
      }
      time.push_back(step * dt_);
      force.push_back(-solution.force[0]);
    }
    double sum = 0, squares = 0, last = 0;
    int count = 0;
    for (std::size_t i = 0; i < time.size(); ++i) {
      if (!(force[i] > 0)) continue;
      if (result.first == 0) result.first = time[i];
      last = time[i];
      if (time[i] <= result.first + 0.1 || time[i] >= result.first + 0.5) continue;
      sum += force[i], squares += force[i] * force[i], ++count;
    }
    result.mean = sum / count;
    result.deviation = std::sqrt(squares / count - result.mean * result.mean);
    result.contact = last - result.first;
    result.energy = (0.5 * v.dot(mass_.cwiseProduct(v)) + 0.5 * u.dot(stiffness_ * u)) / 500;
    return result;
  }

 private:
  int n_;
  double h_, dt_;
  Matrix stiffness_, b_;
  Vector mass_;
  Cholesky effective_;
  Spread contact_, inertia_;
};

// Requirement: the table of impact_bar_test.cpp. The figures there are rounded; those of an independent program for the same scheme are
// used, 0.5 %.
TEST(Impact, bar_table) {
  const Bar bar(100);
  struct Row {
    const char* name;
    double mean, deviation, energy;
    int switches;
  };
  for (const Row& row : {Row{"none", 1032.3, 457.66, 22.851, 102}, Row{"project", 300.85, 102.94, 0.99518, 4},
                         Row{"reflect", 597.47, 299.99, 1.0005, 2}, Row{"propagate", 721.74, 299.99, 0.99705, 2}}) {
    const BarResult result = bar.run(row.name, 1.0);
    EXPECT_NEAR(result.mean, row.mean, 5e-3 * row.mean) << row.name;
    EXPECT_NEAR(result.deviation, row.deviation, 5e-3 * row.deviation) << row.name;
    EXPECT_NEAR(result.energy, row.energy, 5e-4 * row.energy) << row.name;
    EXPECT_EQ(result.switches, row.switches) << row.name;
  }
}

// Requirement: project_hold gives the exact pressure 300, contact time 2/3 s, and loses 1/(2n) of the energy.
TEST(Impact, bar_project_hold) {
  for (const int n : {100, 200, 400}) {
    const BarResult result = Bar(n).run("project_hold", 1.0);
    EXPECT_NEAR(result.mean, 300, 0.03);
    EXPECT_LT(result.deviation, 0.5);
    EXPECT_NEAR(result.contact, 2.0 / 3, 1.0 / (3 * n) + 1e-9);
    EXPECT_NEAR(1 - result.energy, 1.0 / (2 * n), 0.01 / n);
    EXPECT_EQ(result.switches, 2);
  }
}

// ---- the rocking block: half sizes b, h; unknowns (x, y, rotation) of its centre; the two corners of the base ----

struct RockingBlock {
  double half_width = 0.5, half_height = 2, mass = 4000;
  Matrix m = Matrix::Zero(3, 3), b{4, 3};  // rows: tangential A, B, normal A, B
  Spread inertia;
  RockingBlock() {
    const double inertia_moment = mass * (half_width * half_width + half_height * half_height) / 3;
    m.diagonal() << mass, mass, inertia_moment;
    b << 1, 0, half_height, 1, 0, half_height, 0, 1, -half_width, 0, 1, half_width;
    inertia = spread_of(m, b);
  }
  double energy(const Vector& v) const { return 0.5 * v.dot(m * v); }
  /// Velocity after the impact; `contained` [N s] is the part of corner A's impulse that the displacement solve has put into the velocity
  /// already.
  Vector after(const std::string& name, Vector v, bool friction, double contained, Vector* impulse = nullptr) const {
    Impact impact;
    impact.mass = impact.dynamic = &inertia;
    impact.b = &b;
    const Vector pressed = (Vector(4) << 0, 0, 1, 1).finished();
    impact.pressed = &pressed;
    const std::vector<int> sticking{0, 1};
    if (friction) impact.tangents = sticking;
    impact.velocity_weight = 1e-3;
    Vector force = Vector::Zero(4);
    force[2] = -contained / impact.velocity_weight;
    impact.force = &force;
    v -= impact.velocity_weight * inverse(m) * b.transpose() * force;
    Vector a = Vector::Zero(3), sum = Vector::Zero(4);
    ImpactScratch scratch;
    rule(name)->apply(impact, v, sum, scratch);
    rule(name)->hold(impact, a, scratch);
    if (impulse != nullptr) *impulse = sum + impact.velocity_weight * force;
    return v;
  }
};

// Requirement: restitution r = (1 - 1.5 sin^2 alpha)^2 of the energy when the corners stick; the block must not stop dead.
TEST(Impact, rocking_block_housner) {
  const RockingBlock block;
  const double sine = block.half_width / std::hypot(block.half_width, block.half_height), ratio = 1 - 1.5 * sine * sine;
  EXPECT_NEAR(ratio * ratio, 0.8313148789, 1e-9);
  const double omega = -0.3;  // about corner A, falling on B
  const Vector before = (Vector(3) << -block.half_height * omega, block.half_width * omega, omega).finished();
  ASSERT_NEAR((block.b.row(2) * before)(0), 0, 1e-15);
  for (const char* name : {"project", "project_hold"})
    for (const double contained : {0.0, 300.0, 5e4}) {
      Vector impulse;
      const Vector after = block.after(name, before, true, contained, &impulse);
      EXPECT_NEAR(after[2] / omega, ratio, 1e-10) << name << contained;
      EXPECT_NEAR(block.energy(after) / block.energy(before), ratio * ratio, 1e-10);
      EXPECT_NEAR((block.b.row(3) * after)(0), 0, 1e-12);  // it turns about B now
      EXPECT_GT((block.b.row(2) * after)(0), 0.1);
      EXPECT_NEAR(impulse[2], 0, 1e-8);  // corner A leaves: no impulse, not a tensile one
      EXPECT_LT(impulse[3], -1);
      EXPECT_LT((block.m * (after - before) + block.b.transpose() * impulse).norm(), 1e-8);
    }
}

TEST(Impact, rocking_block_without_friction) {
  const RockingBlock block;
  const double b2 = block.half_width * block.half_width, h2 = block.half_height * block.half_height, omega = -0.3;
  const Vector before = (Vector(3) << 0.0, block.half_width * omega, omega).finished();
  const Vector after = block.after("project", before, false, 0);
  EXPECT_NEAR(after[2] / omega, (h2 - 2 * b2) / (h2 + 4 * b2), 1e-10);
  EXPECT_NEAR(after[2] / omega, 0.7, 1e-10);
  EXPECT_NEAR(after[0], 0, 1e-14);
}

// A block that falls flat is stopped at both corners: both impulses are compressive, and equal.
TEST(Impact, block_that_falls_flat_stops) {
  const RockingBlock block;
  const Vector before = (Vector(3) << 0.0, -1.0, 0.0).finished();
  for (const bool friction : {false, true}) {
    Vector impulse;
    const Vector after = block.after("project_hold", before, friction, 200, &impulse);
    EXPECT_LT(after.norm(), 1e-12);
    EXPECT_NEAR(impulse[2], -block.mass / 2, 1e-8);
    EXPECT_NEAR(impulse[3], -block.mass / 2, 1e-8);
    const Vector mirrored = block.after("reflect", before, friction, 0);
    EXPECT_NEAR(block.energy(mirrored), block.energy(before), 1e-9 * block.energy(before));
    EXPECT_NEAR(mirrored[1], 1, 1e-12);
    EXPECT_NEAR((block.after("propagate", before, friction, 0) - mirrored).norm(), 0, 1e-10);  // one matrix: the same reflection
  }
}

// Redundant contact: 40 points under a rigid footing. The rule must give the velocity of the body (independent of the number of points) and
// impulses that are never tensile.
TEST(Impact, redundant_points_under_a_rigid_footing) {
  const double mass = 2e4, moment = 7500;
  Matrix m = Matrix::Zero(2, 2);
  m.diagonal() << mass, moment;
  for (const int points : {2, 3, 40, 200}) {
    const Footing base = footing(points, 1.5);
    const Spread inertia = spread_of(m, base.b);
    Impact impact;
    impact.mass = &inertia;
    impact.b = &base.b;
    impact.velocity_weight = 5e-4;
    const Vector force = Vector::Zero(points), area = ConstMap(base.area.data(), points);
    impact.force = &force;
    impact.area = &area;
    impact.pressed = &area;
    ImpactScratch scratch;
    for (const double spin : {0.0, 0.2, 0.9, 3.0, -3.0}) {
      Vector v = (Vector(2) << -0.5, spin).finished(), impulse = Vector::Zero(points);
      const Vector before = v;
      rule("project")->apply(impact, v, impulse, scratch);
      EXPECT_GT((base.b * v).minCoeff(), -1e-12);
      EXPECT_LE(impulse.maxCoeff(), 0.0);
      EXPECT_LT((m * (v - before) + base.b.transpose() * impulse).norm(), 1e-8);
      // stopped on both ends when the combined impulse falls inside the base, else hinged on the end that penetrates
      const double arm = std::abs(moment * spin / (mass * 0.5));
      if (arm < 1.5) {
        EXPECT_LT(v.norm(), 1e-12) << points << spin;
      } else {
        const double x = spin > 0 ? -1.5 : 1.5, normal = (-0.5 + spin * x) / (1 / mass + x * x / moment);  // -impulse on that end
        EXPECT_NEAR(v[0], -0.5 - normal / mass, 1e-12);
        EXPECT_NEAR(v[1], spin - x * normal / moment, 1e-12);
      }
    }
  }
}

// The acceleration is held on the rows that stay closed only; where the step's force is the right one nothing changes.
TEST(Impact, acceleration_is_held_on_closed_rows) {
  const RockingBlock block;
  Impact impact;
  impact.mass = &block.inertia;
  impact.b = &block.b;
  const Vector pressed = (Vector(4) << 0, 0, 1, 1).finished();
  impact.pressed = &pressed;
  impact.velocity_weight = 1e-3;
  Vector force = Vector::Zero(4);
  force[2] = force[3] = -block.mass * 9.81 / 2;
  impact.force = &force;
  ImpactScratch scratch;
  Vector v = Vector::Zero(3), impulse = Vector::Zero(4);
  // contained force = half the weight too little: the acceleration is downwards and must be brought to zero
  Vector a = (Vector(3) << 0.0, -3.0, 0.0).finished();
  rule("project_hold")->apply(impact, v, impulse, scratch);
  rule("project_hold")->hold(impact, a, scratch);
  EXPECT_LT(a.norm(), 1e-12);
  EXPECT_LT(v.norm(), 1e-12);
  // a body that leaves: v = 0, but without the contact force the acceleration would still be upwards
  force.setZero();
  a << 0, 2, 0;
  rule("project_hold")->apply(impact, v, impulse, scratch);
  rule("project_hold")->hold(impact, a, scratch);
  EXPECT_NEAR(a[1], 2, 1e-12);
  // corner A leaves in the impact, so that its acceleration is free
  const double omega = -0.3;
  v << 0, block.half_width * omega, omega;
  a << 0, -1, 0;
  rule("project_hold")->apply(impact, v, impulse, scratch);
  rule("project_hold")->hold(impact, a, scratch);
  EXPECT_NEAR((block.b.row(3) * a)(0), 0, 1e-12);
  EXPECT_LT((block.b.row(2) * a)(0), -0.1);
}

// A row that moves no mass (a massless point held by springs) cannot receive an impulse; the others do.
TEST(Impact, massless_rows_are_left_alone) {
  Spread inertia{Matrix::Zero(2, 1), Matrix::Zero(2, 1)};
  inertia.factor(0, 0) = inertia.spread(0, 0) = 0.1;  // unknown 0 has mass 100, unknown 1 none
  const Matrix b = Matrix::Identity(2, 2);
  const Vector force = Vector::Zero(2);
  Impact impact;
  impact.mass = &inertia;
  impact.b = &b;
  const Vector pressed = Vector::Ones(2);
  impact.pressed = &pressed;
  impact.force = &force;
  impact.velocity_weight = 1;
  ImpactScratch scratch;
  Vector v = (Vector(2) << -1.0, -1.0).finished(), a = Vector::Zero(2), impulse = Vector::Zero(2);
  rule("project_hold")->apply(impact, v, impulse, scratch);
  rule("project_hold")->hold(impact, a, scratch);
  EXPECT_NEAR(v[0], 0, 1e-14);
  EXPECT_EQ(v[1], -1);
  EXPECT_NEAR(impulse[0], -100, 1e-10);
  EXPECT_EQ(impulse[1], 0);
}

// No rule may change anything without active contact, and all five are in the catalog under their names.
TEST(Impact, catalog_and_idle) {
  std::vector<std::string> names;
  for (const PartInfo* info : impact_rules()) names.emplace_back(info->name);
  EXPECT_EQ(names, (std::vector<std::string>{"none", "project", "project_hold", "reflect", "propagate"}));
  EXPECT_FALSE(rule("none")->acts());
  EXPECT_TRUE(rule("propagate")->needs_dynamic());
  const RockingBlock block;
  const Vector force = Vector::Zero(4);
  for (const std::string& name : names) {
    Impact impact;
    impact.mass = impact.dynamic = &block.inertia;
    impact.b = &block.b;
    impact.force = impact.pressed = &force;  // nobody is pressed
    Vector v = (Vector(3) << 1.0, -2.0, 3.0).finished(), a = v, impulse = Vector::Zero(4);
    ImpactScratch scratch;
    rule(name)->apply(impact, v, impulse, scratch);
    rule(name)->hold(impact, a, scratch);
    EXPECT_EQ(v, (Vector(3) << 1.0, -2.0, 3.0).finished()) << name;
    EXPECT_EQ(impulse.norm(), 0);
  }
}

}  // namespace
}  // namespace uplift::contact_test::impact_test
