#include "uplift/dynamics/statics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "uplift/contact/unheld.h"

namespace uplift {

Vector closed_joint(const Model& model, const Behaviours& behaviours) {
  int rows = 0;
  for (const Interface& interface : model.interfaces) rows += interface.rows();
  Vector result = Vector::Zero(rows);
  double largest = 0;
  for (int i = 0; i < model.free(); ++i) largest = std::max(largest, model.stiffness.coeff(i, i));
  if (largest <= 0) largest = 1e9;
  // A joint far stiffer than the structure would leave nothing of the structure's stiffness in the factored sum once it is taken back.
  constexpr double stiffest = 1e6;
  int first = 0;
  for (std::size_t i = 0; i < model.interfaces.size(); ++i) {
    const Interface& interface = model.interfaces[i];
    const int n = interface.batch.points, components = interface.batch.components;
    double stiffness[3] = {0, 0, 0};
    if (behaviours.interfaces[i].law != nullptr) behaviours.interfaces[i].law->closed_stiffness(components, stiffness);
    for (int c = 0; c < components; ++c)
      for (int p = 0; p < n; ++p) {
        double& value = result[first + c * n + p];
        if (behaviours.interfaces[i].law != nullptr)
          value = std::min(stiffness[c] * interface.area[p], stiffest * largest);
        else if (c == components - 1 || behaviours.interfaces[i].cone->friction() > 0)
          value = largest / n;
      }
    first += interface.rows();
  }
  return result;
}

namespace {

/// A structure that nothing holds has no equilibrium, but the balance of an interface problem is relative to its own forces, the closed
/// joint that is taken back among them: it is met at infinity by every method. The balance of the whole structure, f - K u - B^T p against
/// the loads, is not. `unbalanced` is that difference; what round-off makes of K u does not count, unless it is so much that nothing can be
/// told.
bool in_balance(const Bulk& bulk, const Vector& load, const Vector& reaction, const Vector& displacement, const Vector& unbalanced) {
  if (unbalanced.size() == 0) return true;
  if (!unbalanced.allFinite()) return false;
  double size = 0, round_off = 0;
  for (int i = 0; i < bulk.unknowns; ++i) {
    size = std::max({size, std::abs(load[i]), std::abs(reaction[i])});
    round_off = std::max(round_off, std::abs(bulk.stiffness_matrix.coeff(i, i) * displacement[i]));
  }
  const double lost = 64 * std::numeric_limits<double>::epsilon() * round_off;
  return lost <= 1e-3 * size && unbalanced.cwiseAbs().maxCoeff() <= 1e-6 * size + lost;
}

/// Why a load step has no solution: a small share of the closed joint is left as springs, with which every load has an equilibrium, and the
/// movement shows what these springs alone hold. Empty when it is not that.
std::string diagnose(const InterfaceProblem& problem, const ContactMethod& method) {
  InterfaceProblem held = problem;
  for (const double share : {1e-6, 1e-4}) {
    held.shift = (1 - share) * problem.shift;
    InterfaceSolution solution;
    if (method.solve(held, solution).converged) return unheld_motion(held, solution, 5e-3 / share);
  }
  return {};
}

}  // namespace

StaticOutcome solve_statics(const Model& model, const Bulk& bulk, const Sparse& b, const Vector& gap, const Behaviours& behaviours,
                            const ContactMethod& method, const LinearSolver& solver, int steps, State& state, LinearCounts& counts,
                            const PlasticOptions& plastic) {
  StaticOutcome outcome;
  const Eigen::Index n = bulk.unknowns;
  InterfaceProblem frame = blocks_of(model, behaviours);
  frame.shift = closed_joint(model, behaviours);
  const Vector shift = frame.shift;
  Sparse matrix = bulk.stiffness_matrix.triangularView<upper_triangle>();  // all that a factor is made of
  if (b.rows() > 0) matrix += Sparse(Sparse(b.transpose() * shift.asDiagonal() * b).triangularView<upper_triangle>());
  BulkFactor factor(matrix, &b, bulk.small, solver, model, counts);
  if (!factor.ok()) {
    outcome.why = "static stage: " + factor.why();
    return outcome;
  }
  const InterfaceProblem blocks = frame;
  Condensed condensed(model, b, gap, false, std::move(factor), std::move(frame), method);

  const PlasticBulk yielding(model);
  PlasticNewton newton(yielding, matrix, plastic);
  const PlasticNewton::Make soften = [&](const Sparse& d, std::string& why) -> std::unique_ptr<StepSolver> {
    BulkFactor softer(matrix + d, &b, bulk.small, solver, model, counts);
    why = softer.why();
    if (!softer.ok()) return nullptr;
    return std::make_unique<Condensed>(model, b, gap, false, std::move(softer), blocks, method);
  };
  PlasticState plastic_now, plastic_next;
  if (yielding.any()) plastic_now = yielding.state(state.bulk_history);

  Vector dead = Vector::Zero(n), increment = Vector::Zero(n), product = Vector::Zero(n), moved = Vector::Zero(n),
         reaction = Vector::Zero(n);
  for (const Drive& drive : model.drives)
    if (drive.dead) dead += drive.shape * drive.function->value(state.time);

  // from one share of the load to another, halved when it fails
  const std::function<bool(double, double, int)> go = [&](double from, double to, int depth) {
    bulk.stiffness.multiply(state.displacement, product);
    Vector right = to * dead - product;
    if (b.rows() > 0) right -= b.transpose() * (shift.cwiseProduct(state.opening)).eval();
    const StepStart start{state.displacement, state.opening, state.history};
    const Outcome step = yielding.any() ? newton.solve({right, start, plastic_now, state.time}, condensed, soften, increment, plastic_next)
                                        : condensed.solve(right, start, increment);
    const StepSolver& last = yielding.any() ? newton.last() : condensed;
    outcome.newton = newton.residuals();
    outcome.iterations += step.iterations;
    std::string why = step.why;
    if (step.converged) {
      moved = state.displacement + increment;
      bulk.stiffness.multiply(moved, product);
      right = to * dead - product;
      if (yielding.any()) right -= plastic_next.force;
      if (b.rows() > 0) reaction.noalias() = b.transpose() * last.solution().force;
      right -= reaction;
      if (!in_balance(bulk, to * dead, reaction, moved, right)) {
        why = b.rows() > 0 ? unheld_motion(last.problem(), last.solution(), runaway_ratio) : "";
        if (why.empty()) why = "the balance of the structure is not met";
      }
    } else if (b.rows() > 0 && depth >= 8) {
      if (const std::string found = diagnose(last.problem(), method); !found.empty()) why = found + "; " + why;
    }
    if (!why.empty()) {
      outcome.why = fmt::format("static stage, {:.3g} % of the load: {}", 100 * to, why);
      if (depth >= 8) {
        outcome.failed = last.problem();
        return false;
      }
      ++outcome.retries;
      const double middle = 0.5 * (from + to);
      return go(from, middle, depth + 1) && go(middle, to, depth + 1);
    }
    state.displacement = moved;
    if (b.rows() > 0) {
      state.opening = last.solution().opening;
      state.force = last.solution().force;
      state.mean_force = state.force;
      state.history = last.solution().now;
    }
    if (yielding.any()) {
      std::swap(plastic_now, plastic_next);
      state.bulk_history = plastic_now.history;
    }
    ++outcome.steps;
    return true;
  };
  for (int k = 0; k < steps; ++k)
    if (!go(static_cast<double>(k) / steps, static_cast<double>(k + 1) / steps, 0)) return outcome;
  state.velocity.setZero();
  state.acceleration.setZero();
  state.filter = {};
  outcome.converged = state.displacement.allFinite();
  if (!outcome.converged) outcome.why = "static stage: the displacement is not finite";
  return outcome;
}

}  // namespace uplift
