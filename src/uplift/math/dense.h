#pragma once
#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>
#include <Eigen/SVD>

#include "uplift/math/linalg.h"

// Dense factorisations: kept apart from linalg.h because they are slow to compile. To be included by sources, not by headers.
namespace uplift {

using Cholesky = Eigen::LLT<Matrix>;
using SymmetricEigen = Eigen::SelfAdjointEigenSolver<Matrix>;
using GeneralisedEigen = Eigen::GeneralizedSelfAdjointEigenSolver<Matrix>;
using PartialLu = Eigen::PartialPivLU<Matrix>;
using FullLu = Eigen::FullPivLU<Matrix>;
using Qr = Eigen::HouseholderQR<Matrix>;
using PivotedQr = Eigen::ColPivHouseholderQR<Matrix>;
using CompleteQr = Eigen::CompleteOrthogonalDecomposition<Matrix>;
using PivotedLdlt = Eigen::LDLT<Matrix>;
using Svd = Eigen::JacobiSVD<Matrix>;
using Eigen::OnTheRight;
using Eigen::Success;

}  // namespace uplift
