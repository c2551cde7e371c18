#pragma once

namespace uplift::cli {

/// OpenBLAS chooses its kernels when it is loaded, by the model number of the processor. For a processor that is newer than the library it
/// takes those of 2004, with registers of two numbers, which multiply matrices at a quarter of the speed. In that case the program is
/// started once more, in the same process, with the kernels that suit the instructions of the processor; then this function does not
/// return. A choice that the user has made (OPENBLAS_CORETYPE) is kept. To be called first in main().
void choose_blas_kernels(char** words);

}  // namespace uplift::cli
