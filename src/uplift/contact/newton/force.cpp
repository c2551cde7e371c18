#include <algorithm>

#include "uplift/contact/law_force.h"
#include "uplift/contact/newton/newton.h"
#include "uplift/math/small.h"

// What Newton's method evaluates: the forces of all blocks at z, and their slopes.
namespace uplift {
namespace {

/// P(multiplier + stiffness * opening) of a cone block.
void cone_force(const InterfaceProblem& problem, const Block& block, const AugmentedForce& augmented, double* slope,
                InterfaceSolution& solution) {
  const int n = block.batch.points, components = block.batch.components, normal = block.batch.normal();
  double* force = solution.force.data() + block.first;
  const double* multiplier = augmented.multiplier->data() + block.first;
  const double* stiffness = augmented.stiffness->data() + block.first;
  const double* opening = solution.opening.data() + block.first;
  const double* from = problem.from.data() + block.first;
  for (int i = 0; i < n * components; ++i) force[i] = multiplier[i] + stiffness[i] * (i >= normal ? opening[i] : opening[i] - from[i]);
  block.cone->project(block.batch, force, force, slope);
  if (slope == nullptr) return;
  for (int r = 0; r < components; ++r)
    for (int c = 0; c < components; ++c)
      for (int i = 0; i < n; ++i) slope[(r * components + c) * n + i] *= stiffness[c * n + i];
}

}  // namespace

void size_newton(const InterfaceProblem& problem, NewtonWork& work, InterfaceSolution& solution) {
  const ContactModel& model = *problem.model;
  const Index rows = model.rows(), r = model.factor.cols(), paths = model.average ? rows : 0;
  if (work.model.is(model) && solution.opening.size() == rows && solution.now.size() == problem.old.size() &&
      solution.end_traction.size() == paths)
    return;
  work.model.take(model);
  work.follows = false;
  work.evaluation = {};
  work.first_slope.clear();
  int slopes = 0;
  for (const Block& block : model.blocks) {
    work.first_slope.push_back(slopes);
    slopes += block.slopes();
  }
  work.slope.setZero(slopes);
  for (Vector* v : {&work.gradient, &work.end_pull, &work.direction, &work.origin}) v->setZero(r);
  if (r <= few) work.hessian.setZero(r, r);
  work.pull.setZero(rows);
  solution.next_slope.setZero(model.average ? slopes : 0);
  solution.end_traction.setZero(paths);
  solution.opening.setZero(rows);
  solution.force.setZero(rows);
  if (problem.filter.acts()) solution.plain.setZero(rows);
  if (solution.z.size() != r) solution.z.setZero(r);
  solution.now.setZero(problem.old.size());
}

void evaluate(const InterfaceProblem& problem, const AugmentedForce& augmented, bool with_slope, NewtonWork& work,
              InterfaceSolution& solution) {
  const ContactModel& model = *problem.model;
  if (model.jumps.given()) {
    solution.opening = problem.free_opening;
    model.jumps.spread(solution.z, work.jump, solution.opening);
  } else {
    small::affine(model.factor, problem.free_opening.data(), solution.z.data(), solution.opening.data());
  }
  evaluate_laws(problem, augmented, with_slope, work, solution);
}

void evaluate_laws(const InterfaceProblem& problem, const AugmentedForce& augmented, bool with_slope, NewtonWork& work,
                   InterfaceSolution& solution) {
  const ContactModel& model = *problem.model;
  for (std::size_t b = 0; b < model.blocks.size(); ++b) {
    const Block& block = model.blocks[b];
    const int first_slope = work.first_slope[b];
    double* slope = with_slope ? work.slope.data() + first_slope : nullptr;
    if (block.law != nullptr) {
      LawResponse response{solution.force.data() + block.first, slope, solution.now.data() + block.first_history};
      if (model.average) response.end = solution.end_traction.data() + block.first;
      if (model.average && (with_slope || problem.filter.acts())) response.next = solution.next_slope.data() + first_slope;
      if (problem.filter.acts()) response.plain = solution.plain.data() + block.first;
      law_force(problem, block, solution.opening.data(), response);
    } else {
      cone_force(problem, block, augmented, slope, solution);
    }
  }
}

}  // namespace uplift
