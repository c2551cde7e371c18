#include "uplift/linear/blas.h"

#include <dlfcn.h>
#include <sys/mman.h>

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <mutex>
#include <new>
#include <vector>

extern "C" void dgemm_(const char* transpose_a, const char* transpose_b, const int* m, const int* n, const int* k, const double* alpha,
                       const double* a, const int* lda, const double* b, const int* ldb, const double* beta, double* c, const int* ldc);
extern "C" void openblas_set_num_threads(int count);
extern "C" int openblas_get_num_threads();
extern "C" char* openblas_get_corename();
extern "C" void* blas_memory_alloc(int purpose);
extern "C" void blas_memory_free(void* piece);

namespace uplift {

namespace {

/// Takes pieces of work space from OpenBLAS until one is new, and gives all of them back: it keeps them for later calls.
void add_work_space(std::vector<void*>& known) {
  constexpr std::size_t size = std::size_t{32} << 22;  // bytes: BUFFER_SIZE of OpenBLAS on x86-64, the largest of its targets
  constexpr int of_one_thread = 1;                     // what the routines of BLAS ask for
  void* const trial = mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (trial == MAP_FAILED) throw std::bad_alloc();
  munmap(trial, size);
  std::vector<void*> taken;
  do {
    taken.push_back(blas_memory_alloc(of_one_thread));
  } while (std::ranges::find(known, taken.back()) != known.end());
  known.push_back(taken.back());
  for (void* const piece : taken) blas_memory_free(piece);
}

}  // namespace

namespace {

/// c = alpha op(A) B + beta c.
void multiply(const char* transpose, double alpha, const Eigen::Ref<const Matrix>& a, const Eigen::Ref<const Matrix>& b, double beta,
              Matrix& c) {
  [[maybe_unused]] const bool transposed = *transpose == 'T';
  assert((transposed ? a.cols() : a.rows()) == c.rows() && (transposed ? a.rows() : a.cols()) == b.rows() && b.cols() == c.cols());
  if (c.size() == 0 || b.rows() == 0) return;
  prepare_blas();
  const int m = static_cast<int>(c.rows()), n = static_cast<int>(c.cols()), k = static_cast<int>(b.rows()),
            stride_a = static_cast<int>(a.outerStride()), stride_b = static_cast<int>(b.outerStride());
  dgemm_(transpose, "N", &m, &n, &k, &alpha, a.data(), &stride_a, b.data(), &stride_b, &beta, c.data(), &m);
}

struct BlasUsers {
  std::mutex mutex;
  int count = 0, threads = 1;
};
BlasUsers& blas_users() {
  static BlasUsers users;
  return users;
}

}  // namespace

void add_product(double factor, const Eigen::Ref<const Matrix>& a, const Eigen::Ref<const Matrix>& b, Matrix& y) {
  multiply("N", factor, a, b, 1, y);
}

Matrix transposed_product(const Eigen::Ref<const Matrix>& a, const Eigen::Ref<const Matrix>& b) {
  Matrix product = Matrix::Zero(a.cols(), b.cols());
  multiply("T", 1, a, b, 0, product);
  return product;
}

std::string_view blas_kernels() {
  return openblas_get_corename();
}

SingleThreadBlas::SingleThreadBlas() {
  BlasUsers& users = blas_users();
  const std::lock_guard lock(users.mutex);
  if (users.count++ == 0) users.threads = openblas_get_num_threads();
  openblas_set_num_threads(1);
}

SingleThreadBlas::~SingleThreadBlas() {
  BlasUsers& users = blas_users();
  const std::lock_guard lock(users.mutex);
  if (--users.count == 0) openblas_set_num_threads(users.threads);
}

void prepare_blas() {
  thread_local bool ready = false;
  if (ready) return;
  static std::mutex one_at_a_time;
  static std::vector<void*> known;  // as many as threads have been here
  const std::lock_guard lock(one_at_a_time);
  openblas_set_num_threads(1);
  add_work_space(known);
  ready = true;
}

void use_one_thread_after_fork() {
  using SetLevels = void (*)(int);
  if (const auto set_levels = reinterpret_cast<SetLevels>(::dlsym(RTLD_DEFAULT, "omp_set_max_active_levels"))) set_levels(0);
}

}  // namespace uplift
