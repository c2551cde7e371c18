// The joint filter of the scheme of filtered energy decay on the macro-element (docs/theory/macro_element.md, eqs M29 to M32).
#include <array>

#include "macro_element_support.h"
#include "uplift/laws/macro_filter.h"
#include "uplift/math/linalg.h"

namespace uplift::macro_test::macro_element_filter_test {
namespace {

constexpr double pole = -0.2, gain = 1.0 / 30;  // rho = 0.5

/// A footing with what the filter remembers, booked here by (12a) of the theory.
class Filtered {
 public:
  Filtered(const MacroParameters& parameters, int components)
      : footing(parameters, components), plain(static_cast<std::size_t>(components)), lag_(Vector::Zero(components)) {
    begin();
  }

  const Numbers& mean(const Numbers& to) {
    footing.law.mean(
        batch_, footing.opening.data(), to.data(), footing.memory.data(),
        {footing.force.data(), footing.slope.data(), footing.now.data(), footing.end.data(), footing.next.data(), plain.data()});
    return footing.force;
  }

  /// After `mean`: accepts the step. Returns what the filter stores more and dissipates (J).
  std::pair<double, double> accept(const Numbers& to) {
    const Index n = lag_.size();
    const Vector force = vector(footing.force), added = force - vector(plain), moved = vector(to) - vector(footing.opening);
    double lost = 0, after = 0;
    Vector remembered = Vector::Zero(n);
    if (contact_) {
      Vector elastic(n);
      Matrix slope(n, n);
      footing.law.elastic(static_cast<int>(n), to.data(), footing.now.data(), elastic.data(), slope.data());
      const Vector step = elastic - elastic_, y = c_ * (step - lag_);
      share = y.squaredNorm() > 0 ? (step - lag_).dot(added) / (step - lag_).dot(y) : 1;
      clear = y.norm() > 1e-8 * force.norm();
      for (Index r = 0; r < n; ++r) EXPECT_NEAR(added[r], share * y[r], 1e-8 * (std::abs(force[r]) + std::abs(y[r])) + 1e-6) << "one theta";
      remembered = pole * lag_ + (1 - pole) * step;
      lost = share * 0.5 * (1 + pole) * (step - lag_).dot(y);
      after = share * remembered.dot(c_ * remembered) / (2 * (1 - pole));
      lost += before_ - share * lag_.dot(c_ * lag_) / (2 * (1 - pole));  // what is released
    } else {
      lost = added.dot(moved) + before_;
    }
    const double more = after - before_;
    before_ = after;
    footing.accept(to);
    begin(remembered);
    return {more, lost};
  }

  bool contact() const { return contact_; }
  double stored() const { return before_; }
  const Vector& lag() const { return lag_; }

  Footing footing;
  Numbers plain;
  double share = 1;    // theta
  bool clear = false;  // theta y is more than the round-off of the forces

 private:
  static Vector vector(const Numbers& values) { return Eigen::Map<const Vector>(values.data(), static_cast<Index>(values.size())); }

  void begin() { begin(lag_); }
  void begin(const Vector& remembered) {
    const Index n = remembered.size();
    elastic_.setZero(n), c_.setZero(n, n);
    footing.law.elastic(static_cast<int>(n), footing.opening.data(), footing.memory.data(), elastic_.data(), c_.data());
    c_ *= gain;
    contact_ = c_.norm() > 0;
    const double most = 2 * (1 - pole) * before_, wanted = remembered.dot(c_ * remembered);
    lag_ = wanted > most ? Vector(std::sqrt(most / wanted) * remembered) : remembered;
    pull_ = c_ * lag_;
    rows_.setConstant(n, contact_ ? 1 : -1);
    batch_ = footing.batch;
    batch_.coefficient = rows_.data(), batch_.lag = pull_.data(), batch_.gain = gain;
  }

