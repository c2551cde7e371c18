#include "uplift/laws/tangential.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

namespace uplift {
namespace {

/// A vector in the plane of the interface; the second component is zero in 2D.
struct Plane {
  double x = 0, y = 0;
  Plane operator+(const Plane& o) const { return {x + o.x, y + o.y}; }
  Plane operator-(const Plane& o) const { return {x - o.x, y - o.y}; }
};
Plane operator*(double factor, const Plane& v) {
  return {factor * v.x, factor * v.y};
}
double dot(const Plane& a, const Plane& b) {
  return a.x * b.x + a.y * b.y;
}
double size(const Plane& v) {
  return std::hypot(v.x, v.y);
}

Plane plane(const double* values, int tangents, int points, int i) {
  return {values[i], tangents > 1 ? values[points + i] : 0.0};
}

void put(const Plane& v, int tangents, int points, int i, double* values) {
  values[i] = v.x;
  if (tangents > 1) values[points + i] = v.y;
}

/// A tangential traction with its derivatives with respect to the tangential opening (columns) and the normal opening [Pa/m].
struct Answer {
  Plane traction;
  Plane by_x, by_y, by_normal;
};

/// A bound of the shear [Pa] and its derivative with respect to the normal opening [Pa/m].
struct Bound {
  double value = HUGE_VAL, slope = 0;
};

/// Adds theta y, y = c (increment - lag), the joint filter of the scheme (laws/filter.h), with the largest theta <= 1 that keeps the
/// traction on or within the bound.
void add_filter(const TangentialCall& call, int i, const Bound& bound, Answer& answer) {
  const Batch& batch = call.batch;
  if (batch.coefficient == nullptr) return;
  const int n = batch.points, tangents = batch.components - 1;
  put(answer.traction, tangents, n, i, call.response.plain);
  const double c = batch.coefficient[i];
  if (!(c > 0)) return;
  const Plane increment = plane(call.to, tangents, n, i) - plane(call.from, tangents, n, i),
              y = c * (increment - plane(batch.lag, tangents, n, i));
  const Plane plain = answer.traction, whole = plain + y;
  if (size(whole) <= bound.value) {
    answer.traction = whole;
    answer.by_x.x += c;
    answer.by_y.y += c;
    return;
  }
  // |plain + theta y| = bound, where plain itself is within it: the larger root
  const double a = dot(y, y), b = dot(plain, y), outside = std::min(dot(plain, plain) - bound.value * bound.value, 0.0);
  const double root = std::sqrt(std::max(b * b - a * outside, 0.0));
  const double theta = std::clamp(b > 0 ? -outside / (b + root) : (root - b) / a, 0.0, 1.0);
  answer.traction = plain + theta * y;
  const double rate = dot(answer.traction, y);
  if (!(rate > 1e-14 * bound.value * size(y))) return;
  const auto change = [&](const Plane& direct, double bound_moved) {  // d traction = direct + y d theta stays on the bound
    return direct + (bound.value * bound_moved - dot(answer.traction, direct)) / rate * y;
  };
  answer.by_x = change(answer.by_x + Plane{theta * c, 0}, 0);
  answer.by_y = change(answer.by_y + Plane{0, theta * c}, 0);
  answer.by_normal = change(answer.by_normal, bound.slope);
}

void put(const Answer& answer, const TangentialCall& call, int i) {
  const int n = call.batch.points, components = call.batch.components, tangents = components - 1;
  put(answer.traction, tangents, n, i, call.response.traction);
  if (call.response.slope == nullptr) return;
  const auto entry = [&](int row, int column) -> double& { return call.response.slope[(row * components + column) * n + i]; };
  entry(0, 0) = answer.by_x.x;
  entry(0, tangents) = answer.by_normal.x;
  if (tangents == 1) return;
  entry(1, 0) = answer.by_x.y;
  entry(0, 1) = answer.by_y.x;
  entry(1, 1) = answer.by_y.y;
  entry(1, tangents) = answer.by_normal.y;
}

class NoShear final : public TangentialPart {
 public:
  int num_history(int) const override { return 0; }
  double stiffness() const override { return 0; }
  void respond(const TangentialCall& call) const override { std::fill_n(call.response.traction, call.batch.normal(), 0.0); }
  void mean(const TangentialCall& call) const override {
    respond(call);
    if (call.response.end != nullptr) std::fill_n(call.response.end, call.batch.normal(), 0.0);
    if (call.response.plain != nullptr) std::fill_n(call.response.plain, call.batch.normal(), 0.0);
  }
  void add_energy(const Batch&, const NormalLaw&, const double*, const double*, const double*, double*, double*) const override {}
};

class Bonded final : public TangentialPart {
 public:
  explicit Bonded(double stiffness) : stiffness_(stiffness) {}
  int num_history(int) const override { return 0; }
  double stiffness() const override { return stiffness_; }

