// A bar that strikes a joint of k F_ii = 1000 under gravity, with filtered energy decay and with the trapezoidal rule. E = 900, rho = 1, A
// = 1, L = 10, v0 = -10, g = 1, 100 two-node elements with lumped mass. Exact (d'Alembert): every element falls freely until the wave from
// the contact stops it, so the contact presses with rho c A (v0 + g t) = 30 (10 + t) for 2L/c = 2/3 s. The scheme is written out below for
// this bar alone, from its equations (docs/theory, section 3) and with bisection for the joint.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "manual.h"
#include "support.h"

namespace uplift::verification::energy_decay_bar_test {
namespace {

using Column = std::vector<double>;

constexpr int elements = 100;
constexpr double element = 9000, lumped = 0.05;  // N/m; kg at each end of an element
constexpr double transit = 1.0 / 300;            // s, of a wave through an element
constexpr double speed = 10, gravity = 1, energy = 500;

/// k F_ii = 1000 at a step of the transit time with the trapezoidal rule. K_eff = K + 4M/h^2 of the half-infinite chain has the element
/// matrix [[s, -r], [-r, s]]: amplitudes decay as x^i with 2 s = r (x + 1/x), and its end has the stiffness s - r x.
double stiff_joint() {
  const double s = element + 4 * lumped / (transit * transit), r = element;
  return 1000 * std::sqrt(s * s - r * r);
}

/// Sums of an element matrix [[d, o], [o, d]] over the bar, times x.
Column product(double d, double o, const Column& x) {
  Column y(x.size());
  for (std::size_t i = 0; i + 1 < x.size(); ++i) y[i] += d * x[i] + o * x[i + 1], y[i + 1] += o * x[i] + d * x[i + 1];
  return y;
}

/// Solution of the same sum for a right-hand side (Thomas).
Column solution(double d, double o, Column y) {
  const std::size_t n = y.size();
  Column pivot(n, 2 * d), ratio(n);
  pivot.front() = pivot.back() = d;
  for (std::size_t i = 1; i < n; ++i) {
    ratio[i] = o / pivot[i - 1];
    pivot[i] -= ratio[i] * o;
    y[i] -= ratio[i] * y[i - 1];
  }
  y.back() /= pivot.back();
  for (std::size_t i = n - 1; i-- > 0;) y[i] = y[i] / pivot[i] - ratio[i + 1] * y[i + 1];
  return y;
}

/// Pressure of every step [N], with the spectral radius 1/2 at infinite frequency.
Column march(double gap, double k, double h, int steps) {
  const double a = -0.2, b = 1.0 / 30, g = 0.5 + b, d = element + lumped / (g * g * h * h);
  const std::size_t n = elements + 1;
  Column u(n), v(n, -speed), filtered_u(n), filtered_v(n), unit(n), pressures;
  unit[0] = 1;
  const Column flexible = solution(d, -element, unit), weight = product(lumped, 0, Column(n, -gravity));
  double filtered_gap = 0, coefficient = 0;
  const auto energy_at = [&](double x) { return x < 0 ? 0.5 * k * x * x : 0; };
  for (int step = 0; step < steps; ++step) {
    Column u_lag(n), v_lag(n), right(n);
    for (std::size_t i = 0; i < n; ++i) u_lag[i] = u[i] - b * filtered_u[i], v_lag[i] = v[i] - b * filtered_v[i];
    const Column stiff = product(element, -element, u_lag), momentum = product(lumped, 0, v_lag);
    for (std::size_t i = 0; i < n; ++i) right[i] = weight[i] - stiff[i] + momentum[i] / (g * h);
    Column du = solution(d, -element, right);
    for (double& each : du) each /= g;
    const double c = gap < 0 ? b * k : 0, lag = c > 0 ? filtered_gap * std::sqrt(std::min(1.0, coefficient / c)) : 0;
    const auto mean = [&](double x) { return x == gap ? k * std::max(0.0, -x) : (energy_at(gap) - energy_at(x)) / (x - gap); };
    const auto pressure = [&](double x) {
      const double way = x - gap, end = k * std::max(0.0, -x);
      if (gap < 0) return std::max(0.0, mean(x) - c * (way - lag));
      return (mean(x) - end) * way >= 0 ? end : mean(x);
    };
    double low = gap + du[0], high = low + flexible[0] / g * (4 * k * (std::abs(low) + std::abs(gap)) + 1e3);
    const double free = low;
    for (int i = 0; i < 120; ++i) {
      const double middle = 0.5 * (low + high);
      (middle - free - flexible[0] / g * pressure(middle) > 0 ? high : low) = middle;
    }
    const double next = 0.5 * (low + high), p = pressure(next), way = next - gap;
    if (gap < 0) {
      const double wanted = c * (way - lag), share = wanted <= mean(next) || wanted == 0 ? 1 : mean(next) / wanted;
      coefficient = share * c, filtered_gap = a * lag + (1 - a) * way;
    } else {
      coefficient = filtered_gap = 0;
    }
    for (std::size_t i = 0; i < n; ++i) {
      du[i] += flexible[i] * p / g;
      const double dv = (du[i] / h - v_lag[i]) / g;
      u[i] += du[i], v[i] += dv;
      filtered_u[i] = a * filtered_u[i] + (1 - a) * du[i], filtered_v[i] = a * filtered_v[i] + (1 - a) * dv;
    }
    gap = next;
    pressures.push_back(p);
  }
  return pressures;
}

struct Impact {
  Column pressure;                                                      // N, of every step
  double peak = 0, windowed = 0, deviation = 0, created = 0, lost = 0;  // N; over 10 ms; of the plateau; shares of the energy of the impact
};

Impact impact(const std::string& scheme, double part, double gap) {
  Bar bar;
  bar.velocity = -speed;
  bar.gravity = gravity;
  bar.gap = gap;
  bar.law = "{ type = \"springs\", K_n = " + std::to_string(stiff_joint()) + ", tangential = \"none\" }";
  bar.impact = "\"none\"";
  bar.scheme = "\"" + scheme + "\"";
  bar.step = part * transit;
  bar.duration = 192 * transit;  // 0.64 s
  const History run = run_text(bar.text());
  Impact found;
  double sum = 0;
  int count = 0;
  const int window = std::max(1, static_cast<int>(std::lround(3 / part)));
  for (std::size_t i = 1; i < run.rows(); ++i) {
    const double middle = run.time()[i] - bar.step / 2;
    found.pressure.push_back(-run["foot.1.traction"][i]);
    found.peak = std::max(found.peak, found.pressure.back());
    double mean = 0;
    for (std::size_t k = 0; k < found.pressure.size() && k < static_cast<std::size_t>(window); ++k) mean += found.pressure[i - 1 - k];
    found.windowed = std::max(found.windowed, mean / window);
    if (middle > 0.1 && middle < 0.5) sum += std::pow(found.pressure.back() - 30 * (speed + gravity * middle), 2), ++count;
  }
  found.deviation = std::sqrt(sum / count);
  const auto without_work = [&](std::size_t i) { return (run.mechanical_energy(i) - run["energy.external"][i]) / energy; };
  for (std::size_t i = 0; i < run.rows(); ++i) found.created = std::max(found.created, without_work(i) - 1);
  found.lost = 1 - without_work(run.rows() - 1);
  std::printf("%-22s h = %.2f transit times, gap %.2g m: peak %.0f N, over 10 ms %.0f N, deviation %.2f N, created %.1e, lost %.2f %%\n",
              scheme.c_str(), part, gap, found.peak, found.windowed, found.deviation, found.created, 100 * found.lost);
  return found;
}

// Claim: every step of the program is that of the scheme written out above (1e-6 of the plateau: the tolerance of the contact solve),
// wherever in a step the contact falls. The force of the plateau, 300 to 318 N, scatters by less than 0.2 N and nothing is created. The
// first step of a contact is an impulse over the step: its peak depends on where in the step it falls (325 to 970 N). The mean over 10 ms
// exceeds the plateau by no more than the momentum of the last half element.
TEST(EnergyDecayBar, PlateauOnAStiffJoint) {
  VERIFIES(
      {"Time integration", "Bar that strikes a stiff joint, filtered energy decay",
       "The scheme written out in the test (docs/theory, section 3) with bisection for the joint; d'Alembert's solution for the plateau"});
  for (const double gap : {1.37e-3, 1e-2, 1.5e-2})
    for (const double part : {2.0, 1.0, 0.5, 0.25}) {
      SCOPED_TRACE(part);
      const Impact found = impact("energy_decay", part, gap);
      const Column expected = march(gap, stiff_joint(), part * transit, static_cast<int>(found.pressure.size()));
      for (std::size_t i = 0; i < expected.size(); ++i)
        VERIFY_NEAR("contact force of each step", "N", found.pressure[i], expected[i], 3e-4) << i << ' ' << gap;
      VERIFY_LT("scatter of the force on the plateau", "N", found.deviation, 0.2);
      VERIFY_LT("largest mean of the force over 10 ms", "N", found.windowed, 30 * (speed + gravity * 0.64) + lumped * speed / 0.01);
      VERIFY_LT("energy created, share of the impact energy", "1", found.created, 1e-10);
      VERIFY_GT("energy lost, share of the impact energy (dissipation is positive)", "1", found.lost, 0);
      VERIFY_LT("energy lost, share of the impact energy", "1", found.lost, 0.02);
    }
}

// Claim: the trapezoidal rule rings with the mesh at the same steps and keeps the energy.
TEST(EnergyDecayBar, TrapezoidalRuleRings) {
  VERIFIES({"Time integration", "Bar that strikes a stiff joint, trapezoidal rule",
            "d'Alembert's solution; conservation of energy of the path average (docs/theory, eq 12)"});
  for (const double part : {2.0, 1.0, 0.5, 0.25}) {
    const Impact found = impact("average_acceleration", part, 1.37e-3);
    VERIFY_GT("scatter of the force on the plateau (the rule rings)", "N", found.deviation, 100) << part;
    VERIFY_LT("energy lost, share of the impact energy", "1", std::abs(found.lost), 1e-9) << part;
  }
}

}  // namespace
}  // namespace uplift::verification::energy_decay_bar_test
