#pragma once
#include <string_view>

#include "uplift/math/linalg.h"

namespace uplift {

/// y += factor A B by BLAS, for tall matrices: Eigen packs B anew for every few rows of A where it takes the third-level cache for large.
void add_product(double factor, const Eigen::Ref<const Matrix>& a, const Eigen::Ref<const Matrix>& b, Matrix& y);
/// A^T B by BLAS.
Matrix transposed_product(const Eigen::Ref<const Matrix>& a, const Eigen::Ref<const Matrix>& b);

/// To be called by every thread before it calls BLAS: OpenBLAS maps 134 MB of address space as the work space of every call that runs
/// beside others, keeps it, and tries for ever where the system refuses it. Here it takes one for the thread, or std::bad_alloc is thrown.
/// BLAS itself uses one thread: results do not depend on the number of cores, and runs side by side do not fight for them.
void prepare_blas();

/// The processor for which the kernels of BLAS were written that are in use, such as "SkylakeX"; "Prescott" (SSE3) for those that OpenBLAS
/// does not know.
std::string_view blas_kernels();

/// As long as one exists BLAS uses one thread; with the last one the number of threads is what it was before the first. For a library in a
/// process where others use the same OpenBLAS.
class SingleThreadBlas {
 public:
  SingleThreadBlas();
  SingleThreadBlas(const SingleThreadBlas&) = delete;
  SingleThreadBlas& operator=(const SingleThreadBlas&) = delete;
  ~SingleThreadBlas();
};

/// To be called first in a process that fork() has made: CHOLMOD's parallel loops would wait for ever for the threads that OpenMP keeps in
/// the parent. From here on they have one thread.
void use_one_thread_after_fork();

}  // namespace uplift