  void respond(const TangentialCall& call) const override {
    for (int i = 0; i < call.batch.normal(); ++i) call.response.traction[i] = stiffness_ * call.to[i];
    put_slope(call, stiffness_);
  }

  void mean(const TangentialCall& call) const override {
    for (int i = 0; i < call.batch.normal(); ++i) call.response.traction[i] = 0.5 * stiffness_ * (call.from[i] + call.to[i]);
    put_slope(call, 0.5 * stiffness_);
    if (call.response.end != nullptr)
      for (int i = 0; i < call.batch.normal(); ++i) call.response.end[i] = stiffness_ * call.to[i];
    if (call.batch.coefficient == nullptr) return;
    const int n = call.batch.points, tangents = call.batch.components - 1;
    for (int i = 0; i < n; ++i) {
      const double half = 0.5 * stiffness_;
      Answer answer{plane(call.response.traction, tangents, n, i), {half, 0}, {0, half}, {}};
      add_filter(call, i, {}, answer);
      put(answer, call, i);
    }
  }

  void add_energy(const Batch& batch, const NormalLaw&, const double* opening, const double*, const double*, double* stored,
                  double*) const override {
    if (stored == nullptr) return;
    for (int c = 0; c < batch.components - 1; ++c)
      for (int i = 0; i < batch.points; ++i) {
        const double d = opening[c * batch.points + i];
        stored[i] += 0.5 * stiffness_ * d * d;
      }
  }

 private:
  static void put_slope(const TangentialCall& call, double slope) {
    const int n = call.batch.points, components = call.batch.components;
    if (call.response.slope != nullptr)
      for (int c = 0; c < components - 1; ++c) std::fill_n(call.response.slope + c * (components + 1) * n, n, slope);
  }
  double stiffness_;  // Pa/m
};

/// Memory: slip (one per tangent) [m], dissipated energy [J/m2].
class WithSlip : public TangentialPart {
 public:
  explicit WithSlip(double stiffness) : stiffness_(stiffness) {}
  int num_history(int tangents) const final { return tangents + 1; }
  double stiffness() const final { return stiffness_; }
  void respond(const TangentialCall& call) const final { advance(call, false); }
  void mean(const TangentialCall& call) const final { advance(call, true); }

  void add_energy(const Batch& batch, const NormalLaw& normal, const double* opening, const double* normal_history, const double* history,
                  double* stored, double* dissipated) const final {
    const int n = batch.points, tangents = batch.components - 1;
    for (int i = 0; i < n; ++i) {
      const Plane e = plane(opening, tangents, n, i) - plane(history, tangents, n, i);
      const double d = opening[batch.normal() + i];
      if (stored != nullptr) stored[i] += 0.5 * transfer(normal, d, {normal_history, n, i}) * stiffness_ * dot(e, e);
      if (dissipated != nullptr) dissipated[i] += history[tangents * n + i];
    }
  }

 protected:
  /// State of one point after a step, and the energy that the step took [J/m2].
  struct State {
    Plane slip, end;
    double taken;
  };
  /// Share of K e that is transferred at normal opening d.
  virtual double transfer(const NormalLaw& normal, double d, Memory normal_history) const = 0;
  virtual State one(const TangentialCall& call, int i, const Plane& from, const Plane& to, const Plane& slip, bool average, Answer& answer,
                    Bound& bound) const = 0;

