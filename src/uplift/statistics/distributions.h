#pragma once
#include <optional>
#include <variant>

namespace uplift {

/// An interval; an end without a value is unbounded (the data do not limit it).
struct ConfidenceInterval {
  std::optional<double> lower, upper;
};

/// Density exp(-x^2/2)/sqrt(2 pi) of the standard normal distribution; relative error 1e-14 wherever it is a normal number.
double normal_density(double x);
/// P(X <= x) of the standard normal distribution, by the complementary error function; relative error 1e-14 in the lower tail too.
double normal_cdf(double x);
/// P(X > z) of the standard normal distribution, also where it underflows.
struct NormalTail {
  double log_probability;  // ln P(X > z)
  double hazard;           // density(z)/P(X > z)
  double excess;           // hazard - z > 0, without cancellation for large z
};
NormalTail normal_tail(double z);
/// The x with P(X <= x) = p for 0 <= p <= 1 (infinite at the ends): Abramowitz & Stegun 26.2.23, improved by three steps of Halley's
/// method.
double normal_quantile(double p);

/// Regularised incomplete beta function I_x(a, b), a, b > 0, 0 <= x <= 1: continued fraction by Lentz's method
/// (Abramowitz & Stegun 26.5.8; Press et al., Numerical Recipes, section 6.4).
double incomplete_beta(double a, double b, double x);
/// The x with I_x(a, b) = p, by bisection and Newton's method.
double incomplete_beta_inverse(double a, double b, double p);
/// The t >= 0 with P(|T| <= t) = level for Student's distribution with `freedom` > 0 degrees of freedom; 0 < level < 1.
double student_two_sided(double level, double freedom);

/// The smallest k with P(K <= k) >= u for K binomial of n trials with probability p; 0 <= p <= 1, 0 < u < 1.
long binomial_quantile(long n, double p, double u);

struct Normal {
  double mean, deviation;  // deviation > 0
};
/// ln X is normal with the mean ln(median) and the standard deviation beta.
struct Lognormal {
  double median, beta;  // both > 0
};
struct Uniform {
  double low, high;  // low < high
};
using Distribution = std::variant<Normal, Lognormal, Uniform>;

/// The value that is exceeded with probability 1 - p; 0 < p < 1.
double quantile(const Distribution&, double p);
/// P(X <= x).
double cdf(const Distribution&, double x);

}  // namespace uplift
