#pragma once
#include <cstddef>
#include <string>

// What memory there is, so that a factor is refused before it is made, not killed while it is.
namespace uplift {

/// Memory that this process can still take [bytes]: the least of what the system has available (MemAvailable), what every control group
/// above the process leaves (versions 2 and 1; file cache that can be dropped counts as free) and what is left of the limit on its address
/// space. Infinite where nothing is known. `root` stands before the paths of the system's files: for tests.
double available_memory(const std::string& root = "");

/// Real memory that this process holds now [bytes]; 0 where the system does not tell.
double resident_memory(const std::string& root = "");

/// Hands pages of the heap that nobody uses back to the system, where the C library can: after an analysis, before what it was made for.
void give_back_free_memory();

/// Lets the system give real pages to memory that will be written soon, all at once: one after another, when they are first written, costs
/// twice as much, and as much as two steps of a small model each. The first 2 MB at most, and nothing where the system cannot.
void take_pages(void* begin, std::size_t bytes);

/// Why a factor that takes `needed` bytes is not made when `available` are left; empty when it fits.
std::string memory_refusal(double needed, double available);

}  // namespace uplift
