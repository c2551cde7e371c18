#include "uplift/dynamics/monolithic.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "uplift/contact/law_force.h"
#include "uplift/math/dense.h"

namespace uplift {
namespace {

/// Contact state of a cone point in the active set.
enum class Contact : signed char { open, stick, slip };

/// How the friction of a slipping point depends on its slip s (two components in space, one in the plane), from the last equilibrium:
/// p_t = -mu p_n d + w (I - d d^T) s, which is Newton's method on p_t = -mu p_n s/|s|: w = -mu p_n/|s|, and (I - d d^T) s -> 0.
struct Slip {
  Vec2 direction = Vec2::Zero();
  double turning = 0;  // w, N/m
};

class Monolithic final : public StepSolver {
 public:
  Monolithic(const Sparse& matrix, const Sparse& b, const Vector& gap, ContactModel frame) : matrix_(matrix), b_(b), gap_(gap) {
    frame.factor.setZero(b.rows(), 0);
    problem_ = problem_of(std::make_shared<const ContactModel>(std::move(frame)));
    for (Vector* v : {&solution_.force, &solution_.opening, &solution_.end_traction, &solution_.plain}) v->setZero(b.rows());
    int slopes = 0;
    for (const Block& block : problem_.model->blocks) {
      points_ += static_cast<std::size_t>(block.batch.points);
      slopes += block.slopes();
    }
    solution_.next_slope.setZero(slopes);
  }

  Outcome solve(const Vector& right, const StepStart& start, Vector& increment) override {
    problem_.from = start.opening;
    problem_.old = start.history;
    if (start.filter != nullptr && start.filter != &problem_.filter) problem_.filter = *start.filter;
    solution_.now = start.history;
    origin_ = gap_ + b_ * start.displacement;
    Outcome outcome;
    for (const Contact guess : {Contact::open, Contact::stick}) {
      contact_.assign(points_, guess);
      slip_.assign(points_, {});
      if (settle(right, increment, outcome)) return outcome;
    }
    return outcome;
  }

  const InterfaceProblem& problem() const override { return problem_; }
  const InterfaceSolution& solution() const override { return solution_; }
  JointFilterInput& filter() override { return problem_.filter; }

 private:
  /// Equilibrium and contact state in turns until state and directions of slip stand still; when a state comes back, one point changes at
  /// a time.
  bool settle(const Vector& right, Vector& increment, Outcome& outcome) {
    std::set<std::vector<Contact>> seen;
    bool single = false;
    solution_.force.setZero();
    increment.setZero();
    for (int round = 0; round < 300; ++round) {
      if (!equilibrium(right, increment, outcome)) return false;
      const std::vector<Contact> before = contact_;
      const double turned = update_contact();
      if (contact_ == before) {
        if (turned > 1e-10) continue;
        share_pressures();
        outcome.converged = true;
        return true;
      }
      if (!single && !seen.insert(contact_).second) ++outcome.cycles, single = true;
      if (single) keep_first_change(before);
    }
    outcome.why = "the oracle's active set did not settle";
    return false;
  }

  /// Law forces and their full slope matrix dP/d opening (rows x rows) at the present opening.
  void law_forces(Matrix& slope) {
    slope.setZero(b_.rows(), b_.rows());
    int first_slope = 0;
    for (const Block& block : problem_.model->blocks) {
      double* next = solution_.next_slope.data() + std::exchange(first_slope, first_slope + block.slopes());
      if (block.law == nullptr) continue;
      const int n = block.batch.points, components = block.batch.components;
      std::vector<double> k(static_cast<std::size_t>(n * components * components));
      LawResponse response;
      response.traction = solution_.force.data() + block.first;
      response.slope = k.data();
      response.now = solution_.now.data() + block.first_history;
      if (problem_.model->average) {
        response.end = solution_.end_traction.data() + block.first;
        response.next = next;
        response.plain = solution_.plain.data() + block.first;
      }
      law_force(problem_, block, solution_.opening.data(), response);
      for (int i = 0; i < n; ++i)
        for (int r = 0; r < components; ++r)
          for (int c = 0; c < components; ++c)
            slope(block.first + r * n + i, block.first + c * n + i) = k[static_cast<std::size_t>((r * components + c) * n + i)];
    }
  }

