#include <fmt/format.h>

#include <algorithm>

#include "uplift/laws/fused_points.h"
#include "uplift/laws/joint.h"
#include "uplift/laws/path.h"
#include "uplift/math/exponential.h"
#include "uplift/math/lambert.h"

// The SDM law (strong discontinuity method): Cherubini, Richard & Frau, eqs 15 to 21, in the reading and the closed forms of
// docs/theory, eqs (2) to (8). Opening d [m], memory j [m] (the jump [u]_max, never decreasing), K [Pa/m], F_u, F_c [Pa], G_f [J/m2], a =
// F_u/G_f, d_c = F_c/K < 0:
//     d >= j         t = K (d - j)             up to the threshold F_u exp(-a j)
//     beyond it      t = K y, j = d - y, y = w/a with w exp(-w) = (a F_u/K) exp(-a d)       softening; one root because K > F_u^2/G_f
//     d_c <= d < j   t = k_c (d - j)           closure, k_c = K/(1 + K j/|F_c|)
//     d < d_c        t = K d
// Path average: pieces of straight lines at fixed j (path.h), and on the softening part, where t falls from F_y = F_u exp(-a j_0) to t_1,
//     integral t dd = G_f (exp(-a j_0) - exp(-a j_1)) + (t_1^2 - F_y^2)/(2K) = r (1/a - (2 F_y - r)/(2K)),     r = F_y - t_1,
// with r from q = a (j_1 - j_0), the root of q - (a F_y/K)(1 - exp(-q)) = a (length of the softening part): nothing cancels in a short
// step. Loops run over all points without a branch; points beyond the threshold are rare, are gathered, and have their own loops.
namespace uplift {
namespace {

/// Traction at a fixed jump and its slope.
struct Traction {
  double value, slope;
};

/// Path average at a fixed jump, its derivative with respect to the end of the path, and the traction and its slope there.
template <class T>
struct Average {
  T value, slope, end, end_slope;
};

/// What becomes of a path that may soften.
struct Softening {
  double elastic_end;  // where the part at fixed jump ends [m]
  double jump;         // at the end [m]
  double traction;     // at the end when it softens [Pa]
};

/// The law for one point, without a branch. Loops work on a copy, which the compiler keeps in registers.
struct Sdm {
  double k, strength, energy, closure;  // K, F_u, G_f, |F_c|
  double knot, rate, inverse_rate;      // d_c [m], a [1/m], 1/a (0 without strength)
  double flexibility;                   // 1/K [m/Pa]
  double brittleness;                   // a F_u/K, below 1

  Sdm(double stiffness, double tensile_strength, double cracking_energy, double closure_stress)
      : k(stiffness),
        strength(tensile_strength),
        energy(cracking_energy),
        closure(-closure_stress),
        knot(closure_stress / stiffness),
        rate(tensile_strength / cracking_energy),
        inverse_rate(tensile_strength > 0 ? cracking_energy / tensile_strength : 0),
        flexibility(1 / stiffness),
        brittleness(tensile_strength * tensile_strength / (stiffness * cracking_energy)) {}

  double least_stiffness() const { return strength * strength / energy; }  // Pa/m: a softer joint releases more energy than G_f takes
  double threshold(double j) const { return strength * exponential(-rate * j).value; }

  /// Positive when an opening that is `over` beyond the jump may pass the threshold: F_u (1 - a j) is below F_u exp(-a j).
  template <class T>
  [[gnu::always_inline]] T excess(T over, T j) const {
    return smaller(over, k * over - strength * (1 - rate * j));
  }

  template <class T>
  [[gnu::always_inline]] T closing(T j) const {
    return k * closure / (closure + k * j);
  }

  Traction at(double d, double j) const {
    const double slope = d >= knot && d < j ? closing(j) : k;
    return {d < knot ? k * d : slope * (d - j), slope};
  }

  /// Whether a path meets a bend of the traction at fixed jump, at the knot or at j.
  template <class T>
  [[gnu::always_inline]] auto bends(T from, T to, T j) const {
    return ((from < knot) != (to < knot)) | ((from < j) != (to < j));
  }

  /// The slope of points of which those marked close; no division where there are none.
  [[gnu::always_inline]] double closing_if(bool here, double j) const { return here ? closing(j) : k; }
  [[gnu::always_inline]] Lanes closing_if(LaneMask here, Lanes j) const {
    const Lanes open = k;
    return any(here) ? choose(here, closing(j), open) : open;
  }

