#include "uplift/statistics/distributions.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>

namespace uplift {

namespace {

constexpr double root_half_high = std::numbers::sqrt2 / 2, root_half_low = -0x1.bdd3413b26456p-55;  // sqrt(1/2) = high + low
constexpr double log_root_two_pi = 0.91893853320467274178;

template <class... Case>
struct Cases : Case... {
  using Case::operator()...;
};
template <class... Case>
Cases(Case...) -> Cases<Case...>;  // clang 16 does not deduce it

double log_beta(double a, double b) {
  return std::lgamma(a) + std::lgamma(b) - std::lgamma(a + b);
}

/// The continued fraction 26.5.8, which converges quickly for x < (a + 1)/(a + b + 2).
double beta_fraction(double a, double b, double x) {
  constexpr double tiny = 1e-300;
  const auto guarded = [](double value) { return std::abs(value) < tiny ? tiny : value; };
  double c = 1, d = 1 / guarded(1 - (a + b) * x / (a + 1)), sum = d;
  for (int m = 1; m <= 200000; ++m) {
    const double even = m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m));
    d = 1 / guarded(1 + even * d);
    c = guarded(1 + even / c);
    sum *= d * c;
    const double odd = -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1));
    d = 1 / guarded(1 + odd * d);
    c = guarded(1 + odd / c);
    const double factor = d * c;
    sum *= factor;
    if (std::abs(factor - 1) < 1e-15) break;
  }
  return sum;
}

}  // namespace

// x^2 and x/sqrt(2) are rounded: in the tail the error of the argument is multiplied by x^2, so the lost digits are put back.
double normal_density(double x) {
  const double square = x * x, lost = std::fma(x, x, -square);
  if (!(square < 1e6)) return 0;
  return std::exp(-square / 2) * (1 - lost / 2) * (std::numbers::inv_sqrtpi * root_half_high);
}

double normal_cdf(double x) {
  if (x > 40) return 1;
  if (x < -40) return 0;
  const double z = -x * root_half_high, lost = std::fma(-x, root_half_high, -z) - x * root_half_low;
  return (std::erfc(z) - 2 * std::numbers::inv_sqrtpi * std::exp(-z * z) * lost) / 2;
}

NormalTail normal_tail(double z) {
  if (z < 5) {
    const double tail = normal_cdf(-z), hazard = normal_density(z) / tail;
    return {std::log(tail), hazard, hazard - z};
  }
  double fraction = z;  // Mills' ratio 1/(z + 1/(z + 2/(z + ...)))
  for (int k = 30; k >= 2; --k) fraction = z + k / fraction;
  const double excess = 1 / fraction, hazard = z + excess;
  return {-z * z / 2 - log_root_two_pi - std::log(hazard), hazard, excess};
}

double normal_quantile(double p) {
  assert(p >= 0 && p <= 1);
  if (p > 0.5) return -normal_quantile(1 - p);
  if (p == 0) return -std::numeric_limits<double>::infinity();
  const double t = std::sqrt(-2 * std::log(p));
  double x = (2.515517 + t * (0.802853 + t * 0.010328)) / (1 + t * (1.432788 + t * (0.189269 + t * 0.001308))) - t;
  for (int step = 0; step < 3; ++step) {
    const double newton = (normal_cdf(x) - p) / std::max(normal_density(x), std::numeric_limits<double>::min());
    x -= newton / (1 + x * newton / 2);
  }
  return x;
}

double incomplete_beta(double a, double b, double x) {
  assert(a > 0 && b > 0 && x >= 0 && x <= 1);
  if (x == 0 || x == 1) return x;
  const double front = std::exp(a * std::log(x) + b * std::log1p(-x) - log_beta(a, b));
  return x < (a + 1) / (a + b + 2) ? front * beta_fraction(a, b, x) / a : 1 - front * beta_fraction(b, a, 1 - x) / b;
}

double incomplete_beta_inverse(double a, double b, double p) {
  assert(p >= 0 && p <= 1);
  if (p == 0 || p == 1) return p;
  const double scale = log_beta(a, b);
  double low = 0, high = 1, x = a / (a + b);
  for (int step = 0; step < 400 && low < high; ++step) {
    const double miss = incomplete_beta(a, b, x) - p;
    (miss < 0 ? low : high) = x;
    const double density = std::exp((a - 1) * std::log(x) + (b - 1) * std::log1p(-x) - scale);
    double next = x - miss / density;
    if (!(next > low && next < high)) next = (low + high) / 2;
    const bool done = std::abs(next - x) <= 1e-15 * x;
    x = next;
    if (done) break;
  }
  return x;
}

double student_two_sided(double level, double freedom) {
  assert(level > 0 && level < 1 && freedom > 0);
  const double x = incomplete_beta_inverse(freedom / 2, 0.5, 1 - level);
  return std::sqrt(freedom * (1 - x) / x);
}

long binomial_quantile(long n, double p, double u) {
  if (p <= 0 || p >= 1) return p <= 0 ? 0 : n;
  long below = -1, k = n;  // P(K <= below) < u <= P(K <= k)
  while (k - below > 1) {
    const long middle = below + (k - below) / 2;
    const double to_middle = incomplete_beta(static_cast<double>(n - middle), static_cast<double>(middle + 1), 1 - p);
    (to_middle < u ? below : k) = middle;
  }
  return k;
}

double quantile(const Distribution& distribution, double p) {
  return std::visit(Cases{[p](const Normal& d) { return d.mean + d.deviation * normal_quantile(p); },
                          [p](const Lognormal& d) { return d.median * std::exp(d.beta * normal_quantile(p)); },
                          [p](const Uniform& d) { return d.low + (d.high - d.low) * p; }},
                    distribution);
}

double cdf(const Distribution& distribution, double x) {
  return std::visit(Cases{[x](const Normal& d) { return normal_cdf((x - d.mean) / d.deviation); },
                          [x](const Lognormal& d) { return x > 0 ? normal_cdf(std::log(x / d.median) / d.beta) : 0.0; },
                          [x](const Uniform& d) { return std::clamp((x - d.low) / (d.high - d.low), 0.0, 1.0); }},
                    distribution);
}

}  // namespace uplift
