#pragma once
#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

// What memory there is, so that a factor is refused before it is made, not killed while it is.
namespace uplift {

/// Memory that this process can still take [bytes]: the least of what the system has available (MemAvailable), what every control group
/// above the process leaves (versions 2 and 1; file cache that can be dropped counts as free) and what is left of the limit on its address
/// space. Infinite where nothing is known. `root` stands before the paths of the system's files: for tests.
double available_memory(const std::string& root = "");

/// How many runs can be computed at the same time, at most `wanted`, at least 1: each takes the work space of BLAS (linear/blas.h), a heap
/// of its own and some more, 500 MB together.
int runs_side_by_side(int wanted);

/// Real memory that this process holds now [bytes]; 0 where the system does not tell.
double resident_memory(const std::string& root = "");

/// For a whole program, before it allocates much: the heap grows by 2 MB at a time, and blocks of 4 MB and more are not part of it, so that
/// they go back to the system when they are freed. Where the C library can.
void prepare_heap();

/// Hands pages of the heap that nobody uses back to the system, where the C library can: after an analysis, before what it was made for.
void give_back_free_memory();

/// Asks the system to map, at once, the pages of a block that is filled step by step: faulting them in one by one costs a fifth of a short
/// step. The contents stay as they are.
void provide_pages(const void* begin, std::size_t bytes);

/// At most this much of what a stage records is mapped before its first step [bytes], half of it of the table: a run may end early.
inline constexpr std::size_t most_provided = 64 << 20;

/// What a vector has reserved, at most so many bytes of it.
template <class T>
void provide_pages(const std::vector<T>& reserved, std::size_t most) {
  provide_pages(reserved.data() + reserved.size(), std::min(most, (reserved.capacity() - reserved.size()) * sizeof(T)));
}

/// Why a factor that takes `needed` bytes is not made when `available` are left; empty when it fits.
std::string memory_refusal(double needed, double available);

}  // namespace uplift
