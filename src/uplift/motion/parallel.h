#pragma once
#include <functional>

namespace uplift {

/// Calls work(0) ... work(count - 1), each once, in as many threads (0: one per core), in no order; the work writes to places of its own.
/// The first exception of the work ends it and is thrown here.
void in_parallel(int count, int threads, const std::function<void(int)>& work);

}  // namespace uplift
