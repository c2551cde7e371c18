#include "uplift/motion/formats/convert.h"

#include <fmt/format.h>

#include <cassert>
#include <cmath>
#include <numbers>

namespace uplift {

namespace {

/// Slopes at the points of the cubic spline through equally spaced values: m[i-1] + 4 m[i] + m[i+1] = 3 (y[i+1] - y[i-1])/h (continuous
/// second derivative). First and last piece are parabolas, m[0] + m[1] = 2 (y[1] - y[0])/h, or the spline starts with slope zero.
std::vector<double> spline_slopes(const std::vector<double>& y, double h, bool flat_start) {
  const std::size_t n = y.size();
  if (n == 2 && !flat_start) return {(y[1] - y[0]) / h, (y[1] - y[0]) / h};
  std::vector<double> above(n), m(n);  // Thomas: m[i] = m[i] - above[i] m[i+1]
  above[0] = flat_start ? 0 : 1;
  m[0] = flat_start ? 0 : 2 * (y[1] - y[0]) / h;
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const double pivot = 4 - above[i - 1];
    above[i] = 1 / pivot;
    m[i] = (3 * (y[i + 1] - y[i - 1]) / h - m[i - 1]) / pivot;
  }
  m[n - 1] = (2 * (y[n - 1] - y[n - 2]) / h - m[n - 2]) / (1 - above[n - 2]);
  for (std::size_t i = n - 1; i-- > 0;) m[i] -= above[i] * m[i + 1];
  return m;
}

/// Second derivatives at the points of that spline.
std::vector<double> spline_curvatures(const std::vector<double>& y, const std::vector<double>& slope, double h) {
  const std::size_t n = y.size();
  std::vector<double> curvature(n);
  for (std::size_t i = 0; i + 1 < n; ++i) curvature[i] = (6 * (y[i + 1] - y[i]) / h - 4 * slope[i] - 2 * slope[i + 1]) / h;
  curvature[n - 1] = (-6 * (y[n - 1] - y[n - 2]) / h + 2 * slope[n - 2] + 4 * slope[n - 1]) / h;
  return curvature;
}

std::vector<double> spline_integral(const std::vector<double>& y, const std::vector<double>& slope, double h) {
  std::vector<double> sum(y.size());
  for (std::size_t i = 1; i < y.size(); ++i) sum[i] = sum[i - 1] + h * (y[i - 1] + y[i]) / 2 + h * h * (slope[i - 1] - slope[i]) / 12;
  return sum;
}

std::vector<double> values_as(const Motion& motion, MotionKind kind) {
  const std::vector<double>& y = motion.values;
  if (motion.kind == MotionKind::acceleration) {
    Integrals integrals = integrals_of(y, motion.step);
    return kind == MotionKind::velocity ? std::move(integrals.velocity) : std::move(integrals.displacement);
  }
  const std::vector<double> slope = spline_slopes(y, motion.step, motion.kind == MotionKind::displacement);
  if (motion.kind == MotionKind::velocity) return kind == MotionKind::acceleration ? slope : spline_integral(y, slope, motion.step);
  return kind == MotionKind::velocity ? slope : spline_curvatures(y, slope, motion.step);
}

}  // namespace

Integrals integrals_of(std::span<const double> a, double h) {
  Integrals sums{std::vector<double>(a.size()), std::vector<double>(a.size())};
  std::vector<double>&v = sums.velocity, &u = sums.displacement;
  for (std::size_t i = 1; i < a.size(); ++i) {
    v[i] = v[i - 1] + h * (a[i - 1] + a[i]) / 2;
    u[i] = u[i - 1] + h * v[i - 1] + h * h * (2 * a[i - 1] + a[i]) / 6;
  }
  return sums;
}

double spline_slope_share(double cycles) {
  const double x = 2 * std::numbers::pi * cycles;
  return x == 0 ? 1 : 3 * std::sin(x) / (x * (2 + std::cos(x)));
}

Motion converted(Motion motion, MotionKind kind) {
  if (motion.kind == kind) return motion;
  assert(motion.values.size() >= 2 && motion.step > 0);
  motion.values = values_as(motion, kind);
  const char* how = motion.kind == MotionKind::acceleration ? "integrated exactly from rest" : "by a cubic spline through the points";
  motion.processing.push_back(fmt::format("From {} to {}, {}.", to_string(motion.kind), to_string(kind), how));
  motion.kind = kind;
  return motion;
}

}  // namespace uplift
