#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "uplift/statistics/distributions.h"
#include "uplift/statistics/refused.h"

// Lognormal fragility P(limit exceeded | im) = Phi(ln(im/theta)/beta) from runs: docs/theory/fragility.md. Intensities im > 0 have any
// unit; theta has the same. Data from which theta and beta cannot be identified are refused with the reason.
namespace uplift {

struct FragilityLikelihood;

/// Percentiles of fits to data that are drawn from a fit.
class Bootstrap {
 public:
  /// (ln theta, beta) of the draws that have a fit, in the order of the draws, and the number of draws that have none.
  Bootstrap(std::vector<std::pair<double, double>> draws, int refused);
  int draws() const { return static_cast<int>(draws_.size()); }
  int refused() const { return refused_; }
  double se_log_theta() const;
  double se_beta() const;
  double correlation() const;
  /// Percentile intervals with the confidence `level`, 0 < level < 1.
  ConfidenceInterval theta(double level) const;
  ConfidenceInterval beta(double level) const;
  ConfidenceInterval probability(double im, double level) const;

 private:
  std::vector<std::pair<double, double>> draws_;
  int refused_;
};

/// A lognormal fragility curve fitted to data. Median theta [as im], logarithmic standard deviation beta [-].
class Fragility {
 public:
  double theta() const { return theta_; }
  double beta() const { return beta_; }
  /// P(limit exceeded | im), 0 at im = 0.
  double probability(double im) const;
  /// Of the maximum of the likelihood; stripes with the binomial coefficients, capacities and demands as densities of their logarithm.
  double log_likelihood() const { return log_likelihood_; }
  /// Standard errors of ln theta and beta, and their correlation, from the information matrix (expected for stripes, observed else).
  double se_log_theta() const { return se_log_theta_; }
  double se_beta() const { return se_beta_; }
  double correlation() const { return correlation_; }

  /// Profile likelihood intervals with the confidence `level`, 0 < level < 1. An unbounded end has no value: the data do not show at this
  /// level that exceedance grows with the intensity. Samples without censoring use Student's distribution (exact for theta).
  ConfidenceInterval theta_interval(double level) const;
  ConfidenceInterval beta_interval(double level) const;
  ConfidenceInterval probability_interval(double im, double level) const;

  /// Parametric bootstrap: `draws` data sets of the same size and intensities from this fit, fitted in the same way. Counter-based random
  /// numbers: the same seed gives the same draws. Refused where fewer than half of the draws have a fit.
  OrRefused<Bootstrap> bootstrap(std::uint64_t seed, int draws = 2000) const;

 private:
  friend struct FragilityLikelihood;
  double theta_ = 0, beta_ = 0, log_likelihood_ = 0, se_log_theta_ = 0, se_beta_ = 0, correlation_ = 0;
  std::shared_ptr<const FragilityLikelihood> likelihood_;
};

/// What a run without a known outcome counts as.
enum class Unknown { survived, left_out, exceeded };

/// Runs at one intensity: `exceeded` + `unknown` <= `runs`.
struct Stripe {
  double im = 0;
  long runs = 0;
  long exceeded = 0;
  long unknown = 0;  // failed, out of time, crashed: neither survived nor exceeded
};

/// Multiple stripes: maximum of the binomial likelihood (probit in ln im, concave) by Newton's method. Refused where no or all runs exceed,
/// where one intensity separates exceedances from survivals, where the fraction does not grow with im.
/// Source: Baker, Efficient analytical fragility function fitting, Earthquake Spectra 31 (2015).
OrRefused<Fragility> fit_stripes(std::span<const Stripe>, Unknown = Unknown::left_out);

/// What is known of the capacity of one record.
enum class Known { exact, at_least, at_most };

/// The capacity of one record: the intensity at which it first exceeds the limit.
struct RecordCapacity {
  double im = 0;
  Known known = Known::exact;          // at_least: the record survives im and was not run higher
  std::optional<double> largest = {};  // exact: the intensity up to which the record would have been run; used by the bootstrap
};

/// Incremental dynamic analysis. All capacities exact: moments of ln(im) with n - 1. Otherwise maximum of the normal likelihood with each
/// capacity censored at its own intensity (truncated IDA), concave in 1/beta and ln(theta)/beta (Olsen, Econometrica 46 (1978)).
OrRefused<Fragility> fit_capacities(std::span<const RecordCapacity>);

/// One run of a cloud analysis: demand > 0 in any unit; `at_least`: the run ended early, or the structure was lost, and the demand is a
/// lower bound; `at_most`: it is an upper bound.
struct CloudPoint {
  double im = 0;
  double demand = 0;
  bool at_least = false;
  bool at_most = false;
};

/// ln demand = a + b ln im + sigma * (standard normal).
struct CloudFit {
  double a = 0, b = 0, sigma = 0;  // sigma with n - 2; with censored demands that of the maximum of the likelihood, times `scatter`
  Fragility fragility;             // theta = exp((ln threshold - a)/b), beta = sigma/b
};

/// Cloud analysis: regression of demands, as maximum of a censored likelihood where demands are bounds. Refused with fewer than
/// three exact demands, with one intensity only, where the demand does not grow with im, or without any scatter. `scatter`: factor on
/// sigma, beta and its standard error of a maximum of the likelihood, so that it compares with one of least squares; the intervals of the
/// fit are those of the likelihood all the same.
OrRefused<CloudFit> fit_cloud(std::span<const CloudPoint>, double threshold, double scatter = 1);

/// A fit with every run without outcome counted as survived and as exceeded, and the figure between the two where it may be given.
struct BothWays {
  OrRefused<Fragility> survived, exceeded;
  /// The fit without these runs: only where both ends exist and differ, in ln theta and in beta, by less than the width of its own
  /// confidence interval; else why it is not given.
  OrRefused<Fragility> middle;
};
BothWays both_ways(OrRefused<Fragility> survived, OrRefused<Fragility> left_out, OrRefused<Fragility> exceeded, double level);
BothWays fit_stripes_both_ways(std::span<const Stripe>, double level);

}  // namespace uplift
