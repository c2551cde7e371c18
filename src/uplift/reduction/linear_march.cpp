#include "uplift/reduction/linear_march.h"

#include "uplift/math/symmetric_product.h"

namespace uplift {

LinearMarch::LinearMarch(const Sparse& stiffness, const Sparse& damping, const Sparse& mass, double step, const LinearSolver& solver)
    : stiffness_(stiffness), mass_(mass), step_(step) {
  Factorisation made = solver.factorise(stiffness + (2 / step) * damping + (4 / (step * step)) * mass);
  factor_ = std::move(made.factor);
  why_ = std::move(made.why);
}

void LinearMarch::start(Index columns) {
  displacement_ = velocity_ = before_ = after_ = Matrix::Zero(stiffness_.rows(), columns);
  steps_ = 0;
}

void LinearMarch::advance(const Load& load) {
  if (steps_ == 0) load(0, before_);
  ++steps_;
  load(time(), after_);
  right_ = before_ + after_;
  add_symmetric_product(-2, stiffness_, displacement_, right_);
  add_symmetric_product(4 / step_, mass_, velocity_, right_);
  factor_->solve(right_, increment_);
  displacement_ += increment_;
  velocity_ = (2 / step_) * increment_ - velocity_;
  before_.swap(after_);
}

}  // namespace uplift
