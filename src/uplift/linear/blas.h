#pragma once

namespace uplift {

/// To be called before BLAS is: OpenBLAS maps 134 MB of address space as its work space in its first call, keeps it, and tries for ever
/// where the system refuses it. Here it takes it, or std::bad_alloc is thrown. One thread from then on: results do not depend on the number
/// of cores, and runs side by side do not fight for them.
void prepare_blas();

}  // namespace uplift
