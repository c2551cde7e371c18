#include "uplift/contact/lagrange/lagrange.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "uplift/contact/method.h"
#include "uplift/contact/newton/newton.h"
#include "uplift/contact/point_rows.h"
#include "uplift/math/small.h"

namespace uplift {
namespace {

class LagrangeMethod final : public ContactMethod {
 public:
  explicit LagrangeMethod(LagrangeOptions options) : options_(options) {}

  Outcome solve(const InterfaceProblem& problem, InterfaceSolution& solution) const override {
    size_solution(problem, solution);
    bool laws = false, cones = false, friction = false;
    for (const Block& block : problem.blocks) {
      laws = laws || block.law != nullptr;
      cones = cones || block.cone != nullptr;
      friction = friction || (block.cone != nullptr && block.cone->friction() > 0);
    }
    if (!cones && laws) return solve_laws(problem, solution);
    const bool iterated = problem.solver == InterfaceSolver::krylov && PointRows::suits(problem);
    if (friction || iterated) return solve_frictional(problem, options_, solution);
    if (laws || problem.shift.size() > 0) return solve_frictionless(problem, options_, solution);
    return problem.blocks.size() == 1 ? solve_one(problem, solution) : solve_several(problem, solution);
  }

  bool constrains() const override { return true; }

 private:
  /// Traction laws alone constrain nothing: Newton's method with their true slopes, which friction makes unsymmetric and softening
  /// indefinite. Where it fails, the descent of the potential may still arrive.
  Outcome solve_laws(const InterfaceProblem& problem, InterfaceSolution& solution) const {
    Outcome newton = solve_by_newton(problem, {}, NewtonOptions{options_.tolerance, options_.most_iterations}, solution);
    if (newton.converged) return newton;
    solution.z.setZero();
    Outcome descent = solve_frictionless(problem, options_, solution);
    descent.iterations += newton.iterations;
    if (!descent.converged) descent.why = newton.why;
    return descent;
  }

  /// One frictionless block: the normal rows alone are the problem.
  Outcome solve_one(const InterfaceProblem& problem, InterfaceSolution& solution) const {
    const Block& block = problem.blocks.front();
    const std::ptrdiff_t n = block.batch.points, first = block.first + block.batch.normal(), rows = problem.rows();
    const double* area = block.area.data();
    double* held = solution.lagrange.held.data();
    Status* status = solution.status.data();
#pragma omp simd
    for (std::ptrdiff_t i = 0; i < n; ++i) held[i] = status[i] != Status::open ? area[i] : 0.0;
    const Rows view{n,       problem.factor.cols(), rows, problem.factor.data() + first, problem.free_opening.data() + first, area,
                    nullptr, options_.gap_tolerance};
    const KernelReply reply =
        solve_rows(view, held, solution.z.data(), solution.opening.data() + first, solution.force.data() + first, solution.lagrange.kernel);
    if (reply.iterations > 1)
      for (std::ptrdiff_t i = 0; i < n; ++i) status[i] = held[i] > 0 ? Status::slip : Status::open;
    for (int c = 0; c + 1 < block.batch.components; ++c) {  // tractionless tangentially
      const std::ptrdiff_t row = block.first + c * n;
      double* opening = solution.opening.data() + row;
      std::copy_n(problem.free_opening.data() + row, n, opening);
      for (Index k = 0; k < problem.factor.cols(); ++k) small::add(n, solution.z[k], problem.factor.data() + k * rows + row, opening);
      std::fill_n(solution.force.data() + row, n, 0.0);
    }
    return outcome(problem, reply, first);
  }

  Outcome solve_several(const InterfaceProblem& problem, InterfaceSolution& solution) const {
    LagrangeScratch& scratch = solution.lagrange;
    scratch.limit.setZero();
    int point = 0;
    for (const Block& block : problem.blocks) {
      const int normal = block.first + block.batch.normal();
      for (int i = 0; i < block.batch.points; ++i, ++point) {
        scratch.limit[normal + i] = block.area[static_cast<std::size_t>(i)];
        scratch.held[normal + i] = solution.status[static_cast<std::size_t>(point)] != Status::open ? scratch.limit[normal + i] : 0;
      }
      for (int i = block.first; i < normal; ++i) scratch.held[i] = 0;
    }
    const Rows view{
        problem.rows(), problem.factor.cols(), problem.rows(), problem.factor.data(), problem.free_opening.data(), scratch.limit.data(),
        nullptr,        options_.gap_tolerance};
    const KernelReply reply =
        solve_rows(view, scratch.held.data(), solution.z.data(), solution.opening.data(), solution.force.data(), scratch.kernel);
    point = 0;
    for (const Block& block : problem.blocks)
      for (int i = 0; i < block.batch.points; ++i, ++point)
        solution.status[static_cast<std::size_t>(point)] =
            scratch.held[block.first + block.batch.normal() + i] > 0 ? Status::slip : Status::open;
    return outcome(problem, reply, 0);
  }

