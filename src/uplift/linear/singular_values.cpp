#include "uplift/linear/singular_values.h"

#include <algorithm>
#include <cstddef>
#include <limits>

#include "uplift/linear/blas.h"

// LAPACK, which OpenBLAS contains: Eigen's template of such a decomposition takes a twentieth of the time to compile the whole program.
// These are the steps of its dgesvd(), which itself would need the library of Fortran where OpenBLAS is linked statically. The last
// argument is the length of the word, as Fortran passes it.
extern "C" {
void dgebrd_(const int* m, const int* n, double* a, const int* lda, double* d, double* e, double* tau_q, double* tau_p, double* work,
             const int* size_of_work, int* info);
void dorgbr_(const char* which, const int* m, const int* n, const int* k, double* a, const int* lda, const double* tau, double* work,
             const int* size_of_work, int* info, std::size_t);
void dbdsqr_(const char* triangle, const int* n, const int* columns_of_vt, const int* rows_of_u, const int* columns_of_c, double* d,
             double* e, double* vt, const int* ldvt, double* u, const int* ldu, double* c, const int* ldc, double* work, int* info,
             std::size_t);
}

namespace uplift {

SingularValues::SingularValues(const Matrix& a) {
  const int m = static_cast<int>(a.rows()), n = static_cast<int>(a.cols()), count = std::min(m, n);
  values_.resize(count);
  left_.resize(m, count);
  if (count == 0) return;
  prepare_blas();
  Matrix q = a;  // first A, then Q of A = Q B P^T with a bidiagonal B
  Vector beside(count), tau_q(count), tau_p(count);
  const int size = 64 * (m + n), none = 0, one = 1;  // blocks of up to 64 columns
  Vector work(size);
  int info = 0;
  dgebrd_(&m, &n, q.data(), &m, values_.data(), beside.data(), tau_q.data(), tau_p.data(), work.data(), &size, &info);
  dorgbr_("Q", &m, &count, &n, q.data(), &m, tau_q.data(), work.data(), &size, &info, 1);
  dbdsqr_(m >= n ? "U" : "L", &count, &none, &m, &none, values_.data(), beside.data(), nullptr, &one, q.data(), &m, nullptr, &one,
          work.data(), &info, 1);
  left_ = q.leftCols(count);
  if (info != 0) values_.setConstant(std::numeric_limits<double>::quiet_NaN());  // of numbers that are not finite, for instance
}

}  // namespace uplift
