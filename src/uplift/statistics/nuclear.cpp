#include "uplift/statistics/nuclear.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>

#include "uplift/statistics/distributions.h"

namespace uplift {

namespace {

/// P(X <= x) with a jump at 0 for a scatter of 0.
double lognormal_cdf(double log_ratio, double beta) {
  if (beta > 0) return normal_cdf(log_ratio / beta);
  return log_ratio >= 0 ? 1 : 0;
}

/// ln of P(low < X <= high) of the standard normal distribution, in the tails too; ends may be infinite.
double log_normal_between(double low, double high) {
  if (high < 0) return log_normal_between(-high, -low);
  if (low < 0) return std::log(normal_cdf(high) - normal_cdf(low));
  const double from_low = normal_tail(low).log_probability;
  return std::isinf(high) ? from_low : from_low + std::log1p(-std::exp(normal_tail(high).log_probability - from_low));
}

}  // namespace

double SeismicCapacity::beta_c() const {
  return std::hypot(beta_r, beta_u);
}
double SeismicCapacity::hclpf() const {
  return median * std::exp(-1.65 * (beta_r + beta_u));
}
double SeismicCapacity::hclpf_composite() const {
  return median * std::exp(-2.326 * beta_c());
}
double SeismicCapacity::probability(double a, double confidence) const {
  assert(a > 0 && confidence > 0 && confidence < 1);
  return lognormal_cdf(std::log(a / median) + beta_u * normal_quantile(confidence), beta_r);
}

OrRefused<SeismicCapacity> separation_of_variables(double reference, std::span<const SafetyFactor> factors) {
  if (!(reference > 0 && std::isfinite(reference))) return Refused{fmt::format("the reference {} is not a positive number", reference)};
  double log_median = std::log(reference), of_r = 0, of_u = 0;
  for (const SafetyFactor& f : factors) {
    if (!(f.median > 0 && std::isfinite(f.median)))
      return Refused{fmt::format("factor \"{}\": the median {} is not a positive number", f.name, f.median)};
    for (const double beta : {f.beta_r, f.beta_u})
      if (!(beta >= 0 && std::isfinite(beta)))
        return Refused{fmt::format("factor \"{}\": the logarithmic standard deviation {} is not zero or positive", f.name, beta)};
    log_median += std::log(f.median);
    of_r += f.beta_r * f.beta_r;
    of_u += f.beta_u * f.beta_u;
  }
  return SeismicCapacity{std::exp(log_median), std::sqrt(of_r), std::sqrt(of_u)};
}

SeismicCapacity TwoWayLayout::capacity() const {
  return {median, std::hypot(beta_r, beta_interaction), beta_u};
}

// ln A_ij = mean + row_i + column_j + rest_ij; expected mean squares: rest^2 + J row^2, rest^2 + I column^2, rest^2.
OrRefused<TwoWayLayout> two_way_layout(const Matrix& capacities) {
  const Index rows = capacities.rows(), columns = capacities.cols();
  if (rows < 2 || columns < 2) return Refused{fmt::format("{} records with {} samples: at least two of each are needed", rows, columns)};
  for (Index i = 0; i < rows; ++i)
    for (Index j = 0; j < columns; ++j)
      if (!(capacities(i, j) > 0 && std::isfinite(capacities(i, j))))
        return Refused{fmt::format("record {} with sample {}: the capacity {} is not a positive number", i + 1, j + 1, capacities(i, j))};
  const Matrix logarithms = capacities.array().log();
  const double mean = logarithms.mean(), i = static_cast<double>(rows), j = static_cast<double>(columns);
  const Vector row = logarithms.rowwise().mean().array() - mean, column = logarithms.colwise().mean().transpose().array() - mean;
  const Matrix rest = (logarithms.array() - mean).matrix().colwise() - row;
  const double of_rest = (rest.rowwise() - column.transpose()).squaredNorm() / ((i - 1) * (j - 1));
  const double of_rows = j * row.squaredNorm() / (i - 1), of_columns = i * column.squaredNorm() / (j - 1);
  const auto deviation = [of_rest](double mean_square, double count) { return std::sqrt(std::max(0.0, mean_square - of_rest) / count); };
  // Var(mean) = s_r^2/I + s_u^2/J + s^2/(I J), in which the mean squares stand as below; no less than that of the rest alone
  const double sum = std::max(of_rest, of_rows + of_columns - of_rest);
  const double spread = of_rows * of_rows / (i - 1) + of_columns * of_columns / (j - 1) + of_rest * of_rest / ((i - 1) * (j - 1));
  const double freedom = spread > 0 ? std::max(1.0, sum * sum / spread) : 1;
  return TwoWayLayout{std::exp(mean),     deviation(of_rows, j),    deviation(of_columns, i),
                      std::sqrt(of_rest), std::sqrt(sum / (i * j)), freedom};
}

ConfidenceInterval TwoWayLayout::median_interval(double level) const {
  const double half = student_two_sided(level, freedom) * se_log_median;
  return {median * std::exp(-half), median * std::exp(half)};
}

// By parts: the integral of H dP over every segment of H = c a^-k. Its integrand is a normal density in ln a with the mean
// ln(theta) - k beta^2.
OrRefused<AnnualRisk> risk_of_curve(std::span<const HazardPoint> hazard, double theta, double beta) {
  assert(theta > 0 && beta >= 0);
  if (hazard.size() < 2) return Refused{"a hazard curve needs at least two points"};
  for (std::size_t i = 0; i < hazard.size(); ++i) {
    const HazardPoint& p = hazard[i];
    if (!(p.im > 0 && p.rate > 0 && std::isfinite(p.im) && std::isfinite(p.rate)))
      return Refused{fmt::format("point {} of the hazard curve: {} and {} are not positive numbers", i + 1, p.im, p.rate)};
    if (i > 0 && !(p.im > hazard[i - 1].im && p.rate < hazard[i - 1].rate))
      return Refused{fmt::format("point {} of the hazard curve: the intensity must grow and the rate fall from point to point", i + 1)};
  }
  AnnualRisk risk;
  for (std::size_t i = 0; i <= hazard.size(); ++i) {  // segment i ends at point i; the first and the last are open
    const std::size_t first = std::clamp<std::size_t>(i, 1, hazard.size() - 1) - 1;
    const double x = std::log(hazard[first].im), log_rate = std::log(hazard[first].rate);
    const double k = (log_rate - std::log(hazard[first + 1].rate)) / (std::log(hazard[first + 1].im) - x), y = std::log(theta);
    const double low = i > 0 ? std::log(hazard[i - 1].im) - y : -INFINITY, high = i < hazard.size() ? std::log(hazard[i].im) - y : INFINITY;
    double part = 0;
    if (beta > 0)
      part = std::exp(log_rate + k * (x - y) + k * k * beta * beta / 2 + log_normal_between(low / beta + k * beta, high / beta + k * beta));
    else if (low < 0 && high >= 0)
      part = std::exp(log_rate + k * (x - y));
    risk.rate += part;
    if (i == 0) risk.share_below = part;
    if (i == hazard.size()) risk.share_above = part;
  }
  if (!std::isfinite(risk.rate)) return Refused{"the risk is not finite: the hazard curve is too steep below its first point"};
  if (risk.rate > 0) {
    risk.share_below /= risk.rate;
    risk.share_above /= risk.rate;
  }
  return risk;
}

PerformancePair performance_pair(double design_im, double theta, double beta) {
  assert(design_im > 0 && theta > 0 && beta >= 0);
  return {lognormal_cdf(std::log(design_im / theta), beta), lognormal_cdf(std::log(1.5 * design_im / theta), beta)};
}

}  // namespace uplift