  /// Newton on displacement and multipliers for the present contact state.
  bool equilibrium(const Vector& right, Vector& increment, Outcome& outcome) {
    const Matrix bulk = Matrix(matrix_), b = Matrix(b_);
    const Eigen::Index n = bulk.rows();
    Matrix slope;
    for (int iteration = 0; iteration < 80; ++iteration) {
      solution_.opening = origin_ + b * increment;
      law_forces(slope);
      Vector law_force = Vector::Zero(b_.rows());
      for (const Block& block : problem_.model->blocks)
        if (block.law != nullptr) law_force.segment(block.first, block.rows()) = solution_.force.segment(block.first, block.rows());
      const std::vector<std::pair<int, double>> rows = constraint_rows();  // row, opening that it must have
      const Eigen::Index m = static_cast<Eigen::Index>(rows.size());
      law_force += turning_forces(slope);
      Matrix system = Matrix::Zero(n + m, n + m);
      Vector load(n + m);
      system.topLeftCorner(n, n) = bulk + b.transpose() * slope * b;
      load.head(n) = right - bulk * increment - b.transpose() * law_force;
      for (Eigen::Index k = 0; k < m; ++k) {
        system.block(n + k, 0, 1, n) = b.row(rows[static_cast<std::size_t>(k)].first);
        system.block(0, n + k, n, 1) = force_pattern(b, rows[static_cast<std::size_t>(k)].first);
        load[n + k] = rows[static_cast<std::size_t>(k)].second - solution_.opening[rows[static_cast<std::size_t>(k)].first];
      }
      const double scale = bulk.diagonal().maxCoeff();  // the saddle point's two blocks made comparable
      system.bottomLeftCorner(m, n) *= scale;
      system.topRightCorner(n, m) *= scale;
      load.tail(m) *= scale;
      const Vector step = CompleteQr(system).solve(load);  // least norm: redundant constraints leave the displacement unique
      if (!step.allFinite()) {
        outcome.why = "the oracle's matrix is singular";
        return false;
      }
      const double factor = damped(right, bulk, b, increment, step.head(n), m > 0);
      increment += factor * step.head(n);
      ++outcome.iterations;
      for (const Block& block : problem_.model->blocks)
        if (block.cone != nullptr) solution_.force.segment(block.first, block.rows()).setZero();
      for (Eigen::Index k = 0; k < m; ++k) add_multiplier(rows[static_cast<std::size_t>(k)].first, scale * step[n + k]);
      solution_.opening = origin_ + b * increment;
      solution_.force += turning_forces(slope);
      outcome.residual = step.head(n).norm() / std::max(increment.norm(), 1e-300);
      if (factor == 1 && outcome.residual <= 1e-14) return true;
      if (iteration > 15 && outcome.residual <= 1e-9) return true;  // stiff joints: all that round-off leaves
    }
    outcome.why = fmt::format("the oracle's Newton did not converge (last step {:.2e} of the increment)", outcome.residual);
    return false;
  }

  /// Halves a Newton step until the residual of the traction laws does not grow (constraints are linear and keep the full step).
  double damped(const Vector& right, const Matrix& bulk, const Matrix& b, const Vector& increment, const Vector& step, bool constrained) {
    if (constrained) return 1;
    Matrix slope;
    const auto residual = [&](const Vector& u) {
      solution_.opening = origin_ + b * u;
      law_forces(slope);
      return (right - bulk * u - b.transpose() * solution_.force).norm();
    };
    const double before = residual(increment);
    double factor = 1;
    for (int halving = 0; halving < 14; ++halving, factor *= 0.5)
      if (residual(increment + factor * step) <= before * (1 - 0.1 * factor) + 1e-13 * right.norm()) return factor;
    return 1;
  }

  /// The part w (I - d d^T) s of the friction of slipping points, in space; its slope is added.
  Vector turning_forces(Matrix& slope) const {
    Vector force = Vector::Zero(b_.rows());
    each_point([&](const Block& block, int i, std::size_t point) {
      const int n = block.batch.points, tangents = block.batch.components - 1;
      if (contact_[point] != Contact::slip || tangents < 2) return;
      const Vec2 d = slip_[point].direction;
      const Eigen::Matrix2d across = slip_[point].turning * (Eigen::Matrix2d::Identity() - d * d.transpose());
      const Vec2 turned = across * slip_of(block, i);
      for (int r = 0; r < tangents; ++r) {
        force[block.first + r * n + i] = turned[r];
        for (int c = 0; c < tangents; ++c) slope(block.first + r * n + i, block.first + c * n + i) += across(r, c);
      }
    });
    return force;
  }

  /// Tangential opening since the beginning of the step; the second component is 0 in the plane.
  Vec2 slip_of(const Block& block, int i) const {
    Vec2 slip = Vec2::Zero();
    for (int c = 0; c < block.batch.components - 1; ++c) {
      const int row = block.first + c * block.batch.points + i;
      slip[c] = solution_.opening[row] - problem_.from[row];
    }
    return slip;
  }

