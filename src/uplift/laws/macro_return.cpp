#include "uplift/laws/macro_return.h"

#include <algorithm>
#include <cmath>

#include "uplift/laws/macro_landing.h"
#include "uplift/math/small.h"

namespace uplift {
namespace {

constexpr double yield_tolerance = 1e-12;  // of V
constexpr int size_most = 7;

/// V, or a force where V is infinite [N].
double scale_of(const MacroSurfaces& surfaces, const MacroVector& force, double settlement) {
  const double v = surfaces.capacity(settlement);
  return std::isfinite(v) ? v : std::max(force.head<3>().cwiseAbs().maxCoeff(), 1e-300);
}

/// `scale`: of the tolerance [N].
bool within_bearing(const MacroSurfaces& surfaces, const MacroVector& force, double v, double scale, double tolerance) {
  return !surfaces.has_bearing() || surfaces.bearing_value(force, v) <= tolerance * yield_tolerance * scale;
}
bool within_sliding(const MacroSurfaces& surfaces, const MacroVector& force, double scale, double tolerance) {
  return !surfaces.has_sliding() || surfaces.sliding(force).value <= tolerance * yield_tolerance * scale;
}

/// The surfaces that are taken to yield.
enum Active { bearing_only = 1, sliding_only = 2, both = 3 };

/// Newton's method for the elastic displacement e and the multipliers of the active surfaces. Displacements as unknowns never leave the
/// range of the forces, which is bounded by the edges of the base.
class Return {
 public:
  /// `at`: the forces at the trial state.
  Return(const MacroUplift& uplift, const MacroSurfaces& surfaces, const MacroVector& trial, const MacroElastic& at, double settlement,
         bool every_guess)
      : uplift_(uplift), surfaces_(surfaces), trial_(trial), settlement_(settlement), every_guess_(every_guess) {
    scale_ = scale_of(surfaces, at.force, settlement);
    const MacroElasticity& e = uplift.elasticity();
    row_scale_ = uplift.stiffness() / scale_;
    row_scale_[macro_m1] /= e.length[0];
    row_scale_[macro_m2] /= e.length[1];
  }

  /// `out`: the trial state in contact with a load.
  void solve(MacroReturned& out);

 private:
  struct State {
    MacroVector e = MacroVector::Zero();
    double multiplier[2] = {0, 0};  // of bearing, sliding [m]
    MacroElastic at;
    Fixed<size_most, 1> residual = Fixed<size_most, 1>::Zero();  // scaled
    double size = 0;
  };

  int unknowns() const { return 5 + (active_ == both ? 2 : 1); }
  bool bearing() const { return (active_ & bearing_only) != 0; }
  bool sliding() const { return (active_ & sliding_only) != 0; }
  double plastic_settlement(const MacroVector& e) const { return trial_[macro_n] - e[macro_n]; }
  double capacity(const MacroVector& e) const { return surfaces_.capacity(settlement_ + std::abs(plastic_settlement(e))); }

  bool within_bearing(const MacroVector& force, double v, double tolerance) const {
    return uplift::within_bearing(surfaces_, force, v, scale_, tolerance);
  }
  bool within_sliding(const MacroVector& force, double tolerance) const {
    return uplift::within_sliding(surfaces_, force, scale_, tolerance);
  }
  bool evaluate(State& state) const;
  bool newton(State& state) const;
  void jacobian(const State& state, double* a, Fixed<size_most, 6>* by_data) const;
  bool step(const State& state, State& next) const;
  bool start(double limit, State& state) const;
  bool start_with_less_shear(double share, State& state) const;
  bool guess(State& state) const;
  bool accept(const State& state) const;
  bool attempt(Active active, State& state);
  void linearise(const State& state, MacroReturned& out) const;
  bool settles() const { return surfaces_.has_bearing() && surfaces_.strength().flow == MacroStrength::Flow::settling; }
  bool start_on_edge(State& state) const;

