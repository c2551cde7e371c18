#include "uplift/statistics/fragility.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "uplift/statistics/likelihood.h"

namespace uplift {

namespace {

bool positive(double value) {
  return value > 0 && std::isfinite(value);
}

/// ln of n over k.
double log_choose(double n, double k) {
  return std::lgamma(n + 1) - std::lgamma(k + 1) - std::lgamma(n - k + 1);
}

/// Maximum of the likelihood from `start`.
OrRefused<Fragility> at_maximum(FragilityLikelihood likelihood, const Vec3& start) {
  if (std::string reason = likelihood.not_identifiable(); !reason.empty()) return Refused{std::move(reason)};
  const auto found = likelihood.maximise(start, likelihood.all_directions());
  if (!found) return Refused{"the maximum of the likelihood was not found"};
  likelihood.best = *found;
  return std::move(likelihood).fragility();
}

/// Mean and standard deviation (n - 1) of standardised capacities without censoring. Both are independent of each other.
OrRefused<Fragility> by_moments(FragilityLikelihood likelihood) {
  if (std::string reason = likelihood.not_identifiable(); !reason.empty()) return Refused{std::move(reason)};
  const double n = likelihood.exact_weight();
  likelihood.best.at = Vec3(0, 1, 0);
  likelihood.best.value = likelihood.evaluate(likelihood.best.at).value;
  const double log_theta = likelihood.centre, beta = likelihood.width * std::sqrt(n / (n - 1));
  return std::move(likelihood).with(log_theta, beta, beta / std::sqrt(n), beta / std::sqrt(2 * (n - 1)), 0);
}

}  // namespace

OrRefused<Fragility> fit_stripes(std::span<const Stripe> stripes, Unknown unknown) {
  FragilityLikelihood likelihood;
  std::vector<Stripe> counted;
  double all = 0, above = 0;
  for (std::size_t i = 0; i < stripes.size(); ++i) {
    Stripe s = stripes[i];
    if (!positive(s.im)) return Refused{fmt::format("stripe {}: the intensity {} is not a positive number", i + 1, s.im)};
    if (s.runs < 0 || s.exceeded < 0 || s.unknown < 0 || s.exceeded > s.runs || s.unknown > s.runs - s.exceeded)
      return Refused{
          fmt::format("stripe {}: {} exceedances and {} unknown outcomes are no parts of {} runs", i + 1, s.exceeded, s.unknown, s.runs)};
    if (unknown == Unknown::left_out) s.runs -= s.unknown;
    if (unknown == Unknown::exceeded) s.exceeded += s.unknown;
    s.unknown = 0;
    if (s.runs == 0) continue;
    counted.push_back(s);
    const double n = static_cast<double>(s.runs), k = static_cast<double>(s.exceeded);
    all += n;
    above += k;
    likelihood.terms.push_back({.x = std::log(s.im), .above = k, .below = n - k});
    likelihood.constant += log_choose(n, k);
  }
  likelihood.standardise();
  likelihood.data = std::move(counted);
  const bool both = above > 0 && above < all;  // else refused
  return at_maximum(std::move(likelihood), Vec3(both ? normal_quantile(above / all) : 0, 0, 0));
}

OrRefused<Fragility> fit_capacities(std::span<const RecordCapacity> capacities) {
  if (capacities.size() == 1) return Refused{"not identifiable: one capacity has no scatter, it takes two at least"};
  FragilityLikelihood likelihood;
  for (std::size_t i = 0; i < capacities.size(); ++i) {
    const RecordCapacity& c = capacities[i];
    if (!positive(c.im)) return Refused{fmt::format("record {}: the capacity {} is not a positive number", i + 1, c.im)};
    likelihood.terms.push_back({.x = std::log(c.im),
                                .exact = c.known == Known::exact ? 1.0 : 0.0,
                                .above = c.known == Known::at_most ? 1.0 : 0.0,
                                .below = c.known == Known::at_least ? 1.0 : 0.0});
  }
  likelihood.standardise();
  const double exact = likelihood.exact_weight();
  likelihood.constant = -exact * std::log(likelihood.width);
  likelihood.data = std::vector(capacities.begin(), capacities.end());
  if (exact == static_cast<double>(capacities.size())) return by_moments(std::move(likelihood));
  return at_maximum(std::move(likelihood), Vec3(0, exact > 0 ? 1 : 0, 0));
}

BothWays both_ways(OrRefused<Fragility> survived, OrRefused<Fragility> left_out, OrRefused<Fragility> exceeded, double level) {
  const auto* low = std::get_if<Fragility>(&exceeded);
  const auto* high = std::get_if<Fragility>(&survived);
  const auto* middle = std::get_if<Fragility>(&left_out);
  if (middle && !(low && high)) {
    left_out = Refused{"not given: with the runs without outcome counted as survived or as exceeded there is no fit"};
  } else if (middle) {
    const auto within = [](double difference, const std::optional<double>& lower, const std::optional<double>& upper) {
      return !lower || !upper || std::abs(difference) < *upper - *lower;
    };
    const auto logarithm = [](const std::optional<double>& value) { return value ? std::optional(std::log(*value)) : std::nullopt; };
    const ConfidenceInterval theta = middle->theta_interval(level), beta = middle->beta_interval(level);
    const bool of_theta = within(std::log(high->theta() / low->theta()), logarithm(theta.lower), logarithm(theta.upper));
    const bool of_beta = within(high->beta() - low->beta(), beta.lower, beta.upper);
    if (!of_theta || !of_beta)
      left_out = Refused{fmt::format("not given: the runs without outcome change {} by more than the {:.0f} % confidence interval",
                                     of_theta ? "beta" : "theta", 100 * level)};
  }
  return {std::move(survived), std::move(exceeded), std::move(left_out)};
}

BothWays fit_stripes_both_ways(std::span<const Stripe> stripes, double level) {
  return both_ways(fit_stripes(stripes, Unknown::survived), fit_stripes(stripes, Unknown::left_out),
                   fit_stripes(stripes, Unknown::exceeded), level);
}

}  // namespace uplift
