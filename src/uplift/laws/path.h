#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "uplift/math/lanes.h"

// Averages along the straight path of one opening, without cancellation: a piecewise linear function f is integrated piece by piece,
//     1/(to - from) * integral of f = sum over pieces of share * f(middle)
//     d/d to of it                  = sum over pieces of share * lever * f'(piece)      [= 1/(to - from)^2 * integral of (x - from) f'(x)]
// where share is the piece's part of the length and lever the mean of (x - from)/(to - from) over it. Places are measured from `from`, so
// that both factors are good to round-off however small the step is.
namespace uplift {

/// A path shorter than this [m] counts as the point `to`: averages are values, and d/d to is half the slope.
constexpr double shortest_path = 1e-200;

/// Marks of up to 64 points, as wide as their numbers.
struct Marks {
  alignas(64) std::int64_t of[64];

  /// Calls part(first, count) for every group of `lanes` points in which one is marked.
  template <class Part>
  void for_groups(int points, const Part& part) {
    for (int i = points; i % lanes != 0; ++i) of[i] = 0;
    for (int first = 0; first < points; first += lanes) {
      std::int64_t any = 0;
#pragma omp simd reduction(| : any)
      for (int i = 0; i < lanes; ++i) any |= of[first + i];
      if (any != 0) part(first, points - first < lanes ? points - first : lanes);
    }
  }
};

/// The part of a path that lies on one piece of the axis.
struct Piece {
  double share;   // of the path's length, 0 to 1
  double middle;  // m
  double lever;   // 0 to 1
};

/// The path of one opening from -> to [m], for laws that are written point by point.
class Path {
 public:
  Path(double from, double to) : from_(from), to_(to), low_(smaller(to - from, 0)), high_(larger(to - from, 0)) {}

  bool moves() const { return high_ - low_ > shortest_path; }
  double length() const { return high_ - low_; }
  double from() const { return from_; }
  double to() const { return to_; }

  Piece within(double least, double most) const { return part(least, most); }
  Piece below(double most) const { return part(-HUGE_VAL, most); }
  Piece above(double least) const { return part(least, HUGE_VAL); }

 private:
  Piece part(double least, double most) const {
    if (!moves()) return {least <= to_ && to_ < most ? 1.0 : 0.0, to_, 0.5};
    const double a = smaller(larger(low_, least - from_), most - from_), b = smaller(larger(high_, least - from_), most - from_);
    return {(b - a) / length(), from_ + 0.5 * (a + b), 0.5 * std::abs(a + b) / length()};
  }
  double from_, to_, low_, high_;
};

}  // namespace uplift
