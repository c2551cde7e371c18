#pragma once
#include <Eigen/Core>
#include <Eigen/SparseCore>

#include "uplift/math/product_kernels.h"

// The file that names Eigen; elsewhere only headers of math do (dense.h and sparse_solvers.h, slow to compile: factorisations).
namespace uplift {

using Vector = Eigen::VectorXd;
using Matrix = Eigen::MatrixXd;  // column-major
using Sparse = Eigen::SparseMatrix<double>;
using SparseRows = Eigen::SparseMatrix<double, Eigen::RowMajor>;
using SparseVector = Eigen::SparseVector<double>;
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

/// A position [m] or a direction: three numbers, or two of a plane model (z = 0).
class Place : public Vec3 {
 public:
  Place() : Vec3(Vec3::Zero()) {}
  Place(double x, double y, double z = 0) : Vec3(x, y, z) {}
  template <typename Derived>
  Place(const Eigen::MatrixBase<Derived>& numbers) : Vec3(Vec3::Zero()) {  // NOLINT(google-explicit-constructor): a plain conversion
    head<Derived::RowsAtCompileTime>() = numbers;
  }
};

inline Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a.y() * b.z() - a.z() * b.y(), a.z() * b.x() - a.x() * b.z(), a.x() * b.y() - a.y() * b.x()};
}

inline constexpr unsigned lower_triangle = Eigen::Lower, upper_triangle = Eigen::Upper;

}  // namespace uplift
