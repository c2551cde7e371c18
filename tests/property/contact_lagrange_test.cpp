#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <optional>
#include <random>

#include "unit/contact/contact_support.h"

// The Lagrange method on random interface problems against brute force over all contact statuses.
namespace uplift::contact_test::contact_lagrange_test {
namespace {

class Dice {
 public:
  explicit Dice(unsigned seed) : engine_(seed) {}
  double uniform(double least, double most) { return std::uniform_real_distribution<double>(least, most)(engine_); }
  double normal() { return std::normal_distribution<double>()(engine_); }
  int integer(int least, int most) { return std::uniform_int_distribution<int>(least, most)(engine_); }
  bool chance(double p) { return uniform(0, 1) < p; }

 private:
  std::mt19937 engine_;
};

Matrix random_factor(Dice& dice, int rows, int columns, double scale) {
  Matrix c(rows, columns);
  for (int i = 0; i < rows; ++i)
    for (int k = 0; k < columns; ++k) c(i, k) = scale * dice.normal();
  return c;
}

/// The unique minimiser of |z|^2/2 with target + C z >= 0, by trying every subset of rows; nothing when the constraints contradict each
/// other.
std::optional<Vector> brute_force(const Matrix& c, const Vector& target) {
  const int n = static_cast<int>(c.rows());
  const double size = target.cwiseAbs().maxCoeff();
  for (int set = 0; set < 1 << n; ++set) {
    std::vector<int> rows;
    for (int i = 0; i < n; ++i)
      if ((set >> i & 1) != 0) rows.push_back(i);
    const int k = static_cast<int>(rows.size());
    if (k > c.cols()) continue;
    Matrix a(k, c.cols());
    Vector b(k);
    for (int i = 0; i < k; ++i) a.row(i) = c.row(rows[static_cast<std::size_t>(i)]), b[i] = -target[rows[static_cast<std::size_t>(i)]];
    Vector push(0), z = Vector::Zero(c.cols());
    if (k > 0) {
      CompleteQr qr;
      qr->setThreshold(1e-9);
      qr.compute(a);
      if (qr->rank() < k) continue;
      z = qr.solve(b);
      push = CompleteQr(a.transpose()).solve(z);
      if (push.minCoeff() < -1e-9 * push.cwiseAbs().maxCoeff()) continue;
    }
    if ((target + c * z).minCoeff() > -1e-9 * size) return z;
  }
  return std::nullopt;
}

void check_frictionless(unsigned seed, bool redundant) {
  Dice dice(seed);
  const int r = dice.integer(1, redundant ? 3 : 7), n = dice.integer(1, 9);
  const double scale = std::pow(10.0, dice.uniform(-6, 0)), size = std::pow(10.0, dice.uniform(-5, 1));
  Matrix c = random_factor(dice, n, r, scale);
  Vector target(n);
  const Vector motion = random_factor(dice, r, 1, size / scale).col(0);
  for (int i = 0; i < n; ++i) {
    target[i] = size * dice.normal();
    if (redundant && i > 0 && dice.chance(0.4))
      c.row(i) = dice.chance(0.5) ? c.row(i - 1).eval() : (0.3 * c.row(0) + 0.7 * c.row(i - 1)).eval();
    if (redundant) target[i] = c.row(i).dot(motion) + (dice.chance(0.3) ? size * std::abs(dice.normal()) : 0);  // can always be opened
  }
  Own own;
  std::vector<double> area;
  for (int i = 0; i < n; ++i) area.push_back(std::pow(10.0, dice.uniform(-2, 1)));
  own.add_cone("wall", n, 1, 0, area);
  own.set(c, target);
  InterfaceSolution solution;
  if (dice.chance(0.5))  // a wrong warm start
    for (int i = 0; i < n; ++i) solution.status.push_back(dice.chance(0.5) ? Status::slip : Status::open);
  const Outcome outcome = method("lagrange")->solve(own.problem, solution);
  const std::optional<Vector> expected = brute_force(c, target);
  if (!expected) {
    RC_ASSERT(!outcome.converged);
    RC_ASSERT(outcome.why.find("contradictory constraints") != std::string::npos);
    return;
  }
  RC_ASSERT(outcome.converged);
  // opposing rows, as in a wedge, carry forces that cancel: round-off grows with them
  const double cancelled = (c.cwiseAbs().transpose() * solution.force.cwiseAbs()).norm();
  RC_ASSERT(contact_residual(own.problem, solution) <= 1e-10 + (solution.z.norm() > 0 ? 1e-14 * cancelled / solution.z.norm() : 0));
  RC_ASSERT(solution.force.maxCoeff() <= 0);
  RC_ASSERT((solution.z - *expected).norm() <= 1e-7 * expected->norm());
}

RC_GTEST_PROP(Lagrange, frictionless_against_brute_force, ()) {
  check_frictionless(*rc::gen::arbitrary<unsigned>(), false);
}
RC_GTEST_PROP(Lagrange, redundant_rows_against_brute_force, ()) {
  check_frictionless(*rc::gen::arbitrary<unsigned>(), true);
}

// Of all admissible forces the least-norm one: p/area = min(0, C y) on the closed rows, which no other admissible force beats.
RC_GTEST_PROP(Lagrange, redundant_forces_are_of_least_norm, ()) {
  Dice dice(*rc::gen::arbitrary<unsigned>());
  const int n = dice.integer(3, 60);
  const Footing base = footing(n, 1.5);
  const double offset = dice.uniform(-1.49, 1.49), weight = std::pow(10.0, dice.uniform(2, 8));
  Matrix stiffness = Matrix::Zero(2, 2);
  stiffness.diagonal() << std::pow(10.0, dice.uniform(7, 9)), std::pow(10.0, dice.uniform(7, 9));
  const Spread spread = spread_of(stiffness, base.b);
  Own own;
  own.add_cone("footing", n, 1, 0, base.area);
  // the free motion under the weight at x = offset: the footing stays flat on the ground when it is held
  const Vector load = (Vector(2) << -weight, -weight * offset).finished();
  own.set(spread.factor, base.b * inverse(stiffness) * load);
  InterfaceSolution solution;
  RC_ASSERT(method("lagrange")->solve(own.problem, solution).converged);
  RC_ASSERT(contact_residual(own.problem, solution) <= 1e-10);
  RC_ASSERT(solution.force.maxCoeff() <= 0);
  RC_ASSERT((base.b.transpose() * solution.force - load).norm() <= 1e-9 * load.norm());  // resultants
  // the tensionless linear distribution with these resultants: p/area = min(0, y0 + y1 x), by Newton on y, independently
  Vector y = (Vector(2) << -weight / 3, 0).finished();
  for (int iteration = 0; iteration < 200; ++iteration) {
    Matrix slope = 1e-14 * Matrix::Identity(2, 2);
    Vector sum = Vector::Zero(2);
    for (int i = 0; i < n; ++i) {
      const double field = base.b.row(i).dot(y);
      if (field >= 0) continue;
      sum += base.area[static_cast<std::size_t>(i)] * field * base.b.row(i).transpose();
      slope += base.area[static_cast<std::size_t>(i)] * base.b.row(i).transpose() * base.b.row(i);
    }
    const Vector step = inverse(slope) * (load - sum);
    if (step.norm() <= 1e-15 * y.norm()) break;
    y += step;
  }
  for (int i = 0; i < n; ++i)
    RC_ASSERT(std::abs(solution.force[i] - base.area[static_cast<std::size_t>(i)] * std::min(0.0, base.b.row(i).dot(y))) <= 1e-8 * weight);
}

// ---- friction ----

/// All solutions of a small plane problem with friction: every status of every point is tried.
std::vector<Vector> brute_force_friction(const InterfaceProblem& problem, double friction) {
  const int n = problem.model->blocks[0].batch.points;
  const Matrix& c = problem.model->factor;
  std::vector<Vector> found;
  int all = 1;
  for (int i = 0; i < n; ++i) all *= 4;
  for (int code = 0; code < all; ++code) {
    std::vector<int> rows;
    Matrix v(0, c.cols());
    const auto add = [&](int row, const Vector& column) {
      rows.push_back(row);
      v.conservativeResize(v.rows() + 1, c.cols());
      v.row(v.rows() - 1) = column.transpose();
    };
    std::vector<int> status;
    for (int i = 0, rest = code; i < n; ++i, rest /= 4) {
      status.push_back(rest % 4);  // 0 open, 1 stick, 2 slip forwards, 3 backwards
      if (status.back() == 0) continue;
      const Vector normal = c.row(n + i).transpose(), tangential = c.row(i).transpose();
      if (status.back() == 1) add(n + i, normal), add(i, tangential);
      if (status.back() >= 2) add(n + i, normal - friction * (status.back() == 2 ? 1 : -1) * tangential);
    }
    const int k = static_cast<int>(rows.size());
    Vector p = Vector::Zero(problem.rows()), z = Vector::Zero(c.cols());
    if (k > 0) {
      Matrix u(k, c.cols());
      Vector right(k);
      for (int j = 0; j < k; ++j) {
        const int row = rows[static_cast<std::size_t>(j)];
        u.row(j) = c.row(row);
        right[j] = problem.free_opening[row] - (row < n ? problem.from[row] : 0);
      }
      const PartialLu lu(u * v.transpose());
      if (lu->rcond() < 1e-12) continue;
      const Vector q = lu.solve(right);
      z = -v.transpose() * q;
      for (int j = 0; j < k; ++j) p[rows[static_cast<std::size_t>(j)]] = q[j];
      for (int i = 0; i < n; ++i)
        if (status[static_cast<std::size_t>(i)] >= 2) p[i] = -friction * (status[static_cast<std::size_t>(i)] == 2 ? 1 : -1) * p[n + i];
    }
    InterfaceSolution solution;
    solution.z = z;
    solution.force = p;
    solution.opening = problem.free_opening + c * z;
    if (contact_residual(problem, solution) > 1e-9) continue;
    const bool known = std::any_of(found.begin(), found.end(), [&](const Vector& other) { return (other - z).norm() <= 1e-7 * z.norm(); });
    if (!known) found.push_back(z);
  }
  return found;
}

void check_friction(unsigned seed) {
  Dice dice(seed);
  const int n = dice.integer(1, 4), r = dice.integer(1, 2 * n + 2);
  const double friction = dice.chance(0.8) ? dice.uniform(0.01, 0.9) : dice.uniform(0.9, 3);
  const double scale = std::pow(10.0, dice.uniform(-6, -2)), size = std::pow(10.0, dice.uniform(-5, -1));
  Own own;
  own.add_cone("base", n, 2, friction);
  Vector free(2 * n);
  for (int i = 0; i < 2 * n; ++i) free[i] = size * (dice.normal() - (i >= n ? 0.5 : 0));
  own.set(random_factor(dice, 2 * n, r, scale), free);
  for (int i = 0; i < n; ++i) own.problem.from[i] = size * dice.normal();
  const std::vector<Vector> expected = brute_force_friction(own.problem, friction);
  InterfaceSolution solution;
  if (dice.chance(0.3))
    for (int i = 0; i < n; ++i) solution.status.push_back(static_cast<Status>(dice.integer(0, 2)));
  const Outcome outcome = method("lagrange")->solve(own.problem, solution);
  if (outcome.converged) {
    RC_ASSERT(contact_residual(own.problem, solution) <= 1e-9);
    if (expected.size() == 1) RC_ASSERT((solution.z - expected[0]).norm() <= 1e-6 * expected[0].norm());
  } else {
    RC_ASSERT(!outcome.why.empty());
    // with independent rows and ordinary friction there is a solution, and it must be found
    if (2 * n <= r && friction < 0.9) RC_ASSERT(expected.empty());
  }
}

RC_GTEST_PROP(Lagrange, friction_against_brute_force, ()) {
  check_friction(*rc::gen::arbitrary<unsigned>());
}

}  // namespace
}  // namespace uplift::contact_test::contact_lagrange_test
