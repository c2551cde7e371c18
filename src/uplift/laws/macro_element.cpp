#include "uplift/laws/macro_element.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>

#include "uplift/laws/macro_filter.h"
#include "uplift/laws/macro_rows.h"

namespace uplift {
namespace {

constexpr int most_halvings = 12;  // of an increment whose return fails
constexpr int never = most_halvings + 1;

}  // namespace

/// One step of a point, in as many increments as the return needs. Derivatives are those with respect to the end of the path.
class MacroElement::Path {
 public:
  Path(const MacroElement& law, bool average, const MacroVector& from, const MacroVector& to, const MacroVector& old_plastic,
       const double (&old)[macro_scalars], int guesses_from)
      : plastic(old_plastic),
        memory{old[0], old[1], old[2]},
        law_(&law),
        average_(average),
        guesses_from_(guesses_from),
        from_(from),
        step_(to - from),
        start_(from - old_plastic) {}

  /// False when the return fails.
  bool go() { return go(0, 1, 0); }
  /// Adds the joint filter to the mean; `pull`: C d_f.
  MacroFilter filter(double gain, const MacroVector& pull);

  MacroVector plastic, mean = MacroVector::Zero(), end = MacroVector::Zero();
  MacroMatrix mean_slope = MacroMatrix::Zero(), end_slope = MacroMatrix::Zero();
  double memory[macro_scalars];

 private:
  bool go(double a, double b, int depth);
  void add_average(double a, double b, const MacroVector& before, const MacroMatrix& before_slope, const MacroElastic& at_before,
                   const MacroReturned& now, const MacroMatrix& now_slope, const MacroVector& yielded);