  /// Rows that are held: closed normals at zero, sticking tangents where they were.
  std::vector<std::pair<int, double>> constraint_rows() const {
    std::vector<std::pair<int, double>> rows;
    each_point([&](const Block& block, int i, std::size_t point) {
      if (contact_[point] == Contact::open) return;
      rows.emplace_back(block.first + block.batch.normal() + i, 0.0);
      if (contact_[point] != Contact::stick || block.cone->friction() <= 0) return;
      for (int row = block.first + i; row < block.first + block.batch.normal(); row += block.batch.points)
        rows.emplace_back(row, problem_.from[row]);
    });
    return rows;
  }

  /// Calls visit(row, factor) for the tangents of the slipping point whose normal row this is: p_t = -mu d p_n = factor p_n.
  template <class Visit>
  void each_friction(int normal_row, const Visit& visit) const {
    each_point([&](const Block& block, int i, std::size_t point) {
      if (normal_row != block.first + block.batch.normal() + i || contact_[point] != Contact::slip) return;
      for (int c = 0; c < block.batch.components - 1; ++c)
        visit(block.first + c * block.batch.points + i, -block.cone->friction() * slip_[point].direction[c]);
    });
  }

  /// How the multiplier of a row acts on the unknowns: a slipping point's normal force brings its friction along.
  Vector force_pattern(const Matrix& b, int row) const {
    Vector pattern = b.row(row).transpose();
    each_friction(row, [&](int tangent, double factor) { pattern += factor * b.row(tangent).transpose(); });
    return pattern;
  }

  void add_multiplier(int row, double value) {
    solution_.force[row] += value;
    each_friction(row, [&](int tangent, double factor) { solution_.force[tangent] += factor * value; });
  }

  /// New contact states; returns by how much the directions of slip turned.
  double update_contact() {
    const double largest = std::max(solution_.force.lpNorm<Eigen::Infinity>(), 1e-300);
    double turned = 0;
    each_point([&](const Block& block, int i, std::size_t point) {
      Contact& contact = contact_[point];
      const int normal = block.first + block.batch.normal() + i;
      const double pressure = -solution_.force[normal], friction = block.cone->friction();
      if (contact == Contact::open) {
        if (solution_.opening[normal] < -no_gap * problem_.model->size) contact = Contact::stick;
      } else if (pressure < -1e-12 * largest) {
        contact = Contact::open;
      } else if (friction > 0 && block.batch.components > 1) {
        turned = std::max(turned, update_friction(block, i, point, friction * pressure));
      }
    });
    return turned;
  }

  /// A closed point: past the bound it slips along its force, against its direction of slip it sticks, else the direction follows the slip.
  double update_friction(const Block& block, int i, std::size_t point, double bound) {
    Slip& slip = slip_[point];
    const Vec2 moved = slip_of(block, i);
    const double still = 0.01 * no_gap * problem_.model->size;  // m
    if (contact_[point] == Contact::stick) {
      Vec2 force = Vec2::Zero();
      for (int c = 0; c < block.batch.components - 1; ++c) force[c] = solution_.force[block.first + c * block.batch.points + i];
      if (force.norm() <= bound * (1 + 1e-9)) return 0;
      contact_[point] = Contact::slip;
      slip = {force.normalized(), 0};
      return 1;
    }
    if (moved.dot(slip.direction) < -still) {
      contact_[point] = Contact::stick;
      return 1;
    }
    if (block.batch.components == 2 || moved.norm() < still) return 0;
    const Vec2 direction = moved.normalized();
    const double turned = (direction - slip.direction).norm() * bound;
    slip = {direction, bound / moved.norm()};
    return turned / std::max(solution_.force.lpNorm<Eigen::Infinity>(), 1e-300);
  }

  /// Least-index rule: of all changes only that of the first point is made.
  void keep_first_change(const std::vector<Contact>& before) {
    std::size_t first = 0;
    while (contact_[first] == before[first]) ++first;
    for (std::size_t i = first + 1; i < contact_.size(); ++i) contact_[i] = before[i];
  }

