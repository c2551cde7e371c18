#pragma once
#include <gtest/gtest.h>

#include <optional>
#include <random>

#include "uplift/reduction/projection.h"
#include "uplift/session/reduce.h"
#include "uplift/session/steps.h"

// Reduced models made by hand, and runs with them.
namespace uplift::support {

/// The reduced model of a structure, without any coordinate; `frequency`: that of the energy product [rad/s].
inline ReducedModel without_basis(const Model& model, double frequency) {
  ReducedModel reduced;
  reduced.matrices = matrices_hash(model);
  reduced.loads = orthonormal_loads(model);
  reduced.energy_frequency = frequency;
  reduced.vectors.resize(model.free(), 0);
  return reduced;
}

/// Random vectors, orthonormal in the energy product: runs with a few of them are far from those of the whole model.
inline ReducedModel random_basis(const Model& model, double frequency, Index size, unsigned seed) {
  ReducedModel reduced = without_basis(model, frequency);
  const EnergyProduct product(model.stiffness, model.mass, frequency);
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  while (reduced.vectors.cols() < size) {
    Vector x(model.free());
    for (double& value : x) value = normal(random);
    append(product, x, 1e-8, reduced.vectors);
  }
  return reduced;
}

/// The run of a case that was built, with a reduced model.
inline RunResult run_reduced(BuiltCase built, const ReducedModel& reduced) {
  RunResult result;
  const std::optional<RunState> begin = begin_reduced(reduced, {}, built, {}, result);
  EXPECT_TRUE(begin) << result.reason;
  Keeping keeping;
  keeping.from = &*begin;
  return run(built.model, built.plan, built.behaviours, {}, {}, &keeping);
}

}  // namespace uplift::support
