#include <algorithm>

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

void size_newton(const InterfaceProblem& problem, InterfaceSolution& solution) {
  NewtonScratch& scratch = solution.newton;
  const Eigen::Index rows = problem.rows(), r = problem.factor.cols();
  if (scratch.first_slope.size() == problem.blocks.size() && solution.opening.size() == rows && scratch.gradient.size() == r &&
      solution.now.size() == problem.old.size())
    return;
  scratch.first_slope.clear();
  int slopes = 0;
  for (const Block& block : problem.blocks) {
    scratch.first_slope.push_back(slopes);
    slopes += block.batch.points * block.batch.components * block.batch.components;
  }
  scratch.slope.setZero(slopes);
  scratch.next.setZero(slopes);
  scratch.gradient.setZero(r);
  scratch.end_pull.setZero(r);
  scratch.direction.setZero(r);
  scratch.origin.setZero(r);
  if (r <= few) scratch.hessian.setZero(r, r);
  scratch.end.setZero(rows);
  scratch.pull.setZero(rows);
  solution.opening.setZero(rows);
  solution.force.setZero(rows);
  if (problem.filter.acts()) solution.plain.setZero(rows);
  if (solution.z.size() != r) solution.z.setZero(r);
  solution.now.setZero(problem.old.size());
}

void evaluate(const InterfaceProblem& problem, const AugmentedForce& augmented, bool with_slope, InterfaceSolution& solution) {
  small::affine(problem.factor, problem.free_opening.data(), solution.z.data(), solution.opening.data());
  for (std::size_t b = 0; b < problem.blocks.size(); ++b) {
    const Block& block = problem.blocks[b];
    const int first_slope = solution.newton.first_slope[b];
    double* slope = with_slope ? solution.newton.slope.data() + first_slope : nullptr;
    if (block.law != nullptr) {
      LawResponse response{solution.force.data() + block.first, slope, solution.now.data() + block.first_history};
      if (problem.average) response.end = solution.newton.end.data() + block.first;
      if (problem.average && (with_slope || problem.filter.acts())) response.next = solution.newton.next.data() + first_slope;
      if (problem.filter.acts()) response.plain = solution.plain.data() + block.first;
      law_force(problem, block, solution.opening.data(), response);
    } else {
      cone_force(problem, block, augmented, slope, solution);
    }
  }
}

}  // namespace uplift
