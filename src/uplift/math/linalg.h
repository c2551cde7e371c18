#pragma once
#include <Eigen/Core>
#include <Eigen/SparseCore>

// The file that names Eigen; beside it only math/dense.h and math/sparse_solvers.h do (factorisations, slow to compile).
namespace uplift {

using Vector = Eigen::VectorXd;
using Matrix = Eigen::MatrixXd;  // column-major
using Sparse = Eigen::SparseMatrix<double>;
using SparseRows = Eigen::SparseMatrix<double, Eigen::RowMajor>;
using Triplet = Eigen::Triplet<double>;
using Vec2 = Eigen::Vector2d;
using Vec3 = Eigen::Vector3d;
using Vec4 = Eigen::Vector4d;
using Mat4 = Eigen::Matrix4d;
using Map = Eigen::Map<Vector>;  // someone else's numbers as a vector
using ConstMap = Eigen::Map<const Vector>;
using ColumnStride = Eigen::OuterStride<>;
using ConstMatrixMap = Eigen::Map<const Matrix, 0, ColumnStride>;  // columns of someone else's matrix, apart by a stride
using Index = Eigen::Index;
inline constexpr unsigned lower_triangle = Eigen::Lower, upper_triangle = Eigen::Upper;

}  // namespace uplift
