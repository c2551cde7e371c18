#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>

#include "uplift/statistics/likelihood.h"
#include "uplift/statistics/random.h"

namespace uplift {

namespace {

constexpr std::uint32_t bootstrap_stream = 0x626f6f74;  // apart from the numbers that draw samples

/// One standard normal or uniform number for each observation of one draw.
struct Draw {
  CounterRandom random;
  std::uint64_t index;
  std::uint32_t next = 0;
  double uniform() { return random.uniform(index, next++); }
  double normal() { return random.normal(index, next++); }
};

OrRefused<Fragility> refit(std::vector<Stripe> stripes, const Fragility& fit, Draw draw) {
  for (Stripe& s : stripes) s.exceeded = binomial_quantile(s.runs, fit.probability(s.im), draw.uniform());
  return fit_stripes(stripes);
}

OrRefused<Fragility> refit(std::vector<RecordCapacity> capacities, const Fragility& fit, Draw draw) {
  for (RecordCapacity& c : capacities) {
    const double drawn = fit.theta() * std::exp(fit.beta() * draw.normal());
    const double limit = c.known == Known::exact ? c.largest.value_or(drawn) : c.im;
    if (c.known == Known::at_most)
      c = {std::max(drawn, limit), drawn > limit ? Known::exact : Known::at_most};
    else
      c = {std::min(drawn, limit), drawn > limit ? Known::at_least : Known::exact};
  }
  return fit_capacities(capacities);
}

OrRefused<Fragility> refit(CloudData cloud, const Fragility&, Draw draw) {
  for (CloudPoint& p : cloud.points) {
    const double drawn = std::exp(cloud.a + cloud.b * std::log(p.im) + cloud.sigma * draw.normal());
    const bool above = p.at_least && drawn > p.demand, below = p.at_most && drawn < p.demand;
    p = {p.im, above || below ? p.demand : drawn, above, below};
  }
  auto fitted = fit_cloud(cloud.points, cloud.threshold);
  if (const auto* refused = std::get_if<Refused>(&fitted)) return *refused;
  return std::get<CloudFit>(std::move(fitted)).fragility;
}

/// Percentiles with linear interpolation between the ordered values.
ConfidenceInterval percentiles(std::vector<double> values, double level) {
  std::sort(values.begin(), values.end());
  const auto at = [&values](double share) {
    const double place = share * static_cast<double>(values.size() - 1);
    const auto below = static_cast<std::size_t>(place), above = std::min(below + 1, values.size() - 1);
    return values[below] + (place - static_cast<double>(below)) * (values[above] - values[below]);
  };
  return {at((1 - level) / 2), at((1 + level) / 2)};
}

struct Moments {
  double first = 0, second = 0, mixed = 0;  // central, with n - 1
};
Moments moments(const std::vector<std::pair<double, double>>& draws) {
  const double n = static_cast<double>(draws.size());
  double first = 0, second = 0;
  for (const auto& [x, y] : draws) first += x / n, second += y / n;
  Moments sum;
  for (const auto& [x, y] : draws) {
    sum.first += (x - first) * (x - first) / (n - 1);
    sum.second += (y - second) * (y - second) / (n - 1);
    sum.mixed += (x - first) * (y - second) / (n - 1);
  }
  return sum;
}

}  // namespace

Bootstrap::Bootstrap(std::vector<std::pair<double, double>> draws, int refused) : draws_(std::move(draws)), refused_(refused) {
  assert(draws_.size() >= 2);
}

double Bootstrap::se_log_theta() const {
  return std::sqrt(moments(draws_).first);
}
double Bootstrap::se_beta() const {
  return std::sqrt(moments(draws_).second);
}
double Bootstrap::correlation() const {
  const Moments m = moments(draws_);
  return m.first > 0 && m.second > 0 ? m.mixed / std::sqrt(m.first * m.second) : 0;
}

ConfidenceInterval Bootstrap::theta(double level) const {
  std::vector<double> values;
  for (const auto& [log_theta, beta] : draws_) values.push_back(std::exp(log_theta));
  return percentiles(std::move(values), level);
}
ConfidenceInterval Bootstrap::beta(double level) const {
  std::vector<double> values;
  for (const auto& [log_theta, beta] : draws_) values.push_back(beta);
  return percentiles(std::move(values), level);
}
ConfidenceInterval Bootstrap::probability(double im, double level) const {
  std::vector<double> values;
  for (const auto& [log_theta, beta] : draws_) values.push_back(normal_cdf((std::log(im) - log_theta) / beta));
  return percentiles(std::move(values), level);
}

OrRefused<Bootstrap> Fragility::bootstrap(std::uint64_t seed, int draws) const {
  assert(draws >= 2);
  const CounterRandom random(seed, bootstrap_stream);
  std::vector<std::pair<double, double>> fits;
  for (int i = 0; i < draws; ++i) {
    const Draw draw{random, static_cast<std::uint64_t>(i)};
    const auto fitted = std::visit([&](const auto& data) { return refit(data, *this, draw); }, likelihood_->data);
    if (const auto* fit = std::get_if<Fragility>(&fitted)) fits.emplace_back(std::log(fit->theta()), fit->beta());
  }
  const int refused = draws - static_cast<int>(fits.size());
  if (fits.size() < 2 || refused > draws / 2)
    return Refused{fmt::format("{} of {} data sets drawn from the fit have no fit themselves", refused, draws)};
  return Bootstrap(std::move(fits), refused);
}

}  // namespace uplift
