#include "uplift/math/singular_values.h"

#include <Eigen/SVD>

namespace uplift {

SingularValues::SingularValues(const Matrix& a) {
  const Eigen::BDCSVD<Matrix> solver(a, Eigen::ComputeThinU);
  values_ = solver.singularValues();
  left_ = solver.matrixU();
}

}  // namespace uplift
