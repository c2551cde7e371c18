#include "uplift/laws/fused_points.h"
#include "uplift/laws/joint.h"
#include "uplift/laws/path.h"

// Tensionless springs, the classic no-tension base: K the stiffness [Pa/m], c the damping in contact [Pa s/m], d the opening, r = (to -
// from)/step.
//     c = 0:  t = K min(d, 0)
//     c > 0:  t = min(0, K d + c r) for d < 0, else 0       (a Kelvin-Voigt base that never pulls)
// Path average: the path is straight and r constant, so t is linear up to the place k = min(0, -c r/K) where it ends (by zero force when
// the faces part, r > 0; by a jump to c r when they meet, r < 0), and mean = share * (K middle + c r) with the part of the path below k.
// Energy: K min(d, 0)^2/2 is stored; the dashpot takes c|r| per metre of path below k, and -K d per metre between k and 0, where the
// parting faces no longer push although the spring is still short. Memory (c > 0 only): the energy taken by the dashpot [J/m2].
namespace uplift {
namespace {

/// Path average, its derivative with respect to the end of the path, and the traction and its slope there.
struct LanesAverage {
  Lanes value, slope, end, end_slope;
};

/// Without the dashpot, as evaluate_points wants it.
struct FusedSprings {
  static constexpr bool remembers = false, rises = true;
  double stiffness;

  [[gnu::always_inline]] static LaneMask bends(Lanes from, Lanes to, Lanes) { return (from < 0.0) != (to < 0.0); }

  [[gnu::always_inline]] static Lanes twice_stored(Lanes to, Lanes, Lanes end) { return end * to; }

  /// The traction of the middle of the path.
  [[gnu::always_inline]] LanesAverage straight(Lanes from, Lanes to, Lanes) const {
    const Lanes slope = choose(to < 0.0, Lanes(stiffness), Lanes(0));
    return {slope * (0.5 * (from + to)), 0.5 * slope, slope * to, slope};
  }

  [[gnu::always_inline]] LanesAverage average(Lanes from, Lanes to, Lanes old) const {
    const LanesAverage point = straight(to, to, old);
    const Lanes zero = 0, increment = to - from, length = absolute(increment), inverse = 1 / length;
    const Lanes a = smaller(smaller(increment, zero), -from), b = smaller(larger(increment, zero), -from);
    const Lanes weight = 0.5 * stiffness * (b - a) * inverse;
    const LaneMask moves = length > shortest_path;
    return {choose(moves, weight * (2 * from + (a + b)), point.end), choose(moves, weight * absolute(a + b) * inverse, point.slope),
            point.end, point.end_slope};
  }
};

class Springs final : public NormalLaw {
 public:
  Springs(double stiffness, double damping) : stiffness_(stiffness), damping_(damping) {}
  int num_history() const override { return damping_ > 0 ? 1 : 0; }
  double stiffness() const override { return stiffness_; }
  double dashpot() const override { return damping_; }
  bool carries_tension() const override { return false; }
  /// The SDM without strength, whose closure stress is far below what a base bears at rest; it has no dashpot.
  std::optional<EquivalentLaw> equivalent() const override {
    if (damping_ > 0) return {};
    return EquivalentLaw{"sdm", {{"F_u", 0.0}, {"G_f", 0.1}, {"F_c", -1e-7 * stiffness_}}};
  }

  void respond(const Batch& batch, const double* from, const double* to, const double* old, const LawResponse& response) const override {
    if (damping_ > 0) return viscous(batch, from, to, old, response, false);
    const double stiffness = stiffness_;
    double* traction = response.traction;
#pragma omp simd
    for (int i = 0; i < batch.points; ++i) traction[i] = force(stiffness, to[i]);
    if (double* slope = response.slope; slope != nullptr)
#pragma omp simd
      for (int i = 0; i < batch.points; ++i) slope[i] = to[i] < 0 ? stiffness : 0.0;
  }

  void mean(const Batch& batch, const double* from, const double* to, const double* old, const LawResponse& response) const override {
    if (damping_ > 0) return viscous(batch, from, to, old, response, true);
    for (int first = 0; first < batch.points; first += block) {
      double spare[3][block];
      const auto given = [first](double* values, double* instead) { return values != nullptr ? values + first : instead; };
      average(batch.points - first < block ? batch.points - first : block, from + first, to + first, response.traction + first,
              given(response.slope, spare[0]), given(response.end, spare[1]), given(response.next, spare[2]));
    }
  }

  bool fused(const FusedEvaluation& evaluation) const override {
    return damping_ == 0 && evaluate_points(FusedSprings{stiffness_}, evaluation, false);
  }

  void energy(const Batch& batch, const double* opening, const double* history, double* stored, double* dissipated) const override {
    const double half = 0.5 * stiffness_;
    if (stored != nullptr)
#pragma omp simd
      for (int i = 0; i < batch.points; ++i) stored[i] = half * smaller(opening[i], 0.0) * smaller(opening[i], 0.0);
    if (dissipated != nullptr)
      for (int i = 0; i < batch.points; ++i) dissipated[i] = damping_ > 0 ? history[i] : 0.0;
  }

