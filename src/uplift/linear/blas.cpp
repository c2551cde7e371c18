#include "uplift/linear/blas.h"

#include <sys/mman.h>

#include <algorithm>
#include <cstddef>
#include <mutex>
#include <new>
#include <vector>

extern "C" void openblas_set_num_threads(int count);
/// The number of threads that OpenBLAS starts before main(); 0: it asks the environment and the system. Null in a shared OpenBLAS.
extern "C" [[gnu::weak]] int blas_num_threads;
extern "C" void* blas_memory_alloc(int purpose);
extern "C" void blas_memory_free(void* piece);

namespace uplift {

namespace {

/// OpenBLAS starts its threads before main(): they wait by spinning, and where the system refuses them memory they try for ever, also at
/// the end of the program. openblas_set_num_threads() comes too late for them. Linked statically, the constructor of OpenBLAS comes after
/// this.
[[gnu::constructor(101)]] void start_no_threads() {
  if (&blas_num_threads != nullptr) blas_num_threads = 1;
}

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

}  // namespace uplift
