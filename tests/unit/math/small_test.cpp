#include "uplift/math/small.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>

namespace uplift::small_test {
namespace {

/// All sizes about one and several registers; what stands below the diagonal is not read, and old values of the result play no part.
TEST(SmallKernels, SymmetricProductReadsTheUpperTriangle) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> value(-1, 1);
  for (Index size = 0; size <= 40; ++size) {
    const Matrix any = Matrix::NullaryExpr(size, size, [&] { return value(random); });
    const Matrix full = any + any.transpose();
    Matrix upper = full;
    upper.triangularView<Eigen::StrictlyLower>().setConstant(std::numeric_limits<double>::quiet_NaN());
    const Vector x = Vector::NullaryExpr(size, [&] { return value(random); });
    Vector y = Vector::Constant(size, 7);
    small::multiply_symmetric(upper, x.data(), y.data());
    EXPECT_LE((y - full * x).norm(), 1e-15 * static_cast<double>(size * size)) << size;
  }
}

}  // namespace
}  // namespace uplift::small_test
