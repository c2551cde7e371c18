#include "uplift/contact/newton/many.h"

#include "uplift/contact/lagrange/lagrange.h"
#include "uplift/contact/point_rows.h"
#include "uplift/math/dense.h"

// Newton's direction is that to the solution z' of the linearised problem
//     z' = -C^T (p + (k - D) (opening' - opening) - D opening)        opening' = free opening + C z'
// which PointRows solves by rows, so that nothing of order r^2 m is formed. Where rows are many more than coordinates, as under a rigid
// footing, H itself is formed.
namespace uplift {
namespace {

class Direction final : public MethodWork {
 public:
  bool solve(const InterfaceProblem& problem, InterfaceSolution& solution) {
    return (PointRows::suits(problem) && solve_by_rows(problem, solution)) || solve_by_hessian(problem, solution);
  }

 private:
  bool solve_by_hessian(const InterfaceProblem& problem, InterfaceSolution& solution) {
    const Index r = problem.factor.cols();
    hessian_.setIdentity(r, r);
    work_.resize(problem.rows(), r);
    const NewtonScratch& scratch = solution.newton;
    for (std::size_t b = 0; b < problem.blocks.size(); ++b) {
      const Block& block = problem.blocks[b];
      const int n = block.batch.points, components = block.batch.components;
      for (int row = 0; row < components; ++row)
        for (int column = 0; column < components; ++column)
          add_weighted_gram(problem, block.first + row * n, block.first + column * n,
                            ConstMap(scratch.slope.data() + scratch.first_slope[b] + (row * components + column) * n, n), work_, hessian_);
    }
    if (problem.shift.size() > 0) {
      taken_ = -problem.shift;
      add_weighted_gram(problem, 0, 0, ConstMap(taken_.data(), taken_.size()), work_, hessian_);
    }
    lu_.compute(hessian_);
    lu_.solve(scratch.gradient, solution.newton.direction);
    solution.newton.direction *= -1;
    return solution.newton.direction.allFinite();
  }

  bool solve_by_rows(const InterfaceProblem& problem, InterfaceSolution& solution) {
    const NewtonScratch& scratch = solution.newton;
    if (!scratch.slope.allFinite()) return false;
    rows_.begin(problem);
    for (std::size_t b = 0; b < problem.blocks.size(); ++b)
      rows_.linearise(b, scratch.slope.data() + scratch.first_slope[b], solution.force, solution.opening);
    if (!rows_.solve(force_, opening_, solution.newton.direction, solution.systems)) return false;
    solution.newton.direction -= solution.z;
    return true;
  }

  PointRows rows_;
  Matrix hessian_, work_;
  Vector taken_, force_, opening_;
  PartialLu lu_;
};

}  // namespace

bool direction_of_many(const InterfaceProblem& problem, InterfaceSolution& solution) {
  std::unique_ptr<MethodWork>& kept = solution.newton.direction_of_many.work;
  if (kept == nullptr) kept = std::make_unique<Direction>();
  return static_cast<Direction&>(*kept).solve(problem, solution);
}

}  // namespace uplift