  Surface surface(double step, double from, double to, Memory old) const override {
    double traction, taken;
    viscous(Batch{1, 1, step}, &from, &to, damping_ > 0 ? &old[0] : &from, {.traction = &traction, .now = &taken}, false);
    Along open{from > 0 ? 1.0 : 0.0, to > 0 ? 1.0 : 0.0, 0, 0, 0};
    const Path path(from, to);
    open.mean = path.moves() ? path.above(0).share : open.end;
    open.mean_slope = path.moves() ? (open.end - open.mean) / (to - from) : 0;
    return {traction, open, open};
  }

 private:
  static constexpr int block = 64;

  /// K min(d, 0); an opening that is no number gives no number, which stops Newton's method.
  static double force(double stiffness, double d) {
    return d > 0 ? 0.0 : stiffness * d;
  }

  /// Points that stay in contact, or apart, have the traction of the middle of their path; only the others need the pieces of it.
  void average(int count, const double* from, const double* to, double* mean, double* slope, double* end, double* next) const {
    const double stiffness = stiffness_;
    Marks crossing;
    std::int64_t any = 0;
#pragma omp simd reduction(| : any)
    for (int i = 0; i < count; ++i) {
      const std::int64_t crosses = (from[i] < 0) != (to[i] < 0);
      any |= crosses;
      crossing.of[i] = crosses;
      mean[i] = force(stiffness, 0.5 * (from[i] + to[i]));
      slope[i] = next[i] = to[i] < 0 ? 0.5 * stiffness : 0.0;
      end[i] = force(stiffness, to[i]);
    }
    if (any == 0) return;
    crossing.for_groups(count, [=](int first, int some) {
#pragma omp simd
      for (int i = first; i < first + some; ++i) {
        const double increment = to[i] - from[i], low = smaller(increment, 0.0), high = larger(increment, 0.0),
                     length = std::abs(increment);
        const double a = smaller(low, -from[i]), b = smaller(high, -from[i]), inverse = 1 / length;
        const double weight = 0.5 * stiffness * (b - a) * inverse;
        mean[i] = length > shortest_path ? weight * (2 * from[i] + (a + b)) : end[i];
        slope[i] = length > shortest_path ? weight * std::abs(a + b) * inverse : next[i];
      }
    });
  }

  /// With the dashpot, or one point without; `average`: the path average, else the traction at the end.
  void viscous(const Batch& batch, const double* from, const double* to, const double* old, const LawResponse& response,
               bool average) const {
    const double per_step = batch.step > 0 ? damping_ / batch.step : 0;  // c/step [Pa/m]
    for (int i = 0; i < batch.points; ++i) {
      const Path path(from[i], to[i]);
      const double dashpot = per_step * (to[i] - from[i]);  // c r [Pa]
      const double knee = smaller(0, -dashpot / stiffness_);
      const Piece pushing = path.below(knee), parting = path.within(knee, 0);
      const double end = to[i] < knee ? stiffness_ * to[i] + dashpot : force(0, to[i]);
      const double end_slope = to[i] < knee ? stiffness_ + per_step : 0;
      if (average) {
        response.traction[i] = pushing.share * (stiffness_ * pushing.middle + dashpot);
        // a path that crosses 0 inwards meets the jump from 0 to c r, with lever |from|/length
        const double jump = from[i] > 0 && to[i] < 0 ? per_step * from[i] / path.length() : 0;
        if (response.slope != nullptr) response.slope[i] = pushing.share * (stiffness_ * pushing.lever + per_step) + jump;
        if (response.end != nullptr) response.end[i] = end;
        if (response.next != nullptr) response.next[i] = to[i] < knee ? 0.5 * stiffness_ + per_step : 0;
      } else {
        response.traction[i] = end;
        if (response.slope != nullptr) response.slope[i] = end_slope;
      }
      if (response.now != nullptr && damping_ > 0)
        response.now[i] = old[i] + path.length() * (pushing.share * std::abs(dashpot) - parting.share * stiffness_ * parting.middle);
    }
  }

  double stiffness_, damping_;  // Pa/m, Pa s/m
};

}  // namespace

const Entry<InterfaceLaw>& entry_law_springs() {
  static const Entry<InterfaceLaw> entry =
      joint_entry({.name = "springs",
                   .summary = "tensionless springs (Winkler base without tension), with a dashpot in contact if wanted",
                   .equations = "t_n = K_n min(d_n, 0)\n"
                                "with damping: t_n = min(0, K_n d_n + c d'_n) while d_n < 0, else 0: it never pulls",
                   .source = "Winkler (1867); the dashpot as in Kelvin-Voigt contact, cut off at zero force",
                   .params = {number("K_n", "Pa/m", "normal stiffness in compression").positive().or_word("soil"),
                              number("c", "Pa s/m", "damping while in contact").nonnegative().or_word("soil").standard(0.0)}},
                  "none", [](const Values& values) -> std::unique_ptr<const NormalLaw> {
                    return std::make_unique<Springs>(values.number("K_n"), values.number("c"));
                  });
  return entry;
}

}  // namespace uplift
