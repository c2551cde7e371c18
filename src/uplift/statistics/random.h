#pragma once
#include <array>
#include <cstdint>

namespace uplift {

/// Philox4x32-10: 128 random bits as a function of a counter and a key, without a state. Source: Salmon, Moraes, Dror & Shaw, Parallel
/// random numbers: as easy as 1, 2, 3, SC11 (2011).
std::array<std::uint32_t, 4> philox(std::array<std::uint32_t, 4> counter, std::array<std::uint32_t, 2> key);

/// Random numbers that are functions of (seed, stream, sample, variable): the same number in any order and with any number of workers.
class CounterRandom {
 public:
  /// Streams of one seed are independent of each other: one for each purpose.
  explicit CounterRandom(std::uint64_t seed, std::uint32_t stream = 0) : seed_(seed), stream_(stream) {}
  /// 64 random bits.
  std::uint64_t bits(std::uint64_t sample, std::uint32_t variable) const;
  /// Uniform in the open interval (0, 1), a multiple of 2^-53.
  double uniform(std::uint64_t sample, std::uint32_t variable) const;
  /// Standard normal, by the quantile of `uniform`.
  double normal(std::uint64_t sample, std::uint32_t variable) const;

 private:
  std::uint64_t seed_;
  std::uint32_t stream_;
};

}  // namespace uplift
