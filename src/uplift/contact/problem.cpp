#include "uplift/contact/problem.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "uplift/contact/law_force.h"

namespace uplift {
namespace {

double largest(const Vector& v) {
  return v.size() > 0 ? v.cwiseAbs().maxCoeff() : 0;
}

/// scratch.balance = C^T force
void pull_of(const ContactModel& model, const Vector& force, ResidualScratch& scratch) {
  if (!model.jumps.given()) {
    scratch.balance.noalias() = model.factor.transpose() * force;
    return;
  }
  scratch.balance.setZero(model.factor.cols());
  model.jumps.gather(force, scratch.jump, scratch.balance);
}

double balance(const InterfaceProblem& problem, const InterfaceSolution& solution, ResidualScratch& scratch) {
  pull_of(*problem.model, solution.force, scratch);
  const double size = solution.z.norm() + scratch.balance.norm();
  if (problem.model->shift.size() > 0) {
    scratch.force = solution.force - problem.model->shift.cwiseProduct(solution.opening);
    pull_of(*problem.model, scratch.force, scratch);
  }
  scratch.balance += solution.z;
  return scratch.balance.norm() / (size + std::numeric_limits<double>::min());
}

/// Largest difference between the force and that of the law, N.
double law_error(const InterfaceProblem& problem, const Block& block, const InterfaceSolution& solution, ResidualScratch& scratch) {
  scratch.now.resize(problem.old.size());
  for (Vector* v : {&scratch.traction, &scratch.end, &scratch.plain}) v->resize(problem.rows());
  for (Vector* v : {&scratch.slope, &scratch.next}) v->resize(most_components * problem.rows());
  law_force(problem, block, solution.opening.data(),
            {.traction = scratch.traction.data(),
             .slope = scratch.slope.data(),
             .now = scratch.now.data(),
             .end = scratch.end.data(),
             .next = scratch.next.data(),
             .plain = scratch.plain.data()});
  double worst = 0;
  for (int i = 0; i < block.rows(); ++i) worst = std::max(worst, std::abs(solution.force[block.first + i] - scratch.traction[i]));
  return worst;
}

/// Distance of (p / P, opening / L) of each point from its own projection: q = p/P, s = opening/L (normal), slip/L (tangential);
///   normal     |q_n - min(0, q_n + s_n)|       penetration, tension and complementarity in one
///   tangential |q_t - P_ball(q_t + s_t)|       radius mu |q_n|: bound, direction and complementarity in one
double cone_error(const InterfaceProblem& problem, const Block& block, const InterfaceSolution& solution, double force_scale,
                  double length_scale) {
  const int n = block.batch.points, tangents = block.batch.components - 1;
  const double friction = block.cone->friction();
  double worst = 0;
  for (int i = 0; i < n; ++i) {
    const int row = block.normal_row() + i;
    const double q = solution.force[row] / force_scale, s = solution.opening[row] / length_scale;
    worst = std::max(worst, std::abs(q - std::min(0.0, q + s)));
    const double radius = friction * std::max(0.0, -q);
    double size = 0, pushed[2] = {}, force[2] = {};
    for (int c = 0; c < tangents; ++c) {
      const int tangential = block.first + c * n + i;
      force[c] = solution.force[tangential] / force_scale;
      pushed[c] = force[c] + (solution.opening[tangential] - problem.from[tangential]) / length_scale;
      size = std::hypot(size, pushed[c]);
    }
    const double shrink = size > radius ? radius / size : 1;
    double error = 0;
    for (int c = 0; c < tangents; ++c) error = std::hypot(error, force[c] - shrink * pushed[c]);
    worst = std::max(worst, error);
  }
  return worst;
}

}  // namespace

InterfaceProblem problem_of(std::shared_ptr<const ContactModel> model) {
  int rows = 0, history = 0;
  for (const Block& block : model->blocks) {
    rows += block.rows();
    if (block.law != nullptr) history += block.law->num_history(block.batch.components) * block.batch.points;
  }
  InterfaceProblem problem;
  problem.model = std::move(model);
  for (Vector* v : {&problem.free_opening, &problem.from}) v->setZero(rows);
  problem.old.setZero(history);
  return problem;
}

void size_solution(const InterfaceProblem& problem, InterfaceSolution& solution) {
  const Index rows = problem.rows(), r = problem.model->factor.cols();
  std::size_t points = 0;
  for (const Block& block : problem.model->blocks) points += static_cast<std::size_t>(block.batch.points);
  if (solution.opening.size() == rows && solution.force.size() == rows && solution.z.size() == r && solution.status.size() == points &&
      solution.now.size() == problem.old.size())
    return;
  if (solution.z.size() != r) solution.z.setZero(r);
  if (solution.status.size() != points) solution.status.assign(points, Status::open);
  solution.opening.setZero(rows);
  if (solution.force.size() != rows) solution.force.setZero(rows);
  solution.now.setZero(problem.old.size());
}

double contact_residual(const InterfaceProblem& problem, const InterfaceSolution& solution) {
  ResidualScratch scratch;
  return contact_residual(problem, solution, scratch);
}

double contact_residual(const InterfaceProblem& problem, const InterfaceSolution& solution, ResidualScratch& scratch) {
  if (!solution.z.allFinite() || !solution.force.allFinite() || !solution.opening.allFinite())
    return std::numeric_limits<double>::infinity();
  // the solution's own opening is not trusted
  if (problem.model->jumps.given()) {
    scratch.moved.setZero(problem.rows());
    problem.model->jumps.spread(solution.z, scratch.jump, scratch.moved);
  } else {
    scratch.moved.noalias() = problem.model->factor * solution.z;
  }
  scratch.opening = problem.free_opening + scratch.moved;
  const double force = largest(solution.force), moved = largest(scratch.moved);
  const double force_scale = force > 0 ? force : 1;
  double length_scale = moved > 0 ? moved : largest(problem.free_opening);
  if (!(length_scale > 0)) length_scale = 1;
  scratch.opening -= solution.opening;
  double worst = std::max(balance(problem, solution, scratch), largest(scratch.opening) / length_scale);
  for (const Block& block : problem.model->blocks)
    worst = std::max(worst, block.law != nullptr ? law_error(problem, block, solution, scratch) / force_scale
                                                 : cone_error(problem, block, solution, force_scale, length_scale));
  return worst;
}

}  // namespace uplift
