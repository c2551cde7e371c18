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

/// 10^e, built once. In long double: with a plain double a scaled value of fifteen digits would already be a unit off.
const std::array<long double, 2 * power_limit + 1>& powers() {
  static const auto table = [] {
    std::array<long double, 2 * power_limit + 1> made{};
    for (int e = -power_limit; e <= power_limit; ++e) made[static_cast<std::size_t>(e + power_limit)] = std::pow(10.0L, e);
    return made;
  }();
  return table;
}

constexpr std::array<std::uint64_t, 17> whole_powers = [] {
  std::array<std::uint64_t, 17> made{};
  std::uint64_t value = 1;
  for (auto& each : made) {
    each = value;
    value *= 10;
  }
  return made;
}();

/// "00", "01", ... "99"
constexpr std::array<char, 200> pairs = [] {
  std::array<char, 200> made{};
  for (std::size_t i = 0; i < 100; ++i) {
    made[2 * i] = static_cast<char>('0' + i / 10);
    made[2 * i + 1] = static_cast<char>('0' + i % 10);
  }
  return made;
}();

struct Decimal {
  char figures[20];  // without trailing zeros
  int kept = 0;      // how many
  int exponent = 0;  // value = d.ddd... * 10^exponent
};

/// size = mantissa * 10^(exponent - digits + 1) with 10^(digits - 1) <= mantissa < 10^digits, size > 0 and not tiny.
Decimal decimal(double size, int digits) {
  Decimal made;
  int binary;
  std::frexp(size, &binary);
  made.exponent = static_cast<int>(std::floor((binary - 1) * 0.30102999566398120));
  const auto scaled = [&] {
    return static_cast<std::uint64_t>(size * powers()[static_cast<std::size_t>(digits - 1 - made.exponent + power_limit)] + 0.5L);
  };
  const std::uint64_t limit = whole_powers[static_cast<std::size_t>(digits)];
  std::uint64_t mantissa = scaled();
  if (mantissa >= limit) {  // the estimate of the exponent is at most one too small
    ++made.exponent;
    mantissa = scaled();
    if (mantissa >= limit) {
      ++made.exponent;
      mantissa /= 10;
    }
  }
  int at = digits;
  for (; at >= 2; at -= 2) {
    std::memcpy(made.figures + at - 2, pairs.data() + 2 * (mantissa % 100), 2);
    mantissa /= 100;
  }
  if (at == 1) made.figures[0] = static_cast<char>('0' + mantissa);
  made.kept = digits;
  while (made.kept > 1 && made.figures[made.kept - 1] == '0') --made.kept;
  return made;
}

char* copy(char* out, const char* from, int count) {
  std::memcpy(out, from, static_cast<std::size_t>(count));
  return out + count;
}

}  // namespace

char* write_number(char* out, double value, int digits) {
  assert(std::isfinite(value) && digits >= 1 && digits <= 15);
  const double size = std::abs(value);
  if (size < 1e-300) {
    if (size > 0) return std::to_chars(out, out + number_room, value).ptr;
    *out++ = '0';
    return out;
  }
  if (value < 0) *out++ = '-';
  const Decimal number = decimal(size, digits);
  const int kept = number.kept, exponent = number.exponent;
  if (exponent >= 0 && exponent < digits) {
    const int whole = exponent + 1;
    if (kept <= whole) {
      out = copy(out, number.figures, kept);
      for (int i = kept; i < whole; ++i) *out++ = '0';
      return out;
    }
    out = copy(out, number.figures, whole);
    *out++ = '.';
    return copy(out, number.figures + whole, kept - whole);
  }
  if (exponent < 0 && exponent >= -5) {
    out = copy(out, "0.0000", 1 - exponent);
    return copy(out, number.figures, kept);
  }
  *out++ = number.figures[0];
  if (kept > 1) {
    *out++ = '.';
    out = copy(out, number.figures + 1, kept - 1);
  }
  *out++ = 'e';
  return std::to_chars(out, out + 8, exponent).ptr;
}

void append_number(std::string& text, double value, int digits) {
  char out[number_room];
  text.append(out, write_number(out, value, digits));
}

void append_exact(std::string& text, double value) {
  assert(std::isfinite(value));
  char out[40];
  text.append(out, std::to_chars(out, out + sizeof out, value).ptr);
}

}  // namespace uplift
