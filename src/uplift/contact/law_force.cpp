#include "uplift/contact/law_force.h"

namespace uplift {
namespace {

/// Tractions become forces on the rows: times scale * area.
void to_force(const InterfaceProblem& problem, const Block& block, double* force, double* slope) {
  const int n = block.batch.points, components = block.batch.components;
  const double* area = block.area.data();
  const double scale = problem.model->scale;
  if (n == 1) {
    const double weight = scale * area[0];
    for (int c = 0; c < components; ++c) force[c] *= weight;
    if (slope != nullptr)
      for (int c = 0; c < components * components; ++c) slope[c] *= weight;
    return;
  }
  if (components == 1 && slope != nullptr) {
#pragma omp simd
    for (int i = 0; i < n; ++i) {
      const double weight = scale * area[i];
      force[i] *= weight;
      slope[i] *= weight;
    }
    return;
  }
  for (int c = 0; c < components; ++c)
#pragma omp simd
    for (int i = 0; i < n; ++i) force[c * n + i] *= scale * area[i];
  if (slope != nullptr)
    for (int c = 0; c < components * components; ++c)
#pragma omp simd
      for (int i = 0; i < n; ++i) slope[c * n + i] *= scale * area[i];
}

}  // namespace

void law_force(const InterfaceProblem& problem, const Block& block, const double* opening, const LawResponse& response) {
  Batch batch = block.batch;
  batch.step = problem.model->step;
  if (problem.filter.acts()) {
    batch.coefficient = problem.filter.coefficient.data() + block.first;
    batch.lag = problem.filter.lag.data() + block.first;
    batch.gain = problem.filter.gain;
  }
  const double *from = problem.from.data() + block.first, *to = opening + block.first;
  const double* old = problem.old.data() + block.first_history;
  if (problem.model->average)
    block.law->mean(batch, from, to, old, response);
  else
    block.law->respond(batch, from, to, old, response);
  to_force(problem, block, response.traction, response.slope);
}

}  // namespace uplift
