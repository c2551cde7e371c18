#include "uplift/contact/newton/balance.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "uplift/math/small.h"

namespace uplift {

double balance_scale(const InterfaceProblem& problem, NewtonWork& work, const InterfaceSolution& solution) {
  const Matrix& factor = problem.model->factor;
  const Index r = factor.cols();
  const double *z = solution.z.data(), *g = work.gradient.data();
  double scale = 0;
  if (problem.model->shift.size() > 0) {
    work.direction.setZero();
    small::add_transposed<0>(factor.rows(), r, factor.data(), factor.rows(), solution.force.data(), work.direction.data());
    for (Index i = 0; i < r; ++i) scale = std::max({scale, std::abs(z[i]), std::abs(work.direction[i])});
  } else {
    for (Index i = 0; i < r; ++i) scale = std::max({scale, std::abs(z[i]), std::abs(g[i] - z[i])});
  }
  return scale;
}

double balance_round_off(const InterfaceProblem& problem, NewtonWork& work, const InterfaceSolution& solution) {
  const ContactModel& model = *problem.model;
  double* of_row = work.pull.data();  // what the round-off of a row's force is a share of
  for (std::size_t b = 0; b < model.blocks.size(); ++b) {
    const Block& block = model.blocks[b];
    const double* slopes = work.slope.data() + work.first_slope[b];
    const int n = block.batch.points, components = block.batch.components;
    for (int c = 0; c < components; ++c)
      for (int i = 0; i < n; ++i) {
        const Index row = block.first + c * n + i;
        const double slope = std::abs(slopes[(c * components + c) * n + i]);
        const double moved = std::abs(problem.free_opening[row]) + std::abs(solution.opening[row] - problem.free_opening[row]);
        of_row[row] = slope * moved + std::abs(solution.force[row]);
      }
  }
  double sum = 0;
  for (Index j = 0; j < model.factor.cols(); ++j) {
    const double* column = model.factor.data() + j * model.factor.rows();
    Lanes component = 0;
    for_lanes(model.factor.rows(), [&](const auto& at) { component += absolute(at(column)) * at(of_row); });
    const double whole = std::abs(solution.z[j]) + uplift::sum(component);
    sum += whole * whole;
  }
  return std::numeric_limits<double>::epsilon() * std::sqrt(sum);
}

std::string why_not_finite(const InterfaceProblem& problem, const InterfaceSolution& solution) {
  std::string why = "the interface forces are not finite";
  for (const Block& block : problem.model->blocks)
    if (block.footprint && !solution.force.segment(block.first, block.rows()).allFinite())
      why = fmt::format(
          "the ground under \"{}\" has no state for this motion: its bearing capacity is exhausted, or its footing "
          "lands on an edge",
          block.name);
  return why;
}

}  // namespace uplift
