#include "uplift/dynamics/joint_filter.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <type_traits>

#include "uplift/math/fixed.h"
#include "uplift/math/lanes.h"

namespace uplift {
namespace {

/// What a row begins a step with.
struct Beginning {
  double gain, closed, stuck;  // b; half of the closed joint's stiffness: normal, of the row [Pa/m]
  bool normal;

  /// `contact`, `slope`: of the law in the normal and in the row; `before`, `remembered`: coefficient and filtered increment.
  template <class At>
  [[gnu::always_inline]] void put(const At& at, Lanes contact, Lanes slope, Lanes before, Lanes remembered, double* coefficient,
                                  double* lag) const {
    const Lanes zero = 0;
    const LaneMask touches = contact >= closed;
    const Lanes here = normal ? choose(touches, gain * slope, Lanes(-1))
                              : choose(touches || (slope >= stuck && slope > zero), Lanes(2 * gain * stuck), zero);
    const LaneMask acts = here > zero, grows = acts && before < here;
    if (any(grows)) remembered *= std::experimental::sqrt(choose(grows, before / choose(grows, here, Lanes(1)), Lanes(1)));
    at.put(coefficient, here);
    at.put(lag, choose(acts, remembered, zero));
  }
};

}  // namespace

JointFilter::JointFilter(const Model& model, const Behaviours& behaviours, const Scheme& scheme)
    : blocks_(blocks_of(model, behaviours).blocks), pole_(scheme.pole), gain_(scheme.gain) {
  int slopes = 0;
  for (const Block& block : blocks_) {
    if (block.batch.rotations > 0) {
      const int n = block.batch.components;
      assert(n == 3 || n == 6);
      footings_.push_back({.law = block.law, .first = block.first, .first_history = block.first_history, .components = n});
      slopes += block.slopes();
      continue;
    }
    Part part{.first = block.first,
              .first_slope = slopes,
              .points = block.batch.points,
              .components = block.batch.components,
              .area = block.area};
    if (block.law != nullptr) block.law->closed_stiffness(part.components, part.stiffness);
    slopes += block.slopes();
    parts_.push_back(std::move(part));
  }
}

void JointFilter::begin_anew(const State& now, FilterMemory& memory) const {
  for (const Block& block : blocks_) {
    if (block.law == nullptr || block.batch.rotations > 0) continue;
    const int n = block.batch.points, components = block.batch.components, normal = components - 1;
    Vector traction(block.rows()), end(block.rows()), slope(block.rows() * components), next(block.rows() * components),
        history(block.law->num_history(components) * n);
    const double* at = now.opening.data() + block.first;
    next.setZero();
    block.law->mean(block.batch, at, at, now.history.data() + block.first_history,
                    {.traction = traction.data(), .slope = slope.data(), .now = history.data(), .end = end.data(), .next = next.data()});
    double stiffness[3] = {};
    block.law->closed_stiffness(components, stiffness);
    next *= 2;
    const double* contact = next.data() + (normal * components + normal) * n;
    for (int c = 0; c < components; ++c) {
      const Beginning beginning{gain_, 0.5 * stiffness[normal], 0.5 * stiffness[c], c == normal};
      const double* tangent = next.data() + (c * components + c) * n;
      double *coefficient = memory.coefficient.data() + block.first + c * n, *lag = memory.opening.data() + block.first + c * n;
      for_lanes(n, [&](const auto& here) { beginning.put(here, here(contact), here(tangent), Lanes(0), Lanes(0), coefficient, lag); });
    }
  }
}

void JointFilter::take_over(const State& now) {
  taken_over_ = {.gain = gain_, .pole = pole_, .coefficient = now.filter.coefficient, .lag = now.filter.opening};
  ready_ = &taken_over_;
  storage_ = now.filter.stored;
  for (Footing& footing : footings_) {
    std::copy_n(now.filter.opening.data() + footing.first, footing.components, footing.filtered);
    footing.stored = now.filter.coefficient[footing.first];
    look(footing, now);
    begin_footing(footing, *ready_);
  }
}

void JointFilter::give(FilterMemory& memory) const {
  if (ready_ == nullptr) return;
  memory.coefficient = ready_->coefficient;
  memory.opening = ready_->lag;
  memory.stored = storage_;
  for (const Footing& footing : footings_) {
    std::copy_n(footing.filtered, footing.components, memory.opening.data() + footing.first);
    memory.coefficient.segment(footing.first, footing.components).setZero();
    memory.coefficient[footing.first] = footing.stored;
  }
}

void JointFilter::shorten(double shrink) {
  ready_->lag *= shrink;
  for (Footing& footing : footings_) {
    for (double& each : footing.filtered) each *= shrink;
    begin_footing(footing, *ready_);
  }
}

void JointFilter::begin(JointFilterInput& input) {
  if (ready_ == &input) return;
  input = *ready_;
  ready_ = &input;
}

/// Elastic openings and C = b * slope of the law there.
void JointFilter::look(Footing& footing, const State& now) const {
  const int n = footing.components;
  footing.law->elastic(n, now.opening.data() + footing.first, now.history.data() + footing.first_history, footing.elastic,
                       footing.coefficient);
  for (int i = 0; i < n * n; ++i) footing.coefficient[i] *= gain_;
}

void JointFilter::begin_footing(Footing& footing, JointFilterInput& input) {
  footing.components == 3 ? begin_rows<3>(footing, input) : begin_rows<6>(footing, input);
}

double JointFilter::end_footing(Footing& footing, const InterfaceSolution& solution, double to_mean, const State& now, const State& next,
                                JointFilterInput& input) const {
  return footing.components == 3 ? end_rows<3>(footing, solution, to_mean, now, next, input)
                                 : end_rows<6>(footing, solution, to_mean, now, next, input);
}

/// After look(): what the filter remembers is scaled down where it would store more with the new C. N: rows of the point.
template <int N>
void JointFilter::begin_rows(Footing& footing, JointFilterInput& input) {
  const int first = footing.first;
  const Eigen::Map<const Fixed<N, N>> coefficient(footing.coefficient);
  Fixed<N, 1> lag = Eigen::Map<const Fixed<N, 1>>(footing.filtered), pull = coefficient * lag;
  const double wanted = lag.dot(pull);
  if (wanted > footing.stored) {
    const double scale = std::sqrt(footing.stored / wanted);
    lag *= scale, pull *= scale;
  }
  Eigen::Map<Fixed<N, 1>>(footing.lag) = lag;
  input.coefficient.segment<N>(first).setConstant(coefficient.diagonal().isZero(0) ? -1 : 1);
  input.lag.segment<N>(first) = pull;
}

/// The same as for the rows of other points with the matrix C instead of c and the elastic increment; returns the dissipation less what the
/// filter has stored before.
template <int N>
double JointFilter::end_rows(Footing& footing, const InterfaceSolution& solution, double to_mean, const State& now, const State& next,
                             JointFilterInput& input) const {
  using OfRows = Fixed<N, 1>;
  const int first = footing.first;
  const OfRows before = Eigen::Map<const OfRows>(footing.elastic), lag = Eigen::Map<const OfRows>(footing.lag);
  const Fixed<N, N> coefficient = Eigen::Map<const Fixed<N, N>>(footing.coefficient);
  look(footing, next);
  const OfRows added = to_mean * solution.force.segment<N>(first) - solution.plain.segment<N>(first);  // N, N m
  double dissipated = 0, stored = 0;
  OfRows filtered = OfRows::Zero();
  if (input.coefficient[first] > 0) {
    const OfRows increment = Eigen::Map<const OfRows>(footing.elastic) - before, ahead = increment - lag;
    const double whole = ahead.dot(coefficient * ahead), taken = added.dot(ahead);
    const double kept = whole > 0 && taken < (1 - 1e-6) * whole ? larger(taken / whole, 0.0) : 1;  // theta
    filtered = pole_ * lag + (1 - pole_) * increment;
    stored = kept * filtered.dot(coefficient * filtered);
    dissipated = kept * (0.5 * (1 + pole_) * whole - 0.5 / (1 - pole_) * lag.dot(coefficient * lag));
  } else {
    dissipated = added.dot(solution.opening.segment<N>(first) - now.opening.segment<N>(first));
  }
  Eigen::Map<OfRows>(footing.filtered) = filtered;
  footing.stored = stored;
  begin_rows<N>(footing, input);
  return dissipated;
}

/// With theta c the part of the coefficient that took effect, d_f the lag and d_f,1 the filtered increment after the step: storage
/// A theta c d_f,1^2/(2 (1 - a)), dissipation A theta c ((1 + a)/2 (d - d_f)^2 - d_f^2/(2 (1 - a))) and the storage before, which is larger
/// than what the last term takes where theta c has fallen.
void JointFilter::end(const InterfaceProblem& problem, const InterfaceSolution& solution, const State& now, const State& next,
                      JointFilterInput& input) {
  // copies: numbers written through pointers might be members
  const double to_mean = 1 / problem.model->scale, pole = pole_, gain = gain_, loss = 0.5 * (1 + pole), store = 0.5 / (1 - pole);
  Lanes dissipated = 0, storage = 0;
  for (const Part& part : parts_) {
    const int n = part.points, normal = part.components - 1;
    const double* slopes = solution.next_slope.data() + part.first_slope;
    const double *area = part.area.data(), *contact = slopes + (normal * part.components + normal) * n;
    const auto end_rows = [&](int c, auto is_normal) __attribute__((always_inline)) {
      const int first = part.first + c * n;
      const Beginning beginning{gain, 0.5 * part.stiffness[normal], 0.5 * part.stiffness[c], is_normal};
      const double *plain = solution.plain.data() + first, *force = solution.force.data() + first, *to = solution.opening.data() + first,
                   *from = now.opening.data() + first, *slope = slopes + (c * part.components + c) * n;
      double *coefficient = input.coefficient.data() + first, *lag = input.lag.data() + first;
      for_lanes(
          n, [ =, &dissipated, &storage ](const auto& at) __attribute__((always_inline)) {
            const Lanes zero = 0, tangent = 2 * at(slope), here = at(coefficient), bears = at(force), size = at(area), before = at(lag);
            // most registers go on as they are: in contact, where nothing was cut off, or apart
            if constexpr (is_normal) {
              if (!any(gain * tangent != here || bears == zero)) {
                const Lanes increment = at(to) - at(from), ahead = increment - before, weight = size * here;
                const Lanes filtered = pole * before + (1 - pole) * increment;
                dissipated += weight * (loss * ahead * ahead - store * before * before);
                storage += weight * filtered * filtered;
                return at.put(lag, filtered);
              }
              if (!any(here >= zero || tangent >= beginning.closed || bears != zero || at(plain) != zero)) return;
            }
            const Lanes increment = at(to) - at(from), ahead = increment - before;
            const Lanes added = to_mean * bears - size * at(plain), wanted = size * here * ahead;  // N
            const LaneMask acts = here > zero, less = acts && added * wanted < (1 - 1e-6) * wanted * wanted;
            Lanes kept = choose(acts, here, zero);  // theta c
            if (any(less)) kept *= choose(less, larger(added / choose(less, wanted, Lanes(1)), zero), Lanes(1));
            const Lanes filtered = choose(acts, pole * before + (1 - pole) * increment, zero), weight = size * kept;
            dissipated += weight * (loss * ahead * ahead - store * before * before) + choose(acts, zero, added * increment);
            storage += weight * filtered * filtered;
            beginning.put(at, is_normal ? tangent : 2 * at(contact), tangent, kept, filtered, coefficient, lag);
          });
    };
    for (int c = 0; c < normal; ++c) end_rows(c, std::false_type());
    end_rows(normal, std::true_type());
  }
  double lost = sum(dissipated), stored = sum(storage);
  for (Footing& footing : footings_) {
    lost += end_footing(footing, solution, to_mean, now, next, input);
    stored += footing.stored;
  }
  dissipated_ = lost + storage_;
  storage_ = store * stored;
  ready_ = &input;
}

}  // namespace uplift