  /// Redundant frictionless points: of all admissible pressures with the same effect on the structure those of least sum p^2/area, as the
  /// methods promise. Their dual is p = area * min(0, B y) on the touching points; the set where it is negative is found by repetition.
  void share_pressures() {
    std::vector<int> touching;
    std::vector<double> area;
    each_point([&](const Block& block, int i, std::size_t) {
      const int row = block.first + block.batch.normal() + i;
      if (block.cone->friction() > 0 || solution_.opening[row] > 10 * no_gap * problem_.model->size) return;
      touching.push_back(row);
      area.push_back(block.area[static_cast<std::size_t>(i)]);
    });
    const Matrix b = Matrix(b_);
    const Eigen::Index count = static_cast<Eigen::Index>(touching.size());
    Vector push = Vector::Zero(b.cols());  // B^T p
    for (const int row : touching) push += b.row(row).transpose() * solution_.force[row];
    std::vector<char> pressed(touching.size(), 1);
    for (int round = 0; round < 100 && count > 0; ++round) {
      Matrix gram = Matrix::Zero(b.cols(), b.cols());
      for (Eigen::Index k = 0; k < count; ++k)
        if (pressed[static_cast<std::size_t>(k)] != 0)
          gram += area[static_cast<std::size_t>(k)] * b.row(touching[static_cast<std::size_t>(k)]).transpose() *
                  b.row(touching[static_cast<std::size_t>(k)]);
      CompleteQr decomposition;
      decomposition->setThreshold(1e-11);
      decomposition.compute(gram);
      const Vector y = decomposition.solve(push);
      if ((gram * y - push).norm() > 1e-9 * push.norm()) return;  // the first answer stays
      bool changed = false;
      for (Eigen::Index k = 0; k < count; ++k) {
        char& now = pressed[static_cast<std::size_t>(k)];
        const double pull = b.row(touching[static_cast<std::size_t>(k)]).dot(y);
        changed = changed || (now != 0) != (pull < 0);
        now = pull < 0 ? 1 : 0;
      }
      if (changed) continue;
      for (Eigen::Index k = 0; k < count; ++k)
        solution_.force[touching[static_cast<std::size_t>(k)]] =
            pressed[static_cast<std::size_t>(k)] != 0
                ? area[static_cast<std::size_t>(k)] * b.row(touching[static_cast<std::size_t>(k)]).dot(y)
                : 0;
      return;
    }
  }

  /// Calls visit(block, number in the block, number among all points) for every point under a cone.
  template <class Visit>
  void each_point(const Visit& visit) const {
    std::size_t point = 0;
    for (const Block& block : problem_.model->blocks)
      for (int i = 0; i < block.batch.points; ++i, ++point)
        if (block.cone != nullptr) visit(block, i, point);
  }

  const Sparse matrix_;
  const Sparse& b_;
  const Vector& gap_;
  InterfaceProblem problem_;
  InterfaceSolution solution_;
  std::size_t points_ = 0;
  std::vector<Contact> contact_;
  std::vector<Slip> slip_;
  Vector origin_;
};

/// Solves every step twice from the same beginning and refuses it when the answers differ.
class Compared final : public StepSolver {
 public:
  Compared(const Sparse& matrix, std::unique_ptr<StepSolver> solver, std::unique_ptr<StepSolver> oracle, double tolerance)
      : matrix_(matrix), solver_(std::move(solver)), oracle_(std::move(oracle)), tolerance_(tolerance) {}

  Outcome solve(const Vector& right, const StepStart& start, Vector& increment) override {
    Outcome outcome = solver_->solve(right, start, increment);
    if (!outcome.converged) return outcome;
    other_.resize(increment.size());
    const Outcome check = oracle_->solve(right, start, other_);
    if (!check.converged) outcome.why = check.why;
    const double difference = energy_norm(other_ - increment),
                 size = std::max(energy_norm(start.displacement + increment), energy_norm(increment));
    if (check.converged && difference > tolerance_ * size)
      outcome.why = fmt::format("the oracle's step differs by {:.2e} of the displacement", difference / size);
    outcome.converged = outcome.why.empty();
    return outcome;
  }

  const InterfaceProblem& problem() const override { return solver_->problem(); }
  const InterfaceSolution& solution() const override { return solver_->solution(); }
  JointFilterInput& filter() override { return solver_->filter(); }
  const BulkFactor* factor() const override { return solver_->factor(); }
  void forget() override { solver_->forget(), oracle_->forget(); }

 private:
  double energy_norm(const Vector& u) const { return std::sqrt(std::max(0.0, u.dot(matrix_ * u))); }

  const Sparse matrix_;
  std::unique_ptr<StepSolver> solver_, oracle_;
  double tolerance_;
  Vector other_;
};

}  // namespace

std::unique_ptr<StepSolver> make_monolithic(const Sparse& matrix, const Sparse& b, const Vector& gap, ContactModel frame) {
  return std::make_unique<Monolithic>(matrix, b, gap, std::move(frame));
}

std::unique_ptr<StepSolver> make_compared(const Sparse& matrix, std::unique_ptr<StepSolver> solver, std::unique_ptr<StepSolver> oracle,
                                          double tolerance) {
  return std::make_unique<Compared>(matrix, std::move(solver), std::move(oracle), tolerance);
}

}  // namespace uplift
