#include <fmt/format.h>

#include <cmath>

#include "uplift/statistics/likelihood.h"

namespace uplift {

namespace {

/// y = level + slope x in standardised numbers, x with the mean of all points.
struct Line {
  double level = 0, slope = 0, residual = 0;  // residual: sum of squares
};

Line least_squares(const std::vector<FragilityLikelihood::Term>& terms) {
  double n = 0, x = 0, y = 0, xx = 0, xy = 0;
  for (const auto& t : terms) ++n, x += t.x, y += t.y;
  for (const auto& t : terms) xx += (t.x - x / n) * (t.x - x / n), xy += (t.x - x / n) * (t.y - y / n);
  Line line;
  line.slope = xx > 0 ? xy / xx : 0;
  line.level = (y - line.slope * x) / n;
  for (const auto& t : terms) line.residual += (t.y - line.level - line.slope * t.x) * (t.y - line.level - line.slope * t.x);
  return line;
}

/// Regression in the units of the data: a, b, sigma of the standardised line with the deviation `sigma`.
void unstandardise(const FragilityLikelihood& likelihood, const Line& line, double sigma, CloudData& data) {
  data.b = likelihood.demand_width * line.slope / likelihood.width;
  data.a = std::log(data.threshold) + likelihood.demand_width * line.level - data.b * likelihood.centre;
  data.sigma = likelihood.demand_width * sigma;
}

/// Terms of the points, x and y standardised. `exact` has those with exact demands.
FragilityLikelihood cloud_likelihood(const CloudData& data, std::vector<FragilityLikelihood::Term>& exact) {
  FragilityLikelihood likelihood;
  likelihood.regression = true;
  for (const CloudPoint& p : data.points)
    likelihood.terms.push_back({.x = std::log(p.im),
                                .y = std::log(p.demand) - std::log(data.threshold),
                                .exact = p.at_least || p.at_most ? 0.0 : 1.0,
                                .above = p.at_least ? 1.0 : 0.0,
                                .below = p.at_most ? 1.0 : 0.0});
  likelihood.standardise();
  double n = 0, mean = 0, squares = 0;
  for (const auto& t : likelihood.terms) ++n, mean += t.y;
  for (const auto& t : likelihood.terms) squares += (t.y - mean / n) * (t.y - mean / n);
  if (squares > 0) likelihood.demand_width = std::sqrt(squares / n);
  for (auto& t : likelihood.terms) {
    t.y /= likelihood.demand_width;
    if (t.exact > 0) exact.push_back(t);
  }
  likelihood.constant = -static_cast<double>(exact.size()) * std::log(likelihood.demand_width);
  return likelihood;
}

std::string invalid(std::span<const CloudPoint> points, double threshold) {
  const auto positive = [](double value) { return value > 0 && std::isfinite(value); };
  if (!positive(threshold)) return fmt::format("the limit {} of the demand is not a positive number", threshold);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!positive(points[i].im)) return fmt::format("run {}: the intensity {} is not a positive number", i + 1, points[i].im);
    if (!positive(points[i].demand)) return fmt::format("run {}: the demand {} is not a positive number", i + 1, points[i].demand);
  }
  return {};
}

/// Why a line through the exact demands is not determined, or has no scatter.
std::string no_line(const std::vector<FragilityLikelihood::Term>& exact, const Line& line) {
  if (exact.size() < 3) return "not identifiable: fewer than three runs with an exact demand";
  double level = 0, spread = 0, squares = 0;
  for (const auto& t : exact) level += t.x / static_cast<double>(exact.size());
  for (const auto& t : exact) spread += (t.x - level) * (t.x - level), squares += t.y * t.y;
  if (!(spread > 1e-24)) return "not identifiable: all exact demands are at one intensity";
  if (!(line.residual > 1e-24 * (squares + line.slope * line.slope))) return "not identifiable: the demands have no scatter";
  return {};
}

/// Without censoring: least squares and n - 2, the covariance from the normal equations (x has the mean 0 and the variance 1).
OrRefused<CloudFit> by_least_squares(FragilityLikelihood likelihood, const Line& line, CloudData data) {
  if (!(line.slope > 0)) return Refused{"the demand does not grow with the intensity"};
  const double n = static_cast<double>(likelihood.terms.size()), sigma = std::sqrt(line.residual / (n - 2)),
               most_likely = std::sqrt(line.residual / n);
  const double t = -line.level / line.slope, ratio = sigma / line.slope, log_theta = likelihood.centre + likelihood.width * t;
  if (!(std::abs(log_theta) < 700)) return Refused{"the demand hardly grows with the intensity: the median is beyond all numbers"};
  likelihood.best.at = Vec3(line.level, line.slope, 1) / most_likely;
  likelihood.best.value = likelihood.evaluate(likelihood.best.at).value;
  unstandardise(likelihood, line, sigma, data);
  likelihood.data = data;
  const double width = likelihood.width, of_t = ratio * std::sqrt((1 + t * t) / n);
  const double of_ratio = ratio * std::sqrt(ratio * ratio / n + 1 / (2 * (n - 2))), covariance = ratio * ratio * ratio * t / n;
  return CloudFit{data.a, data.b, data.sigma,
                  std::move(likelihood).with(log_theta, width * ratio, width * of_t, width * of_ratio, covariance / (of_t * of_ratio))};
}

OrRefused<CloudFit> by_likelihood(FragilityLikelihood likelihood, const Line& start, CloudData data, double scatter) {
  const double precision = std::sqrt(static_cast<double>(likelihood.terms.size()) / start.residual);
  const auto found = likelihood.maximise(Vec3(start.level, start.slope, 1) * precision, likelihood.all_directions());
  if (!found) return Refused{"the maximum of the likelihood was not found"};
  likelihood.best = *found;
  const Vec3 p = found->at;
  if (!(p[1] > 0)) return Refused{"the demand does not grow with the intensity"};
  unstandardise(likelihood, {p[0] / p[2], p[1] / p[2]}, scatter / p[2], data);
  likelihood.data = data;
  auto fitted = std::move(likelihood).fragility(scatter);
  if (const auto* refused = std::get_if<Refused>(&fitted)) return *refused;
  return CloudFit{data.a, data.b, data.sigma, std::get<Fragility>(std::move(fitted))};
}

}  // namespace

OrRefused<CloudFit> fit_cloud(std::span<const CloudPoint> points, double threshold, double scatter) {
  if (std::string reason = invalid(points, threshold); !reason.empty()) return Refused{std::move(reason)};
  CloudData data{{points.begin(), points.end()}, threshold};
  std::vector<FragilityLikelihood::Term> exact;
  FragilityLikelihood likelihood = cloud_likelihood(data, exact);
  const Line of_exact = exact.empty() ? Line() : least_squares(exact);
  if (std::string reason = no_line(exact, of_exact); !reason.empty()) return Refused{std::move(reason)};
  if (exact.size() == points.size()) return by_least_squares(std::move(likelihood), of_exact, std::move(data));
  const Line of_all = least_squares(likelihood.terms);
  return by_likelihood(std::move(likelihood), of_all.residual > of_exact.residual ? of_all : of_exact, std::move(data), scatter);
}

}  // namespace uplift
