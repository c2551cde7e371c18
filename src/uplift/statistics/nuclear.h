#pragma once
#include <span>
#include <string>
#include <vector>

#include "uplift/math/linalg.h"
#include "uplift/statistics/distributions.h"
#include "uplift/statistics/refused.h"

// Seismic capacities as nuclear practice states them: docs/theory/fragility.md.
namespace uplift {

/// Capacity A = A_m e_R e_U; e_R (randomness) and e_U (uncertainty) are lognormal with the median 1.
struct SeismicCapacity {
  double median = 0;  // A_m [as the intensity], > 0
  double beta_r = 0;  // from record to record, >= 0
  double beta_u = 0;  // of knowledge, >= 0

  /// Composite sqrt(beta_r^2 + beta_u^2).
  double beta_c() const;
  /// High confidence of a low probability of failure: 95 % confidence of at most 5 %, A_m exp(-1.65 (beta_r + beta_u)).
  double hclpf() const;
  /// 1 % of the composite curve, Phi(ln(a/A_m)/beta_c): A_m exp(-2.326 beta_c).
  double hclpf_composite() const;
  /// Probability of failure at the intensity a that is not exceeded with `confidence` in (0, 1):
  /// Phi((ln(a/A_m) + beta_u Phi^-1(confidence))/beta_r).
  double probability(double a, double confidence) const;
};

/// One factor of a separation of variables: a factor of safety with its scatter.
struct SafetyFactor {
  std::string name;
  double median = 1, beta_r = 0, beta_u = 0;
  std::string source = {};  // where the numbers come from
};
/// A_m = reference * product of the medians; variances of the logarithms add up. Source: EPRI TR-103959 (1994). Refused where a median or
/// the reference is not positive, or a beta is negative or not finite (with the factor's name).
OrRefused<SeismicCapacity> separation_of_variables(double reference, std::span<const SafetyFactor>);

/// Scatter of capacities of every record (row) with every sample of the uncertain variables (column).
struct TwoWayLayout {
  double median = 0;            // exp of the mean of ln capacity
  double beta_r = 0;            // between records
  double beta_u = 0;            // between samples
  double beta_interaction = 0;  // what neither explains: records that react differently to the samples
  double se_log_median = 0;     // standard error of ln median: records and samples are drawn, not their pairs
  double freedom = 1;           // its degrees of freedom, after Satterthwaite
  /// beta_r with the interaction, which differs from record to record: the capacity to be used in HCLPF and risk.
  SeismicCapacity capacity() const;
  /// Of the median, with the confidence `level`, 0 < level < 1.
  ConfidenceInterval median_interval(double level) const;
};
/// Components of variance of a two-way layout without repetition, by mean squares; negative components count as 0. At least two rows
/// and two columns of positive numbers, else refused.
OrRefused<TwoWayLayout> two_way_layout(const Matrix& capacities);

/// Points of a hazard curve: mean annual rate [1/a] with which the intensity is exceeded.
struct HazardPoint {
  double im = 0, rate = 0;
};
/// Annual rate of failure, and its shares that rest on rates below the first and above the last point of the hazard curve.
struct AnnualRisk {
  double rate = 0;  // [1/a]
  double share_below = 0, share_above = 0;
  double share_beyond() const { return share_below + share_above; }
};
/// Integral of P(failure | a) |dH| with the lognormal curve (theta, beta >= 0) and a hazard curve that is linear in ln a, ln H between its
/// points and goes on with the slopes of its ends. Every segment in closed form. Refused unless there are two points with ascending im > 0
/// and descending rate > 0.
OrRefused<AnnualRisk> risk_of_curve(std::span<const HazardPoint>, double theta, double beta);

/// The performance that ASCE/SEI 43 asks for: at most about 1 % at the design motion and 10 % at 1.5 times it.
struct PerformancePair {
  double at_design = 0, at_one_and_a_half = 0;
  bool met() const { return at_design <= 0.01 && at_one_and_a_half <= 0.10; }
};
/// Of the lognormal curve (theta, beta >= 0).
PerformancePair performance_pair(double design_im, double theta, double beta);

}  // namespace uplift
