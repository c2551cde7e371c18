#include "uplift/dynamics/plastic_newton.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "uplift/math/dense.h"

namespace uplift {

namespace {

constexpr std::size_t mixing_depth = 5;
constexpr int patience = 5;

}  // namespace

PlasticNewton::PlasticNewton(const PlasticBulk& bulk, const Sparse& stiffness, const PlasticOptions& options)
    : bulk_(bulk), options_(options), weight_(stiffness.diagonal()) {
  for (double& w : weight_) w = w > 0 ? 1 / std::sqrt(w) : 0;
}

/// The next y of Anderson's mixing: the steps before tell how y answers its own change.
void PlasticNewton::mix() {
  if (given_before_.size() > mixing_depth + 1) {
    given_before_.erase(given_before_.begin());
    change_before_.erase(change_before_.begin());
  }
  const Index count = static_cast<Index>(given_before_.size());
  if (count > 1) {
    Matrix given(given_.size(), count - 1), change(given_.size(), count - 1);
    for (Index k = 0; k + 1 < count; ++k) {
      const auto at = static_cast<std::size_t>(k);
      given.col(k) = given_before_[at + 1] - given_before_[at];
      change.col(k) = change_before_[at + 1] - change_before_[at];
    }
    CompleteQr least_squares;
    least_squares->setThreshold(1e-10);
    least_squares.compute(weight_.asDiagonal() * change);
    const Vector share = least_squares.solve(weight_.cwiseProduct(change_));
    given_ -= (given + change) * share;
  }
  given_ += change_;
}

/// Goes over to the tangent of the present state. A tangent that is not positive definite (no associated flow, or no strength left) gets a
/// share of the elastic stiffness back.
bool PlasticNewton::soften(const Step& step, const Make& make, const Vector& increment, const PlasticState& now) {
  const Sparse full = step.weight * bulk_.softening(step.start.displacement + increment, step.at, step.old.history, now);
  std::string why;
  for (const double share : {1.0, 0.9, 0.5}) {
    const Sparse softening = share * full;
    auto made = make(softening, why);
    if (made == nullptr) continue;
    softening_ = softening;
    tangent_ = std::move(made);
    last_ = tangent_.get();
    return true;
  }
  return false;
}

/// After so many iterations with one factor. A symmetric part alone may lead away from the solution: it then stays for as long as mixing
/// needs to make use of it.
bool PlasticNewton::wants_tangent(int since) const {
  const std::size_t count = residuals_.size();
  if (options_.newton == PlasticOptions::Newton::full && (count < 2 || residuals_[count - 1] < residuals_[count - 2])) return true;
  if (since <= patience) return false;
  if (options_.newton == PlasticOptions::Newton::full) return true;
  return residuals_[count - 1] > std::pow(options_.slow, patience) * residuals_[count - 1 - patience];
}

Outcome PlasticNewton::solve(const Step& step, StepSolver& elastic, const Make& make, Vector& increment, PlasticState& now) {
  Outcome outcome;
  last_ = &elastic;
  softening_.resize(0, 0);
  residuals_.clear();
  given_before_.clear();
  change_before_.clear();
  given_ = step.right - step.weight * step.old.force;
  Vector moved;
  int since = 0;  // iterations with the present factor
  const bool may_soften = options_.newton != PlasticOptions::Newton::modified;
  for (int iteration = 0; iteration < options_.iterations; ++iteration) {
    const Outcome inner = last_->solve(given_, step.start, increment);
    outcome.iterations += inner.iterations;
    outcome.cycles += inner.cycles;
    if (!inner.converged) {
      outcome.why = inner.why;
      return outcome;
    }
    moved = step.start.displacement + increment;
    if (!moved.allFinite()) break;
    if (const BulkResponse response = bulk_.respond(moved, step.at, step.old.history, now, size_); !response.converged) {
      outcome.why = response.why;
      return outcome;
    }
    change_ = step.right - step.weight * now.force - given_;  // y of this state less the one that led to it
    if (softening_.size() > 0) change_ += softening_ * increment;
    const double size = weight_.cwiseProduct(size_).norm(), rest = weight_.cwiseProduct(change_).norm();
    residuals_.push_back(size > 0 ? rest / size : 0);
    if (!(rest > options_.tolerance * size)) {
      outcome.converged = true;
      return outcome;
    }
    ++since;
    if (may_soften && wants_tangent(since) && soften(step, make, increment, now)) {
      since = 0;
      given_before_.clear();
      change_before_.clear();
      given_ = step.right - step.weight * now.force + softening_ * increment;
      continue;
    }
    given_before_.push_back(given_);
    change_before_.push_back(change_);
    mix();
  }
  outcome.why = fmt::format("yielding solids: no balance in {} iterations, {:.1e} of their forces are left", residuals_.size(),
                            residuals_.empty() ? 0 : residuals_.back());
  return outcome;
}

}  // namespace uplift