  double stiffness_;  // Pa/m

 private:
  void advance(const TangentialCall& call, bool average) const {
    const int n = call.batch.points, tangents = call.batch.components - 1;
    for (int i = 0; i < n; ++i) {
      Answer answer;
      Bound bound;
      const State state = one(call, i, plane(call.from, tangents, n, i), plane(call.to, tangents, n, i), plane(call.old, tangents, n, i),
                              average, answer, bound);
      if (average) add_filter(call, i, bound, answer);
      put(answer, call, i);
      if (average && call.response.end != nullptr) put(state.end, tangents, n, i, call.response.end);
      if (call.now == nullptr) continue;
      put(state.slip, tangents, n, i, call.now);
      call.now[tangents * n + i] = call.old[tangents * n + i] + state.taken;
    }
  }
};

/// The step is done in two parts that the normal part's path gives: a fraction f of it at the old openness, the rest at the new one, with
/// f from the path average of the openness. Work of the two elastic parts = change of stored energy; the change of openness between them
/// only dissipates.
class OpenFree final : public WithSlip {
 public:
  using WithSlip::WithSlip;

 protected:
  double transfer(const NormalLaw& normal, double d, Memory normal_history) const override {
    return 1 - normal.surface(0, d, d, normal_history).openness.end;
  }

  State one(const TangentialCall& call, int i, const Plane& from, const Plane& to, const Plane& slip, bool average, Answer& answer,
            Bound&) const override {
    const int normal = call.batch.normal();
    const Along o =
        call.normal.surface(call.batch.step, call.from[normal + i], call.to[normal + i], {call.normal_old, call.batch.points, i}).openness;
    const double w0 = 1 - o.begin, w1 = 1 - o.end, gap = o.end - o.begin;
    const double f = gap != 0 ? std::clamp((o.end - o.mean) / gap, 0.0, 1.0) : 1, rest = 1 - f;
    const double f_slope = gap != 0 ? (rest * o.end_slope - o.mean_slope) / gap : 0;
    const double shrink = w0 < w1 ? w0 / w1 : 1;  // of e, when contact grows: continuous traction
    const Plane increment = to - from, e0 = from - slip, ea = e0 + f * increment, eb = shrink * ea, e1 = eb + rest * increment;
    const double k = stiffness_;

    State state;
    state.slip = w1 > 0 ? to - e1 : to;
    state.end = k * w1 * e1;
    state.taken = 0.5 * k * (w0 * dot(ea, ea) - w1 * dot(eb, eb));
    double diagonal;
    if (average) {
      answer.traction = k * (w0 * f * (e0 + 0.5 * f * increment) + w1 * rest * (eb + 0.5 * rest * increment));
      diagonal = k * (0.5 * w0 * f * f + w1 * rest * (shrink * f + 0.5 * rest));
      const Plane by_fraction = w0 * ea - w1 * (eb + rest * (1 - shrink) * increment);
      const Plane by_openness = w0 < w1 ? -0.5 * rest * rest * increment : -rest * (eb + 0.5 * rest * increment);
      answer.by_normal = k * (f_slope * by_fraction + o.end_slope * by_openness);
    } else {
      answer.traction = state.end;
      diagonal = k * w1 * (shrink * f + rest);
      answer.by_normal = k * (f_slope * w1 * (shrink - 1) * increment + o.end_slope * (w0 < w1 ? -rest * increment : -1.0 * e1));
    }
    answer.by_x = {diagonal, 0};
    answer.by_y = {0, diagonal};
    return state;
  }
};

/// Elastic-plastic slip.
/// End of the step: return mapping of the trial K (to - slip) on the bound at the end; the slip's work is t . slip.
/// Path average: the bound is that of the path-averaged normal traction, constant in the step, and the path under it is followed exactly:
/// elastic up to the place f where it meets the bound, then slip, whose traction goes from t_a to t_b on the bound and counts by its mean
/// (exact for one component). A traction that is above the bound at the beginning first drops onto it, at the end it drops onto the bound
/// there. So mean . (to - from) = change of stored energy + drops + (t_a + t_b)/2 . slip, of which the drops and the slip's work are never
/// negative.
class CoulombShear final : public WithSlip {
 public:
  CoulombShear(double stiffness, double friction, double cohesion) : WithSlip(stiffness), friction_(friction), cohesion_(cohesion) {}