  const MacroElement* law_;
  bool average_;
  int guesses_from_;                 // the return tries every first guess after so many halvings
  MacroVector from_, step_, start_;  // start_: elastic displacement at the beginning
  MacroMatrix plastic_slope_ = MacroMatrix::Zero();
  MacroVector settlement_slope_ = MacroVector::Zero();
};

/// The part of the path between the shares a and b; halved where the return fails.
bool MacroElement::Path::go(double a, double b, int depth) {
  const MacroVector before = from_ + a * step_ - plastic, trial = from_ + b * step_ - plastic;
  const MacroReturned now = macro_return(law_->uplift_, law_->surfaces_, trial, memory[macro_memory_settlement], depth >= guesses_from_);
  if (!now.converged) {
    const double middle = 0.5 * (a + b);
    return depth < most_halvings && go(a, middle, depth + 1) && go(middle, b, depth + 1);
  }
  const MacroElastic at_before = law_->uplift_.respond(before, false);
  const MacroMatrix one = MacroMatrix::Identity(), before_slope = a * one - plastic_slope_;
  const MacroMatrix now_slope = now.by_trial * (b * one - plastic_slope_) + now.by_settlement * settlement_slope_.transpose();
  const MacroVector yielded = trial - now.elastic;  // with the shear that a footing without contact forgets
  if (average_)
    add_average(a, b, before, before_slope, at_before, now, now_slope, yielded);
  else
    memory[macro_memory_dissipated] += now.at.force.dot(yielded) + (now.at.contact ? 0 : at_before.shear_energy);

  plastic += yielded;
  const MacroMatrix yielded_slope = (b * one - now_slope) - plastic_slope_;
  plastic_slope_ += yielded_slope;
  memory[macro_memory_settlement] += std::abs(yielded[macro_n]);
  settlement_slope_ += (yielded[macro_n] < 0 ? -1 : 1) * yielded_slope.row(macro_n).transpose();
  if (now.at.contact) memory[macro_memory_slip] += std::hypot(yielded[macro_h1], yielded[macro_h2]);
  end = now.at.force;
  end_slope = now.at.stiffness * now_slope;
  return true;
}

/// Adds the discrete gradient of the increment. Where the average over a long increment would feed energy in (a reversal while N changes
/// much), it is raised along the increment until nothing is dissipated.
void MacroElement::Path::add_average(double a, double b, const MacroVector& before, const MacroMatrix& before_slope,
                                     const MacroElastic& at_before, const MacroReturned& now, const MacroMatrix& now_slope,
                                     const MacroVector& yielded) {
  MacroUplift::Average average = law_->uplift_.average(before, at_before, now.elastic, now.at);
  MacroMatrix slope = average.by_from * before_slope + average.by_to * now_slope;
  const double share = b - a;
  const double dissipated = average.force.dot(yielded);
  const MacroVector scaled = law_->uplift_.stiffness().cwiseProduct(share * step_);
  const double square = scaled.dot(share * step_);
  if (dissipated < 0 && square > 0) {
    const MacroMatrix yielded_slope = (b * MacroMatrix::Identity() - now_slope) - plastic_slope_;
    const double raise = -dissipated / square;
    const MacroVector by_to =
        -(slope.transpose() * yielded + yielded_slope.transpose() * average.force + 2 * raise * share * scaled) / square;
    average.force += raise * scaled;
    slope += scaled * by_to.transpose();
    slope.diagonal() += raise * share * law_->uplift_.stiffness();
  } else {
    memory[macro_memory_dissipated] += dissipated;
  }
  mean += share * average.force;
  mean_slope += share * slope;
}

MacroFilter MacroElement::Path::filter(double gain, const MacroVector& pull) {
  const MacroMatrix coefficient = gain * law_->uplift_.respond(start_).stiffness;
  const MacroMatrix elastic_slope = MacroMatrix::Identity() - plastic_slope_;
  const MacroFilterStep step{.increment = step_,
                             .elastic = from_ + step_ - plastic - start_,
                             .elastic_slope = elastic_slope,
                             .mean = mean,
                             .mean_slope = mean_slope,
                             .dissipated = memory[macro_memory_dissipated],
                             .dissipated_slope = mean_slope.transpose() * step_ + mean - elastic_slope.transpose() * end};
  MacroFilter added = macro_filter(law_->elasticity(), coefficient, pull, step);
  mean += added.force;
  mean_slope += added.slope;
  memory[macro_memory_dissipated] = std::max(0.0, memory[macro_memory_dissipated] + added.dissipated);
  return added;
}

MacroElement::MacroElement(const MacroParameters& parameters)
    : uplift_(parameters.elasticity), surfaces_(uplift_.elasticity(), parameters.strength), torsion_(parameters.torsion) {}

int MacroElement::num_history(int components) const {
  return (components == 6 ? 5 : 3) + macro_scalars;
}

void MacroElement::advance(bool average, const Batch& batch, const double* from, const double* to, const double* old,
                           const LawResponse& response) const {
  const int n = batch.points;
  const bool filters = average && batch.coefficient != nullptr;
  for (int i = 0; i < n; ++i) {
    const Rows rows(n, i, batch.components);
    if (rows.has_torsion()) put_torsion(average, rows, from, to, response);
    if (rows.has_torsion() ? go_elastically<2>(average, batch, rows, from, to, old, response)
                           : go_elastically<1>(average, batch, rows, from, to, old, response))
      continue;
    double scalars[macro_scalars];
    for (int k = 0; k < macro_scalars; ++k) scalars[k] = old[(rows.count + k) * n + i];
    // summed up within the step first: thousands of sub-steps would each be rounded to the digits of the whole
    const double dissipated_before = std::exchange(scalars[macro_memory_dissipated], 0);
    const auto start = [&](int guesses_from) {
      return Path(*this, average, rows.get(from), rows.get(to), rows.get(old), scalars, guesses_from);
    };
    // guesses that help only sometimes come last: else round-off decides how often an increment is halved
    Path path = start(never);
    if (!path.go() && !(path = start(most_halvings)).go() && !(path = start(0)).go()) {
      path = start(never);
      path.mean.setConstant(std::numeric_limits<double>::quiet_NaN());
      path.end = path.mean;
    }
    if (filters) rows.put(path.mean, response.plain);
    MacroFilter filter;
    if (filters && batch.coefficient[i] > 0) filter = path.filter(batch.gain, rows.get(batch.lag));
    path.memory[macro_memory_dissipated] += dissipated_before;
    rows.put(average ? path.mean : path.end, response.traction);
    if (response.slope != nullptr) rows.put(average ? path.mean_slope : path.end_slope, 1, response.slope);
    if (response.end != nullptr) rows.put(path.end, response.end);
    if (response.next != nullptr) rows.put(path.end_slope, 0.5, response.next);
    if (response.now != nullptr) {
      rows.put(path.plastic, response.now);
      for (int k = 0; k < macro_scalars; ++k) response.now[(rows.count + k) * n + i] = path.memory[k];
    }
    if (!filters) continue;
    if (batch.coefficient[i] > 0)
      rows.filter_torsion(filter, batch.gain * torsion_, batch, from, to, response);
    else
      rows.take_end(from, to, response);
  }
}

void MacroElement::respond(const Batch& batch, const double* from, const double* to, const double* old, const LawResponse& response) const {
  advance(false, batch, from, to, old, response);
}

void MacroElement::mean(const Batch& batch, const double* from, const double* to, const double* old, const LawResponse& response) const {
  advance(true, batch, from, to, old, response);
}

/// Forces without stiffness.
MacroElastic MacroElement::respond_without_yielding(const Rows& rows, const MacroVector& elastic) const {
  return rows.has_torsion() ? uplift_.respond<2>(elastic, false) : uplift_.respond<1>(elastic, false);
}

void MacroElement::energy(const Batch& batch, const double* opening, const double* history, double* stored, double* dissipated) const {
  for (int i = 0; i < batch.points; ++i) {
    const Rows rows(batch.points, i, batch.components);
    if (stored != nullptr) {
      const MacroElastic at = respond_without_yielding(rows, rows.get(opening) - rows.get(history));
      const double twist = rows.has_torsion() ? opening[rows.at(batch.components - 1)] : 0;
      stored[i] = at.energy + at.shear_energy + 0.5 * torsion_ * twist * twist;
    }
    if (dissipated != nullptr) dissipated[i] = history[(rows.count + macro_memory_dissipated) * batch.points + i];
  }
}

void MacroElement::closed_stiffness(int components, double* stiffness) const {
  const Rows rows(1, 0, components);
  for (int r = 0; r < rows.count; ++r) stiffness[r] = uplift_.stiffness()[rows.variable[r]];
  if (rows.has_torsion()) stiffness[components - 1] = torsion_;
}

FootingContact MacroElement::contact(const Batch& batch, const double* opening, const double* history) const {
  const Rows rows(batch.points, 0, batch.components);
  const MacroVector elastic = rows.get(opening) - rows.get(history);
  const MacroElasticity& ground = uplift_.elasticity();
  const double one = ground.length[0] * std::abs(elastic[macro_m1]), two = ground.length[1] * std::abs(elastic[macro_m2]);
  const double edge = 0.5 * (ground.disc ? std::sqrt(one * one + two * two) : one + two), toe = elastic[macro_n] + edge;
  const MacroElastic at = respond_without_yielding(rows, elastic);
  const double open = 1 - at.contact_share;
  // what has lifted off is straight: its slope is the rotation
  FootingContact made{open, at.contact ? open * std::sqrt(one * one + two * two) : edge - elastic[macro_n], -toe};
  if (surfaces_.has_bearing()) {
    made.bearing_capacity = surfaces_.capacity(history[rows.count + macro_memory_settlement]);
    made.bearing_utilisation = std::min(1.0, surfaces_.bearing_utilisation(at.force, made.bearing_capacity));
  }
  if (surfaces_.has_sliding()) made.sliding_utilisation = std::min(1.0, surfaces_.sliding_utilisation(at.force));
  return made;
}

MacroState MacroElement::state(int components, const double* opening, const double* history) const {
  const Rows rows(1, 0, components);
  const MacroVector plastic = rows.get(history);
  const MacroElastic at = respond_without_yielding(rows, rows.get(opening) - plastic);
  const double* scalars = history + rows.count;
  return {.vertical = at.force[macro_n],
          .heave = at.heave,
          .uplifted_share = 1 - at.contact_share,
          .bearing = surfaces_.bearing_utilisation(at.force, surfaces_.capacity(scalars[macro_memory_settlement])),
          .sliding = surfaces_.sliding_utilisation(at.force),
          .settlement = plastic[macro_n],
          .accumulated = scalars[macro_memory_settlement],
          .slip = scalars[macro_memory_slip],
          .dissipated = scalars[macro_memory_dissipated]};
}

}  // namespace uplift
