#include "uplift/statistics/likelihood.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace uplift {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// A x = b with a positive definite A (L D L^T); rows and columns of zeros give x = 0. False when A is not positive definite.
bool solve_definite(Mat3 a, Vec3 b, Vec3& x) {
  for (int i = 0; i < 3; ++i)
    if (a.row(i).isZero(0) && b[i] == 0) a(i, i) = 1;
  for (int k = 0; k < 3; ++k) {
    if (!(a(k, k) > 0)) return false;
    for (int i = k + 1; i < 3; ++i) {
      const double factor = a(i, k) / a(k, k);
      for (int j = k + 1; j < 3; ++j) a(i, j) -= factor * a(k, j);
      b[i] -= factor * b[k];
    }
  }
  for (int k = 2; k >= 0; --k) {
    for (int j = k + 1; j < 3; ++j) b[k] -= a(k, j) * b[j];
    b[k] /= a(k, k);
  }
  x = b;
  return b.allFinite();
}

}  // namespace

double FragilityLikelihood::standard(double im) const {
  return (std::log(im) - centre) / width;
}

void FragilityLikelihood::standardise() {
  double weight = 0, sum = 0, squares = 0;
  for (const Term& t : terms) sum += (t.exact + t.above + t.below) * t.x, weight += t.exact + t.above + t.below;
  centre = weight > 0 ? sum / weight : 0;
  for (const Term& t : terms) squares += (t.exact + t.above + t.below) * (t.x - centre) * (t.x - centre);
  width = squares > 0 ? std::sqrt(squares / weight) : 1;
  for (Term& t : terms) t.x = (t.x - centre) / width;
}

double FragilityLikelihood::exact_weight() const {
  double sum = 0;
  for (const Term& t : terms) sum += t.exact;
  return sum;
}

FragilityLikelihood::Value FragilityLikelihood::evaluate(const Vec3& p) const {
  Value result;
  const int scale = regression ? 2 : 1;
  double exact = 0;
  for (const Term& t : terms) {
    const Vec3 row(1, t.x, -t.y);
    const double z = row.dot(p);
    double slope = 0, curvature = 0;
    if (t.exact > 0) {
      exact += t.exact;
      result.value -= t.exact * (z * z / 2 + 0.91893853320467274178);
      slope -= t.exact * z;
      curvature += t.exact;
    }
    if (t.above > 0) {
      const NormalTail tail = normal_tail(-z);
      result.value += t.above * tail.log_probability;
      slope += t.above * tail.hazard;
      curvature += t.above * tail.hazard * tail.excess;
    }
    if (t.below > 0) {
      const NormalTail tail = normal_tail(z);
      result.value += t.below * tail.log_probability;
      slope -= t.below * tail.hazard;
      curvature += t.below * tail.hazard * tail.excess;
    }
    result.slope += slope * row;
    result.curvature += curvature * (row * row.transpose());
  }
  if (exact > 0) {
    if (!(p[scale] > 0)) {
      result.value = -infinity;
      return result;
    }
    result.value += exact * std::log(p[scale]);
    result.slope[scale] += exact / p[scale];
    result.curvature(scale, scale) += exact / (p[scale] * p[scale]);
  }
  return result;
}

std::optional<FragilityLikelihood::Maximum> FragilityLikelihood::maximise(const Vec3& start, const Mat3& directions) const {
  constexpr double full_steps = 1e-8, converged = 1e-20;  // of the square of Newton's decrement, in units of ln L
  Vec3 p = start;
  Value now = evaluate(p);
  int last_steps = 0;
  for (int iteration = 0; iteration < 200; ++iteration) {
    if (!std::isfinite(now.value)) return std::nullopt;
    const Vec3 slope = directions.transpose() * now.slope;
    Vec3 s;
    if (!solve_definite(directions.transpose() * now.curvature * directions, slope, s)) return std::nullopt;
    const double decrement = slope.dot(s);
    if (decrement < converged || last_steps == 4) return Maximum{p, now.value};
    double length = 1;
    Vec3 next = p + directions * s;
    Value there = evaluate(next);
    if (decrement < std::max(full_steps, 1e-12 * std::abs(now.value))) {  // differences of ln L are round-off here
      ++last_steps;
    } else {
      for (int halving = 0; halving < 100 && !(there.value >= now.value + 1e-4 * length * decrement); ++halving) {
        length /= 2;
        next = p + length * (directions * s);
        there = evaluate(next);
      }
      if (!(there.value >= now.value)) return std::nullopt;
    }
    p = next;
    now = there;
  }
  return std::nullopt;
}

