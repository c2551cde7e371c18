#include "uplift/statistics/latin_hypercube.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>
#include <numeric>
#include <vector>

#include "uplift/math/dense.h"
#include "uplift/statistics/distributions.h"
#include "uplift/statistics/random.h"

namespace uplift {

namespace {

constexpr std::uint32_t order_stream = 0x6c687331, place_stream = 0x6c687332;  // apart from each other and from other purposes

/// The indices of the values in ascending order; equal values keep theirs.
std::vector<Index> ascending(const Vector& values) {
  std::vector<Index> order(static_cast<std::size_t>(values.size()));
  std::iota(order.begin(), order.end(), Index{0});
  std::stable_sort(order.begin(), order.end(), [&](Index i, Index j) { return values[i] < values[j]; });
  return order;
}

/// Rank 0 ... n - 1 of every value.
Vector ranks(const Vector& values) {
  Vector rank(values.size());
  const auto order = ascending(values);
  for (std::size_t first = 0, last; first < order.size(); first = last) {
    for (last = first + 1; last < order.size() && values[order[last]] == values[order[first]];) ++last;
    for (std::size_t k = first; k < last; ++k) rank[order[k]] = static_cast<double>(first + last - 1) / 2;
  }
  return rank;
}

Matrix correlation(const Matrix& columns) {
  const Matrix centred = columns.rowwise() - columns.colwise().mean();
  Matrix result = centred.transpose() * centred;
  const Vector length = result.diagonal().cwiseSqrt();
  for (Index i = 0; i < result.rows(); ++i)
    for (Index j = 0; j < result.cols(); ++j) {
      const double scale = length[i] * length[j];
      result(i, j) = i == j ? 1 : scale > 0 ? std::clamp(result(i, j) / scale, -1.0, 1.0) : 0;
    }
  return result;
}

bool positive_definite(const Matrix& a) {
  return Cholesky(a)->info() == Success && SymmetricEigen(a).eigenvalues()[0] > 1e-10;
}

/// Strata 0 ... n - 1 in a random order for each variable.
Matrix random_strata(Index samples, Index variables, std::uint64_t seed) {
  const CounterRandom random(seed, order_stream);
  Matrix strata(samples, variables);
  for (Index j = 0; j < variables; ++j) {
    Vector draws(samples);
    for (Index i = 0; i < samples; ++i) draws[i] = random.uniform(static_cast<std::uint64_t>(i), static_cast<std::uint32_t>(j));
    strata.col(j) = ranks(draws);
  }
  return strata;
}

/// The strata in the order of scores with the correlation `wanted`: normal scores S with the correlation T = Q Q^T become S (P Q^-1)^T,
/// wanted = P P^T.
Matrix reordered(const Matrix& strata, const Matrix& wanted) {
  const double n = static_cast<double>(strata.rows());
  const Matrix scores = strata.unaryExpr([n](double rank) { return normal_quantile((rank + 1) / (n + 1)); });
  const Matrix q = Cholesky(correlation(scores))->matrixL(), p = Cholesky(wanted)->matrixL();
  const Matrix mixed = scores * (p * inverse(q)).transpose();
  Matrix result(strata.rows(), strata.cols());
  for (Index j = 0; j < strata.cols(); ++j) result.col(j) = ranks(mixed.col(j));
  return result;
}

/// Exchanges two strata of one variable wherever that reduces the sum of squares of what is missing to the target.
void exchange(Matrix& strata, const Matrix& target) {
  const Index n = strata.rows();
  const double length = std::sqrt(static_cast<double>(n) * (static_cast<double>(n) * static_cast<double>(n) - 1) / 12);  // of centred ranks
  Matrix missing = target - correlation(strata);
  for (Index j = 0; j < strata.cols(); ++j)
    for (Index i = 0; i < n; ++i)
      for (Index l = 0; l < i; ++l) {
        const double change = (strata(l, j) - strata(i, j)) / (length * length);
        Vector left = missing.col(j) - change * (strata.row(i) - strata.row(l)).transpose();
        left[j] = 0;
        if (left.squaredNorm() >= missing.col(j).squaredNorm() - 1e-12) continue;
        std::swap(strata(i, j), strata(l, j));
        missing.col(j) = left;
        missing.row(j) = left.transpose();
      }
}

/// Repeated with the target corrected by what is missing; the normal scores have the correlation 2 sin(pi/6 rho) at the rank correlation
/// rho.
Matrix correlated(const Matrix& strata, const Matrix& target) {
  Matrix wanted = target.unaryExpr([](double rho) { return 2 * std::sin(std::numbers::pi / 6 * rho); });
  wanted.diagonal().setOnes();
  if (!positive_definite(wanted)) wanted = target;
  Matrix best = strata;
  double least = 2;
  for (int repetition = 0; repetition < 20 && positive_definite(wanted); ++repetition) {
    const Matrix ordered = reordered(strata, wanted);
    const Matrix missing = target - correlation(ordered);
    const double error = missing.cwiseAbs().maxCoeff();
    if (error < least) {
      least = error;
      best = ordered;
    }
    wanted += missing;
    wanted.diagonal().setOnes();
  }
  const auto error = [&target](const Matrix& ordered) { return (target - correlation(ordered)).cwiseAbs().maxCoeff(); };
  if (strata.rows() <= 200)  // with more samples the error is small, and exchanges take long
    for (int sweep = 0; sweep < 10 && error(best) > 0.02; ++sweep) exchange(best, target);
  return best;
}

LatinHypercube placed(const Matrix& strata, std::uint64_t seed) {
  const CounterRandom random(seed, place_stream);
  const double n = static_cast<double>(strata.rows());
  LatinHypercube result{strata, correlation(strata)};
  for (Index j = 0; j < strata.cols(); ++j)
    for (Index i = 0; i < strata.rows(); ++i) {
      const double within = random.uniform(static_cast<std::uint64_t>(strata(i, j)), static_cast<std::uint32_t>(j));
      result.probability(i, j) = std::min((strata(i, j) + within) / n, std::nextafter((strata(i, j) + 1) / n, 0.0));
    }
  return result;
}

}  // namespace

Matrix rank_correlation(const Matrix& columns) {
  Matrix rank(columns.rows(), columns.cols());
  for (Index j = 0; j < columns.cols(); ++j) rank.col(j) = ranks(columns.col(j));
  return correlation(rank);
}

OrRefused<LatinHypercube> latin_hypercube(Index samples, const Matrix& target, std::uint64_t seed) {
  const Index variables = target.rows();
  assert(samples >= 1 && variables >= 1 && target.cols() == variables);
  if (!target.allFinite() || (target - target.transpose()).cwiseAbs().maxCoeff() > 1e-12 ||
      (target.diagonal().array() - 1).abs().maxCoeff() > 1e-12)
    return Refused{"the matrix of correlations is not symmetric with ones on its diagonal"};
  const double smallest = SymmetricEigen(target).eigenvalues()[0];
  if (!(smallest > 1e-10))
    return Refused{fmt::format("the matrix of correlations is not positive definite (smallest eigenvalue {:.3g})", smallest)};
  if (samples <= variables)
    return Refused{fmt::format("{} samples cannot correlate {} variables: more samples than variables are needed", samples, variables)};
  return placed(correlated(random_strata(samples, variables, seed), target), seed);
}

LatinHypercube latin_hypercube(Index samples, Index variables, std::uint64_t seed) {
  assert(samples >= 1 && variables >= 1);
  const Matrix strata = random_strata(samples, variables, seed);
  return placed(samples > variables ? correlated(strata, Matrix::Identity(variables, variables)) : strata, seed);
}

}  // namespace uplift
