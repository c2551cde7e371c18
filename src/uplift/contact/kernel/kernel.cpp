#include "uplift/contact/kernel/kernel.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "uplift/contact/kernel/dense.h"

namespace uplift {
namespace {

constexpr int most_iterations = 60;

void size_scratch(Index rows, Index columns, KernelScratch& scratch) {
  scratch.closed_rows.size(rows, columns);
  if (scratch.opening.size() == rows && scratch.z.size() == columns) return;
  scratch.closed.reserve(static_cast<std::size_t>(rows));
  for (Vector* v : {&scratch.opening, &scratch.field, &scratch.right, &scratch.root, &scratch.multiplier}) v->setZero(rows);
  for (Vector* v : {&scratch.z, &scratch.step}) v->setZero(columns);
}

/// One pass of the general active set: the closed rows solved, openings, pressures C y and forces evaluated. False when the closed rows
/// contradict each other beyond `gap`.
bool solve_closed(const Rows& rows, const ConstMatrixMap& c, double gap, const double* held, KernelScratch& scratch) {
  const ConstMap target(rows.target, rows.count);
  const Index count = static_cast<Index>(scratch.closed.size());
  const auto row = [&](Index k) { return scratch.closed[static_cast<std::size_t>(k)]; };
  HeldRows& solver = scratch.closed_rows;
  for (Index k = 0; k < count; ++k) {
    scratch.root[k] = std::sqrt(held[row(k)]);
    solver.transposed().col(k) = scratch.root[k] * c.row(row(k)).transpose();
    scratch.right[k] = -scratch.root[k] * target[row(k)];
  }
  solver.compute(count);
  solver.least_norm(scratch.right, scratch.z);
  for (int refinement = 0;; ++refinement) {
    scratch.opening = target;
    scratch.opening.noalias() += c * scratch.z;
    double worst = 0;
    for (Index k = 0; k < count; ++k) {
      const double value = scratch.opening[row(k)];
      worst = std::max(worst, std::abs(value));
      scratch.right[k] = -scratch.root[k] * value;
    }
    if (worst <= 1e-13 * target.cwiseAbs().maxCoeff() || (refinement == 3 && worst <= gap)) break;
    if (refinement == 3) return false;
    solver.least_norm(scratch.right, scratch.step);
    scratch.z += scratch.step;
  }
  solver.multipliers(scratch.z, scratch.multiplier);
  solver.least_norm(scratch.multiplier, scratch.step);
  scratch.field.noalias() = c * scratch.step;
  for (Index k = 0; k < count; ++k) scratch.field[row(k)] = scratch.multiplier[k] / scratch.root[k];
  return true;
}

/// Without coordinates the openings are what they are.
KernelReply nothing_moves(const Rows& rows, double* held, double* z, double* opening, double* force) {
  KernelReply reply;
  reply.end = KernelEnd::solved;
  std::fill_n(z, rows.columns, 0.0);
  for (std::ptrdiff_t i = 0; i < rows.count; ++i) {
    opening[i] = rows.target[i];
    force[i] = 0;
    const bool may = rows.limit[i] > 0, must = !may && rows.fixed != nullptr && rows.fixed[i] > 0;
    if (may) held[i] = 0;
    if (!std::isfinite(opening[i])) reply.end = KernelEnd::not_finite;
    if (reply.solved() && ((may && opening[i] < -rows.tolerance) || (must && std::abs(opening[i]) > rows.tolerance))) {
      reply.end = KernelEnd::inconsistent;
      reply.worst = i;
    }
  }
  return reply;
}

}  // namespace

KernelReply general_active_set(const Rows& rows, double* held, double* z_out, double* opening_out, double* force, KernelScratch& scratch) {
  const Index n = rows.count, r = rows.columns;
  const ConstMatrixMap c(rows.factor, n, r, ColumnStride(rows.stride));
  const ConstMap target(rows.target, n);
  KernelReply reply;
  if (!target.allFinite() || !c.allFinite()) {
    reply.end = KernelEnd::not_finite;
    return reply;
  }
  const double gap = std::max(rows.tolerance, rows.relative * target.norm());
  scratch.visited.count = 0;
  scratch.visited.note(n, held);
  size_scratch(n, r, scratch);
  const Vector &opening = scratch.opening, &field = scratch.field;
  for (reply.iterations = 1; reply.iterations <= most_iterations; ++reply.iterations) {
    scratch.closed.clear();
    for (Index i = 0; i < n; ++i)
      if (held[i] > 0) scratch.closed.push_back(i);
    if (!solve_closed(rows, c, gap, held, scratch)) return reply;
    double largest = 0;
    for (const std::ptrdiff_t i : scratch.closed) largest = std::max(largest, std::abs(field[i]));
    const double pressure = 1e-12 * largest;
    for (Index i = 0; i < n; ++i) force[i] = held[i] * (rows.limit[i] > 0 ? std::min(0.0, field[i]) : field[i]);
    bool changed = false;
    for (Index i = 0; i < n; ++i) {
      if (!(rows.limit[i] > 0)) continue;
      const bool now = held[i] > 0 ? field[i] <= pressure : opening[i] < -gap || (opening[i] <= gap && field[i] < -pressure);
      changed = changed || now != (held[i] > 0);
      held[i] = now ? rows.limit[i] : 0;
    }
    if (!changed) {
      reply.residual = kernel_residual(c, scratch.z, force, held, opening, rows.target, scratch.step);
      std::copy_n(scratch.z.data(), r, z_out);
      std::copy_n(opening.data(), n, opening_out);
      reply.end = KernelEnd::solved;
      return reply;
    }
    if (!scratch.visited.note(n, held)) {
      reply.cycles = 1;
      return reply;
    }
  }
  return reply;
}

KernelReply solve_rows(const Rows& rows, double* held, double* z, double* opening, double* force, KernelScratch& scratch) {
  if (rows.fixed != nullptr)
    for (std::ptrdiff_t i = 0; i < rows.count; ++i)
      if (!(rows.limit[i] > 0)) held[i] = rows.fixed[i];
  if (rows.count == 0 || rows.columns == 0) return nothing_moves(rows, held, z, opening, force);
  KernelReply reply = rows.columns <= 3 ? small_active_set(rows, held, z, opening, force, scratch)
                                        : general_active_set(rows, held, z, opening, force, scratch);
  if (reply.end != KernelEnd::stuck) return reply;
  const int iterations = reply.iterations, cycles = reply.cycles;
  reply = dual_active_set(rows, held, z, opening, force, scratch);
  reply.iterations += iterations;
  reply.cycles += cycles;
  return reply;
}

}  // namespace uplift
