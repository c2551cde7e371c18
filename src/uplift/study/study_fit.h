#pragma once
#include <optional>
#include <string>
#include <vector>

#include "uplift/statistics/clustered.h"
#include "uplift/statistics/fragility.h"
#include "uplift/statistics/ida_fractiles.h"
#include "uplift/statistics/nuclear.h"
#include "uplift/study/study_curve.h"

// What the runs of a study say (docs/theory/fragility.md).
namespace uplift {

/// Confidence of all intervals.
inline constexpr double study_confidence = 0.9;

/// The capacity of one curve for one limit, with runs of unknown outcome counted in three ways; nothing where it is not known.
struct StudyCapacity {
  std::size_t curve = 0;
  std::optional<RecordCapacity> survived, left_out, exceeded;
  bool found = false;                 // within the tolerance, or beyond an end of the range
  std::vector<double> resurrections;  // intensities of survivals above the capacity
};

/// How a variable moves the result: geometric means over the third of the samples with its smallest and with its largest values.
struct StudyInfluence {
  std::size_t variable = 0;
  double low = 0, high = 0;
};

/// All of one limit state.
struct StudyLimitFit {
  long survived = 0, exceeded = 0, unknown = 0;  // runs
  std::vector<StudyCapacity> capacities;         // of methods that search
  std::vector<Stripe> stripes;                   // of stripes
  std::vector<CloudPoint> cloud;                 // of a cloud
  long without_demand = 0;                       // runs of a cloud whose demand is 0, which has no logarithm: at most the limit
  std::optional<CloudFit> regression;            // of a cloud
  BothWays fit{Refused{"there are no runs"}, Refused{"there are no runs"}, Refused{"there are no runs"}};
  OrRefused<TwoWayLayout> layout = Refused{"it needs a search of the capacity, with at least two samples and two motions, crossed"};
  OrRefused<SharedError> shared = Refused{"it is of stripes and clouds"};  // of the fit in the middle
  OrRefused<Bootstrap> bootstrap = Refused{"the plan asks for none"};      // of the fit in the middle
  OrRefused<SeismicCapacity> capacity = Refused{"there are no runs"};      // with the factors of safety of the plan
  /// Of the median of the fit in the middle, which exists. Curves share their motions and their samples: where the layout is known, its
  /// interval; of stripes and clouds at least that of the shared error; else all curves count as independent.
  ConfidenceInterval theta_interval() const;
  /// Of P(exceed | im), im > 0: that of the likelihood, and at least what the interval of the median makes of the curve.
  ConfidenceInterval probability_interval(double im) const;
  std::optional<IdaFractiles> fractiles;            // of searches: three curves or more, and a limit that grows with the intensity
  std::vector<StudyInfluence> tornado;              // the largest first; of the capacity where it is searched, else of the demand
  std::string no_tornado;                           // why there is none, though there are variables
  long tornado_samples = 0, tornado_responses = 0;  // on which it rests
};
StudyLimitFit fit_limit(const StudyCase& study, const std::vector<StudyCurve>& curves, std::size_t limit);

/// Percentiles of a floor spectrum over all runs of a level that say something.
struct StudyFloor {
  std::string floor;
  double damping = 0, level = 0;  // intensity, of clouds the factor
  long runs = 0;
  long lost = 0;                                   // of these, runs that lost the structure: their spectra are those up to there
  long missing = 0;                                // runs without an outcome, which have no spectra
  std::vector<double> frequencies, p16, p50, p84;  // Hz, m/s2; empty: no run of the level has a spectrum
};
std::vector<StudyFloor> floor_percentiles(const StudyCase& study, const std::vector<StudyCurve>& curves);

/// Probabilities at the design motion of the site; nothing without one, and without a curve.
std::optional<PerformancePair> performance_of(const StudySite& site, const OrRefused<Fragility>& curve);
/// Annual rate with which the limit is exceeded, by the hazard curve of the site; refused without one, and without a curve.
OrRefused<AnnualRisk> risk_of(const StudySite& site, const OrRefused<Fragility>& curve);
/// Median, beta_R and beta_U by the two-way layout, or, where the runs vary no number of the case, by the fit in the middle, whose beta
/// then is beta_R; times the factors of safety. Refused where motions and samples cannot be told apart, and where nothing says beta_U.
OrRefused<SeismicCapacity> seismic_capacity(const StudySite& site, const StudyLimitFit& fit, bool sampled);
/// The same with the median and the composite beta of the capacity. By components of variance it differs, for few motions and samples,
/// from that of the fit.
std::optional<PerformancePair> composite_performance_of(const StudySite& site, const OrRefused<SeismicCapacity>& capacity);
OrRefused<AnnualRisk> composite_risk_of(const StudySite& site, const OrRefused<SeismicCapacity>& capacity);

}  // namespace uplift
