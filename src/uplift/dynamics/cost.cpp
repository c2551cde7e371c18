#include "uplift/dynamics/cost.h"

#include <algorithm>
#include <cmath>

#include "uplift/dynamics/bulk.h"
#include "uplift/linear/large.h"
#include "uplift/linear/memory.h"
#include "uplift/model/matrix_sum.h"

namespace uplift {

namespace {

double bytes_of(const Sparse& matrix) {
  return 12 * static_cast<double>(matrix.nonZeros()) + 4 * static_cast<double>(matrix.cols());
}

/// Of the rows that this process keeps, the first one of the job.
double distributed_bytes(const Model& model) {
  double entries = 0;
  if (model.distributed == nullptr) return 0;
  for (const auto& matrix : {model.distributed->stiffness, model.distributed->mass, model.distributed->damping})
    if (matrix != nullptr) entries += matrix->entries().front();
  const auto& cells = model.distributed->cells;
  return 12 * entries + (cells != nullptr ? cells->bytes().front() : 0);
}

/// C, Q and the last block of a split factor, and what the interface problem makes of C.
double interface_blocks(double rows, double touched) {
  const double r = std::min(rows, touched), turned = rows < touched ? r * touched : 0;
  return 8 * (rows * r + turned + touched * touched + 3 * r * r);
}

/// Of the loads of the flexibility with reach: some at once (solved_response.cpp), and the rows of this process of loads and answers.
double loads_at_once(double unknowns, double touched) {
  constexpr double numbers = 1 << 17, most = 32;
  return 3 * 8 * unknowns * std::min(touched, std::clamp(std::floor(numbers / std::max(unknowns, 1.0)), 1.0, most));
}

}  // namespace

BulkCost predict_bulk(const Model& model, const LinearSolver& solver, const BulkUse& use) {
  BulkCost cost;
  const Sparse b = stack_interfaces(model);
  const std::vector<int> touched = touched_unknowns(b);
  cost.touched = static_cast<int>(touched.size());
  Sparse unit(model.free(), model.free());
  unit.setIdentity();
  FactorCost statics;
  {
    const OwnedSum step = matrix_sum(model, 1, use.damping, use.mass);
    cost.step = predict(solver, step, touched);
    cost.step.working_bytes += bytes_of(step.here);
    if (const auto other = use.statics ? solver_for_statics(solver, {}) : nullptr)
      statics = predict(*other, matrix_sum(model, 1, 0, 0), touched);
    statics.working_bytes += bytes_of(step.here);
  }
  {
    OwnedSum mass = matrix_sum(model, 0, 0, 1);
    mass.here += unit;
    cost.mass = predict(solver, mass, use.impacts ? touched : std::vector<int>());
    cost.mass.working_bytes += bytes_of(mass.here);
  }
  cost.elsewhere_bytes = std::max({cost.step.most_elsewhere, statics.most_elsewhere, cost.mass.most_elsewhere});
  const double beside = std::max({cost.step.beside, statics.beside, cost.mass.beside});
  const auto rows = static_cast<double>(b.rows()), n = static_cast<double>(model.free());
  cost.matrix_bytes = bytes_of(model.stiffness) + bytes_of(model.mass) + bytes_of(model.damping) + distributed_bytes(model);
  // SymmetricPair: half the entries, 20 bytes each
  const double pair = solver.distributed() ? 0 : 10 * static_cast<double>(model.stiffness.nonZeros()) + 24 * n;
  const double steps = (use.propagates ? 2 : 1) * use.step_sizes;
  const double blocks = interface_blocks(rows, static_cast<double>(cost.touched));
  cost.interface_bytes = (steps + (use.impacts ? 1 : 0)) * blocks;
  const double vectors = solver.distributed() ? 14 : 17;  // of the step and of the balance of an instant
  const double kept = (use.keeps_mass ? cost.mass.bytes : 0) + steps * cost.step.bytes + cost.interface_bytes + pair + vectors * 8 * n;
  double more = std::max(kept, (steps > 1 ? kept : cost.step.bytes) + cost.step.working_bytes);
  // a factor of M that is kept is made after that of the first step size, one for the acceleration of the beginning alone before it
  more = std::max(more, (use.keeps_mass ? cost.step.bytes : 0) + cost.mass.bytes + cost.mass.working_bytes);
  more = std::max(more, statics.bytes + statics.working_bytes + blocks);
  if (solver.distributed()) more = std::max(more, cost.step.bytes + loads_at_once(n, static_cast<double>(cost.touched)) + 6 * 8 * n);
  more += cost.record_bytes = use.record_bytes;
  give_back_free_memory();
  cost.bytes = std::max(cost.matrix_bytes, resident_memory()) + more;
  cost.matrix_bytes += pair;
  cost.available = available_memory();
  const Rates rates = measure_rates(cost.step.bytes);
  cost.factor_seconds = steps * factor_seconds(cost.step, rates) + factor_seconds(cost.mass, rates);
  cost.solve_seconds = solve_seconds(cost.step, rates);
  cost.refusal = !cost.step.why.empty()   ? cost.step.why
                 : !cost.mass.why.empty() ? cost.mass.why
                                          : memory_refusal(more + beside, cost.available);
  return cost;
}

}  // namespace uplift
