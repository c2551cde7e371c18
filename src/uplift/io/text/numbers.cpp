#include "uplift/io/text/numbers.h"

#include <algorithm>
#include <array>
#include <bit>
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

constexpr std::array<std::int64_t, 17> whole_powers = [] {
  std::array<std::int64_t, 17> made{};
  std::int64_t value = 1;
  for (auto& each : made) {
    each = value;
    value *= 10;
  }
  return made;
}();

/// The eight digits of a number below 10^8 as eight bytes, the first digit in the lowest: halves, quarters and single digits side by side.
inline std::uint64_t eight_digits(std::uint64_t number) {
  std::uint64_t fours = number / 10000 | (number % 10000) << 32;
  const std::uint64_t hundreds = ((fours * 10486) >> 20) & 0x0000007f0000007f;
  std::uint64_t twos = hundreds | (fours - 100 * hundreds) << 16;
  const std::uint64_t tens = ((twos * 103) >> 10) & 0x000f000f000f000f;
  return tens | (twos - 10 * tens) << 8;
}

constexpr int figures = 16;
constexpr std::uint64_t zeros = 0x3030303030303030;  // "00000000"

struct Decimal {
  char text[2 * figures];  // 16 figures, and room to copy 16 from any of them
  int kept = 0;            // figures before the zeros at the end
  int exponent = 0;        // value = d.ddd... * 10^exponent
};

/// size > 0 and not tiny, rounded to so many digits. Without a branch that depends on the number.
inline Decimal decimal(double size, int digits) {
  static_assert(std::endian::native == std::endian::little);
  Decimal made;
  const int binary = static_cast<int>(std::bit_cast<std::uint64_t>(size) >> 52) - 1023;
  const auto power = [](int e) { return powers()[static_cast<std::size_t>(e + power_limit)]; };
  made.exponent = (binary * 315653) >> 20;  // log10(2) * 2^20: right or one too small
  made.exponent += size >= power(made.exponent + 1);
  auto mantissa = static_cast<std::int64_t>(size * power(digits - 1 - made.exponent) + 0.5L);
  if (mantissa >= whole_powers[static_cast<std::size_t>(digits)]) {  // 9.99... was rounded up
    ++made.exponent;
    mantissa /= 10;
  }
  const auto filled = [&](int count) {
    return static_cast<std::uint64_t>(mantissa * whole_powers[static_cast<std::size_t>(count - digits)]);
  };
  std::uint64_t first, last = 0;
  if (digits <= figures / 2) {
    first = eight_digits(filled(figures / 2));
  } else {
    const std::uint64_t all = filled(figures);
    first = eight_digits(all / 100'000'000), last = eight_digits(all % 100'000'000);
  }
  made.kept = last != 0 ? figures - std::countl_zero(last) / 8 : figures / 2 - std::countl_zero(first) / 8;
  for (int part = 0; const std::uint64_t bytes : {first | zeros, last | zeros, zeros, zeros})
    std::memcpy(made.text + 8 * part++, &bytes, sizeof bytes);
  return made;
}

/// Always as many figures as there can be: one move.
void copy(char* out, const char* from) {
  std::memcpy(out, from, figures);
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
  *out = '-';
  out += value < 0;
  const Decimal number = decimal(size, digits);
  const int kept = number.kept, exponent = number.exponent;
  if (exponent >= 0 && exponent < digits) {
    const int whole = exponent + 1;
    copy(out, number.text);
    if (kept <= whole) return out + whole;
    out[whole] = '.';
    copy(out + whole + 1, number.text + whole);
    return out + kept + 1;
  }
  if (exponent < 0 && exponent >= -5) {
    std::memcpy(out, "0.000000", 8);
    copy(out + 1 - exponent, number.text);
    return out + 1 - exponent + kept;
  }
  out[0] = number.text[0];
  out[1] = '.';
  copy(out + 2, number.text + 1);
  out += kept > 1 ? kept + 1 : 1;
  *out++ = 'e';
  return std::to_chars(out, out + 8, exponent).ptr;
}

void append_number(std::string& text, double value, int digits) {
  char out[number_room];
  text.append(out, write_number(out, value, digits));
}

void append_numbers(std::string& text, std::span<const double> values, int digits) {
  std::array<char, 64 * number_room> some;
  char* out = some.data();
  for (const double value : values) {
    if (out > some.data() + some.size() - 2 * number_room) {
      text.append(some.data(), out);
      out = some.data();
    }
    out = std::isfinite(value) ? write_number(out, value, digits) : std::copy_n("null", 4, out);
    *out++ = ',';
  }
  text.append(some.data(), values.empty() ? out : out - 1);
}

std::string csv_cell(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == text.npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + "\"";
}

void append_exact(std::string& text, double value) {
  assert(std::isfinite(value));
  char out[40];
  text.append(out, std::to_chars(out, out + sizeof out, value).ptr);
}

}  // namespace uplift
