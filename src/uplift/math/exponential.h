#pragma once
#include <algorithm>
#include <bit>
#include <cstdint>

// Exponential functions without a branch and without a call, so that a loop over points becomes vector code (the C library's functions do
// not).
namespace uplift {

/// exp(x) - 1 and exp(x), both to about 1 ulp; x is held within +-708, where exp(x) neither underflows nor overflows.
struct Exponential {
  double value;      // exp(x)
  double minus_one;  // exp(x) - 1, without cancellation near x = 0
};

/// x = n ln 2 + r with |r| <= ln 2 / 2 (Cody & Waite: ln 2 in two parts, n times the first one is exact); exp(r) - 1 by its Taylor
/// polynomial of degree 13, whose remainder is below 1e-17 of r; 2^n by its bits.
inline Exponential exponential(double x) {
  constexpr double round_to_integer = 0x1.8p52, log2_e = 0x1.71547652b82fep0;
  constexpr double ln2_high = 0x1.62e42feep-1, ln2_low = 0x1.a39ef35793c76p-33;
  x = std::min(std::max(x, -708.0), 708.0);
  const double shifted = x * log2_e + round_to_integer;
  const double n = shifted - round_to_integer;
  const double r = (x - n * ln2_high) - n * ln2_low;
  double sum = 1.0 / 6227020800.0;
  sum = sum * r + 1.0 / 479001600.0;
  sum = sum * r + 1.0 / 39916800.0;
  sum = sum * r + 1.0 / 3628800.0;
  sum = sum * r + 1.0 / 362880.0;
  sum = sum * r + 1.0 / 40320.0;
  sum = sum * r + 1.0 / 5040.0;
  sum = sum * r + 1.0 / 720.0;
  sum = sum * r + 1.0 / 120.0;
  sum = sum * r + 1.0 / 24.0;
  sum = sum * r + 1.0 / 6.0;
  sum = sum * r + 0.5;
  const double p = r + (r * r) * sum;
  const std::uint64_t bits = (std::bit_cast<std::uint64_t>(shifted) << 52) + 0x3ff0000000000000ULL;
  const double power = std::bit_cast<double>(bits);
  return {power * p + power, power * p + (power - 1.0)};
}

}  // namespace uplift
