#include "uplift/dynamics/plastic_newton.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "uplift/math/dense.h"

namespace uplift {

namespace {

constexpr std::size_t mixing_depth = 5;
constexpr int patience = 5;
/// Part of the forces that is left: from there on their sizes are those of the iteration before.
constexpr double near_balance = 0.1;

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
  const Sparse full = step.weight * bulk_.softening(step.start.displacement + increment, {step.old, step.at, step.duration}, now, whole_);
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
  duration_ = flow_share_ = 0;
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

/// Goes over to the tangent of a state, and takes the whole step from there. Fails where no tangent serves.
bool PlasticNewton::begin_newton(const Step& step, const Make& make, const Vector& increment, const PlasticState& now) {
  if (!soften(step, make, increment, now)) return false;
  mixing_->forget();
  given_ = step.right - step.weight * now.force + softening_ * increment;
  return true;
}

/// The line search along the step that begin_newton has just given, from the state with that increment and the residual `change_`.
void PlasticNewton::begin_search(const Vector& increment) {
  search_ = {given_ - change_, change_, increment, {}, LineSearch(0)};
}

/// What the state that a share of the step has led to says: true when another share is to be tried.
bool PlasticNewton::searches_on(const Vector& increment) {
  Search& s = *search_;
  if (s.way.size() == 0) {
    s.way = increment - s.increment;
    s.line = LineSearch(s.way.dot(s.rest));
  }
  if (!s.line.goes_on(s.way.dot(change_))) return false;
  given_ = s.given + s.line.share() * s.rest;
  return true;
}

/// Where a law has no answer: a step of half the length.
bool PlasticNewton::shorten_search() {
  if (!search_) return false;
  search_->rest *= 0.5 * search_->line.share();
  search_->way.resize(0);
  search_->line = LineSearch(0);
  given_ = search_->given + search_->rest;
  return true;
}

/// A load step that goes on as the last one, which yielded so much that it took tangents: with the tangent where that leads to.
bool PlasticNewton::expect_flow(const Step& step, const Make& make, Vector& increment, PlasticState& now) {
  if (!(step.share > 0) || !(flow_share_ > 0)) return false;
  increment = step.share / flow_share_ * flow_;
  moved_ = step.start.displacement + increment;
  return bulk_.respond(moved_, {step.old, step.at, step.duration}, now, &size_).converged && begin_newton(step, make, increment, now);
}

void PlasticNewton::remember_flow(const Step& step, const Vector& increment) {
  flow_share_ = softening_.size() > 0 && whole_ ? step.share : 0;
  if (flow_share_ > 0) flow_ = increment;
}

Outcome PlasticNewton::solve(const Step& step, StepSolver& elastic, const Make& make, Vector& increment, PlasticState& now) {
  const auto begin = [&] {
    last_ = &elastic;
    now.history = step.old.history;  // so that a step does not depend on those before it
    softening_.resize(0, 0);
    residuals_.clear();
    search_.reset();
    mixing_->forget();
  };
  const bool may_soften = options_.newton != PlasticOptions::Newton::modified;
  Outcome flowing;
  begin();
  if (may_soften && expect_flow(step, make, increment, now)) {
    flowing = iterate(step, make, increment, now);
    if (flowing.converged) return flowing;
  }
  begin();
  given_ = step.right - step.weight * step.old.force;
  expect_growth(step);
  Outcome outcome = iterate(step, make, increment, now);
  outcome.iterations += flowing.iterations;
  outcome.cycles += flowing.cycles;
  if (!outcome.converged) forget();
  return outcome;
}

Outcome PlasticNewton::iterate(const Step& step, const Make& make, Vector& increment, PlasticState& now) {
  Outcome outcome;
  int since = 0;  // iterations with the present factor
  const bool may_soften = options_.newton != PlasticOptions::Newton::modified;
  bool newton = softening_.size() > 0 && whole_;  // a new tangent after every step
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
    const bool sizes_known = !residuals_.empty() && residuals_.back() < near_balance;
    if (const BulkResponse response = bulk_.respond(moved_, {step.old, step.at, step.duration}, now, sizes_known ? nullptr : &size_);
        !response.converged) {
      now.history = step.old.history;  // the next update begins anew, not where this one has failed
      if (shorten_search()) continue;
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
      remember_flow(step, increment);
      return outcome;
    }
    if (search_ && searches_on(increment)) continue;
    ++since;
    search_.reset();
    if (may_soften && (newton || wants_tangent(since)) && begin_newton(step, make, increment, now)) {
      since = 0;
      newton = whole_;
      if (newton) begin_search(increment);
    } else {
      newton = false;
      mixing_->mix(weight_, change_, given_);
    }
  }
  outcome.why = fmt::format("yielding solids: no balance in {} iterations, {:.1e} of their forces are left", residuals_.size(),
                            residuals_.empty() ? 0 : residuals_.back());
  return outcome;
}

}  // namespace uplift
