#include "uplift/contact/newton/many.h"

#include "uplift/contact/newton/jump_direction.h"
#include "uplift/contact/point_rows.h"
#include "uplift/math/dense.h"

// Newton's direction is that to the solution z' of the linearised problem
//     z' = -C^T (p + (k - D) (opening' - opening) - D opening)        opening' = free opening + C z'
// which PointRows solves by rows, so that nothing of order r^2 m is formed. Where rows are more than the jumps that they feel, a few jumps
// each, JumpDirection solves in the jumps. Where rows are many more than coordinates, as under a rigid footing, H itself is formed.
namespace uplift {
namespace {

class Direction final : public MethodWork {
 public:
  bool solve(const InterfaceProblem& problem, NewtonWork& work, InterfaceSolution& solution) {
    if (problem.model->jumps.given() && jumps_.solve(problem, work, solution.systems)) return true;
    return (PointRows::suits(*problem.model) && solve_by_rows(problem, work, solution)) || solve_by_hessian(*problem.model, work);
  }

 private:
  bool solve_by_hessian(const ContactModel& model, NewtonWork& work) {
    const Index r = model.factor.cols();
    hessian_.setIdentity(r, r);
    weighted_.resize(model.rows(), r);
    for (std::size_t b = 0; b < model.blocks.size(); ++b) {
      const Block& block = model.blocks[b];
      const int n = block.batch.points, components = block.batch.components;
      for (int row = 0; row < components; ++row)
        for (int column = 0; column < components; ++column)
          add_weighted_gram(model, block.first + row * n, block.first + column * n,
                            ConstMap(work.slope.data() + work.first_slope[b] + (row * components + column) * n, n), weighted_, hessian_);
    }
    if (model.shift.size() > 0) {
      taken_ = -model.shift;
      add_weighted_gram(model, 0, 0, ConstMap(taken_.data(), taken_.size()), weighted_, hessian_);
    }
    lu_.compute(hessian_);
    lu_.solve(work.gradient, work.direction);
    work.direction *= -1;
    return work.direction.allFinite();
  }

  bool solve_by_rows(const InterfaceProblem& problem, NewtonWork& work, InterfaceSolution& solution) {
    if (!work.slope.allFinite()) return false;
    rows_.begin(problem);
    for (std::size_t b = 0; b < problem.model->blocks.size(); ++b)
      rows_.linearise(b, work.slope.data() + work.first_slope[b], solution.force, solution.opening);
    if (!rows_.solve(force_, opening_, work.direction, solution.systems)) return false;
    work.direction -= solution.z;
    return true;
  }

  PointRows rows_;
  JumpDirection jumps_;
  Matrix hessian_, weighted_;
  Vector taken_, force_, opening_;
  PartialLu lu_;
};

}  // namespace

bool direction_of_many(const InterfaceProblem& problem, NewtonWork& work, InterfaceSolution& solution) {
  if (work.direction_of_many == nullptr) work.direction_of_many = std::make_unique<Direction>();
  return static_cast<Direction&>(*work.direction_of_many).solve(problem, work, solution);
}

}  // namespace uplift
