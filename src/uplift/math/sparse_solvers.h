#pragma once
#include <Eigen/SparseCholesky>

#include "uplift/math/linalg.h"

// Sparse factorisations of Eigen: kept apart from linalg.h because they are slow to compile. To be included by sources, not by headers.
namespace uplift {

using Eigen::Success;
using SparseLdlt = Eigen::SimplicialLDLT<Sparse, Eigen::Lower, Eigen::AMDOrdering<int>>;

}  // namespace uplift
