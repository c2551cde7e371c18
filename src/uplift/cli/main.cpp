#include "uplift/cli/blas_kernels.h"
#include "uplift/cli/commands.h"

int main(int count, char** words) {
  uplift::cli::choose_blas_kernels(words);
  return uplift::cli::program(count, words, "uplift");
}
