#include "uplift/contact/lagrange/force_share.h"

#include <numbers>
#include <random>

#include "unit/contact/contact_support.h"
#include "unit/contact/least_norm.h"

// How points of a rigid base share a force: of all forces with the resultant found that the cones admit, the one of least sum p^2/area.
namespace uplift::contact_test::force_share_test {
namespace {

/// Points of a rigid body of unit masses at the height `height` above them; rows of (u_x, theta, u_y) or of all six.
struct Base {
  Own own;
  InterfaceSolution solution;
  std::vector<double> x, y, area;
  int components;
  double friction;
  Base(std::vector<double> at_x, std::vector<double> at_y, std::vector<double> areas, int c, double mu, double height = 2)
      : x(std::move(at_x)), y(std::move(at_y)), area(std::move(areas)), components(c), friction(mu) {
    const Index n = points();
    Matrix b = Matrix::Zero(n * c, c == 3 ? 6 : 3);
    for (Index i = 0; i < n; ++i) {
      const double xi = x[static_cast<std::size_t>(i)], yi = y[static_cast<std::size_t>(i)];
      b(i, 0) = 1, b(i, 1) = -height, b(normal(i), 2) = 1, b(normal(i), 1) = xi;
      if (c < 3) continue;
      b(n + i, 3) = 1, b(n + i, 4) = -height, b(normal(i), 4) = yi;
      b(i, 5) = -yi, b(n + i, 5) = xi;
    }
    own.add_cone("base", static_cast<int>(n), c, mu, area);
    own.set(b, Vector::Zero(n * c));
    solution.opening = Vector::Zero(n * c);
    solution.force = Vector::Zero(n * c);
  }
  Index points() const { return static_cast<Index>(x.size()); }
  Index normal(Index i) const { return (components - 1) * points() + i; }
  const Matrix& rows() const { return own.problem.model->factor; }
  double pressure(Index i) const { return -solution.force[normal(i)] / area[static_cast<std::size_t>(i)]; }
  void press(Index i, double force, double along_x = 0, double along_y = 0) {
    solution.force[normal(i)] = -force;
    solution.force[i] = along_x;
    if (components == 3) solution.force[points() + i] = along_y;
  }
  void slide(Index i, double along_x, double along_y = 0) {
    solution.opening[i] = along_x;
    if (components == 3) solution.opening[points() + i] = along_y;
  }
  bool share() {
    solution.z = -rows().transpose() * solution.force;
    own.problem.free_opening = solution.opening - rows() * solution.z;
    ForceShare share;
    return share.solve(own.problem, 1e-12, solution);
  }
};

std::vector<double> steps(int n, double from, double to) {
  std::vector<double> result;
  for (int i = 0; i < n; ++i) result.push_back(from + (to - from) * i / (n - 1));
  return result;
}

/// By Dykstra, from the resultant of the forces that the base has now; whether it leaves more than one force.
std::pair<Vector, bool> by_dykstra(const Base& base) {
  const Index n = base.points();
  std::vector<ConePart> cones;
  Matrix rows(base.rows().cols(), n * base.components), back = Matrix::Zero(n * base.components, n * base.components);
  Index column = 0;
  for (Index i = 0; i < n; ++i) {
    const double root = std::sqrt(base.area[static_cast<std::size_t>(i)]);
    Vector slip = Vector::Zero(2);
    for (int c = 0; c + 1 < base.components; ++c) slip[c] = base.solution.opening[c * n + i];
    const bool slides = slip.norm() > 0;
    cones.push_back({column, slides ? 1 : base.components, base.friction});
    if (slides) {
      for (int c = 0; c + 1 < base.components; ++c)
        back(c * n + i, column) = root * base.friction * slip[c] / slip.norm() / std::hypot(1, base.friction);
      back(base.normal(i), column++) = -root / std::hypot(1, base.friction);
    } else {
      for (int c = 0; c < base.components; ++c) back(c * n + i, column++) = root;
    }
  }
  const Matrix used = back.leftCols(column);
  const Matrix given = base.rows().transpose() * used;
  return {used * least_norm(cones, given, base.rows().transpose() * base.solution.force), PivotedQr(given)->rank() < column};
}

TEST(ForceShare, IsTheProjectionThatDykstraFinds) {
  constexpr double pi = std::numbers::pi;
  int moved = 0, bounded = 0;
  for (unsigned seed = 0; seed < 60; ++seed) {
    std::mt19937 generator(seed);
    std::uniform_real_distribution<> uniform(-1, 1);
    const int components = seed % 2 == 0 ? 2 : 3, n = 2 + static_cast<int>(seed % 7);
    std::vector<double> x, y, area;
    for (int i = 0; i < n; ++i)
      x.push_back(uniform(generator)), y.push_back(uniform(generator)), area.push_back(std::exp(uniform(generator)));
    Base base(x, y, area, components, 0.2 + 0.5 * (1 + uniform(generator)));
    const double turn = seed % 3 == 0 ? 0.5 : 0;  // the slip of a body that turns as it slides
    for (int i = 0; i < n; ++i) {
      const double p = std::exp(2 * uniform(generator)), share = std::abs(uniform(generator)), angle = pi * uniform(generator);
      double along_x = components == 3 ? std::cos(angle) : angle > 0 ? 1 : -1, along_y = components == 3 ? std::sin(angle) : 0;
      const bool slides = seed % 5 == 0 || (seed % 5 == 1 && uniform(generator) > 0);
      if (slides) {
        along_x = 0.8 - turn * y[static_cast<std::size_t>(i)], along_y = components == 3 ? 0.6 + turn * x[static_cast<std::size_t>(i)] : 0;
        base.slide(i, along_x, along_y);
      }
      const double force = base.friction * p * (slides ? 1 : share) / std::hypot(along_x, along_y);
      base.press(i, p, force * along_x, force * along_y);
    }
    const Vector found = base.solution.force;
    const auto [expected, redundant] = by_dykstra(base);
    EXPECT_EQ(base.share(), redundant) << seed;
    for (Index i = 0; i < n; ++i) {
      double shear = 0;
      for (int c = 0; c + 1 < components; ++c) shear = std::hypot(shear, base.solution.force[c * n + i]);
      const double bound = -base.friction * base.solution.force[base.normal(i)];
      if (base.solution.opening[i] == 0 && bound > 1e-6 * found.cwiseAbs().maxCoeff() && shear >= bound * (1 - 1e-12)) {
        ++bounded;
        break;
      }
    }
    const double size = expected.cwiseAbs().maxCoeff();
    EXPECT_LE((base.solution.force - expected).cwiseAbs().maxCoeff(), 1e-6 * size) << seed;
    EXPECT_LE((base.rows().transpose() * (base.solution.force - found)).norm(), 1e-10 * (base.rows().transpose() * found).norm()) << seed;
    if ((base.solution.force - found).cwiseAbs().maxCoeff() > 0.1 * size) ++moved;
  }
  EXPECT_GT(moved, 30);
  EXPECT_GT(bounded, 15);  // in which a bound of friction decides at a point that bears
}

/// Where every point bears: N/A + M_y x/I + M_x y/I, the shear by area, the torque by area and distance.
TEST(ForceShare, IsNaviersWhereEveryPointBears) {
  std::vector<double> x, y;
  for (const double at_y : steps(5, -1.5, 1.5))
    for (const double at_x : steps(5, -1, 1)) x.push_back(at_x), y.push_back(at_y);
  Base base(x, y, std::vector<double>(25, 0.04), 3, 0.5);
  for (const Index corner : {0, 4, 20, 24}) base.press(corner, 2.5 + 0.1 * static_cast<double>(corner), 0.3, corner < 10 ? 0.2 : -0.1);
  double force = 0, moment_x = 0, moment_y = 0, shear_x = 0, shear_y = 0, torque = 0, square_x = 0, square_y = 0;
  for (std::size_t i = 0; i < 25; ++i) {
    const Index at = static_cast<Index>(i);
    const double p = -base.solution.force[base.normal(at)], along_x = base.solution.force[at], along_y = base.solution.force[25 + at];
    force += p, moment_x += p * y[i], moment_y += p * x[i], shear_x += along_x, shear_y += along_y,
        torque += x[i] * along_y - y[i] * along_x;
    square_x += 0.04 * x[i] * x[i], square_y += 0.04 * y[i] * y[i];
  }
  ASSERT_TRUE(base.share());
  for (std::size_t i = 0; i < 25; ++i) {
    const Index at = static_cast<Index>(i);
    EXPECT_NEAR(base.pressure(at), force + moment_y * x[i] / square_x + moment_x * y[i] / square_y, 1e-12 * force);  // area 1
    EXPECT_NEAR(base.solution.force[at] / 0.04, shear_x - torque * y[i] / (square_x + square_y), 1e-12 * force);
    EXPECT_NEAR(base.solution.force[25 + at] / 0.04, shear_y + torque * x[i] / (square_x + square_y), 1e-12 * force);
  }
}

/// Without friction, beyond the kernel: p = k (x - x_0) on one side of x_0, which bisection finds from the eccentricity.
TEST(ForceShare, IsATriangleBeyondTheKernel) {
  const std::vector<double> x = steps(41, -1, 1);
  for (const double eccentricity : {0.45, 0.7, 0.93}) {
    Base base(x, std::vector<double>(41, 0.0), std::vector<double>(41, 0.05), 2, 0);
    base.press(0, 0.5 * (1 - eccentricity)), base.press(40, 0.5 * (1 + eccentricity));
    double low = -1, high = 1;
    const auto sums = [&](double edge) {
      double force = 0, moment = 0;
      for (const double at : x) force += 0.05 * std::max(0.0, at - edge), moment += 0.05 * at * std::max(0.0, at - edge);
      return std::pair(force, moment);
    };
    for (int i = 0; i < 60; ++i) {
      const double edge = 0.5 * (low + high);
      const auto [force, moment] = sums(edge);
      (moment < eccentricity * force ? low : high) = edge;
    }
    ASSERT_TRUE(base.share());
    const double slope = 1 / sums(low).first;
    for (Index i = 0; i < 41; ++i)
      EXPECT_NEAR(base.pressure(i), slope * std::max(0.0, x[static_cast<std::size_t>(i)] - low), 1e-9) << eccentricity << " " << i;
  }
}

/// Two points that push against each other: only the shear of the body stays. One point, and a corner that bears all: nothing is free.
TEST(ForceShare, FewPoints) {
  Base two({-1, 1}, {0.5, 0.5}, {1, 1}, 3, 0.5);
  two.press(0, 1, 0.4, 0.1), two.press(1, 1, -0.2, 0.1);
  ASSERT_TRUE(two.share());
  for (Index i = 0; i < 2; ++i) {
    EXPECT_NEAR(two.pressure(i), 1, 1e-12);
    EXPECT_NEAR(two.solution.force[i], 0.1, 1e-12);
    EXPECT_NEAR(two.solution.force[2 + i], 0.1, 1e-12);
  }
  Base one({0.3}, {-0.2}, {0.5}, 3, 0.5);
  one.press(0, 2, 0.6, -0.8);
  const Vector alone = one.solution.force;
  EXPECT_FALSE(one.share());  // its rows are independent
  EXPECT_LE((one.solution.force - alone).cwiseAbs().maxCoeff(), 1e-12);
  Base corner({-1, 0, 1, -1, 0, 1, -1, 0, 1}, {-1, -1, -1, 0, 0, 0, 1, 1, 1}, std::vector<double>(9, 0.1), 3, 0.5);
  corner.press(8, 2, 0.6, -0.8);
  const Vector all = corner.solution.force;
  ASSERT_TRUE(corner.share());
  EXPECT_LE((corner.solution.force - all).cwiseAbs().maxCoeff(), 1e-9);
}

/// A shear of mu N, sticking or sliding, makes every point use all its friction: tau = mu p, p by Navier.
TEST(ForceShare, AllFrictionIsUsedAtTheBound) {
  for (const bool slides : {false, true}) {
    Base base(steps(11, -1, 1), std::vector<double>(11, 0.0), std::vector<double>(11, 1.0), 3, 0.4);
    for (const Index i : {1, 7, 9}) base.press(i, 1, 0.4 * 0.6, 0.4 * 0.8);
    for (Index i = 0; slides && i < 11; ++i) base.slide(i, 3e-5, 4e-5);
    double moment = 0, square = 0;
    for (const Index i : {1, 7, 9}) moment += base.x[static_cast<std::size_t>(i)];
    for (const double x : base.x) square += x * x;
    ASSERT_TRUE(base.share()) << slides;
    for (Index i = 0; i < 11; ++i) {
      const double p = 3.0 / 11 + moment * base.x[static_cast<std::size_t>(i)] / square;
      ASSERT_GT(p, 0);
      EXPECT_NEAR(base.pressure(i), p, 1e-8) << slides << " " << i;
      EXPECT_NEAR(base.solution.force[i], 0.24 * p, 1e-8) << slides << " " << i;
      EXPECT_NEAR(base.solution.force[11 + i], 0.32 * p, 1e-8) << slides << " " << i;
    }
  }
}

TEST(ForceShare, LeavesWhatNoClosedPointCanBear) {
  Base base({-1, 0, 1}, {0, 0, 0}, {1, 1, 1}, 2, 0.5);
  base.press(0, -1), base.press(2, 0.2);  // is pulled at
  const Vector found = base.solution.force;
  EXPECT_FALSE(base.share());
  EXPECT_EQ(base.solution.force, found);
  Base open({-1, 0, 1}, {0, 0, 0}, {1, 1, 1}, 2, 0.5);
  open.solution.opening.setConstant(1);
  EXPECT_FALSE(open.share());
}

/// Friction below the bound is none of a slide: what the rays cannot give stays as it was found.
TEST(ForceShare, LeavesAResultantThatNoSlideGives) {
  Base base({-1, 0, 1}, {0, 0, 0}, {1, 1, 1}, 2, 0.5);
  for (Index i = 0; i < 3; ++i) base.press(i, 1 + 0.5 * static_cast<double>(i), 0.2), base.slide(i, 1);
  const Vector found = base.solution.force;
  EXPECT_FALSE(base.share());
  EXPECT_EQ(base.solution.force, found);
}

/// A base turns about its centre; two of its points with hardly any pressure have a friction along their arm. Of the admissible forces the
/// shortest presses there, across the slip.
TEST(ForceShare, KeepsWhatIsBetter) {
  Base base({-1, 1, 1, -1, 0, 0, -2, 2}, {-1, -1, 1, 1, -3, 3, 0, 0}, std::vector<double>(8, 1.0), 3, 0.5);
  for (Index i = 0; i < 8; ++i) {
    const double x = base.x[static_cast<std::size_t>(i)], y = base.y[static_cast<std::size_t>(i)], arm = std::hypot(x, y);
    base.slide(i, -y, x);
    if (i < 6)
      base.press(i, 1, 0.5 * -y / arm, 0.5 * x / arm);
    else
      base.press(i, 1e-9, 0.5e-9 * x / arm);
  }
  const Vector found = base.solution.force;
  EXPECT_FALSE(base.share());
  EXPECT_EQ(base.solution.force, found);
}

/// Three points of a plane base stick whose tangential openings at the beginning differ by round-off: no motion of the base holds all of
/// them exactly, and what is left is no slip. z by hand from the openings, B z = -free opening / 1e-4: f = C^T p = -z.
TEST(ForceShare, PointsHeldWithinRoundOffStick) {
  constexpr double height = 2, shear = 300, weight = 1000;
  Vector exact;  // of the first: no openings to differ
  for (const std::string name : {"lagrange", "augmented_lagrangian"})
    for (const double off : {0.0, 1e-14, 1e-13}) {
      if (off > 0 && name != "lagrange") continue;  // the multipliers of points that contradict each other do not come to rest
      Base base({-1, 0, 1}, {0, 0, 0}, {1, 1, 1}, 2, 0.6, height);
      ContactModel& model = base.own.change();
      model.factor *= 1e-4;
      model.size = 4;
      InterfaceProblem& problem = base.own.problem;
      for (Index i = 0; i < 3; ++i) problem.free_opening[i] = 1e-8 * shear, problem.free_opening[3 + i] = -1e-8 * weight;
      problem.from[1] = off, problem.from[2] = -off;
      InterfaceSolution solution;
      const Outcome outcome = method(name)->solve(problem, solution);
      ASSERT_TRUE(outcome.converged) << name << outcome.why;
      EXPECT_LE(contact_residual(problem, solution), 1e-8) << name << off;
      const Vector& force = solution.force;
      if (exact.size() == 0) exact = force;
      EXPECT_LE((force - exact).cwiseAbs().maxCoeff(), 1e-6 * weight) << name << off;
      EXPECT_NEAR(force.head(3).sum(), shear, 1e-6 * weight) << name << off;
      EXPECT_NEAR(force.tail(3).sum(), -weight, 1e-6 * weight) << name << off;
      EXPECT_NEAR(force[5] - force[3], height * shear, 1e-6 * weight) << name << off;  // the moment about the centre of the base is zero
      for (Index i = 0; i < 3; ++i) EXPECT_LE(std::abs(force[i]), -0.6 * force[3 + i] + 1e-6 * weight) << name << off << i;
    }
}

}  // namespace
}  // namespace uplift::contact_test::force_share_test
