#include "uplift/linear/blas.h"

#include <sys/mman.h>

#include <cstddef>
#include <cstdlib>
#include <new>

extern "C" void openblas_set_num_threads(int count);
extern "C" void dpotrf_(const char* triangle, const int* n, double* a, const int* stride, int* info);

namespace uplift {

namespace {

/// OpenBLAS starts its threads before main(), and they wait by spinning. Linked statically, its constructor comes after this one.
[[gnu::constructor(101)]] void start_no_threads() {
  setenv("OPENBLAS_NUM_THREADS", "1", 0);
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
