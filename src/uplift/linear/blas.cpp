#include "uplift/linear/blas.h"

#include <sys/mman.h>

#include <cstddef>
#include <new>

extern "C" void openblas_set_num_threads(int count);
/// The number of threads that OpenBLAS starts before main(); 0: it asks the environment and the system. Null in a shared OpenBLAS.
extern "C" [[gnu::weak]] int blas_num_threads;
extern "C" void dpotrf_(const char* triangle, const int* n, double* a, const int* stride, int* info);

namespace uplift {

namespace {

/// OpenBLAS starts its threads before main(): they wait by spinning, and where the system refuses them memory they try for ever, also at
/// the end of the program. openblas_set_num_threads() comes too late for them. Linked statically, the constructor of OpenBLAS comes after
/// this.
[[gnu::constructor(101)]] void start_no_threads() {
  if (&blas_num_threads != nullptr) blas_num_threads = 1;
}

bool take_work_space() {
  constexpr std::size_t size = std::size_t{32} << 22;  // bytes: BUFFER_SIZE of OpenBLAS on x86-64, the largest of its targets
  void* const trial = mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (trial == MAP_FAILED) throw std::bad_alloc();
  munmap(trial, size);
  openblas_set_num_threads(1);
  double one = 1;
  const int n = 1;
  int info = 0;
  dpotrf_("U", &n, &one, &n, &info);
  return info == 0;
}

}  // namespace

void prepare_blas() {
  static const bool ready = take_work_space();
  static_cast<void>(ready);
}

}  // namespace uplift
