#include <algorithm>
#include <cmath>
#include <functional>

#include "uplift/statistics/likelihood.h"

// Profile likelihood intervals of functions of (a, b): docs/theory/fragility.md, eqs (N6) and (N7). The values p that a function fixes form
// a line in (a, b), on which ln L is concave; a fragility grows with the intensity, b >= 0.
namespace uplift {

namespace {

/// All p with one value of a function: start + directions s.
struct Constraint {
  Vec3 start;
  Vec3 direction;  // of (a, b); zero: none
};
using Constrain = std::function<Constraint(double value)>;

class Profile {
 public:
  Profile(const FragilityLikelihood& likelihood, double cutoff) : likelihood_(likelihood), cutoff_(cutoff) {}

  /// The value beyond `inside` (in steps that double, from `step`) at which the deviance reaches the cutoff; none up to `bound`.
  std::optional<double> end(const Constrain& constrain, double inside, double step, double bound) {
    last_ = likelihood_.best.at;
    for (double at_inside = -std::sqrt(cutoff_);; step *= 2) {
      const double outside = step > 0 ? std::min(inside + step, bound) : std::max(inside + step, bound);
      const double at_outside = miss(constrain(outside));
      if (at_outside >= 0) return root(constrain, inside, at_inside, outside, at_outside);
      if (outside == bound) return std::nullopt;
      inside = outside;
      at_inside = at_outside;
    }
  }

 private:
  /// sqrt of the deviance less that of the cutoff: nearly linear in the value of the function, held where it is of no interest.
  double miss(const Constraint& constraint) {
    const double loss = 2 * (likelihood_.best.value - largest(constraint)), root = std::sqrt(cutoff_);
    return std::min(std::sqrt(std::max(0.0, loss)) - root, 3 * root);
  }

  double largest(const Constraint& constraint) {
    Mat3 directions = Mat3::Zero();
    directions.col(0) = constraint.direction;
    if (likelihood_.regression) directions(2, 2) = 1;
    Vec3 start = constraint.start;
    start[2] = last_[2];
    const double squared = constraint.direction.squaredNorm();  // the last maximum, projected on the line
    if (squared > 0) start += constraint.direction * (constraint.direction[1] != 0 ? last_[1] - start[1] : last_[0] - start[0]);
    const auto found = likelihood_.maximise(start, directions);
    if (!found) return -1e300;  // no maximum in reach of doubles: far outside of every interval
    if (found->at[1] < 0) return largest({constraint.start, Vec3::Zero()});
    last_ = found->at;
    return found->value;
  }

  /// False position in a bracket (Illinois variant), with a bisection where three steps have not halved it.
  double root(const Constrain& constrain, double low, double at_low, double high, double at_high) {
    double before = std::abs(high - low);
    for (int step = 1; step <= 200 && std::abs(high - low) > 1e-11 * std::max(std::abs(low), std::abs(high)); ++step) {
      double middle = low - at_low * (high - low) / (at_high - at_low);
      if (step % 3 == 0) {
        if (std::abs(high - low) > before / 2) middle = low + (high - low) / 2;
        before = std::abs(high - low);
      }
      const double at_middle = miss(constrain(middle));
      if (std::abs(at_middle) < 1e-10) return middle;
      if ((at_middle > 0) == (at_high > 0)) {
        at_low /= 2;
      } else {
        low = high;
        at_low = at_high;
      }
      high = middle;
      at_high = at_middle;
    }
    return low + (high - low) / 2;
  }

  const FragilityLikelihood& likelihood_;
  double cutoff_;
  Vec3 last_ = Vec3::Zero();
};

Constraint at_threshold(double t) {
  return {Vec3::Zero(), Vec3(-t, 1, 0)};
}
Constraint at_slope(double b) {
  return {Vec3(0, b, 0), Vec3(1, 0, 0)};
}

}  // namespace

double FragilityLikelihood::cutoff(double level) const {
  double exact = 0, all = 0;
  for (const Term& t : terms) exact += t.exact, all += t.exact + t.above + t.below;
  if (exact < all) {
    const double z = normal_quantile((1 + level) / 2);
    return z * z;
  }
  const double freedom = all - (regression ? 2 : 1), t = student_two_sided(level, freedom);
  return all * std::log1p(t * t / freedom);
}

ConfidenceInterval Fragility::theta_interval(double level) const {
  const FragilityLikelihood& l = *likelihood_;
  Profile profile(l, l.cutoff(level));
  const double t = -l.best.at[0] / l.best.at[1], step = se_log_theta_ / l.width;
  const auto threshold = [&](double sign) -> std::optional<double> {
    const double bound = sign * 700 / l.width;
    const auto found = profile.end(at_threshold, t, sign * step, t + bound);
    if (!found) return std::nullopt;
    const double theta = std::exp(l.centre + l.width * *found);
    return theta > 0 && std::isfinite(theta) ? std::optional(theta) : std::nullopt;
  };
  return {threshold(-1), threshold(1)};
}

ConfidenceInterval Fragility::beta_interval(double level) const {
  const FragilityLikelihood& l = *likelihood_;
  Profile profile(l, l.cutoff(level));
  const double b = l.best.at[1], step = b * std::min(0.5, se_beta_ / beta_);
  const auto steepest = profile.end(at_slope, b, step, 1e12 * b), flattest = profile.end(at_slope, b, -step, 0);
  ConfidenceInterval result;
  result.lower = steepest ? l.width / *steepest : 0;
  if (flattest && *flattest > 0) result.upper = l.width / *flattest;
  return result;
}

ConfidenceInterval Fragility::probability_interval(double im, double level) const {
  if (!(im > 0)) return {0, 0};
  const FragilityLikelihood& l = *likelihood_;
  Profile profile(l, l.cutoff(level));
  const double x = l.standard(im), eta = l.best.at[0] + l.best.at[1] * x;
  const auto at_probability = [x](double value) { return Constraint{Vec3(value, 0, 0), Vec3(-x, 1, 0)}; };
  const double step = std::hypot(se_log_theta_, se_beta_ * eta) / beta_;
  const auto low = profile.end(at_probability, eta, -step, std::min(eta, 0.0) - 40),
             high = profile.end(at_probability, eta, step, std::max(eta, 0.0) + 40);
  return {low ? normal_cdf(*low) : 0, high ? normal_cdf(*high) : 1};
}

}  // namespace uplift
