#include "uplift/statistics/clustered.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "uplift/statistics/distributions.h"

// Two-way clusters: A. C. Cameron, J. B. Gelbach, D. L. Miller, Robust inference with multiway clustering, Journal of Business & Economic
// Statistics 29 (2011).
namespace uplift {
namespace {

/// What a run adds to the score and to the information of (a, b) in a + b ln im.
struct Term {
  double x, score, weight;
};

/// Sum over the groups of the squares of their sums, with the factor G/(G - 1) of few groups; and their number.
template <class Key>
std::pair<double, double> variance_of(const std::vector<double>& influence, const std::vector<Key>& keys) {
  std::map<Key, double> sums;
  for (std::size_t i = 0; i < keys.size(); ++i) sums[keys[i]] += influence[i];
  const auto count = static_cast<double>(sums.size());
  double squares = 0;
  for (const auto& [key, sum] : sums) squares += sum * sum;
  return {count > 1 ? squares * count / (count - 1) : 0, count};
}

/// `gradient`: of ln theta with respect to a, where x begins at ln theta and a is 0 there.
OrRefused<SharedError> shared_error(const std::vector<Term>& terms, std::span<const SharedRun> runs, double gradient) {
  double all = 0, first = 0, second = 0;  // the information matrix: sums of the weights, with x and with its square
  std::vector<long> motions, samples;
  std::vector<std::pair<long, long>> curves;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const auto& [x, score, weight] = terms[i];
    all += weight, first += weight * x, second += weight * x * x;
    motions.push_back(runs[i].motion);
    samples.push_back(runs[i].sample);
    curves.emplace_back(runs[i].motion, runs[i].sample);
  }
  const double determinant = all * second - first * first;
  if (!(determinant > 0)) return Refused{"the information matrix is singular"};
  std::vector<double> influence;
  for (const Term& term : terms) influence.push_back(gradient * term.score * (second - first * term.x) / determinant);
  const auto [of_motions, rows] = variance_of(influence, motions);
  const auto [of_samples, columns] = variance_of(influence, samples);
  const auto [of_curves, cells] = variance_of(influence, curves);
  if (rows < 2) return Refused{"it takes two motions at least"};
  const auto count = static_cast<double>(runs.size());
  if (rows == count && (columns < 2 || columns == count)) return Refused{"no motion and no sample has several runs"};
  // every curve stands in one motion and in one sample; what they share is no less than what the curves have alone
  const double sum = columns > 1 ? std::max({of_motions, of_samples, of_motions + of_samples - of_curves}) : of_motions;
  if (!(sum > 0 && std::isfinite(sum))) return Refused{"the runs have no scatter"};
  double spread = of_motions * of_motions / (rows - 1);
  if (columns > 1) spread += of_samples * of_samples / (columns - 1) + of_curves * of_curves / std::max(1.0, cells - 1);
  return SharedError{std::sqrt(sum), spread > 0 ? std::clamp(sum * sum / spread, 1.0, rows - 1) : 1};
}

}  // namespace

ConfidenceInterval SharedError::theta_interval(double theta, double level) const {
  const double half = student_two_sided(level, freedom) * se_log_theta;
  return {theta * std::exp(-half), theta * std::exp(half)};
}

// P(exceeded) = Phi(z), z = (ln im - ln theta)/beta = a + b ln im
OrRefused<SharedError> shared_error_of_stripes(const Fragility& fit, std::span<const SharedRun> runs) {
  const double b = 1 / fit.beta(), middle = std::log(fit.theta());
  std::vector<Term> terms;
  for (const SharedRun& run : runs) {
    const double x = std::log(run.im) - middle, z = b * x;
    // hazards of both tails: density/Phi(z) and density/Phi(-z), without the loss of digits of their quotients
    const double below = normal_tail(-z).hazard, above = normal_tail(z).hazard;
    terms.push_back({x, run.exceeded ? below : -above, below * above});
  }
  return shared_error(terms, runs, -1 / b);
}

// ln D = a + b ln im + sigma e, theta where it is ln d
OrRefused<SharedError> shared_error_of_cloud(const CloudFit& fit, double limit, std::span<const SharedRun> runs) {
  const double theta = (std::log(limit) - fit.a) / fit.b;
  std::vector<Term> terms;
  for (const SharedRun& run : runs) {
    const double x = std::log(run.im) - theta, z = (std::log(run.demand) - fit.a - fit.b * std::log(run.im)) / fit.sigma;
    const double hazard = normal_tail(run.at_most ? -z : z).hazard;
    terms.push_back(run.at_most    ? Term{x, -hazard, hazard * (hazard + z)}
                    : run.censored ? Term{x, hazard, hazard * (hazard - z)}
                                   : Term{x, z, 1});
  }
  return shared_error(terms, runs, -fit.sigma / fit.b);
}

}  // namespace uplift
