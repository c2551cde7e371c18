#include "uplift/dynamics/cost.h"

#include <algorithm>

#include "uplift/dynamics/bulk.h"
#include "uplift/linear/large.h"
#include "uplift/linear/memory.h"
#include "uplift/math/upper_sum.h"

namespace uplift {

namespace {

double bytes_of(const Sparse& matrix) {
  return 12 * static_cast<double>(matrix.nonZeros()) + 4 * static_cast<double>(matrix.cols());
}

/// C, Q and the last block of a split factor, and what the interface problem makes of C.
double interface_blocks(double rows, double touched) {
  const double r = std::min(rows, touched), turned = rows < touched ? r * touched : 0;
  return 8 * (rows * r + turned + touched * touched + 3 * r * r);
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
    const Term terms[] = {{1, model.stiffness}, {1, model.damping}, {1, model.mass}};
    const Sparse step = upper_sum(terms);
    cost.step = solver.predict(step, touched);
    cost.step.working_bytes += bytes_of(step);
    if (const auto other = use.statics ? solver_for_statics(solver, {}) : nullptr) statics = other->predict(step, touched);
    statics.working_bytes += bytes_of(step);
  }
  {
    const Term terms[] = {{1, model.mass}, {1, unit}};
    const Sparse mass = upper_sum(terms);
    cost.mass = solver.predict(mass, use.impacts ? touched : std::vector<int>());
    cost.mass.working_bytes += bytes_of(mass);
  }
  cost.elsewhere_bytes = std::max({cost.step.most_elsewhere, statics.most_elsewhere, cost.mass.most_elsewhere});
  const double beside = std::max({cost.step.beside, statics.beside, cost.mass.beside});
  const auto rows = static_cast<double>(b.rows()), n = static_cast<double>(model.free());
  cost.matrix_bytes = bytes_of(model.stiffness) + bytes_of(model.mass) + bytes_of(model.damping);
  // SymmetricPair: half the entries, 20 bytes each
  const double pair = solver.distributed() ? 0 : 10 * static_cast<double>(model.stiffness.nonZeros()) + 24 * n;
  const double steps = use.step_sizes + (use.propagates ? 1 : 0);
  const double blocks = interface_blocks(rows, static_cast<double>(cost.touched));
  cost.interface_bytes = (steps + (use.impacts ? 1 : 0)) * blocks;
  const double kept = (use.keeps_mass ? cost.mass.bytes : 0) + steps * cost.step.bytes + cost.interface_bytes + pair + 25 * 8 * n;
  double more = std::max(kept, (steps > 1 ? kept : cost.step.bytes) + cost.step.working_bytes);
  // a factor of M that is kept is made after that of the first step size, one for the acceleration of the beginning alone before it
  more = std::max(more, (use.keeps_mass ? cost.step.bytes : 0) + cost.mass.bytes + cost.mass.working_bytes);
  more = std::max(more, statics.bytes + statics.working_bytes + blocks);
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
