#include "uplift/dynamics/plastic_newton.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "uplift/math/dense.h"
#include "uplift/math/line_search.h"

namespace uplift {

namespace {

constexpr std::size_t mixing_depth = 5;
constexpr int patience = 5;

}  // namespace

/// Anderson's mixing: the iterations before tell how y answers its own change.
class PlasticNewton::Mixing {
 public:
  void forget() { count_ = 0; }
  /// Moves y on by its change, both of this iteration.
  void mix(const Vector& weight, const Vector& change, Vector& y) {
    remember(y, change);
    if (count_ > 1) {
      const Index steps = static_cast<Index>(count_) - 1;
      y_steps_.resize(y.size(), steps);
      change_steps_.resize(y.size(), steps);
      for (Index k = 0; k < steps; ++k) {
        const auto at = static_cast<std::size_t>(k);
        y_steps_.col(k) = y_[at + 1] - y_[at];
        change_steps_.col(k) = change_[at + 1] - change_[at];
      }
      least_squares_->setThreshold(1e-10);
      least_squares_.compute(weight.asDiagonal() * change_steps_);
      y -= (y_steps_ + change_steps_) * least_squares_.solve(weight.cwiseProduct(change));
    }
    y += change;
  }

 private:
  void remember(const Vector& y, const Vector& change) {
    if (count_ > mixing_depth) {
      std::rotate(y_.begin(), y_.begin() + 1, y_.end());
      std::rotate(change_.begin(), change_.begin() + 1, change_.end());
      --count_;
    }
    y_[count_] = y;
    change_[count_++] = change;
  }

  std::array<Vector, mixing_depth + 1> y_, change_;  // oldest first; `count_` of them count
  std::size_t count_ = 0;
  Matrix y_steps_, change_steps_;
  CompleteQr least_squares_;
};

PlasticNewton::PlasticNewton(const PlasticBulk& bulk, Vector diagonal, const PlasticOptions& options)
    : bulk_(bulk), options_(options), weight_(std::move(diagonal)), mixing_(std::make_unique<Mixing>()) {
  for (double& w : weight_) w = w > 0 ? 1 / std::sqrt(w) : 0;
}

PlasticNewton::~PlasticNewton() = default;

/// Goes over to the tangent of the present state. A tangent that is not positive definite (no associated flow, or no strength left) gets a
/// share of the elastic stiffness back.
bool PlasticNewton::soften(const Step& step, const Make& make, const Vector& increment, const PlasticState& now) {
  const Sparse full = step.weight * bulk_.softening(step.start.displacement + increment, {step.old.history, step.at, step.duration}, now);
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

void PlasticNewton::forget() {
  duration_ = 0;
}

/// What yielding has added to its forces in steps of the same length, continued as a parabola, goes into the first y.
void PlasticNewton::expect_growth(const Step& step) {
  if (duration_ > 0 && step.duration == duration_) given_ -= step.weight * (2 * growth_ - growth_before_);
}

void PlasticNewton::remember_growth(const Step& step, const PlasticState& now) {
  growth_before_.swap(growth_);
  growth_ = now.force - step.old.force;
  if (duration_ == 0 || step.duration != duration_) growth_before_ = growth_;
  duration_ = step.duration;
}

Outcome PlasticNewton::solve(const Step& step, StepSolver& elastic, const Make& make, Vector& increment, PlasticState& now) {
  Outcome outcome;
  last_ = &elastic;
  softening_.resize(0, 0);
  residuals_.clear();
  mixing_->forget();
  given_ = step.right - step.weight * step.old.force;
  expect_growth(step);
  int since = 0;  // iterations with the present factor
  const bool may_soften = options_.newton != PlasticOptions::Newton::modified;
  std::optional<LineSearch> search;
  for (int iteration = 0; iteration < options_.iterations; ++iteration) {
    const Outcome inner = last_->solve(given_, step.start, increment);
    outcome.iterations += inner.iterations;
    outcome.cycles += inner.cycles;
    if (!inner.converged) {
      outcome.why = inner.why;
      return outcome;
    }
    moved_ = step.start.displacement + increment;
    if (!moved_.allFinite()) break;
    if (const BulkResponse response = bulk_.respond(moved_, {step.old.history, step.at, step.duration}, now, size_); !response.converged) {
      if (search) {  // a step of half the length
        searched_.rest *= 0.5 * search->share();
        searched_.way.resize(0);
        search.emplace(0.0);
        given_ = searched_.given + searched_.rest;
        continue;
      }
      outcome.why = response.why;
      return outcome;
    }
    change_ = step.right - step.weight * now.force - given_;  // y of this state less the one that led to it
    if (softening_.size() > 0) change_ += softening_ * increment;
    const double size = weight_.cwiseProduct(size_).norm(), rest = weight_.cwiseProduct(change_).norm();
    residuals_.push_back(size > 0 ? rest / size : 0);
    if (!(rest > options_.tolerance * size)) {
      outcome.converged = true;
      remember_growth(step, now);
      return outcome;
    }
    if (search) {
      if (searched_.way.size() == 0) {
        searched_.way = increment - searched_.increment;
        search.emplace(searched_.way.dot(searched_.rest));
      }
      if (search->goes_on(searched_.way.dot(change_))) {
        given_ = searched_.given + search->share() * searched_.rest;
        continue;
      }
    }
    ++since;
    if (may_soften && (search || wants_tangent(since)) && soften(step, make, increment, now)) {
      since = 0;
      mixing_->forget();
      given_ = step.right - step.weight * now.force + softening_ * increment;
      searched_.given = given_ - change_;
      searched_.rest = change_;
      searched_.increment = increment;
      searched_.way.resize(0);
      search.emplace(0.0);
      continue;
    }
    search.reset();
    mixing_->mix(weight_, change_, given_);
  }
  outcome.why = fmt::format("yielding solids: no balance in {} iterations, {:.1e} of their forces are left", residuals_.size(),
                            residuals_.empty() ? 0 : residuals_.back());
  return outcome;
}

}  // namespace uplift
