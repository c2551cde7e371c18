#pragma once
#include <span>
#include <variant>
#include <vector>

#include "uplift/math/fixed.h"
#include "uplift/statistics/fragility.h"

// What all fits of a fragility share; used by the sources of this folder only.
namespace uplift {

/// Demands and the threshold of a cloud analysis, and its regression.
struct CloudData {
  std::vector<CloudPoint> points;
  double threshold = 0;
  double a = 0, b = 0, sigma = 0;
};

/// The likelihood of every kind of data in the unknowns p = (a, b, c) with z = a + b x - c y, x the standardised ln im and y the
/// standardised ln(demand/threshold): docs/theory/fragility.md, eqs (N2) to (N4). It is concave, and P(exceeded | im) = Phi(a + b x).
/// Stripes and capacities have no c.
struct FragilityLikelihood {
  /// Weights of the three kinds of observation at (x, y).
  struct Term {
    double x = 0, y = 0;
    double exact = 0;  // density of z times the scale (b, or c of a regression)
    double above = 0;  // ln Phi(z)
    double below = 0;  // ln Phi(-z)
  };
  struct Value {
    double value = 0;
    Vec3 slope = Vec3::Zero();
    Mat3 curvature = Mat3::Zero();  // minus the second derivatives
  };
  struct Maximum {
    Vec3 at = Vec3::Zero();
    double value = 0;
  };

  std::vector<Term> terms;
  double centre = 0, width = 1;                                                    // x = (ln im - centre)/width
  double demand_width = 1;                                                         // y = ln(demand/threshold)/demand_width
  bool regression = false;                                                         // the unknown c is free
  double constant = 0;                                                             // binomial coefficients and scales of the densities
  std::variant<std::vector<Stripe>, std::vector<RecordCapacity>, CloudData> data;  // as fitted
  Maximum best;

  double standard(double im) const;
  /// Standardises terms whose x are ln im.
  void standardise();
  double exact_weight() const;
  Value evaluate(const Vec3& p) const;
  /// The information matrix at `best`: expected for stripes, whose numbers of runs are planned; observed else.
  Mat3 information() const;
  /// The largest value over p = start + directions s, from s = 0 by Newton's method with step halving. Zero columns are no directions.
  std::optional<Maximum> maximise(const Vec3& start, const Mat3& directions) const;
  /// Directions of all unknowns.
  Mat3 all_directions() const;
  /// Why the maximum is not finite; empty when it is.
  std::string not_identifiable() const;
  /// Twice the loss of ln L that bounds an interval of the confidence `level`.
  double cutoff(double level) const;
  /// theta, beta, standard errors from `best`.
  OrRefused<Fragility> fragility(double scatter = 1) &&;  // `scatter`: factor on beta and its standard error
  /// The same with other numbers than those of `best`, in units of ln im.
  Fragility with(double log_theta, double beta, double se_log_theta, double se_beta, double correlation) &&;
};

}  // namespace uplift
