#pragma once
#include <functional>
#include <memory>
#include <string>

#include "uplift/linear/solver.h"

namespace uplift {

/// A linear structure at rest that is marched by the trapezoidal rule under many loads at once, one a column:
///   (K + 2/h C + 4/h^2 M) du = f0 + f1 - 2 K u + 4/h M v,   v1 = 2 du/h - v.
class LinearMarch {
 public:
  /// The matrices must stay alive. Where K + 2/h C + 4/h^2 M is not positive definite `why` says so.
  LinearMarch(const Sparse& stiffness, const Sparse& damping, const Sparse& mass, double step, const LinearSolver& solver);
  const std::string& why() const { return why_; }
  /// Fills the loads at a time [s], one a column.
  using Load = std::function<void(double time, Matrix& load)>;
  void start(Index columns);
  void advance(const Load& load);
  double time() const { return static_cast<double>(steps_) * step_; }
  const Matrix& displacement() const { return displacement_; }
  const Matrix& velocity() const { return velocity_; }

 private:
  const Sparse &stiffness_, &mass_;
  double step_;
  long steps_ = 0;
  std::string why_;
  std::unique_ptr<const Factor> factor_;
  Matrix displacement_, velocity_, before_, after_, right_, increment_;
};

}  // namespace uplift
