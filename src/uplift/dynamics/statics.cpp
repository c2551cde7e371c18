#include "uplift/dynamics/statics.h"

#include <algorithm>
#include <functional>

namespace uplift {

Vector closed_joint(const Model& model, const Behaviours& behaviours) {
  int rows = 0;
  for (const Interface& interface : model.interfaces) rows += interface.rows();
  Vector result = Vector::Zero(rows);
  double largest = 0;
  for (int i = 0; i < model.free(); ++i) largest = std::max(largest, model.stiffness.coeff(i, i));
  if (largest <= 0) largest = 1e9;
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
          value = stiffness[c] * interface.area[p];
        else if (c == components - 1 || behaviours.interfaces[i].cone->friction() > 0)
          value = largest / n;
      }
    first += interface.rows();
  }
  return result;
}

StaticOutcome solve_statics(const Model& model, const Bulk& bulk, const Sparse& b, const Vector& gap, const Behaviours& behaviours,
                            const ContactMethod& method, const LinearSolver& solver, int steps, State& state, LinearCounts& counts) {
  StaticOutcome outcome;
  const Eigen::Index n = bulk.unknowns;
  InterfaceProblem frame = blocks_of(model, behaviours);
  frame.shift = closed_joint(model, behaviours);
  const Vector shift = frame.shift;
  Sparse matrix = bulk.stiffness_matrix;
  if (b.rows() > 0) matrix += Sparse(b.transpose() * shift.asDiagonal() * b);
  BulkFactor factor(matrix, bulk.small, solver, model, counts);
  if (!factor.ok()) {
    outcome.why = "static stage: " + factor.why();
    return outcome;
  }
  Condensed condensed(model, b, gap, std::move(factor), std::move(frame), method);

  Vector dead = Vector::Zero(n), increment = Vector::Zero(n), product = Vector::Zero(n);
  for (const Drive& drive : model.drives)
    if (drive.dead) dead += drive.shape * drive.function->value(state.time);

  // from one share of the load to another, halved when it fails
  const std::function<bool(double, double, int)> go = [&](double from, double to, int depth) {
    bulk.stiffness.multiply(state.displacement, product);
    Vector right = to * dead - product;
    if (b.rows() > 0) right -= b.transpose() * (shift.cwiseProduct(state.opening)).eval();
    const Outcome step = condensed.solve(right, state.displacement, state.opening, state.history, increment);
    outcome.iterations += step.iterations;
    if (!step.converged) {
      outcome.why = "static stage: " + step.why;
      if (depth >= 8) return false;
      ++outcome.retries;
      const double middle = 0.5 * (from + to);
      return go(from, middle, depth + 1) && go(middle, to, depth + 1);
    }
    state.displacement += increment;
    if (b.rows() > 0) {
      state.opening = condensed.solution().opening;
      state.force = condensed.solution().force;
      state.mean_force = state.force;
      state.history = condensed.solution().now;
    }
    ++outcome.steps;
    return true;
  };
  for (int k = 0; k < steps; ++k)
    if (!go(static_cast<double>(k) / steps, static_cast<double>(k + 1) / steps, 0)) return outcome;
  state.velocity.setZero();
  state.acceleration.setZero();
  outcome.converged = state.displacement.allFinite();
  if (!outcome.converged) outcome.why = "static stage: the displacement is not finite";
  return outcome;
}

}  // namespace uplift