  /// Average at fixed jump of a path without a bend: the traction of its middle.
  template <class T>
  [[gnu::always_inline]] Average<T> straight(T from, T to, T j) const {
    const auto closed = to < knot;
    const T slope = closing_if((!closed) & (to < j), j), start = choose(closed, T(0), j);
    return {slope * (0.5 * (from + to) - start), 0.5 * slope, slope * (to - start), slope};
  }

  /// Average at fixed jump of any path, which is that of the three straight pieces below `knot`, from there to j, and above. Places are
  /// measured from `from`.
  template <class T>
  [[gnu::always_inline]] Average<T> average(T from, T to, T j) const {
    const T zero = 0, d_c = knot, increment = to - from, low = smaller(increment, zero), high = larger(increment, zero),
            length = absolute(increment);
    const T held = larger(length, T(shortest_path)), soft = closure + k * j;
    const T inverse_both = 1 / (held * soft);  // one division for 1/length and the closing stiffness
    const T inverse = soft * inverse_both, closing_stiffness = k * closure * held * inverse_both;
    const T start = d_c - from, finish = j - from;  // of the closure
    const T a0 = smaller(low, start), a1 = smaller(high, start), c0 = larger(low, finish), c1 = larger(high, finish);
    const T b0 = smaller(larger(low, start), finish), b1 = smaller(larger(high, start), finish);
    const T a = k * (a1 - a0), b = closing_stiffness * (b1 - b0), c = k * (c1 - c0), half = 0.5 * inverse;
    const T sum = a * (2 * from + (a0 + a1)) + b * ((b0 + b1) - 2 * finish) + c * ((c0 + c1) - 2 * finish);
    const T levers = absolute(a * (a0 + a1) + b * (b0 + b1) + c * (c0 + c1));
    const auto closed = to < d_c;
    const auto moves = length > shortest_path;
    const T slope = choose(closed | (to >= j), T(k), closing_stiffness), end = slope * (to - choose(closed, zero, j));
    return {choose(moves, sum * half, end), choose(moves, levers * half * inverse, 0.5 * slope), end, slope};
  }

  double stored(double d, double j) const {
    const double in_closure = smaller(larger(d, knot), j) - j, closed = smaller(d, knot), open = larger(d, j) - j;
    return 0.5 * k * (open * open + (closed - knot) * (closed + knot)) + 0.5 * closing(j) * in_closure * in_closure;
  }

  double dissipated(double j) const { return -energy * exponential(-rate * j).minus_one; }

  /// Where softening begins, and the jump and the traction at `to`; `limit` is the threshold at j. Also right for a path that does not get
  /// there.
  Softening soften(double from, double to, double j, double limit) const {
    const double yield = j + limit * flexibility, elastic_end = smaller(to, larger(from, yield));
    const double y = inverse_rate * lambert_root(brittleness * exponential(-rate * to).value);
    return {elastic_end, to > elastic_end ? larger(j, to - y) : j, k * y};
  }

  double softening_slope(double traction) const { return -k * rate * traction / (k - rate * traction); }
};

/// The law as evaluate_points wants it.
struct FusedSdm : Sdm {
  static constexpr bool remembers = true, rises = false;
  /// Twice `stored` from the traction t = end, without a division: t (d - j) in closure and above; below the knot t d - K d_c j, because
  /// k_c (d_c - j) = K d_c there.
  [[gnu::always_inline]] Lanes twice_stored(Lanes d, Lanes j, Lanes end) const {
    return end * d - j * choose(d < knot, Lanes(k * knot), end);
  }
  [[gnu::always_inline]] LaneMask changes(Lanes from, Lanes to, Lanes j) const { return excess(larger(from, to) - j, j) > 0.0; }
};

constexpr int block = 64;  // points that are treated together: what is gathered lies on the stack

/// One block of points.
struct Step {
  const double *from, *to, *old;
  int count;
};

/// Points of a block whose path touches the threshold, side by side.
struct Gathered {
  int count = 0;
  int padded = 0;  // count filled up with copies of the last point to whole vector registers
  int place[block];
  alignas(64) double from[block];
  alignas(64) double to[block];
  alignas(64) double jump[block];
  alignas(64) double limit[block];