  Batch batch_;
  Vector lag_, elastic_, pull_, rows_;
  Matrix c_;
  double before_ = 0;
  bool contact_ = true;
};

double pulling(const Numbers& force, const MacroElasticity& e) {  // > 0: N < 0, or a moment beyond the edge
  const std::size_t normal = force.size() == 3 ? 1 : 2;
  const double one = 2 * std::abs(force[normal == 1 ? 2 : 4]) / e.length[0], two = normal == 1 ? 0 : 2 * std::abs(force[3]) / e.length[1];
  return force[normal] + (e.disc ? std::hypot(one, two) : std::max(one, two));
}

MacroParameters foundation(unsigned k) {
  MacroParameters p = square();
  p.elasticity.shape = std::array{4.0, 6.0, 8.0, 5.3}[k % 4];
  p.elasticity.disc = k % 3 == 1;
  if (k % 5 == 0) p.strength.ultimate = 100e6, p.strength.reference = 0.05;
  if (k % 5 == 1) p.strength.service = HUGE_VAL;
  if (k % 5 == 2) p.strength.flow = MacroStrength::Flow::associated;
  if (k % 5 == 3) p.strength.power_law = MacroPowerLaw{{0.3, 0.7, 0.9, 2}, {0.4, 0.8, 0.9, 2}};
  if (k % 5 == 4) p.strength.cohesion = 5e4;
  return p;
}

/// Short and long steps: balance, no energy from the filter or the ground, no adhesion, storage never negative.
TEST(MacroElementFilter, OnlyDissipatesOnRandomPaths) {
  int steps = 0, landed = 0, lifted = 0, shortened = 0;
  for (unsigned k = 0; k < 240; ++k) {
    const int components = k % 2 == 0 ? 3 : 6;
    const MacroParameters p = foundation(k / 2);
    Filtered filtered(p, components);
    RandomPath path(components, std::array{0.3, 1.0, 4.0}[k % 3], k);
    Numbers target = path.next(filtered.footing.memory);
    const double share = std::array{1.0, 0.2, 0.02}[k / 3 % 3];
    for (int i = 0; i < 12; ++i) {
      if (i % 6 == 0) target = path.next(filtered.footing.memory);
      Numbers to = target;
      if (k % 7 == 0 && i % 4 == 2) to[components == 3 ? 1 : 2] += 0.02;  // off the ground
      for (std::size_t r = 0; r < to.size(); ++r) to[r] = filtered.footing.opening[r] + share * (to[r] - filtered.footing.opening[r]);
      if (!finite(filtered.mean(to))) break;
      const Footing& f = filtered.footing;
      double work = 0, size = 0;
      for (std::size_t r = 0; r < to.size(); ++r) {
        work += f.force[r] * (to[r] - f.opening[r]);
        size += std::abs(f.force[r] * (to[r] - f.opening[r]));
      }
      const double before = f.stored(f.opening, f.memory), after = f.stored(to, f.now),
                   yielded = f.dissipated(f.now) - f.dissipated(f.memory);
      const bool contact = filtered.contact();
      if (contact) EXPECT_LE(pulling(f.force, p.elasticity), std::max(0.0, pulling(filtered.plain, p.elasticity)) + 1e-3) << k;  // N
      const auto [more, lost] = filtered.accept(to);
      const double round_off = 1e-12 * (size + before + after + yielded + f.dissipated(f.memory) + filtered.stored());
      EXPECT_GE(yielded, 0) << k;
      EXPECT_GE(lost, -round_off) << k;
      EXPECT_GE(filtered.stored(), 0) << k;
      EXPECT_NEAR(work, after - before + yielded + more + lost, 100 * round_off) << k << ' ' << i;
      if (contact && filtered.clear) EXPECT_TRUE(filtered.share >= -1e-6 && filtered.share <= 1 + 1e-6) << filtered.share;
      ++steps, landed += !contact && filtered.contact(), lifted += contact && !filtered.contact();
      shortened += contact && filtered.share < 0.999;
    }
  }
  EXPECT_GT(steps, 2000);
  EXPECT_GT(landed, 20);
  EXPECT_GT(lifted, 20);
  EXPECT_GT(shortened, 50);
}

/// Slope beside central differences, with a lag of the size of the step and where theta is below 1.
TEST(MacroElementFilter, SlopeIsTheDerivative) {
  for (const int components : {3, 6}) {
    Numbers errors, shortened;  // shortened: theta below 1
    for (unsigned k = 0; k < 60; ++k) {
      const MacroParameters p = foundation(k);
      Filtered filtered(p, components);
      RandomPath path(components, k % 2 == 0 ? 1 : 3, k);
      Numbers scale(static_cast<std::size_t>(components));
      filtered.footing.law.closed_stiffness(components, scale.data());
      for (int i = 0; i < 4; ++i) {
        const Numbers to = path.next(filtered.footing.memory);
        if (!finite(filtered.mean(to))) break;
        const Numbers slope = filtered.footing.slope;
        const std::size_t n = scale.size(), normal = components == 3 ? 1 : 2;
        double error = 0;
        for (std::size_t c = 0; c < n; ++c) {
          const double h = c <= normal ? 1e-8 : 1e-9;
          Numbers moved = to;
          moved[c] += h;
          const Numbers up = filtered.mean(moved);
          moved[c] -= 2 * h;
          const Numbers down = filtered.mean(moved);
          for (std::size_t r = 0; r < n; ++r)
            error = std::max(error, std::abs((up[r] - down[r]) / (2 * h) - slope[r * n + c]) / std::sqrt(scale[r] * scale[c]));
        }
        filtered.mean(to);
        const bool contact = filtered.contact();
        filtered.accept(to);
        (contact && filtered.share < 0.999 ? shortened : errors).push_back(std::isfinite(error) ? error : 1);
      }
    }
    ASSERT_GT(errors.size(), 100U);
    ASSERT_GT(shortened.size(), 10U);
    for (Numbers* each : {&errors, &shortened}) {  // a few differences cross a corner of the law
      std::ranges::sort(*each);
      EXPECT_LT((*each)[each->size() * 4 / 5], 1e-4);
      EXPECT_LT((*each)[each->size() / 2], 1e-6);
    }
  }
}

/// theta of (M32) for forces and a dissipation that depend linearly on the end of the step: largest, and with its derivatives.
TEST(MacroElementFilter, TakesTheLargestShareAndKnowsItsSlope) {
  std::mt19937 random(7);
  const auto any = [&] { return std::uniform_real_distribution<double>(-1, 1)(random); };
  int at_edge = 0, by_yielding = 0, beyond = 0;
  for (int k = 0; k < 400; ++k) {
    MacroElasticity ground{.disc = k % 2 == 0, .length = {2, k % 2 == 0 ? 2.0 : 3.0}};
    MacroMatrix half, elastic, force;
    MacroVector pull, mean, to, lost;
    for (int i = 0; i < 5; ++i) {
      for (int j = 0; j < 5; ++j) half(i, j) = any(), elastic(i, j) = 0.2 * any() + (i == j), force(i, j) = any();
      pull[i] = any(), mean[i] = any(), to[i] = any(), lost[i] = 0.1 * any();
    }
    mean[macro_n] += k % 4 < 2 ? 2 : 0.3;
    const MacroMatrix coefficient = half * half.transpose();
    const auto step_at = [&](const MacroVector& q) {
      return MacroFilterStep{.increment = q,
                             .elastic = elastic * q,
                             .elastic_slope = elastic,
                             .mean = mean + force * (q - to),
                             .mean_slope = force,
                             .dissipated = 0.05 + lost.dot(q - to),
                             .dissipated_slope = lost};
    };
    const auto filter_at = [&](const MacroVector& q) { return macro_filter(ground, coefficient, pull, step_at(q)); };
    const auto tilt = [&](const MacroVector& f) {
      const double one = 2 / ground.length[0] * std::abs(f[macro_m1]), two = 2 / ground.length[1] * std::abs(f[macro_m2]);
      return (ground.disc ? std::hypot(one, two) : std::max(one, two)) - f[macro_n];
    };
    const MacroFilter filter = filter_at(to);
    const MacroFilterStep step = step_at(to);
    const MacroVector y = coefficient * step.elastic - pull;
    EXPECT_LE((filter.force - filter.share * y).norm(), 1e-12);
    const auto admissible = [&](double share, double slack) {
      return tilt(step.mean + share * y) <= std::max(tilt(step.mean), 0.0) + slack &&
             step.dissipated + share * y.dot(step.increment - step.elastic) >= -slack;
    };
    EXPECT_TRUE(filter.share >= 0 && filter.share <= 1 && admissible(filter.share, 1e-10));
    if (filter.share > 0.999 || filter.share == 0) continue;
    EXPECT_FALSE(admissible(filter.share + 1e-6, 0)) << k;
    (step.dissipated + filter.dissipated < 1e-12 ? by_yielding : at_edge)++;
    beyond += tilt(step.mean) > 0;
    for (int c = 0; c < 5; ++c) {
      MacroVector up = to, down = to;
      up[c] += 1e-6, down[c] -= 1e-6;
      const MacroVector difference = (filter_at(up).force - filter_at(down).force) / 2e-6;
      EXPECT_LE((difference - filter.slope.col(c)).norm(), 1e-6 * (1 + difference.norm())) << k;
    }
  }
  EXPECT_GT(at_edge, 40);
  EXPECT_GT(by_yielding, 40);
  EXPECT_GT(beyond, 5);
}

/// Pressed in full and without yielding it is the filter of linear springs: K (q_0 + q_1)/2 + b K (d - d_f).
TEST(MacroElementFilter, IsThatOfSpringsWhileNothingLifts) {
  for (const int components : {3, 6}) {
    MacroParameters p = square();
    p.strength.service = HUGE_VAL;
    Filtered filtered(p, components);
    const std::size_t n = static_cast<std::size_t>(components), normal = components == 3 ? 1 : 2;
    Numbers k(n), at(n), expected(n), remembered(n);
    filtered.footing.law.closed_stiffness(components, k.data());
    at[normal] = -0.01;  // 26.9 MN
    filtered.mean(at), filtered.accept(at);
    for (std::size_t r = 0; r < n; ++r) remembered[r] = filtered.lag()[static_cast<Index>(r)];
    for (int i = 1; i < 20; ++i) {
      Numbers to = at;
      for (std::size_t r = 0; r < n; ++r) to[r] += (r <= normal ? 2e-4 : 1e-5) * std::sin(1.3 * i + static_cast<double>(r));
      filtered.mean(to);
      for (std::size_t r = 0; r < n; ++r) {
        const double step = to[r] - at[r];
        expected[r] = k[r] * (0.5 * (at[r] + to[r]) + gain * (step - remembered[r]));
        EXPECT_NEAR(filtered.footing.force[r], expected[r], 1e-12 * std::abs(expected[r]) + 1e-12 * k[r] * (r <= normal ? 1e-2 : 1e-3))
            << r;
        remembered[r] = pole * remembered[r] + (1 - pole) * step;
      }
      filtered.accept(to);
      at = to;
    }
  }
}

/// In the air at the start: the forces at the end, not the average, which is half of them here.
TEST(MacroElementFilter, LandingTakesTheForcesAtTheEnd) {
  MacroParameters p = lifting(4, 6, 6e8, 1.8e9);
  Filtered filtered(p, 3);
  filtered.mean({0, 0.01, 0}), filtered.accept({0, 0.01, 0});
  ASSERT_FALSE(filtered.contact());
  filtered.mean({0, -0.002, 1e-5});
  EXPECT_NEAR(filtered.footing.force[1], -6e8 * 0.002, 1e-6);
  EXPECT_NEAR(filtered.footing.force[2], 1.8e9 * 1e-5, 1e-6);
  // two springs: (p(g_1) - mean) moves through the whole step
  const double stored = 0.5 * (6e8 * 0.002 * 0.002 + 1.8e9 * 1e-10);
  EXPECT_NEAR(filtered.accept({0, -0.002, 1e-5}).second, 6e8 * 0.002 * 0.012 + 1.8e9 * 1e-10 - stored, 1e-9 * stored);
}

}  // namespace
}  // namespace uplift::macro_test::macro_element_filter_test
