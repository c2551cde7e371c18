#include "uplift/io/numbers.h"

#include <array>
#include <cassert>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>

namespace uplift {
namespace {

constexpr int power_limit = 340;

/// 10^e as long double. Built once; exact up to 10^27, then within a few units of 1e-19.
const std::array<long double, 2 * power_limit + 1>& powers() {
  static const auto table = [] {
    std::array<long double, 2 * power_limit + 1> made{};
    for (int e = -power_limit; e <= power_limit; ++e) made[static_cast<std::size_t>(e + power_limit)] = std::pow(10.0L, e);
    return made;
  }();
  return table;
}

long double power(int e) { return powers()[static_cast<std::size_t>(e + power_limit)]; }

constexpr std::array<std::uint64_t, 17> whole_powers = [] {
  std::array<std::uint64_t, 17> made{};
  std::uint64_t value = 1;
  for (auto& each : made) {
    each = value;
    value *= 10;
  }
  return made;
}();

}  // namespace

void append_number(std::string& text, double value, int digits) {
  assert(std::isfinite(value) && digits >= 1 && digits <= 15);
  char out[32];
  char* at = out;
  if (std::signbit(value)) *at++ = '-';
  const double size = std::abs(value);
  if (size == 0) {
    text += '0';
    return;
  }
  if (size < 1e-300) return append_exact(text, value);
  // size = mantissa * 10^(exponent - digits + 1), 10^(digits - 1) <= mantissa < 10^digits
  int binary;
  std::frexp(size, &binary);
  int exponent = static_cast<int>(std::floor((binary - 1) * 0.30102999566398120));
  const std::uint64_t limit = whole_powers[static_cast<std::size_t>(digits)];
  std::uint64_t mantissa = static_cast<std::uint64_t>(size * power(digits - 1 - exponent) + 0.5L);
  if (mantissa >= limit) {  // the estimate of the exponent is at most one too small
    ++exponent;
    mantissa = static_cast<std::uint64_t>(size * power(digits - 1 - exponent) + 0.5L);
    if (mantissa >= limit) {
      ++exponent;
      mantissa /= 10;
    }
  }
  int kept = digits;
  while (mantissa % 10 == 0) {
    mantissa /= 10;
    --kept;
  }
  char figures[20];
  for (int i = kept - 1; i >= 0; --i) {
    figures[i] = static_cast<char>('0' + mantissa % 10);
    mantissa /= 10;
  }
  if (exponent >= 0 && exponent < digits) {
    for (int i = 0; i <= exponent || i < kept; ++i) {
      if (i == exponent + 1) *at++ = '.';
      *at++ = i < kept ? figures[i] : '0';
    }
  } else if (exponent < 0 && exponent >= -5) {
    *at++ = '0';
    *at++ = '.';
    for (int i = -1; i > exponent; --i) *at++ = '0';
    std::memcpy(at, figures, static_cast<std::size_t>(kept));
    at += kept;
  } else {
    *at++ = figures[0];
    if (kept > 1) {
      *at++ = '.';
      std::memcpy(at, figures + 1, static_cast<std::size_t>(kept - 1));
      at += kept - 1;
    }
    *at++ = 'e';
    at = std::to_chars(at, out + sizeof out, exponent).ptr;
  }
  text.append(out, static_cast<std::size_t>(at - out));
}

void append_exact(std::string& text, double value) {
  assert(std::isfinite(value));
  char out[40];
  text.append(out, std::to_chars(out, out + sizeof out, value).ptr);
}

}  // namespace uplift