  void put(int at, int point, double opening, double opening_at_end, double old_jump, double threshold) {
    place[at] = point;
    from[at] = opening;
    to[at] = opening_at_end;
    jump[at] = old_jump;
    limit[at] = threshold;
  }
};

bool respond_below(const Sdm law, const Step step, double* traction, double* slope, double* now) {
  double most = 0;
#pragma omp simd reduction(max : most)
  for (int i = 0; i < step.count; ++i) {
    const double j = step.old[i];
    const Traction end = law.at(step.to[i], j);
    most = larger(most, law.excess(larger(step.from[i], step.to[i]) - j, j));
    traction[i] = end.value;
    slope[i] = end.slope;
    now[i] = j;
  }
  return most > 0;
}

/// The first loop is right for points without a bend in their path, which is the rule; lanes in which one has a bend are done again.
bool mean_below(const Sdm law, const Step step, const LawResponse& response) {
  double *mean = response.traction, *slope = response.slope, *now = response.now, *end = response.end, *next = response.next, most = 0;
  Marks bends;
  std::int64_t any = 0;
#pragma omp simd reduction(max : most) reduction(| : any)
  for (int i = 0; i < step.count; ++i) {
    const double from = step.from[i], to = step.to[i], j = step.old[i];
    const Average<double> average = law.straight(from, to, j);
    most = larger(most, law.excess(larger(from, to) - j, j));
    const std::int64_t bent = law.bends(from, to, j);
    any |= bent;
    bends.of[i] = bent;
    mean[i] = average.value;
    slope[i] = next[i] = average.slope;
    now[i] = j;
    end[i] = average.end;
  }
  if (any == 0) return most > 0;
  bends.for_groups(step.count, [=](int first, int count) {
#pragma omp simd
    for (int i = first; i < first + count; ++i) {
      const Average<double> average = law.average(step.from[i], step.to[i], step.old[i]);
      mean[i] = average.value;
      slope[i] = average.slope;
    }
  });
  return most > 0;
}

/// A step that begins beyond the threshold (a first step from an initial opening) begins with the jump that belongs there.
void gather(const Sdm law, const Step step, Gathered& found) {
  alignas(64) double limit[block];
#pragma omp simd
  for (int i = 0; i < step.count; ++i) limit[i] = law.threshold(step.old[i]);
  for (int i = 0; i < step.count; ++i) {
    const double from = step.from[i], to = step.to[i], yield = step.old[i] + limit[i] * law.flexibility;
    if (!(larger(from, to) > yield)) continue;
    double jump = step.old[i], bound = limit[i];
    if (from - yield > 1e-9 * bound * law.flexibility + 1e-15 * std::abs(from)) {
      jump = law.soften(jump, from, jump, bound).jump;
      bound = law.threshold(jump);
    }
    found.put(found.count, i, from, to, jump, bound);
    ++found.count;
  }
  found.padded = found.count;
  for (const int last = found.count - 1; last >= 0 && found.padded % lanes != 0; ++found.padded)
    found.put(found.padded, found.place[last], found.from[last], found.to[last], found.jump[last], found.limit[last]);
}

void respond_beyond(const Sdm law, const Step& step, double* traction, double* slope, double* now) {
  Gathered points;
  gather(law, step, points);
  alignas(64) double value[block];
  alignas(64) double tangent[block];
  const int padded = points.padded;
#pragma omp simd
  for (int i = 0; i < padded; ++i) {
    const double to = points.to[i], j = points.jump[i];
    const Softening s = law.soften(points.from[i], to, j, points.limit[i]);
    const Traction fixed = law.at(to, j);
    const bool softens = to > s.elastic_end;
    value[i] = softens ? s.traction : fixed.value;
    tangent[i] = softens ? law.softening_slope(s.traction) : fixed.slope;
    points.jump[i] = s.jump;
  }
  for (int i = 0; i < points.count; ++i) {
    const int place = points.place[i];
    traction[place] = value[i];
    slope[place] = tangent[i];
    now[place] = points.jump[i];
  }
}

void mean_beyond(const Sdm law, const Step& step, const LawResponse& response) {
  Gathered points;
  gather(law, step, points);
  alignas(64) double value[block];
  alignas(64) double derivative[block];
  alignas(64) double last[block];
  alignas(64) double last_slope[block];
  const int padded = points.padded;
#pragma omp simd
  for (int i = 0; i < padded; ++i) {
    const double from = points.from[i], to = points.to[i], j = points.jump[i], limit = points.limit[i];
    const Softening s = law.soften(from, to, j, limit);
    const double increment = to - from, inverse = std::abs(increment) > shortest_path ? 1 / increment : 0;
    const bool softens = to > s.elastic_end;
    const Average<double> elastic = law.average(from, s.elastic_end, j);
    // q by one Newton step from the jumps' own difference, which has only its last digits wrong
    const double length = to - s.elastic_end, scale = law.rate * limit * law.flexibility;
    const double guess = law.rate * (s.jump - j), drop = exponential(-guess).minus_one;
    const double correction = (guess + scale * drop - law.rate * length) / (1 - scale * (1 + drop));
    const double r = -limit * (drop + (1 + drop) * correction);
    const double work = r * (law.inverse_rate - 0.5 * law.flexibility * (2 * limit - r));
    // integral of F_y - t over the softening part; a triangle when it is so short that the difference is lost
    const double below = law.rate * length < 1e-6 ? 0.5 * r * length : limit * length - work;
    const double share = (s.elastic_end - from) * inverse;
    const double at_end = softens ? s.traction : elastic.end;
    value[i] = inverse != 0 ? share * elastic.value + work * inverse : at_end;
    derivative[i] = inverse != 0 ? share * share * elastic.slope - (increment * r - below) * inverse * inverse : elastic.slope;
    points.jump[i] = s.jump;
    last[i] = at_end;
    last_slope[i] = softens ? law.softening_slope(s.traction) : elastic.end_slope;
  }
  for (int i = 0; i < points.count; ++i) {
    const int place = points.place[i];
    response.traction[place] = value[i];
    response.slope[place] = derivative[i];
    response.now[place] = points.jump[i];
    response.end[place] = last[i];
    response.next[place] = 0.5 * last_slope[i];
  }
}

class SdmLaw final : public NormalLaw {
 public:
  explicit SdmLaw(const Sdm& law) : law_(law) {}
  int num_history() const override { return 1; }
  double stiffness() const override { return law_.k; }
  LawScales scales() const override {
    return {.strength = law_.strength, .closure = law_.closure, .opening = law_.inverse_rate, .least_stiffness = law_.least_stiffness()};
  }
  bool carries_tension() const override { return law_.strength > 0; }
  std::optional<EquivalentLaw> equivalent() const override {
    if (law_.strength > 0) return {};
    return EquivalentLaw{"springs", {}};
  }

