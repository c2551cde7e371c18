#include "uplift/math/product_kernels.h"

namespace Eigen::internal {
UPLIFT_PRODUCT_KERNELS()
}