  static Outcome outcome(const InterfaceProblem& problem, const KernelReply& reply, std::ptrdiff_t first) {
    Outcome outcome;
    outcome.converged = reply.solved();
    outcome.iterations = reply.iterations;
    outcome.cycles = reply.cycles;
    outcome.residual = reply.residual;
    if (!outcome.converged) outcome.why = kernel_failure(problem, reply, first);
    return outcome;
  }

  LagrangeOptions options_;
};

}  // namespace

std::string kernel_failure(const InterfaceProblem& problem, const KernelReply& reply, std::ptrdiff_t first) {
  if (reply.end == KernelEnd::inconsistent)
    return fmt::format("contradictory constraints: no motion of the structure opens {}", point_name(problem, first + reply.worst));
  if (reply.end == KernelEnd::not_finite) return "the openings are not finite";
  return fmt::format("the active set did not settle in {} iterations, the dual method included", reply.iterations);
}

std::string point_name(const InterfaceProblem& problem, std::ptrdiff_t row) {
  for (const Block& block : problem.blocks)
    if (row >= block.first && row < block.first + block.rows())
      return fmt::format("point {} of '{}'", (row - block.first) % block.batch.points + 1, block.name);
  return fmt::format("row {}", row);
}

std::string point_names(const InterfaceProblem& problem, const std::vector<std::ptrdiff_t>& rows, std::size_t most) {
  std::string text;
  for (std::size_t k = 0; k < rows.size() && k < most; ++k) text += (k > 0 ? ", " : "") + point_name(problem, rows[k]);
  if (rows.size() > most) text += fmt::format(" and {} more", rows.size() - most);
  return text;
}

void size_solution(const InterfaceProblem& problem, InterfaceSolution& solution) {
  const Index rows = problem.rows(), r = problem.factor.cols();
  std::size_t points = 0;
  for (const Block& block : problem.blocks) points += static_cast<std::size_t>(block.batch.points);
  if (solution.opening.size() == rows && solution.force.size() == rows && solution.z.size() == r && solution.status.size() == points &&
      solution.now.size() == problem.old.size() && solution.lagrange.held.size() == rows)
    return;
  if (solution.z.size() != r) solution.z.setZero(r);
  if (solution.status.size() != points) solution.status.assign(points, Status::open);
  solution.opening.setZero(rows);
  if (solution.force.size() != rows) solution.force.setZero(rows);
  solution.now.setZero(problem.old.size());
  solution.lagrange.held.setZero(rows);
  solution.lagrange.limit.setZero(rows);
}

const Entry<ContactMethod>& entry_method_lagrange() {
  static const Entry<ContactMethod> entry{
      {.name = "lagrange",
       .summary = "constraints by Lagrange multipliers: exact, redundant points share the force with least norm",
       .equations = "minimise |z|^2/2, opening_n >= 0, p_n <= 0, p_n opening_n = 0\n"
                    "friction: |p_t| <= -mu p_n, p_t along the slip, opening_t - from_t\n"
                    "of all admissible forces the one of least sum p^2 / area",
       .source = "Cherubini, Richard & Frau, eq 1 with alpha = 0; Hintermueller, Ito & Kunisch (2002); Goldfarb & Idnani (1983); Alart & "
                 "Curnier (1991)",
       .params =
           {number("gap_tolerance", "m", "a point is closed only when it would penetrate by more than this").positive().standard(1e-12),
            number("tolerance", "1", "balance residual beside traction laws, relative to the interface force").positive().standard(1e-12),
            integer("most_iterations", "iterations before the fallback").between(1, 10000).standard(100.0)}},
      [](const Values& values) -> std::unique_ptr<const ContactMethod> {
        return std::make_unique<LagrangeMethod>(
            LagrangeOptions{values.number("gap_tolerance"), values.number("tolerance"), values.integer("most_iterations")});
      }};
  return entry;
}

}  // namespace uplift