  void respond(const Batch& batch, const double* from, const double* to, const double* old, const LawResponse& response) const override {
    for (int first = 0; first < batch.points; first += block) {
      double spare[2][block];
      const Step step{from + first, to + first, old + first, std::min(block, batch.points - first)};
      double* slope = response.slope != nullptr ? response.slope + first : spare[0];
      double* now = response.now != nullptr ? response.now + first : spare[1];
      if (respond_below(law_, step, response.traction + first, slope, now))
        respond_beyond(law_, step, response.traction + first, slope, now);
    }
  }

  void mean(const Batch& batch, const double* from, const double* to, const double* old, const LawResponse& response) const override {
    for (int first = 0; first < batch.points; first += block) {
      double spare[4][block];
      const auto given = [first](double* values, double* instead) { return values != nullptr ? values + first : instead; };
      const Step step{from + first, to + first, old + first, std::min(block, batch.points - first)};
      const LawResponse here{.traction = response.traction + first,
                             .slope = given(response.slope, spare[0]),
                             .now = given(response.now, spare[1]),
                             .end = given(response.end, spare[2]),
                             .next = given(response.next, spare[3])};
      if (mean_below(law_, step, here)) mean_beyond(law_, step, here);
    }
  }

  bool fused(const FusedEvaluation& evaluation) const override { return evaluate_points(FusedSdm{law_}, evaluation, law_.strength > 0); }

  void energy(const Batch& batch, const double* opening, const double* history, double* stored, double* dissipated) const override {
    const Sdm law = law_;
    if (stored != nullptr)
#pragma omp simd
      for (int i = 0; i < batch.points; ++i) stored[i] = law.stored(opening[i], history[i]);
    if (dissipated != nullptr)
#pragma omp simd
      for (int i = 0; i < batch.points; ++i) dissipated[i] = law.dissipated(history[i]);
  }

  Surface surface(double step, double from, double to, Memory old) const override;