Mat3 FragilityLikelihood::information() const {
  if (!std::holds_alternative<std::vector<Stripe>>(data)) return evaluate(best.at).curvature;
  Mat3 sum = Mat3::Zero();
  for (const Term& t : terms) {
    const Vec3 row(1, t.x, 0);
    const double z = row.dot(best.at);
    sum += (t.above + t.below) * normal_tail(z).hazard * normal_tail(-z).hazard * (row * row.transpose());
  }
  return sum;
}

Mat3 FragilityLikelihood::all_directions() const {
  Mat3 directions = Mat3::Identity();
  if (!regression) directions(2, 2) = 0;
  return directions;
}

std::string FragilityLikelihood::not_identifiable() const {
  double last_survival = -infinity, first_exceedance = infinity, last_exceedance = -infinity, first_survival = infinity;
  for (const Term& t : terms) {
    if (t.exact + t.below > 0) last_survival = std::max(last_survival, t.x), first_survival = std::min(first_survival, t.x);
    if (t.exact + t.above > 0) last_exceedance = std::max(last_exceedance, t.x), first_exceedance = std::min(first_exceedance, t.x);
  }
  if (last_survival < first_survival && last_exceedance < first_exceedance) return "not identifiable: there are no runs with an outcome";
  if (last_exceedance < first_exceedance) return "not identifiable: no run exceeds the limit";
  if (last_survival < first_survival) return "not identifiable: every run exceeds the limit";
  if (std::min(first_survival, first_exceedance) == std::max(last_survival, last_exceedance))
    return "not identifiable: all runs are at one intensity";
  if (last_survival <= first_exceedance) return "not identifiable: one intensity separates all survivals from all exceedances";
  if (exact_weight() == 0 && last_exceedance <= first_survival)
    return "not identifiable: all exceedances are at lower intensities than all survivals";
  return {};
}

Fragility FragilityLikelihood::with(double log_theta, double beta, double se_log_theta, double se_beta, double correlation) && {
  Fragility result;
  result.theta_ = std::exp(log_theta);
  result.beta_ = beta;
  result.log_likelihood_ = best.value + constant;
  result.se_log_theta_ = se_log_theta;
  result.se_beta_ = se_beta;
  result.correlation_ = correlation;
  result.likelihood_ = std::make_shared<const FragilityLikelihood>(std::move(*this));
  return result;
}

// theta and beta are functions of a and b; their covariance follows from that of p, the inverse of the curvature.
OrRefused<Fragility> FragilityLikelihood::fragility(double scatter) && {
  const double a = best.at[0], b = best.at[1];
  if (!(b > 0)) return Refused{"the fraction of exceedances does not grow with the intensity"};
  const double t = -a / b, log_theta = centre + width * t, beta = width / b;
  if (!(std::abs(log_theta) < 700) || !(beta < 1e100))
    return Refused{"the fraction of exceedances hardly grows with the intensity: the median is beyond all numbers"};
  const Mat3 curvature = information();
  const Vec3 of_log_theta = Vec3(-1, -t, 0) * (width / b), of_beta = Vec3(0, -1, 0) * (width / (b * b));
  Vec3 to_log_theta, to_beta;
  if (!solve_definite(curvature, of_log_theta, to_log_theta) || !solve_definite(curvature, of_beta, to_beta))
    return Refused{"the standard errors cannot be computed: the information matrix is singular"};
  const double variance = of_log_theta.dot(to_log_theta), of_scatter = of_beta.dot(to_beta);
  if (!(variance > 0 && of_scatter > 0)) return Refused{"the standard errors cannot be computed: the information matrix is singular"};
  const double correlation = std::clamp(of_log_theta.dot(to_beta) / std::sqrt(variance * of_scatter), -1.0, 1.0);
  return std::move(*this).with(log_theta, scatter * beta, std::sqrt(variance), scatter * std::sqrt(of_scatter), correlation);
}

double Fragility::probability(double im) const {
  return normal_cdf(std::log(im / theta_) / beta_);
}

}  // namespace uplift
