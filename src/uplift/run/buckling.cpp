#include "uplift/run/buckling.h"

#include "uplift/model/damping.h"
#include "uplift/model/matrix_sum.h"

namespace uplift {

std::optional<double> buckling_share(const Model& model, const Sparse& geometric, const LinearSolver& solver) {
  if (model.free() == 0 || geometric.nonZeros() == 0) return std::nullopt;
  const Sparse held = cones_held(model), to_held = held.transpose();
  const Sparse stiffness = to_held * bonded_stiffness(model, WholeMatrices(solver.matrices_of(model)).stiffness()) * held,
               softening = to_held * geometric * held;
  if (stiffness.rows() == 0) return std::nullopt;
  const auto stands = [&](double share) { return solver.factorise(stiffness + share * softening).factor != nullptr; };
  if (stands(1) || !stands(0)) return std::nullopt;
  double low = 0, high = 1;
  while (high - low > 1e-4 * high && high > 1e-9) {
    const double middle = 0.5 * (low + high);
    (stands(middle) ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace uplift