 protected:
  double transfer(const NormalLaw&, double, Memory) const override { return 1; }

  State one(const TangentialCall& call, int i, const Plane& from, const Plane& to, const Plane& slip, bool average, Answer& answer,
            Bound& bound) const override {
    const int normal = call.batch.normal(), last = call.batch.components * call.batch.components - 1;
    Surface surface;
    if (cohesion_ > 0 || average)
      surface = call.normal.surface(call.batch.step, call.from[normal + i], call.to[normal + i], {call.normal_old, call.batch.points, i});
    const double pull = call.response.traction[normal + i];
    const double bond = average ? surface.damage.mean : surface.damage.end;
    const double bond_slope = average ? surface.damage.mean_slope : surface.damage.end_slope;
    bound = {cohesion_ * (1 - bond) - friction_ * std::min(pull, 0.0), 0};
    if (call.response.slope != nullptr)
      bound.slope = -cohesion_ * bond_slope - (pull < 0 ? friction_ * call.response.slope[last * call.batch.points + i] : 0);

    const Plane t0 = stiffness_ * (from - slip);
    if (!average) return at_end(t0, to - from, to, bound, answer);
    State state = along(t0, to - from, bound, answer);
    drop(cohesion_ * (1 - surface.damage.end) - friction_ * std::min(surface.traction, 0.0), state);
    state.slip = to - (1 / stiffness_) * state.end;
    return state;
  }

 private:
  /// n (n . v) taken off v, times factor
  static Plane across(double factor, const Plane& n, const Plane& v) { return factor * (v - dot(n, v) * n); }

  /// Traction at the end of the step above the bound there: it drops onto it, which dissipates (the opening does not move).
  void drop(double bound, State& state) const {
    const double length = size(state.end);
    if (length <= bound) return;
    state.taken += (length - bound) * (length + bound) / (2 * stiffness_);
    state.end = (bound / length) * state.end;
  }

  State at_end(const Plane& t0, const Plane& increment, const Plane& to, const Bound& bound, Answer& answer) const {
    const double k = stiffness_;
    const Plane trial = t0 + k * increment;
    const double length = size(trial);
    if (length <= bound.value) {
      answer = {trial, {k, 0}, {0, k}, {}};
      return {to - (1 / k) * trial, trial, 0};
    }
    const Plane n = (1 / length) * trial, t = bound.value * n;
    answer = {t, across(bound.value / length, n, {k, 0}), across(bound.value / length, n, {0, k}), bound.slope * n};
    return {to - (1 / k) * t, t, bound.value * (length - bound.value) / k};
  }

  State along(const Plane& start, const Plane& increment, const Bound& bound, Answer& answer) const {
    const double k = stiffness_, start_length = size(start);
    const bool drops = start_length > bound.value;
    const Plane n0 = drops ? (1 / start_length) * start : Plane{}, t0 = drops ? bound.value * n0 : start;
    double taken = drops ? (start_length - bound.value) * (start_length + bound.value) / (2 * k) : 0;
    const Plane trial = t0 + k * increment;
    const double length = size(trial);
    if (length <= bound.value) {
      answer = {0.5 * (t0 + trial), {0.5 * k, 0}, {0, 0.5 * k}, bound.slope * n0};
      return {{}, trial, taken};
    }
    const double f = reach(t0, k * increment, drops ? 0 : (start_length - bound.value) * (start_length + bound.value));
    const Plane ta = t0 + f * k * increment, n = (1 / length) * trial, tb = bound.value * n;
    taken += (length - bound.value) / k * 0.5 * (dot(ta, n) + bound.value);
    answer.traction = 0.5 * (f * (t0 + ta) + (1 - f) * (ta + tb));

    // d traction = ((trial - t_b) df + (1 + f) dt_0 + f K d increment + (1 - f) dt_b)/2, f from |t_a| = bound
    const double rate = k * dot(ta, increment), ratio = bound.value / length;
    const bool grazes = rate <= 1e-14 * k * bound.value * size(increment);
    const auto change = [&](const Plane& moved, const Plane& t0_moved, double bound_moved) {
      const double df = grazes ? 0 : (bound.value * bound_moved - dot(ta, t0_moved + f * moved)) / rate;
      const Plane dtb = bound_moved * n + across(ratio, n, t0_moved + moved);
      return 0.5 * (df * (trial - tb) + (1 + f) * t0_moved + f * moved + (1 - f) * dtb);
    };
    answer.by_x = change({k, 0}, {}, 0);
    answer.by_y = change({0, k}, {}, 0);
    answer.by_normal = change({}, bound.slope * n0, bound.slope);
    return {{}, tb, taken};
  }

