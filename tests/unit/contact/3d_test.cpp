#include <algorithm>
#include <cmath>
#include <random>

#include "unit/contact/contact_support.h"
#include "uplift/contact/newton/newton.h"

// Contact of surfaces: three components a point, (t1, t2, n).
namespace uplift::contact_test::three_dimensions_test {
namespace {

const std::vector<std::string> all_methods = {"newton", "penalty", "augmented_lagrangian", "lagrange"};

std::unique_ptr<const InterfaceLaw> rubbing_springs(double stiffness, double friction) {
  auto table = std::make_shared<RawTable>();
  table->entries.emplace_back("type", Raw{std::string("springs"), {}, "type"});
  table->entries.emplace_back("K_n", Raw{stiffness, {}, "K_n"});
  table->entries.emplace_back("tangential", Raw{std::string("coulomb"), {}, "tangential"});
  table->entries.emplace_back("K_t", Raw{stiffness, {}, "K_t"});
  table->entries.emplace_back("friction", Raw{friction, {}, "friction"});
  return make_part(law_catalog(), check_part(Raw{table, {}, "test"}, interface_behaviours()));
}

/// Cones, or (Newton) stiff springs.
Own surface(const std::string& method_name, int points, double friction, double stiffness = 1e8) {
  Own own;
  if (method_name != "newton") {
    own.add_cone("surface", points, 3, friction);
    return own;
  }
  own.laws.push_back(rubbing_springs(stiffness, friction));
  Block& block = own.add("surface", points, 3, std::vector<double>(static_cast<std::size_t>(points), 1.0));
  block.law = own.laws.back().get();
  own.problem.old.setZero(block.law->num_history(3) * points);
  return own;
}
std::unique_ptr<const ContactMethod> chosen(const std::string& name, double stiffness = 1e8) {
  return name == "penalty" ? method(name, {{"stiffness", stiffness}}) : method(name);
}

struct Data {
  Matrix factor;
  Vector free_opening, from;
};

/// Rows of a body of many unknowns (`rigid`: of a rigid one with six), compressed in the mean and pushed along.
Data draw(int points, bool rigid, unsigned seed) {
  std::mt19937 engine(seed);
  std::normal_distribution<double> normal;
  const Index rows = 3 * points, columns = rigid ? 6 : rows;
  Data data{Matrix::Zero(rows, columns), Vector::Zero(rows), Vector::Zero(rows)};
  if (rigid) {
    for (int i = 0; i < points; ++i) {
      const double x = normal(engine), y = normal(engine);
      data.factor.row(i) << 1, 0, 0, 0, 0, -y;
      data.factor.row(points + i) << 0, 1, 0, 0, 0, x;
      data.factor.row(2 * points + i) << 0, 0, 1, y, -x, 0;
    }
  } else {
    for (Index i = 0; i < rows; ++i)
      for (Index j = 0; j < columns; ++j)
        data.factor(i, j) = 0.2 * normal(engine) / std::sqrt(static_cast<double>(rows)) + (i == j ? 1 : 0);
  }
  data.factor *= 1e-4;
  const Vector push = Vector::NullaryExpr(columns, [&] { return normal(engine); });
  data.free_opening = 2 * data.factor * push;
  data.free_opening.tail(points).array() -= rigid ? 3e-4 : 1e-4;
  for (Index i = 0; i < 2 * points; ++i) data.from[i] = rigid ? 0 : 1e-5 * normal(engine);
  return data;
}

/// The same with the tangential axes turned.
Data turned(const Data& data, double angle) {
  const Index n = data.factor.rows() / 3;
  const double c = std::cos(angle), s = std::sin(angle);
  Data result = data;
  result.factor.topRows(n) = c * data.factor.topRows(n) + s * data.factor.middleRows(n, n);
  result.factor.middleRows(n, n) = -s * data.factor.topRows(n) + c * data.factor.middleRows(n, n);
  const auto turn = [&](const Vector& v, Vector& w) {
    w.head(n) = c * v.head(n) + s * v.segment(n, n);
    w.segment(n, n) = -s * v.head(n) + c * v.segment(n, n);
  };
  turn(data.free_opening, result.free_opening);
  turn(data.from, result.from);
  return result;
}

void take(Own& own, const Data& data) {
  own.set(data.factor, data.free_opening);
  own.problem.from = data.from;
}

// Claim: the answer does not depend on the choice of the tangential axes.
TEST(Surface, is_isotropic) {
  int slipped = 0;
  for (const std::string& name : all_methods)
    for (const bool rigid : {false, true})
      for (unsigned seed = 1; seed <= 5; ++seed) {
        const Data data = draw(9, rigid, seed);
        Own own = surface(name, 9, 0.3);
        take(own, data);
        InterfaceSolution reference;
        const Outcome first = chosen(name)->solve(own.problem, reference);
        ASSERT_TRUE(first.converged) << name << rigid << seed << first.why;
        slipped += static_cast<int>(std::count(reference.status.begin(), reference.status.end(), Status::slip));
        for (const double angle : {0.3, 1.2, std::acos(-1) / 2, 2.9}) {
          take(own, turned(data, angle));
          InterfaceSolution solution;
          const Outcome outcome = chosen(name)->solve(own.problem, solution);
          ASSERT_TRUE(outcome.converged) << name << rigid << seed << outcome.why;
          EXPECT_LE((solution.z - reference.z).norm(), 1e-10 * reference.z.norm()) << name << rigid << seed << ", angle " << angle;
          if (name != "penalty") EXPECT_LE(contact_residual(own.problem, solution), 1e-10);
        }
      }
  EXPECT_GT(slipped, 20);
}

// Claim: a block pushed obliquely along a plane moves by (|H| - mu N)/kappa in the direction of H, friction mu N against it; below the
// bound it stays. kappa: resistance of the block; N: the weight, less what the block's own resistance carries on springs.
TEST(Surface, block_slides_on_a_plane) {
  constexpr int points = 4;
  constexpr double kappa = 1e6, weight = 1e4, friction = 0.35, stiffness = 1e8;
  for (const std::string& name : all_methods)
    for (const double angle : {0.0, 0.4, 2.0, 4.5})
      for (const double share : {0.5, 0.9, 1.1, 3.0}) {
        const bool springs = name == "newton" || name == "penalty";
        const double pressed = springs ? weight * stiffness * points / (kappa + stiffness * points) : weight;
        const double push = share * friction * pressed;
        Own own = surface(name, points, friction, stiffness);
        Matrix factor = Matrix::Zero(3 * points, 3);
        for (int c = 0; c < 3; ++c) factor.col(c).segment(c * points, points).setConstant(1 / std::sqrt(kappa));
        Vector free_opening(3 * points);
        const double load[3] = {push * std::cos(angle), push * std::sin(angle), -weight};
        for (int c = 0; c < 3; ++c) free_opening.segment(c * points, points).setConstant(load[c] / kappa);
        own.set(factor, free_opening);
        InterfaceSolution solution;
        const Outcome outcome = chosen(name, stiffness)->solve(own.problem, solution);
        SCOPED_TRACE(name + ", angle " + std::to_string(angle) + ", share " + std::to_string(share));
        ASSERT_TRUE(outcome.converged) << outcome.why;
        const double along_x = std::cos(angle), along_y = std::sin(angle);
        const double force_x = solution.force.head(points).sum(), force_y = solution.force.segment(points, points).sum();
        EXPECT_NEAR(-solution.force.tail(points).sum(), pressed, 1e-9 * weight);
        EXPECT_NEAR(-force_x * along_y + force_y * along_x, 0, 1e-9 * weight);
        double resists = std::min(push, friction * pressed), moved = (push - resists) / kappa;
        if (springs && share < 1) moved = push / (kappa + stiffness * points), resists = moved * stiffness * points;
        EXPECT_NEAR(force_x * along_x + force_y * along_y, resists, 1e-9 * weight);  // against the motion
        for (int i = 0; i < points; ++i) {
          EXPECT_NEAR(solution.opening[i], moved * along_x, 1e-9 * weight / kappa);
          EXPECT_NEAR(solution.opening[points + i], moved * along_y, 1e-9 * weight / kappa);
        }
      }
}

// Claim: the slope of the augmented force is its derivative (open, stick and slip points, all three components).
TEST(Surface, tangent_is_the_derivative) {
  constexpr int points = 12;
  Data data = draw(points, false, 7);
  data.free_opening.head(2 * points) *= 0.1;  // some points stick
  Own own = surface("augmented_lagrangian", points, 0.3);
  take(own, data);
  const Vector stiffness = Vector::Constant(3 * points, 1e8);
  Vector multiplier = Vector::Zero(3 * points);
  multiplier.head(points).setConstant(100);
  const AugmentedForce augmented{&multiplier, &stiffness};
  InterfaceSolution solution;
  NewtonWork work;
  size_newton(own.problem, work, solution);
  evaluate(own.problem, augmented, true, work, solution);
  const Vector slope = work.slope;
  int slips = 0, opens = 0;
  constexpr double h = 1e-9;
  for (int c = 0; c < 3; ++c)
    for (int i = 0; i < points; ++i) {
      Vector forces[2];
      for (const int side : {0, 1}) {
        own.problem.free_opening = data.free_opening;
        own.problem.free_opening[c * points + i] += side == 0 ? -h : h;
        evaluate(own.problem, augmented, false, work, solution);
        forces[side] = solution.force;
      }
      for (int r = 0; r < 3; ++r)
        EXPECT_NEAR((forces[1] - forces[0])[r * points + i] / (2 * h), slope[(r * 3 + c) * points + i], 1e-5 * 1e8) << r << c << i;
      if (c == 0) {
        const double q = forces[0][2 * points + i], t = std::hypot(forces[0][i], forces[0][points + i]);
        opens += q == 0;
        slips += q < 0 && t >= -0.3 * q * (1 - 1e-9);
      }
    }
  EXPECT_GT(slips, 1);
  EXPECT_GT(opens, 1);
  EXPECT_LT(slips + opens, points);
}

// Claim: the exact methods solve and agree, on rigid bodies (redundant rows) and on many independent rows, beside springs too.
TEST(Surface, exact_methods_agree) {
  for (const bool rigid : {false, true})
    for (const bool beside : {false, true})
      for (unsigned seed = 11; seed < 21; ++seed) {
        const int points = 8, extra = beside ? 4 : 0;
        const Data data = draw(points + extra, rigid, seed);
        Own own = surface("lagrange", points, 0.4);
        if (beside) {  // the other points on springs
          own.laws.push_back(rubbing_springs(2e7, 0.5));
          Block& block = own.add("springs", extra, 3, std::vector<double>(static_cast<std::size_t>(extra), 1.0));
          block.law = own.laws.back().get();
          own.problem.old.setZero(block.law->num_history(3) * extra);
        }
        take(own, data);
        InterfaceSolution solutions[2];
        for (const int k : {0, 1}) {
          const Outcome outcome = method(k == 0 ? "lagrange" : "augmented_lagrangian")->solve(own.problem, solutions[k]);
          ASSERT_TRUE(outcome.converged) << rigid << beside << seed << k << outcome.why;
          EXPECT_LE(contact_residual(own.problem, solutions[k]), 1e-9) << rigid << beside << seed << k;
        }
        // under a rigid body friction has several solutions: the pressures, and with them the friction, can be shared in many ways
        if (!rigid) EXPECT_LE((solutions[0].z - solutions[1].z).norm(), 1e-7 * solutions[0].z.norm()) << rigid << beside << seed;
      }
}

// Claim: what is kept from step to step (compliance, factor, first guess) does not change an answer: a path in many steps, every step
// solved afresh too, with another compliance in between.
TEST(Surface, what_is_kept_does_not_show) {
  constexpr int points = 10;
  for (const std::string name : {"newton", "augmented_lagrangian", "lagrange"}) {
    const Data data = draw(points, false, 3), other = draw(points, false, 4);
    Own own = surface(name, points, 0.4);
    take(own, data);
    InterfaceSolution kept;
    const auto work = chosen(name)->make_work();
    int changes = 0;
    for (int step = 0; step < 60; ++step) {
      if (step == 30) own.change().factor = other.factor;
      const double phase = 0.1 * step;
      own.problem.free_opening = data.free_opening + 1e-4 * std::sin(phase) * other.free_opening.normalized() +
                                 (1 - std::cos(3 * phase)) * 0.3 * other.free_opening;
      const std::vector<Status> before = kept.status;
      const Outcome outcome = chosen(name)->solve(own.problem, *work, kept);
      ASSERT_TRUE(outcome.converged) << name << step << outcome.why;
      EXPECT_LE(contact_residual(own.problem, kept), 1e-10) << name << step;
      changes += before != kept.status;
      InterfaceSolution fresh;
      ASSERT_TRUE(chosen(name)->solve(own.problem, fresh).converged);
      EXPECT_LE((kept.z - fresh.z).norm(), 1e-9 * fresh.z.norm()) << name << step;
    }
    if (name == "lagrange") EXPECT_GT(changes, 5);
  }
}

}  // namespace
}  // namespace uplift::contact_test::three_dimensions_test
