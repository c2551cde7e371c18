#pragma once
#include <Eigen/Core>

// The kernels of products of dense matrices and vectors, which are not inlined: compiled once, not in every file that multiplies.
// NOLINTBEGIN(bugprone-macro-parentheses)
#define UPLIFT_PRODUCT_KERNELS(KIND)                                                                                                      \
  KIND template struct gebp_kernel<double, double, Index, blas_data_mapper<double, Index, ColMajor, 0, 1>,                                \
                                   gebp_traits<double, double>::mr, gebp_traits<double, double>::nr, false, false>;                       \
  KIND template struct gemm_pack_lhs<double, Index, const_blas_data_mapper<double, Index, ColMajor>, gebp_traits<double, double>::mr,     \
                                     gebp_traits<double, double>::LhsProgress, gebp_traits<double, double>::LhsPacket4Packing, ColMajor>; \
  KIND template struct gemm_pack_lhs<double, Index, const_blas_data_mapper<double, Index, RowMajor>, gebp_traits<double, double>::mr,     \
                                     gebp_traits<double, double>::LhsProgress, gebp_traits<double, double>::LhsPacket4Packing, RowMajor>; \
  KIND template struct gemm_pack_rhs<double, Index, const_blas_data_mapper<double, Index, ColMajor>, gebp_traits<double, double>::nr,     \
                                     ColMajor>;                                                                                           \
  KIND template struct gemm_pack_rhs<double, Index, const_blas_data_mapper<double, Index, RowMajor>, gebp_traits<double, double>::nr,     \
                                     RowMajor>;                                                                                           \
  KIND template struct general_matrix_vector_product<Index, double, const_blas_data_mapper<double, Index, ColMajor>, ColMajor, false,     \
                                                     double, const_blas_data_mapper<double, Index, RowMajor>, false, 0>;                  \
  KIND template struct general_matrix_vector_product<Index, double, const_blas_data_mapper<double, Index, RowMajor>, RowMajor, false,     \
                                                     double, const_blas_data_mapper<double, Index, ColMajor>, false, 0>;
// NOLINTEND(bugprone-macro-parentheses)
#if EIGEN_WORLD_VERSION == 3 && EIGEN_MAJOR_VERSION == 4  // the names are Eigen's own; with another version every file has its copy
namespace Eigen::internal {
UPLIFT_PRODUCT_KERNELS(extern)
}
#else
#undef UPLIFT_PRODUCT_KERNELS
#define UPLIFT_PRODUCT_KERNELS(KIND)
#endif
