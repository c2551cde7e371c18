/// The number of threads that OpenBLAS starts before main(); 0: it asks the environment and the system. Absent from other BLAS libraries.
extern "C" [[gnu::weak]] int blas_num_threads;

namespace {

/// OpenBLAS starts its threads before main(): they wait by spinning, and where the system refuses them memory they try for ever, also at
/// the end of the program. openblas_set_num_threads() comes too late for them. Linked statically, the constructor of OpenBLAS comes after
/// this.
[[gnu::constructor(101)]] void start_no_threads() {
  if (&blas_num_threads != nullptr) blas_num_threads = 1;
}

}  // namespace
