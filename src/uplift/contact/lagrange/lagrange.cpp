#include "uplift/contact/lagrange/lagrange.h"

#include <algorithm>
#include <cmath>

#include "uplift/contact/kernel/kernel.h"
#include "uplift/contact/lagrange/failures.h"
#include "uplift/contact/newton/newton.h"
#include "uplift/contact/point_rows.h"
#include "uplift/math/small.h"

namespace uplift {
namespace {

struct LagrangeWork final : MethodWork {
  KernelScratch kernel;
  Vector limit, held;  // rows: area of the normal rows of cones, and the same where they are closed
  NewtonWork newton;
  std::unique_ptr<MethodWork> frictionless, frictional;
};

class LagrangeMethod final : public ContactMethod {
 public:
  explicit LagrangeMethod(LagrangeOptions options) : options_(options) {}

  std::unique_ptr<MethodWork> make_work() const override { return std::make_unique<LagrangeWork>(); }
  Outcome solve(const InterfaceProblem& problem, MethodWork& kept, InterfaceSolution& solution) const override {
    LagrangeWork& work = static_cast<LagrangeWork&>(kept);
    size_solution(problem, solution);
    if (const Index rows = problem.rows(); work.held.size() != rows)
      for (Vector* v : {&work.held, &work.limit}) v->setZero(rows);
    bool laws = false, cones = false, friction = false;
    for (const Block& block : problem.model->blocks) {
      laws = laws || block.law != nullptr;
      cones = cones || block.cone != nullptr;
      friction = friction || (block.cone != nullptr && block.cone->friction() > 0);
    }
    if (!cones && laws) return solve_laws(problem, work, solution);
    const bool iterated = problem.model->solver == InterfaceSolver::krylov && PointRows::suits(*problem.model);
    if (friction || iterated) return solve_frictional(problem, options_, work.frictional, solution);
    if (laws || problem.model->shift.size() > 0) return solve_frictionless(problem, options_, work.frictionless, solution);
    return problem.model->blocks.size() == 1 ? solve_one(problem, work, solution) : solve_several(problem, work, solution);
  }

  bool constrains() const override { return true; }

 private:
  /// Traction laws alone constrain nothing: Newton's method with their true slopes, which friction makes unsymmetric and softening
  /// indefinite. Where it fails, the descent of the potential may still arrive.
  Outcome solve_laws(const InterfaceProblem& problem, LagrangeWork& work, InterfaceSolution& solution) const {
    Outcome newton = solve_by_newton(problem, {}, NewtonOptions{options_.tolerance, options_.most_iterations}, work.newton, solution);
    if (newton.converged) return newton;
    solution.z.setZero();
    Outcome descent = solve_frictionless(problem, options_, work.frictionless, solution);
    descent.iterations += newton.iterations;
    if (!descent.converged) descent.why = newton.why;
    return descent;
  }

  /// One frictionless block: the normal rows alone are the problem.
  Outcome solve_one(const InterfaceProblem& problem, LagrangeWork& work, InterfaceSolution& solution) const {
    const Block& block = problem.model->blocks.front();
    const std::ptrdiff_t n = block.batch.points, first = block.normal_row(), rows = problem.rows();
    const double* area = block.area.data();
    double* held = work.held.data();
    const Lanes zero = 0;
    char* status = reinterpret_cast<char*>(solution.status.data());
    for_lanes(n, [&](const auto& at) { at.put(held, choose(at(status) != zero, at(area), zero)); });
    const Rows view{
        n,       problem.model->factor.cols(),   rows, problem.model->factor.data() + first, problem.free_opening.data() + first, area,
        nullptr, options_.gap_of(*problem.model)};
    const KernelReply reply =
        solve_rows(view, held, solution.z.data(), solution.opening.data() + first, solution.force.data() + first, work.kernel);
    if (reply.iterations > 1)
      for_lanes(n,
                [&, slip = Lanes(static_cast<int>(Status::slip))](const auto& at) { at.put(status, choose(at(held) > zero, slip, zero)); });
    for (int c = 0; c + 1 < block.batch.components; ++c) {  // tractionless tangentially
      const std::ptrdiff_t row = block.first + c * n;
      double* opening = solution.opening.data() + row;
      std::copy_n(problem.free_opening.data() + row, n, opening);
      for (Index k = 0; k < problem.model->factor.cols(); ++k)
        small::add(n, solution.z[k], problem.model->factor.data() + k * rows + row, opening);
      std::fill_n(solution.force.data() + row, n, 0.0);
    }
    return outcome(problem, reply, first);
  }

  Outcome solve_several(const InterfaceProblem& problem, LagrangeWork& work, InterfaceSolution& solution) const {
    work.limit.setZero();
    int point = 0;
    for (const Block& block : problem.model->blocks) {
      const int normal = block.normal_row();
      for (int i = 0; i < block.batch.points; ++i, ++point) {
        work.limit[normal + i] = block.area[static_cast<std::size_t>(i)];
        work.held[normal + i] = solution.status[static_cast<std::size_t>(point)] != Status::open ? work.limit[normal + i] : 0;
      }
      for (int i = block.first; i < normal; ++i) work.held[i] = 0;
    }
    const Rows view{problem.rows(),
                    problem.model->factor.cols(),
                    problem.rows(),
                    problem.model->factor.data(),
                    problem.free_opening.data(),
                    work.limit.data(),
                    nullptr,
                    options_.gap_of(*problem.model)};
    const KernelReply reply =
        solve_rows(view, work.held.data(), solution.z.data(), solution.opening.data(), solution.force.data(), work.kernel);
    point = 0;
    for (const Block& block : problem.model->blocks)
      for (int i = 0; i < block.batch.points; ++i, ++point)
        solution.status[static_cast<std::size_t>(point)] = work.held[block.normal_row() + i] > 0 ? Status::slip : Status::open;
    return outcome(problem, reply, 0);
  }

  static Outcome outcome(const InterfaceProblem& problem, const KernelReply& reply, std::ptrdiff_t first) {
    Outcome outcome;
    outcome.converged = reply.solved();
    outcome.iterations = reply.iterations;
    outcome.cycles = reply.cycles;
    outcome.residual = reply.residual;
    if (!outcome.converged) outcome.why = kernel_failure(*problem.model, reply, first);
    return outcome;
  }

  LagrangeOptions options_;
};

}  // namespace

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
           {number("gap_tolerance", "m",
                   "a point is closed only when it would penetrate by more than this; absent: 1e-12 of the size of the interfaces, or "
                   "`tolerance` of it where that is smaller")
                .positive()
                .optional(),
            number("tolerance", "1", "balance residual beside traction laws, relative to the interface force").positive().standard(1e-12),
            integer("most_iterations", "iterations before the fallback").between(1, 10000).standard(100.0)}},
      [](const Values& values) -> std::unique_ptr<const ContactMethod> {
        return std::make_unique<LagrangeMethod>(
            LagrangeOptions{values.has("gap_tolerance") ? std::optional(values.number("gap_tolerance")) : std::nullopt,
                            values.number("tolerance"), values.integer("most_iterations")});
      }};
  return entry;
}

}  // namespace uplift