 private:
  Sdm law_;
};

/// Damage D = 1 - exp(-a j) (1 without strength as soon as j > 0); openness eta D, where eta (eq 20) rises from 0 at d_c to 1 at d = j.
Surface SdmLaw::surface(double, double from, double to, Memory old) const {
  const double knot = law_.knot, rate = law_.rate;
  const bool strong = law_.strength > 0;
  double j = old[0], limit = law_.threshold(j);
  if (from > j + limit * law_.flexibility) {
    j = law_.soften(j, from, j, limit).jump;
    limit = law_.threshold(j);
  }
  const Softening s = law_.soften(from, to, j, limit);
  const auto damage_at = [&](double jump) { return strong ? -exponential(-rate * jump).minus_one : jump > 0 ? 1.0 : 0.0; };
  const auto eta_at = [&](double d) { return d >= j ? 1.0 : d > knot ? (d - knot) / (j - knot) : 0.0; };
  const bool softens = to > s.elastic_end;
  const double begin = damage_at(j), end = damage_at(s.jump), width = j - knot;
  const double growth = softens && strong ? rate * (1 - end) * law_.k / (law_.k - rate * s.traction) : 0;  // dD/d to
  const double eta_slope = to >= knot && to < j ? 1 / width : 0;

  Surface surface;
  surface.traction = softens ? s.traction : law_.at(to, j).value;
  surface.damage = {.begin = begin, .end = end, .end_slope = growth};
  surface.openness = {
      .begin = eta_at(from) * begin, .end = softens ? end : eta_at(to) * begin, .end_slope = softens ? growth : eta_slope * begin};
  // Along the softening part the damage counts by the mean of its ends, or is complete without strength.
  const double average_damage = strong ? 0.5 * (begin + end) : end, average_growth = strong ? 0.5 * growth : 0;
  const Path path(from, to), elastic(from, s.elastic_end);
  const double share = path.moves() ? (to - s.elastic_end) / path.length() : 0, fixed = 1 - share;
  const double share_slope = path.moves() && softens ? fixed / path.length() : 0;
  const Piece rising = elastic.within(knot, j), open = elastic.above(j);
  const double eta = rising.share * (rising.middle - knot) / width + open.share, eta_mean_slope = rising.share * rising.lever / width;
  surface.damage.mean = fixed * begin + share * average_damage;
  surface.damage.mean_slope = share_slope * (average_damage - begin) + share * average_growth;
  surface.openness.mean = fixed * eta * begin + share * average_damage;
  surface.openness.mean_slope = softens ? share_slope * (average_damage - eta * begin) + share * average_growth : eta_mean_slope * begin;
  return surface;
}

std::unique_ptr<const NormalLaw> make_sdm(const Values& values) {
  const Sdm law(values.number("K_n"), values.number("F_u"), values.number("G_f"), values.number("F_c"));
  const double least = law.least_stiffness();
  if (!(law.k > least))
    throw InputError(
        values.where("K_n"), values.path("K_n"),
        fmt::format("K_n > F_u^2/G_f = {:.6g} Pa/m, else the law snaps back (a softer joint releases more energy than G_f takes)", least),
        fmt::format("{:.6g} Pa/m", law.k));
  return std::make_unique<SdmLaw>(law);
}

}  // namespace

const Entry<InterfaceLaw>& entry_law_sdm() {
  static const Entry<InterfaceLaw> entry =
      joint_entry({.name = "sdm",
                   .summary = "strong discontinuity method: uplift as a displacement jump that is remembered, with cracking energy",
                   .equations = "t_n = K_n (d_n - eta j), j the largest jump so far\n"
                                "t_n <= F_u exp(-F_u j/G_f)\n"
                                "eta = 1 for t_n > 0; 1 - t_n/F_c for F_c <= t_n <= 0; 0 below",
                   .source = "Cherubini, Richard & Frau, eqs 15 to 21, in the reading of docs/theory, eqs (2) to (8)",
                   .params = {number("K_n", "Pa/m", "normal stiffness; above F_u^2/G_f").positive().or_word("soil"),
                              number("F_u", "Pa", "tensile strength; 0: no tension, the jump follows the opening").nonnegative(),
                              number("G_f", "J/m2", "cracking energy").positive(),
                              number("F_c", "Pa", "closure stress; its size should stay below 1 % of the bearing pressure").negative()}},
                  "bonded", make_sdm);
  return entry;
}

}  // namespace uplift