  /// Fraction of the elastic increment at which |t0 + f increment| meets the bound; `inside` = |t0|^2 - bound^2 <= 0.
  static double reach(const Plane& t0, const Plane& increment, double inside) {
    const double a = dot(increment, increment), b = dot(t0, increment), root = std::sqrt(std::max(b * b - a * inside, 0.0));
    const double f = b > 0 ? -inside / (b + root) : (root - b) / a;
    return std::clamp(f, 0.0, 1.0);
  }

  double friction_, cohesion_;  // 1, Pa
};

/// A parameter that the chosen part would not use is an error: it was meant to do something.
void refuse(const Values& values, std::string_view key, std::string_view owner) {
  if (values.given(key))
    throw InputError(values.where(key), values.path(key), fmt::format("no {} here: it belongs to tangential = {}", key, owner),
                     fmt::format("tangential = \"{}\"", values.text("tangential")));
}

}  // namespace

std::string tangential_kind(const Values& values) {
  const std::string& kind = values.text("tangential");
  if (values.given("tangential")) return kind;
  if (values.given("friction") || values.given("cohesion")) return "coulomb";
  return values.given("K_t") && kind == "none" ? "bonded" : kind;
}

std::optional<std::string> stated_tangential(const Values& behaviour) {
  return behaviour.items().contains("tangential") ? std::optional(tangential_kind(behaviour)) : std::nullopt;
}

std::optional<std::string> decided_tangential(const Values& behaviour) {
  std::optional<std::string> kind = stated_tangential(behaviour);
  if (kind && *kind == behaviour.text("tangential")) kind.reset();
  return kind;
}

std::unique_ptr<const TangentialPart> make_tangential(const Values& values, double normal_stiffness) {
  const std::string kind = tangential_kind(values);
  if (kind != "coulomb") {
    refuse(values, "friction", "\"coulomb\"");
    refuse(values, "cohesion", "\"coulomb\"");
  }
  if (kind == "none") {
    refuse(values, "K_t", "\"bonded\", \"open_free\" or \"coulomb\"");
    return std::make_unique<NoShear>();
  }
  const double stiffness = values.has("K_t") ? values.number("K_t") : normal_stiffness;
  if (kind == "bonded") return std::make_unique<Bonded>(stiffness);
  if (kind == "open_free") return std::make_unique<OpenFree>(stiffness);
  if (!values.has("friction"))
    throw InputError(values.where("friction"), values.path("friction"),
                     "a number (1): tangential = \"coulomb\" needs its coefficient of friction", "nothing");
  return std::make_unique<CoulombShear>(stiffness, values.number("friction"), values.has("cohesion") ? values.number("cohesion") : 0);
}

std::vector<Field> tangential_fields(const char* standard) {
  return {choice("tangential", {"none", "bonded", "open_free", "coulomb"},
                 "shear: none; elastic, open or closed; elastic and free where open; elastic with friction. Absent: coulomb where friction "
                 "is given, "
                 "bonded where only K_t is")
              .standard(standard),
          number("K_t", "Pa/m", "tangential stiffness; absent: K_n").positive().or_word("soil").optional(),
          number("friction", "1", "coefficient of friction (coulomb)").nonnegative().optional(),
          number("cohesion", "Pa", "shear strength at zero pressure, lost with damage (coulomb); absent: 0").nonnegative().optional()};
}

}  // namespace uplift
