#include "uplift/cli/blas_kernels.h"

#include <sys/auxv.h>
#include <unistd.h>

#include <array>
#include <cstdlib>

#include "uplift/linear/blas.h"

namespace uplift::cli {

namespace {

constexpr const char* kernel_choice = "OPENBLAS_CORETYPE";

/// Null: the kernels that OpenBLAS has chosen are as good as any, or there are none for this kind of processor.
const char* better_kernels() {
#ifdef __x86_64__
  if (blas_kernels() != "Prescott") return nullptr;  // what it takes for processors that it does not know
  __builtin_cpu_init();
  if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512bw") &&
      __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl"))
    return "SkylakeX";
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) return "Haswell";
#endif
  return nullptr;
}

/// Not as the argument of the dynamic loader, which would be started in place of the program.
bool started_by_its_name() {
  return getauxval(AT_BASE) != 0;
}

}  // namespace

void choose_blas_kernels(char** words) {
  if (std::getenv(kernel_choice) != nullptr || !started_by_its_name()) return;
  const char* kernels = better_kernels();
  if (kernels == nullptr) return;
  std::array<char, 4096> file{};  // its real name: with that of the link the process would be called "exe"
  if (readlink("/proc/self/exe", file.data(), file.size() - 1) <= 0) return;
  setenv(kernel_choice, kernels, 1);  // no other thread runs here
  execv(file.data(), words);
  unsetenv(kernel_choice);  // the file is gone: slower, and otherwise the same
}

}  // namespace uplift::cli