  const MacroUplift& uplift_;
  const MacroSurfaces& surfaces_;
  MacroVector trial_, row_scale_;
  double settlement_;
  bool every_guess_;
  double scale_ = 0;  // V, or a force of the trial state where V is infinite [N]
  Active active_ = bearing_only;
};

/// Forces and residual at state.e and its multipliers; false where the surfaces have no meaning.
bool Return::evaluate(State& state) const {
  state.at = uplift_.respond(state.e);
  const MacroVector& force = state.at.force;
  if (!state.at.contact || !(force[macro_n] > 0)) return false;
  if (bearing() && !surfaces_.bears(force)) return false;
  const double v = capacity(state.e);
  MacroVector r = state.e - trial_;
  int row = 5;
  state.residual.setZero();
  if (bearing()) {
    r += state.multiplier[0] * surfaces_.bearing_flow(force, v).direction;
    state.residual[row++] = surfaces_.bearing(force, v).value / scale_;
  }
  if (sliding()) {
    r += state.multiplier[1] * surfaces_.sliding_flow(force).direction;
    state.residual[row] = surfaces_.sliding(force).value / scale_;
  }
  state.residual.head<5>() = row_scale_.cwiseProduct(r);
  state.size = state.residual.norm();
  return std::isfinite(state.size);
}

/// Matrix of Newton's method, column-major; `by_data`: -d residual/d (trial, settlement).
void Return::jacobian(const State& state, double* a, Fixed<size_most, 6>* by_data) const {
  const int n = unknowns();
  Fixed<size_most, size_most> j = Fixed<size_most, size_most>::Zero();
  const MacroVector& force = state.at.force;
  const MacroMatrix& k = state.at.stiffness;
  const double v = capacity(state.e), sign = plastic_settlement(state.e) < 0 ? -1 : 1;
  const double hardening = surfaces_.hardening(settlement_ + std::abs(plastic_settlement(state.e)));
  MacroMatrix ee = MacroMatrix::Identity();
  Fixed<size_most, 1> by_capacity = Fixed<size_most, 1>::Zero();
  int at = 5;
  if (bearing()) {
    const MacroFlow flow = surfaces_.bearing_flow(force, v);
    const MacroSurface surface = surfaces_.bearing(force, v);
    ee += state.multiplier[0] * flow.slope * k;
    j.col(at).head<5>() = row_scale_.cwiseProduct(flow.direction);
    j.row(at).head<5>() = surface.gradient.transpose() * k / scale_;
    by_capacity.head<5>() = state.multiplier[0] * row_scale_.cwiseProduct(flow.by_capacity);
    by_capacity[at++] = surface.by_capacity / scale_;
  }
  if (sliding()) {
    const MacroFlow flow = surfaces_.sliding_flow(force);
    ee += state.multiplier[1] * flow.slope * k;
    j.col(at).head<5>() = row_scale_.cwiseProduct(flow.direction);
    j.row(at).head<5>() = surfaces_.sliding(force).gradient.transpose() * k / scale_;
  }
  j.topLeftCorner<5, 5>() = row_scale_.asDiagonal() * ee;
  j.col(macro_n) -= sign * hardening * by_capacity;
  for (int c = 0; c < n; ++c)
    for (int r = 0; r < n; ++r) a[c * n + r] = j(r, c);
  if (by_data == nullptr) return;
  by_data->setZero();
  by_data->topLeftCorner<5, 5>() = row_scale_.asDiagonal();
  by_data->col(macro_n) -= sign * hardening * by_capacity;
  by_data->col(5) = -hardening * by_capacity;
}

/// One damped step of Newton's method; false when the residual does not fall.
bool Return::step(const State& state, State& next) const {
  const int n = unknowns();
  double a[size_most * size_most], d[size_most];
  jacobian(state, a, nullptr);
  for (int i = 0; i < n; ++i) d[i] = -state.residual[i];
  if (!small::gauss_solve<0>(n, a, d)) return false;
  double alpha = 1;
  for (int trial = 0; trial < 10; ++trial, alpha *= 0.5) {
    next = state;
    for (int i = 0; i < 5; ++i) next.e[i] += alpha * d[i];
    int at = 5;
    if (bearing()) next.multiplier[0] += alpha * d[at++];
    if (sliding()) next.multiplier[1] += alpha * d[at];
    if (evaluate(next) && next.size <= (1 - 1e-3 * alpha) * state.size) return true;
  }
  return false;
}

bool Return::newton(State& state) const {
  constexpr double enough = 1e-11, round_off = 1e-15;
  State next;
  for (int iteration = 0; iteration < 40; ++iteration) {
    if (state.size <= round_off || !step(state, next)) break;
    state = next;
  }
  return state.size <= enough;
}

/// A first guess: the trial forces, shortened to within the surfaces; `limit`: the largest share of V for N.
bool Return::start(double limit, State& state) const {
  const MacroElasticity& e = uplift_.elasticity();
  const double v = capacity(trial_);
  state = {};
  state.e = trial_;
  if (limit > 0) {
    MacroVector force = uplift_.respond(trial_).force;
    const double n = force[macro_n] = std::min(force[macro_n], limit * v);
    const double shear = std::hypot(force[macro_h1], force[macro_h2]), shear_limit = active_ == sliding_only ? shear : 0.1 * n;
    if (shear > shear_limit) force.segment<2>(macro_h1) *= shear_limit / shear;
    double excess = 1;
    for (int i = 0; i < 2; ++i) excess = std::max(excess, std::abs(force[macro_m1 + i]) / (0.3 * n * e.length[i] * (1 - n / v)));
    if (active_ == sliding_only) excess = 1;
    force.tail<2>() /= excess;
    state.e = uplift_.displacement(force);
  }
  return limit > 0 ? guess(state) : evaluate(state);
}

/// The trial state with so much shear, of its N: where the footing lands on its toe N is next to nothing, and a moment that is cut leads
/// far away.
bool Return::start_with_less_shear(double share, State& state) const {
  state = {};
  state.e = trial_;
  const MacroVector force = uplift_.respond(trial_).force;
  const double shear = std::hypot(force[macro_h1], force[macro_h2]), most = share * force[macro_n];
  if (!(shear > most)) return false;
  state.e.segment<2>(macro_h1) *= most / shear;
  return guess(state);
}

/// Completes a first guess of the displacement by its multiplier.
bool Return::guess(State& state) const {
  const MacroVector force = uplift_.respond(state.e).force, lost = trial_ - state.e;
  const auto project = [&](const MacroVector& direction) {
    const MacroVector scaled = uplift_.stiffness().cwiseProduct(direction);
    return std::max(scaled.dot(lost) / scaled.dot(direction), 0.0);
  };
  if (bearing())
    state.multiplier[0] = project(surfaces_.bearing_flow(force, capacity(state.e)).direction);
  else
    state.multiplier[1] = project(surfaces_.sliding_flow(force).direction);
  return evaluate(state);
}

/// Multipliers of the right sign and no surface exceeded.
bool Return::accept(const State& state) const {
  const double least = -1e-10 * scale_ / uplift_.elasticity().vertical;
  if (state.multiplier[0] < least || state.multiplier[1] < least) return false;
  return (bearing() || within_bearing(state.at.force, capacity(state.e), 10)) && (sliding() || within_sliding(state.at.force, 10));
}

bool Return::attempt(Active active, State& state) {
  active_ = active;
  if ((bearing() && !surfaces_.has_bearing()) || (sliding() && !surfaces_.has_sliding())) return false;
  for (const double limit : {0.0, 0.97, 0.3})
    if (start(limit, state) && newton(state) && accept(state)) return true;
  for (const double share : {0.95, 0.7, 0.3, 0.05})
    if (start_with_less_shear(share, state) && newton(state) && accept(state)) return true;
  return start_on_edge(state) && newton(state) && accept(state);
}

/// d e/d trial and d e/d settlement of the converged state.
void Return::linearise(const State& state, MacroReturned& out) const {
  const int n = unknowns();
  double a[size_most * size_most], factor[size_most * size_most], x[size_most];
  Fixed<size_most, 6> by_data;
  jacobian(state, a, &by_data);
  for (int c = 0; c < 6; ++c) {
    std::copy_n(a, n * n, factor);
    for (int i = 0; i < n; ++i) x[i] = by_data(i, c);
    if (!small::gauss_solve<0>(n, factor, x)) {
      out.converged = false;
      return;
    }
    for (int i = 0; i < 5; ++i) (c < 5 ? out.by_trial(i, c) : out.by_settlement[i]) = x[i];
  }
}

/// A guess of small N. Where it does not find the state without fail, the increment is rather halved.
bool Return::start_on_edge(State& state) const {
  if (!settles() || !bearing()) return false;
  const bool needed = !surfaces_.strength().power_law && uplift_.beyond_capacity(trial_, capacity(trial_));
  if (!needed && !every_guess_) return false;
  const auto borne = MacroLanding(uplift_, surfaces_, trial_, settlement_).borne();
  if (!borne) return false;
  state = {};
  state.e = *borne;
  return guess(state);
}

void Return::solve(MacroReturned& out) {
  const bool bears = within_bearing(out.at.force, surfaces_.capacity(settlement_), 1), grips = within_sliding(out.at.force, 1);
  if (bears && grips) return;
  State state;
  const Active first = bears ? sliding_only : bearing_only, last = bears ? bearing_only : sliding_only;
  out.converged = attempt(first, state);
  if (!out.converged && bears == grips) out.converged = attempt(last, state);
  if (!out.converged) out.converged = attempt(both, state);
  if (!out.converged && bears != grips) out.converged = attempt(last, state);
  out.yielded = true;
  if (!out.converged) {
    out.converged = settles() && MacroLanding(uplift_, surfaces_, trial_, settlement_).land(out);
    return;
  }
  out.elastic = state.e;
  out.at = state.at;
  linearise(state, out);
}

}  // namespace

bool macro_holds(const MacroSurfaces& surfaces, const MacroVector& force, double settlement) {
  const double scale = scale_of(surfaces, force, settlement);
  return within_bearing(surfaces, force, surfaces.capacity(settlement), scale, 1) && within_sliding(surfaces, force, scale, 1);
}

MacroReturned macro_return(const MacroUplift& uplift, const MacroSurfaces& surfaces, const MacroVector& trial, double settlement,
                           bool every_guess) {
  MacroReturned out;
  out.elastic = trial;
  out.at = uplift.respond(trial);
  if (!out.at.contact) {
    out.elastic.segment<2>(macro_h1).setZero();
    out.by_trial.diagonal().segment<2>(macro_h1).setZero();
    return out;
  }
  const bool at_rest = out.at.force[macro_n] == 0;  // without load
  if (!at_rest && (surfaces.has_bearing() || surfaces.has_sliding()))
    Return(uplift, surfaces, trial, out.at, settlement, every_guess).solve(out);
  return out;
}

}  // namespace uplift
