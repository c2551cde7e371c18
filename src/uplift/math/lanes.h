#pragma once
#include <cstddef>
#include <experimental/simd>

// One vector register of numbers, for loops over the points of an interface: 8 numbers with AVX-512, 4 with AVX2, 2 with SSE2. A fixed
// width would be emulated by calls where the registers are narrower. Sums over points are made of these: what compilers make of a loop
// with several sums ends in long chains of single additions.
namespace uplift {

using Lanes = std::experimental::native_simd<double>;
using LaneMask = Lanes::mask_type;
inline constexpr std::ptrdiff_t lanes = Lanes::size();

[[gnu::always_inline]] inline Lanes larger(Lanes a, Lanes b) {
  return std::experimental::max(a, b);
}
[[gnu::always_inline]] inline Lanes smaller(Lanes a, Lanes b) {
  return std::experimental::min(a, b);
}
[[gnu::always_inline]] inline Lanes absolute(Lanes a) {
  return std::experimental::abs(a);
}
/// a where the mask says so, else b.
[[gnu::always_inline]] inline Lanes choose(LaneMask mask, Lanes a, Lanes b) {
  std::experimental::where(mask, b) = a;
  return b;
}
[[gnu::always_inline]] inline bool any(LaneMask mask) {
  return std::experimental::any_of(mask);
}
[[gnu::always_inline]] inline double sum(Lanes a) {
  return std::experimental::reduce(a);
}
[[gnu::always_inline]] inline double largest(Lanes a) {
  return std::experimental::hmax(a);
}
[[gnu::always_inline]] inline double smallest(Lanes a) {
  return std::experimental::hmin(a);
}

// The same for one number, so that a formula can be written once for both.
[[gnu::always_inline]] inline double smaller(double a, double b) {
  return a < b ? a : b;
}
[[gnu::always_inline]] inline double larger(double a, double b) {
  return a > b ? a : b;
}
[[gnu::always_inline]] inline double absolute(double a) {
  return a < 0 ? -a : a;
}
[[gnu::always_inline]] inline double choose(bool mask, double a, double b) {
  return mask ? a : b;
}

/// The numbers of an array from `first` on that fill one register; they may be small integers of one byte.
struct WholeLanes {
  std::ptrdiff_t first;
  [[gnu::always_inline]] Lanes operator()(const double* x, double = 0) const { return {x + first, std::experimental::element_aligned}; }
  [[gnu::always_inline]] Lanes operator()(const char* x) const { return {x + first, std::experimental::element_aligned}; }
  [[gnu::always_inline]] void put(double* y, Lanes value) const { value.copy_to(y + first, std::experimental::element_aligned); }
  [[gnu::always_inline]] void put(char* y, Lanes value) const { value.copy_to(y + first, std::experimental::element_aligned); }
};

/// The last numbers, which do not fill a register: zeros follow them, or the value `beyond`.
struct LastLanes {
  std::ptrdiff_t first, count;
  template <class Number>
  [[gnu::always_inline]] Lanes operator()(const Number* x, double beyond = 0) const {
    alignas(64) double rest[lanes];
    for (std::ptrdiff_t k = 0; k < lanes; ++k) rest[k] = k < count ? x[first + k] : beyond;
    return {rest, std::experimental::vector_aligned};
  }
  template <class Number>
  [[gnu::always_inline]] void put(Number* y, Lanes value) const {
    for (std::ptrdiff_t k = 0; k < count; ++k) y[first + k] = static_cast<Number>(value[static_cast<std::size_t>(k)]);
  }
};

/// Calls work(at) for n points, one register of them after another: at(x) are their numbers in the array x (beyond the last point zeros, or
/// what at(x, beyond) says), at.put(y, value) writes them.
template <class Work>
[[gnu::always_inline]] inline void for_lanes(std::ptrdiff_t n, const Work& work) {
  std::ptrdiff_t i = 0;
  for (; i + lanes <= n; i += lanes) work(WholeLanes{i});
  if (i < n) work(LastLanes{i, n - i});
}

}  // namespace uplift
