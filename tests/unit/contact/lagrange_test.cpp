#include <limits>

#include "unit/contact/contact_support.h"

// The Lagrange method on problems whose answer can be written down.
namespace uplift::contact_test::lagrange_test {
namespace {

// A spring against a wall: k = 4e6, P = 2e5 towards a wall at 0.01: u = 0.01, lambda = 1.6e5.
TEST(Lagrange, spring_against_a_wall) {
  const double k = 4e6, load = 2e5, wall = 0.01;
  Own own;
  own.add_cone("wall", 1, 1, 0);
  own.set(Matrix::Constant(1, 1, -1 / std::sqrt(k)), Vector::Constant(1, wall - load / k));  // opening = wall - u
  InterfaceSolution solution;
  const Outcome outcome = method("lagrange")->solve(own.problem, solution);
  ASSERT_TRUE(outcome.converged) << outcome.why;
  EXPECT_NEAR(solution.force[0], -1.6e5, 1e-8);
  EXPECT_NEAR(load / k + solution.z[0] / std::sqrt(k), wall, 1e-16);
  EXPECT_EQ(solution.status[0], Status::slip);
  EXPECT_LE(contact_residual(own.problem, solution), 1e-14);
  EXPECT_LE(outcome.residual, 1e-14);
}

TEST(Lagrange, a_point_that_just_touches_stays_open) {
  Own own;
  own.add_cone("wall", 1, 1, 0);
  for (const double gap : {0.0, 1e-3, -0.9e-12}) {
    own.set(Matrix::Ones(1, 1), Vector::Constant(1, gap));
    InterfaceSolution solution;
    ASSERT_TRUE(method("lagrange")->solve(own.problem, solution).converged);
    EXPECT_EQ(solution.status[0], Status::open) << gap;
    EXPECT_EQ(solution.force[0], 0);
  }
  own.set(Matrix::Ones(1, 1), Vector::Constant(1, -2e-12));
  InterfaceSolution solution;
  ASSERT_TRUE(method("lagrange")->solve(own.problem, solution).converged);
  EXPECT_EQ(solution.status[0], Status::slip);
  InterfaceSolution loose;
  ASSERT_TRUE(method("lagrange", {{"gap_tolerance", 1e-9}})->solve(own.problem, loose).converged);
  EXPECT_EQ(loose.status[0], Status::open);
}

// ---- a rigid footing on redundant points ----

/// The footing (u_y, theta) on springs of the bulk under a load W at x = e, or held by its mass: what matters is B^T p = -(W, W e) when it
/// stays flat.
struct FlatFooting {
  Own own;
  Footing base;
  Vector load;
  FlatFooting(int points, double eccentricity, double weight, int components, double friction = 0) {
    base = footing(points, 1.5);
    const int unknowns = components == 2 ? 3 : 2;
    Matrix b = Matrix::Zero(points * components, unknowns);
    b.bottomLeftCorner(points, 2) = base.b;
    if (components == 2) b.topRightCorner(points, 1).setOnes();
    load = Vector::Zero(unknowns);
    load[0] = -weight;
    load[1] = -weight * eccentricity;
    Matrix stiffness = Matrix::Identity(unknowns, unknowns) * 4e9;
    stiffness(1, 1) = 3e9;
    if (components == 2) stiffness(0, 2) = stiffness(2, 0) = 0.5e9;
    own.add_cone("footing", points, components, friction, base.area);
    own.set(spread_of(stiffness, b).factor, b * inverse(stiffness) * load);
  }
};

// Eccentricity inside the kernel: p/area = -(W/A) (1 + e x / i^2), exactly (Navier); beyond it the tensionless linear distribution, its
// resultants exact.
TEST(Lagrange, eccentric_footing_on_forty_points) {
  const double weight = 1e6;
  const Footing base = footing(40, 1.5);
  double area = 0, second = 0;
  for (std::size_t i = 0; i < 40; ++i) area += base.area[i], second += base.area[i] * base.x[i] * base.x[i];
  const double kernel = second / area / 1.5;
  InterfaceSolution solution;  // kept: every solve starts from the status of the one before
  const auto lagrange = method("lagrange");
  for (const double e : {0.0, 0.2, 0.49, 0.52, 0.8, 1.2, 1.4, 1.49, 1.0, 0.3, 0.0, -0.7, -1.4, 0.45}) {
    FlatFooting flat(40, e, weight, 1);
    const Outcome outcome = lagrange->solve(flat.own.problem, solution);
    ASSERT_TRUE(outcome.converged) << outcome.why;
    EXPECT_LE(contact_residual(flat.own.problem, solution), 1e-12);
    EXPECT_LE(solution.force.maxCoeff(), 0.0);
    EXPECT_LE(solution.opening.cwiseAbs().maxCoeff(), 1e-15);  // it stays flat on the ground
    EXPECT_LE((base.b.transpose() * solution.force - flat.load).norm(), 1e-9 * weight);
    if (std::abs(e) < kernel)
      for (Index i = 0; i < 40; ++i) {
        const double x = base.x[static_cast<std::size_t>(i)], a = base.area[static_cast<std::size_t>(i)];
        EXPECT_NEAR(solution.force[i], -weight * a * (1 / area + e * x / second), 1e-9 * weight);
      }
    // linear over the closed points, zero where the line is tensile
    std::vector<std::size_t> closed;
    for (std::size_t i = 0; i < 40; ++i)
      if (solution.force[static_cast<Index>(i)] < 0) closed.push_back(i);
    ASSERT_GE(closed.size(), 2u);
    const auto pressure = [&](std::size_t i) { return solution.force[static_cast<Index>(i)] / base.area[i]; };
    const double slope = (pressure(closed.back()) - pressure(closed.front())) / (base.x[closed.back()] - base.x[closed.front()]);
    for (std::size_t i = 0; i < 40; ++i) {
      const double line = pressure(closed.front()) + slope * (base.x[i] - base.x[closed.front()]);
      EXPECT_NEAR(pressure(i), std::min(0.0, line), 1e-7 * weight) << e << " " << i;
    }
  }
}

// Eccentricity and the continuous solution: toe pressure 2 W / (3 (b - e)) over the length 3 (b - e), to the order of the nodal rule.
TEST(Lagrange, partly_lifted_pressures_converge_to_the_continuous_ones) {
  const double e = 0.9, weight = 1e6;
  double before = 0;
  for (const int points : {11, 41, 161}) {
    FlatFooting flat(points, e, weight, 1);
    InterfaceSolution solution;
    ASSERT_TRUE(method("lagrange")->solve(flat.own.problem, solution).converged);
    const double toe = -solution.force[points - 1] / flat.base.area.back();
    const double error = std::abs(toe / (2 * weight / (3 * (1.5 - e))) - 1);
    if (before > 0) {
      EXPECT_LT(error, 0.2 * before);  // order 2: 1/16 at best, the edge moves through a cell
    }
    before = error;
  }
  EXPECT_LT(before, 1e-3);
}

// The tangential rows of a frictionless block carry nothing, and their opening is reported.
TEST(Lagrange, frictionless_block_with_tangential_rows) {
  FlatFooting flat(40, 0.8, 1e6, 2);
  flat.own.problem.free_opening.head(40).array() += 1e-3;  // as by a horizontal load
  InterfaceSolution solution;
  ASSERT_TRUE(method("lagrange")->solve(flat.own.problem, solution).converged);
  EXPECT_EQ(solution.force.head(40).norm(), 0);
  EXPECT_LE((solution.opening - flat.own.problem.free_opening - flat.own.problem.model->factor * solution.z).norm(), 1e-18);
  EXPECT_GT(std::abs(solution.opening[0]), 1e-6);
  EXPECT_LE(contact_residual(flat.own.problem, solution), 1e-12);
}

// Two blocks are one problem: the same footing cut in two gives the same forces.
TEST(Lagrange, two_blocks_as_one) {
  FlatFooting flat(40, 0.8, 1e6, 1);
  Own cut;
  const std::vector<double>& area = flat.base.area;
  cut.add_cone("left", 13, 1, 0, {area.begin(), area.begin() + 13});
  cut.add_cone("right", 27, 1, 0, {area.begin() + 13, area.end()});
  cut.set(flat.own.problem.model->factor, flat.own.problem.free_opening);
  InterfaceSolution one, two;
  ASSERT_TRUE(method("lagrange")->solve(flat.own.problem, one).converged);
  ASSERT_TRUE(method("lagrange")->solve(cut.problem, two).converged);
  EXPECT_LE((one.force - two.force).norm(), 1e-10 * one.force.norm());
  EXPECT_EQ(one.status, two.status);
}

// ---- laws and constraints in one problem ----

TEST(Lagrange, spring_law_beside_a_wall) {
  const double k = 4e6, law = 3e6, wall = 0.01;
  for (const double load : {3e4, 6e4, 2e5, -1e5}) {  // open wall, nearly, closed, pulling away from both
    Own own;
    own.add_springs("springs", 1, law);
    own.add_cone("wall", 1, 1, 0);
    const double root = 1 / std::sqrt(k);
    own.set((Matrix(2, 1) << -root, -root).finished(), (Vector(2) << -load / k, wall - load / k).finished());
    InterfaceSolution solution;
    const Outcome outcome = method("lagrange")->solve(own.problem, solution);
    ASSERT_TRUE(outcome.converged) << outcome.why;
    EXPECT_LE(contact_residual(own.problem, solution), 1e-12);
    const double free = load > 0 ? load / (k + law) : load / k, u = std::min(free, wall);
    EXPECT_NEAR(load / k + root * solution.z[0], u, 1e-15);
    EXPECT_NEAR(solution.force[0], u > 0 ? -law * u : 0, 1e-8);
    EXPECT_NEAR(solution.force[1], free > wall ? -(load - (k + law) * wall) : 0, 1e-7);
  }
}

// Many points, springs on one half and constraints on the other, under a footing that rocks: KKT to round-off from any start.
TEST(Lagrange, law_and_constraint_halves_under_a_footing) {
  const Footing base = footing(20, 1.5);
  const Matrix stiffness = (Matrix(2, 2) << 4e8, 1e8, 1e8, 3e8).finished();
  for (const double spin : {-3e-3, -1e-3, 0.0, 1e-3, 3e-3})
    for (const double law : {1e5, 1e8, 1e12}) {
      Own own;
      own.add_springs("soft", 10, law);
      own.add_cone("hard", 10, 1, 0);
      own.set(spread_of(stiffness, base.b).factor, base.b * (Vector(2) << -1e-3, spin).finished());
      InterfaceSolution solution;
      for (int again = 0; again < 2; ++again) {
        const Outcome outcome = method("lagrange")->solve(own.problem, solution);
        ASSERT_TRUE(outcome.converged) << outcome.why << spin << law;
        EXPECT_LE(contact_residual(own.problem, solution), 1e-10) << spin << law;
      }
    }
}

// ---- statics: the factored matrix holds a closed joint D that is taken back; a body that rests on contact alone ----

/// A loose body on `points` points, factor of B^T D B.
Own resting_body(int points, double weight, double eccentricity, double horizontal, double friction) {
  const Footing base = footing(points, 1.5);
  const bool plane = friction > 0;
  Matrix b = Matrix::Zero(points * (plane ? 2 : 1), plane ? 3 : 2);
  b.bottomLeftCorner(points, 2) = base.b;
  if (plane) b.topRightCorner(points, 1).setOnes();
  Vector load = Vector::Zero(b.cols());
  load[0] = -weight;
  load[1] = -weight * eccentricity;
  if (plane) load[2] = horizontal;
  Own own;
  own.add_cone("base", points, plane ? 2 : 1, friction, base.area);
  const Vector shift = Vector::Constant(b.rows(), 1e9 / points);
  const Matrix stiffness = b.transpose() * shift.asDiagonal() * b;
  own.set(spread_of(stiffness, b).factor, b * inverse(stiffness) * load);
  own.change().shift = shift;
  return own;
}

TEST(Lagrange, body_that_rests_on_contact_alone) {
  for (const double friction : {0.0, 0.5})
    for (const double e : {0.0, 0.4, 0.9, 1.3}) {
      Own own = resting_body(40, 1e6, e, 0, friction);
      InterfaceSolution solution;
      const Outcome outcome = method("lagrange")->solve(own.problem, solution);
      ASSERT_TRUE(outcome.converged) << outcome.why << friction << e;
      EXPECT_LE(contact_residual(own.problem, solution), 1e-11);
      const Vector normal = solution.force.tail(40);
      EXPECT_LE(normal.maxCoeff(), 0);
      EXPECT_NEAR(normal.sum(), -1e6, 1e-4);
      const std::vector<double> x = footing(40, 1.5).x;
      EXPECT_NEAR(normal.dot(ConstMap(x.data(), 40)), -1e6 * e, 1e-3);
      EXPECT_LE(solution.opening.tail(40).cwiseAbs().maxCoeff(), 1e-12);
    }
}

// Pulled upwards nothing holds it: a reason, not a number.
TEST(Lagrange, loose_body_is_refused) {
  for (const double friction : {0.0, 0.5}) {
    Own own = resting_body(10, -1e5, 0, 0, friction);
    InterfaceSolution solution;
    const Outcome outcome = method("lagrange")->solve(own.problem, solution);
    EXPECT_FALSE(outcome.converged);
    EXPECT_FALSE(outcome.why.empty());
  }
}

TEST(Lagrange, friction_holds_a_resting_body_up_to_the_cone) {
  const double weight = 1e6, friction = 0.5;
  for (const double share : {0.0, 0.5, 0.9, 0.99}) {
    Own own = resting_body(40, weight, 0.2, share * friction * weight, friction);
    InterfaceSolution solution;
    const Outcome outcome = method("lagrange")->solve(own.problem, solution);
    ASSERT_TRUE(outcome.converged) << outcome.why << share;
    EXPECT_LE(contact_residual(own.problem, solution), 1e-10) << share;
    EXPECT_NEAR(solution.force.head(40).sum(), share * friction * weight, 1e-3);
    for (Index i = 0; i < 40; ++i) EXPECT_LE(std::abs(solution.force[i]), -friction * solution.force[40 + i] + 1e-6 * weight);
  }
  Own sliding = resting_body(40, weight, 0.2, 1.01 * friction * weight, friction);  // nothing holds it
  InterfaceSolution solution;
  const Outcome outcome = method("lagrange")->solve(sliding.problem, solution);
  EXPECT_FALSE(outcome.converged);
  EXPECT_NE(outcome.why.find("'base'"), std::string::npos) << outcome.why;
}

// ---- Coulomb friction ----

// One point on springs k_t, k_n: sticks while k_t s <= mu k_n d, else p_t = mu k_n d along the slip, and the rest of s is slip.
TEST(Lagrange, friction_of_one_point) {
  const double kt = 3e6, kn = 5e6, depth = 0.02, mu = 0.4;
  for (const double start : {0.0, 0.003, -0.02})
    for (const double s : {0.0, 0.005, 0.0129, 0.03, -0.01, -0.05}) {
      Own own;
      own.add_cone("base", 1, 2, mu);
      own.set((Matrix(2, 2) << 1 / std::sqrt(kt), 0, 0, 1 / std::sqrt(kn)).finished(), (Vector(2) << start + s, -depth).finished());
      own.problem.from[0] = start;
      InterfaceSolution solution;
      const Outcome outcome = method("lagrange")->solve(own.problem, solution);
      ASSERT_TRUE(outcome.converged) << outcome.why;
      const double bound = mu * kn * depth, expected = std::clamp(kt * s, -bound, bound);
      EXPECT_NEAR(solution.force[1], -kn * depth, 1e-7);
      EXPECT_NEAR(solution.force[0], expected, 1e-7);
      EXPECT_NEAR(solution.opening[0], start + s - expected / kt, 1e-15);
      EXPECT_EQ(solution.status[0], std::abs(kt * s) > bound ? Status::slip : Status::stick);
      EXPECT_GE(solution.force[0] * (solution.opening[0] - start), -1e-12);  // it only dissipates
    }
}

// In 3D with one stiffness the friction force has the direction of the free slip; with two it must be parallel to the slip that results.
TEST(Lagrange, friction_in_space) {
  const double kn = 5e6, depth = 0.02, mu = 0.4, bound = mu * kn * depth;
  for (const double ratio : {1.0, 3.0, 0.1})
    for (const double angle : {0.0, 0.6, 2.0, 4.0})
      for (const double s : {0.005, 0.03, 0.2}) {
        Own own;
        own.add_cone("base", 1, 3, mu);
        const double k1 = 3e6, k2 = ratio * k1;
        Matrix c = Matrix::Zero(3, 3);
        c.diagonal() << 1 / std::sqrt(k1), 1 / std::sqrt(k2), 1 / std::sqrt(kn);
        own.set(c, (Vector(3) << s * std::cos(angle), s * std::sin(angle), -depth).finished());
        InterfaceSolution solution;
        const Outcome outcome = method("lagrange")->solve(own.problem, solution);
        ASSERT_TRUE(outcome.converged) << outcome.why << " " << ratio << " " << angle << " " << s;
        EXPECT_LE(contact_residual(own.problem, solution), 1e-9);
        const Vector force = solution.force.head(2), slip = solution.opening.head(2);
        if (slip.norm() > 1e-9) {
          EXPECT_NEAR(force.norm(), bound, 1e-4);
          EXPECT_NEAR(force.dot(slip), force.norm() * slip.norm(), 1e-8 * force.norm() * slip.norm());
        } else {
          EXPECT_NEAR(force[0], k1 * s * std::cos(angle), 1e-5);
        }
        if (ratio == 1.0) {
          EXPECT_NEAR(force.norm(), std::min(bound, k1 * s), 1e-5);
        }
      }
}

// A rigid footing with friction: forty redundant points, held as a whole up to mu W although the lightly loaded side is on its own cone.
TEST(Lagrange, redundant_points_with_friction) {
  const double mu = 0.4;
  for (const double e : {0.0, 0.6, 1.1}) {
    FlatFooting flat(40, e, 1e6, 2, mu);
    flat.own.problem.from.head(40).setConstant(flat.own.problem.free_opening[0] - 2e-5);  // free slip of 2e-5 m
    InterfaceSolution solution;
    for (int again = 0; again < 2; ++again) {
      const Outcome outcome = method("lagrange")->solve(flat.own.problem, solution);
      ASSERT_TRUE(outcome.converged) << outcome.why << " " << e;
      EXPECT_LE(contact_residual(flat.own.problem, solution), 1e-9) << e;
      EXPECT_LE(solution.force.tail(40).maxCoeff(), 0);
    }
  }
}

// ---- hostile problems: an answer judged by the contact_residual, or a reason that names the point ----

TEST(Lagrange, contradictory_constraints_are_named) {
  Own own;
  own.add_cone("slot", 3, 1, 0);
  own.set((Matrix(3, 1) << 1, -1, 0).finished(), (Vector(3) << -1e-3, -1e-3, 1.0).finished());
  InterfaceSolution solution;
  const Outcome outcome = method("lagrange")->solve(own.problem, solution);
  EXPECT_FALSE(outcome.converged);
  EXPECT_NE(outcome.why.find("contradictory constraints"), std::string::npos);
  EXPECT_NE(outcome.why.find("of 'slot'"), std::string::npos) << outcome.why;
}

TEST(Lagrange, rows_that_nothing_moves) {
  Own own;
  own.add_cone("fixed", 2, 1, 0);
  own.set(Matrix::Zero(2, 2), (Vector(2) << 0.5, 0.0).finished());
  InterfaceSolution open, closed;
  EXPECT_TRUE(method("lagrange")->solve(own.problem, open).converged);
  EXPECT_EQ(open.force.norm(), 0);
  own.problem.free_opening[1] = -1e-3;
  const Outcome outcome = method("lagrange")->solve(own.problem, closed);
  EXPECT_FALSE(outcome.converged);
  EXPECT_NE(outcome.why.find("point 2 of 'fixed'"), std::string::npos) << outcome.why;
}

TEST(Lagrange, not_finite_is_a_reason) {
  for (const double friction : {0.0, 0.5}) {
    Own own;
    own.add_cone("base", 2, 2, friction);
    own.set(Matrix::Identity(4, 4), Vector::Constant(4, std::numeric_limits<double>::quiet_NaN()));
    InterfaceSolution solution;
    const Outcome outcome = method("lagrange")->solve(own.problem, solution);
    EXPECT_FALSE(outcome.converged);
    EXPECT_NE(outcome.why.find("not finite"), std::string::npos) << outcome.why;
  }
}

TEST(Lagrange, duplicate_points_and_extreme_stiffness) {
  for (const double stiffness : {1e-3, 1.0, 1e9, 1e16})
    for (const double friction : {0.0, 0.3}) {
      Own own;
      own.add_cone("base", 4, 2, friction, {1e-6, 1.0, 1.0, 1e4});
      Matrix c = Matrix::Zero(8, 3);
      for (int i = 0; i < 4; ++i) {
        c(i, 2) = 1;
        c(4 + i, 0) = 1;
        c(4 + i, 1) = i < 3 ? -1.0 : 2.0;  // three points in one place
      }
      own.set(c / std::sqrt(stiffness), (Vector(8) << 1e-3, 1e-3, 1e-3, 1e-3, -2e-3, -2e-3, -2e-3, -5e-4).finished());
      InterfaceSolution solution;
      const Outcome outcome = method("lagrange")->solve(own.problem, solution);
      ASSERT_TRUE(outcome.converged) << outcome.why << stiffness;
      EXPECT_LE(contact_residual(own.problem, solution), 1e-9) << stiffness << " " << friction;
      if (friction > 0) continue;
      EXPECT_NEAR(solution.force[5] / solution.force[4], 1e6, 1);  // shared by area
      EXPECT_NEAR(solution.force[5], solution.force[6], 1e-9 * std::abs(solution.force[6]));
    }
}

// The work space is kept, so that solving again gives the same bits, and another problem of another size is taken without complaint.
TEST(Lagrange, solution_is_reusable) {
  InterfaceSolution solution;
  const auto lagrange = method("lagrange");
  const auto work = lagrange->make_work();
  FlatFooting large(40, 0.8, 1e6, 1), small(7, 0.2, 1e6, 2);
  ASSERT_TRUE(lagrange->solve(large.own.problem, *work, solution).converged);
  ASSERT_TRUE(lagrange->solve(large.own.problem, *work, solution).converged);
  const Vector first = solution.force;
  ASSERT_TRUE(lagrange->solve(large.own.problem, *work, solution).converged);
  EXPECT_EQ(first, solution.force);
  ASSERT_TRUE(lagrange->solve(small.own.problem, *work, solution).converged);
  EXPECT_LE(contact_residual(small.own.problem, solution), 1e-12);
  ASSERT_TRUE(lagrange->solve(large.own.problem, *work, solution).converged);
  EXPECT_LE((first - solution.force).norm(), 1e-10 * first.norm());
}

}  // namespace
}  // namespace uplift::contact_test::lagrange_test
