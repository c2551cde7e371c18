/// The number of threads that OpenBLAS starts before main(); 0: it asks the environment and the system. Absent from other BLAS libraries.
extern "C" [[gnu::weak]] int blas_num_threads;

namespace {

/// OpenBLAS starts its threads before main(): they wait by spinning, and where the system refuses them memory they try for ever, also at
/// the end of the program. openblas_set_num_threads() comes too late for them.
[[gnu::no_sanitize_address]] void start_no_threads() {
  if (&blas_num_threads != nullptr) blas_num_threads = 1;
}

/// Functions in this section of a program are called before the constructors of all libraries, shared ones too.
[[gnu::section(".preinit_array"), gnu::used]] void (*const before_the_libraries)() = start_no_threads;

}  // namespace
