// The reference oscillator: a mass on a massless inextensible column of 5 m on a rigid footing 3 m wide that is pressed
// on a tensionless Winkler base by 1 MN and hit by a half-sine pulse. Everything is compared with an integration of its own here: exact
// contact length, classical Runge-Kutta with 1e-5 s (error below 1e-9 of the peaks), and with the curves of the reference folder when that
// is there.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "manual.h"
#include "support.h"
#include "tower_case.h"

namespace uplift::verification::oscillator_test {
namespace {

using std::numbers::pi;

constexpr double h = 5, half = 1.5, base_mass = 1e4, base_inertia = 7500, load = 1e6, bed = 2e8, EI = 20000e6 * 0.20;
const double stiffness = 3 * EI / (h * h * h), mass = stiffness / std::pow(2 * pi * 10, 2);

/// x of the top, rotation towards +x, settlement of the footing, and their rates.
using Motion = std::array<double, 6>;

struct Contact {
  double force = 0, moment = 0, uplifted = 0, jump = 0, toe = 0;
};

/// Exact resultants of the Winkler base: settlement w + x theta where positive.
Contact contact(double w, double theta) {
  Contact c;
  const double left = w - theta * half, right = w + theta * half;
  c.toe = bed * std::max({left, right, 0.0});
  c.jump = std::max({0.0, -left, -right});
  double lo = -half, hi = half;
  if (left < 0) lo = std::min(half, -w / theta);
  if (right < 0) hi = std::max(-half, -w / theta);
  if (left < 0 && right < 0) hi = lo;
  c.uplifted = 1 - (hi - lo) / (2 * half);
  c.force = bed * (w * (hi - lo) + theta * (hi * hi - lo * lo) / 2);
  c.moment = bed * (w * (hi * hi - lo * lo) / 2 + theta * (hi * hi * hi - lo * lo * lo) / 3);
  return c;
}

Motion rate(double t, const Motion& y, double pulse) {
  const Contact c = contact(y[2], y[1]);
  const double spring = stiffness * (y[0] - h * y[1]), push = t < 0.1 ? pulse * std::sin(pi * t / 0.1) : 0;
  return {y[3], y[4], y[5], (push - spring) / mass, (spring * h - c.moment) / base_inertia, (load - c.force) / (base_mass + mass)};
}

struct Exact {
  double dt = 0;
  std::vector<double> x, theta, settlement;  // every 1e-4 s
  double x_peak = 0, theta_peak = 0, moment = 0, uplifted = 0, jump = 0, toe = 0;
};

Exact integrate(double pulse, double duration) {
  Exact result;
  result.dt = 1e-4;
  Motion y{0, 0, load / (2 * half * bed), 0, 0, 0};
  const double dt = 1e-5;
  const auto plus = [](const Motion& a, double factor, const Motion& b) {
    Motion sum = a;
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += factor * b[i];
    return sum;
  };
  const long steps = std::lround(duration / dt);
  for (long i = 0; i <= steps; ++i) {
    const double t = static_cast<double>(i) * dt;
    const Contact c = contact(y[2], y[1]);
    result.x_peak = std::max(result.x_peak, std::abs(y[0]));
    result.theta_peak = std::max(result.theta_peak, std::abs(y[1]));
    result.moment = std::max(result.moment, std::abs(c.moment));
    result.uplifted = std::max(result.uplifted, c.uplifted);
    result.jump = std::max(result.jump, c.jump);
    result.toe = std::max(result.toe, c.toe);
    if (i % 10 == 0) result.x.push_back(y[0]), result.theta.push_back(y[1]), result.settlement.push_back(y[2]);
    const Motion a = rate(t, y, pulse), b = rate(t + dt / 2, plus(y, dt / 2, a), pulse), c2 = rate(t + dt / 2, plus(y, dt / 2, b), pulse),
                 d = rate(t + dt, plus(y, dt, c2), pulse);
    for (std::size_t k = 0; k < y.size(); ++k) y[k] += dt / 6 * (a[k] + 2 * b[k] + 2 * c2[k] + d[k]);
  }
  return result;
}

struct Oscillator {
  double pulse = 3e5, step = 5e-4, duration = 1;
  int points = 200;
  std::string law = "{ type = \"springs\", K_n = 2e8, tangential = \"none\" }", method, impact = "project_hold", rule = "nodal", bed;
  std::string damping;
  bool macro_element = false;  // with shape number 6 and K_r = K_v D^2/12, instead of the points
  int every = 1;

  std::string ground() const {
    if (macro_element)
      return "[[foundation]]\nname = \"soil\"\nbody = \"base\"\nwidth = 3\n"
             "model = { type = \"macro_element\", shape_number = 6, K_v = 6e8, K_h = 1e8, K_r = 4.5e8 }\n";
    return fmt::format(
        "[[interface]]\nname = \"soil\"\nlaw = {}\n[interface.footing]\nbody = \"base\"\nwidth = 3\npoints = {}\nrule = \"{}\"\n{}\n", law,
        points, rule, bed);
  }
  std::string text() const {
    return fmt::format("title = \"Reference oscillator\"\nimpact = \"{}\"\n{}", impact, method) +
           support::Tower{.mass = fmt::format("mass = {:.17g}", mass)}.text() + ground() +
           fmt::format(
               "[[load]]\nnode = \"top\"\nforce = [0, -1e6]\n[[function]]\nname = \"pulse\"\n"
               "shape = {{ type = \"half_sine\", duration = 0.1 }}\n"
               "[[load]]\nnode = \"top\"\nforce = [{:.17g}, 0]\nfunction = \"pulse\"\n{}\n"
               "[[stage]]\ntype = \"static\"\nsteps = 1\n[[stage]]\ntype = \"dynamic\"\nduration = {:.17g}\nstep = {:.17g}\n"
               "[energy]\ncreated_limit = 1e9\n[output]\nframes = 0\nevery = {}\n",
               pulse, damping, duration, step, every);
  }
};

/// Root mean square of a difference, relative to that of b.
double distance(const std::vector<double>& a, const std::vector<double>& b) {
  double difference = 0, size = 0;
  for (std::size_t i = 0; i < a.size(); ++i) difference += (a[i] - b[i]) * (a[i] - b[i]), size += b[i] * b[i];
  return std::sqrt(difference / size);
}

// Claim: the integration of this test agrees with an independent one (DOP853 at 1e-11): curves to 1e-8 of their peaks in the first
// second, and its first peaks.
TEST(ReferenceOscillator, TheIntegrationOfThisTest) {
  VERIFIES({"Reference oscillator", "The integration of the reference",
            "DOP853 at a tolerance of 1e-11: tests/data/reference/oscillator_A.csv, oscillator_C.csv"});
  const Exact a = integrate(3e5, 1), c = integrate(5e4, 1);
  VERIFY_NEAR("peak of the top", "m", a.x_peak, 3.584171e-2, 1e-6 * 3.584171e-2);
  VERIFY_NEAR("uplifted share of case C", "1", c.uplifted, 0, 0);
  for (const auto& [file, exact] : {std::pair<std::string, const Exact*>{"oscillator_A.csv", &a}, {"oscillator_C.csv", &c}}) {
    const Reference curve = reference(file);
    for (std::size_t i = 0; i < curve["t"].size() && curve["t"][i] <= 1; ++i) {
      const std::size_t at = static_cast<std::size_t>(std::lround(curve["t"][i] / exact->dt));
      VERIFY_NEAR("motion of the top", "m", exact->x[at], curve["x_top"][i], 1e-8 * exact->x_peak * 10);
      VERIFY_NEAR("rotation of the base", "rad", exact->theta[at], curve["theta"][i], 1e-8 * exact->theta_peak * 10);
      VERIFY_NEAR("settlement", "m", exact->settlement[at], curve["w_centre"][i], 1e-8 * exact->x_peak);
    }
  }
}

// Claim: peaks of the first second with 200 points of tensionless springs: motion to 1e-3 at 0.5 ms. With uplift
// the base moment, the toe pressure and the jump carry the footing's own vibration (about 100 Hz): 5e-3 at 0.5 ms, 1e-3 at 0.125 ms. The
// uplifted ratio is counted in points: 1/200. The path average closes the energy balance (1e-9 of the work).
TEST(ReferenceOscillator, Peaks) {
  VERIFIES({"Reference oscillator", "Peaks of the reference oscillator", "Runge-Kutta integration with exact contact length"});
  for (const double pulse : {3e5, 5e4}) {
    const Exact exact = integrate(pulse, 1);
    for (const double dt : {5e-4, 1.25e-4}) {
      Oscillator oscillator;
      oscillator.pulse = pulse;
      oscillator.step = dt;
      const History run = run_text(oscillator.text());
      ASSERT_EQ(run.status, "completed") << run.reason;
      const double sharp = 1e-3, forces = pulse > 1e5 && dt > 2e-4 ? 5e-3 : sharp;
      VERIFY_NEAR("motion of the top over the reference", "1", run.peak("top.ux") / exact.x_peak, 1, sharp) << pulse;
      VERIFY_NEAR("rotation over the reference", "1", run.peak("base.rz") / exact.theta_peak, 1, sharp) << pulse;
      VERIFY_NEAR("base moment over the reference", "1", run.peak("soil.moment") / exact.moment, 1, forces) << pulse;
      VERIFY_NEAR("toe pressure over the reference", "1", run.peak("soil.max_pressure") / exact.toe, 1, forces) << pulse;
      if (exact.jump > 0) VERIFY_NEAR("largest gap over the reference", "1", run.peak("soil.max_opening") / exact.jump, 1, forces) << pulse;
      VERIFY_NEAR("uplifted share", "1", run.peak("soil.uplifted_ratio"), exact.uplifted, 5.1e-3) << pulse;
      VERIFY_LT("residual of the energy balance", "J", run.peak("energy.residual"), 1e-9 * run.peak("energy.external"));
    }
  }
}

// Claim: order 2 in the step for fixed points, and order 2 in the points (nodal quadrature), with and without
// uplift.
TEST(ReferenceOscillator, Orders) {
  VERIFIES(
      {"Reference oscillator", "Order in the step and in the points", "Own refinement; Runge-Kutta integration with exact contact length"});
  for (const double pulse : {3e5, 5e4}) {
    std::vector<double> step, error;
    Oscillator fine;
    fine.pulse = pulse;
    fine.points = 60;
    fine.duration = 0.5;
    fine.step = 6.25e-5;
    const History reference_run = run_text(fine.text());
    for (const double dt : {2e-3, 1e-3, 5e-4}) {
      Oscillator coarse = fine;
      coarse.step = dt;
      const History run = run_text(coarse.text());
      std::vector<double> same;
      for (std::size_t i = 0; i < run.rows(); ++i)
        same.push_back(reference_run["top.ux"][i * static_cast<std::size_t>(std::lround(dt / fine.step))]);
      step.push_back(dt);
      error.push_back(distance(run["top.ux"], same));
    }
    RecordProperty("order_dt_" + std::to_string(pulse), std::to_string(order(step, error)));
    verified_case.curve(pulse > 1e5 ? "step, with uplift" : "step, without uplift", step, error);
    VERIFY_NEAR("order in the step", "1", order(step, error), 2, 0.25) << pulse;
    const Exact exact = integrate(pulse, 0.5);
    std::vector<double> size, far;
    for (const int points : {11, 21, 41}) {
      Oscillator coarse = fine;
      coarse.points = points;
      coarse.step = 1e-4;
      const History run = run_text(coarse.text());
      size.push_back(1.0 / (points - 1));
      far.push_back(distance(run["top.ux"], exact.x));
    }
    RecordProperty("order_points_" + std::to_string(pulse), std::to_string(order(size, far)));
    verified_case.curve(pulse > 1e5 ? "points, with uplift" : "points, without uplift", size, far);
    VERIFY_NEAR("order in the points", "1", order(size, far), 2, 0.3) << pulse;
  }
}

/// The same oscillator on 200 SDM joints (nodal rule) with F_u = 0: memory j = largest opening of a point, t = K (d - j)/(1 + K j/|F_c|)
/// down to F_c, K d below (docs/theory, eqs (2) and (3)). Runge-Kutta with 1e-4 s, j from the stages too; x of the top every 1e-3 s.
std::vector<double> integrate_sdm(double pulse, double closure, double duration) {
  const int n = 200;
  std::vector<double> jump(n, 0.0), x;
  const double dt = 1e-4;
  const auto rate_of = [&](double t, const Motion& y) {
    double force = 0, moment = 0;
    for (int i = 0; i < n; ++i) {
      const double at = -half + 2 * half * i / (n - 1), area = 2 * half / (n - 1) * (i == 0 || i == n - 1 ? 0.5 : 1.0);
      const double opening = -(y[2] + y[1] * at), j = jump[static_cast<std::size_t>(i)];
      if (opening >= j) continue;
      double pressure = -bed * (opening - j) / (1 + bed * j / closure);
      if (pressure > closure) pressure = -bed * opening;
      force += area * pressure;
      moment += area * pressure * at;
    }
    const double spring = stiffness * (y[0] - h * y[1]), push = t < 0.1 ? pulse * std::sin(pi * t / 0.1) : 0;
    return Motion{y[3], y[4], y[5], (push - spring) / mass, (spring * h - moment) / base_inertia, (load - force) / (base_mass + mass)};
  };
  const auto plus = [](const Motion& a, double factor, const Motion& b) {
    Motion sum = a;
    for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += factor * b[k];
    return sum;
  };
  Motion y{0, 0, load / (2 * half * bed), 0, 0, 0};
  for (long step = 0; step <= std::lround(duration / dt); ++step) {
    if (step % 10 == 0) x.push_back(y[0]);
    const double t = static_cast<double>(step) * dt;
    const Motion a = rate_of(t, y), b = rate_of(t + dt / 2, plus(y, dt / 2, a)), c = rate_of(t + dt / 2, plus(y, dt / 2, b)),
                 d = rate_of(t + dt, plus(y, dt, c));
    for (std::size_t k = 0; k < y.size(); ++k) y[k] += dt / 6 * (a[k] + 2 * b[k] + 2 * c[k] + d[k]);
    for (int i = 0; i < n; ++i) {
      const double at = -half + 2 * half * i / (n - 1);
      jump[static_cast<std::size_t>(i)] = std::max(jump[static_cast<std::size_t>(i)], -(y[2] + y[1] * at));
    }
  }
  return x;
}

// Claim: the SDM's closure stress, 200 points, first second, 1 ms. The program's motion of the top is that of the integration above: 0.5 %
// rms (the program's step is ten times longer). Its rms distance from the tensionless base, over the peak, follows a published table, 0.06
// % to 21 % for |F_c|/mean pressure from 0.003 to 1: the table does not say over which time nor by which measure; over the first second and
// the peak it is met within 10 % from 0.1 on and within a half at the smallest.
TEST(ReferenceOscillator, ClosureStress) {
  VERIFIES({"Reference oscillator", "Closure stress of the SDM", "Runge-Kutta integration of 200 SDM joints; a published table"});
  Oscillator base;
  base.step = 1e-3;
  const History tensionless = run_text(base.text());
  const double ratios[] = {0.003, 0.01, 0.03, 0.1, 0.3, 1}, expected[] = {0.0006, 0.0024, 0.008, 0.028, 0.077, 0.21};
  for (int i = 0; i < 6; ++i) {
    Oscillator sdm = base;
    const double closure = ratios[i] * load / (2 * half);
    char law[200];
    std::snprintf(law, sizeof law, "{ type = \"sdm\", K_n = 2e8, F_u = 0, G_f = 1, F_c = %.17g, tangential = \"none\" }", -closure);
    sdm.law = law;
    const History run = run_text(sdm.text());
    double square = 0, peak = tensionless.peak("top.ux");
    for (std::size_t k = 0; k < run.rows(); ++k)
      square += std::pow(run["top.ux"][k] - tensionless["top.ux"][k], 2) / static_cast<double>(run.rows());
    const double measured = std::sqrt(square) / peak;
    RecordProperty("rms_over_peak_" + std::to_string(ratios[i]), std::to_string(measured));
    VERIFY_NEAR("rms distance from the tensionless base over the published one", "1", measured / expected[i], 1,
                ratios[i] < 0.1 ? 0.5 : 0.1)
        << ratios[i];
    const double own = distance(run["top.ux"], integrate_sdm(3e5, closure, 1));
    RecordProperty("own_" + std::to_string(ratios[i]), std::to_string(own));
    VERIFY_LT("rms distance from the integration of the test", "1", own, 0.005) << ratios[i];
    VERIFY_LT("residual of the energy balance", "J", run.peak("energy.residual"), 1e-9 * run.peak("energy.external"));
  }
}

// Claim: a macro-element with shape number 6 and K_r = K_v D^2/12 in place of the springs is the same base. The peaks of three seconds,
// sampled at 1 ms, are given to seven digits; the integration of this test has all of them. The program converges to it with order 2 in
// the step. A bed of points converges to the element with order 2 in the points at the same step: only the points part them.
TEST(ReferenceOscillator, MacroElement) {
  VERIFIES(
      {"Reference oscillator", "The oscillator on a macro-element",
       "Runge-Kutta integration with exact contact length; DOP853 at 1e-11: peaks sampled at 1 ms, tests/data/reference/oscillator_A.csv"});
  const Exact exact = integrate(3e5, 3);
  struct Peaks {
    double top = 0, time = 0, rotation = 0, moment = 0, share = 0;
  };
  const auto peaks_of = [](const std::vector<double>& x, const std::vector<double>& theta, const std::vector<double>& w, std::size_t stride,
                           double dt) {
    Peaks found;
    for (std::size_t i = 0; i < x.size(); i += stride) {
      if (std::abs(x[i]) > found.top) found.top = std::abs(x[i]), found.time = static_cast<double>(i) * dt;
      const Contact c = contact(w[i], theta[i]);
      found.rotation = std::max(found.rotation, std::abs(theta[i]));
      found.moment = std::max(found.moment, std::abs(c.moment)), found.share = std::max(found.share, c.uplifted);
    }
    return found;
  };
  const Peaks sampled = peaks_of(exact.x, exact.theta, exact.settlement, 10, exact.dt);
  VERIFY_NEAR("peak of the top, sampled at 1 ms", "m", sampled.top, 3.587591e-2, 5e-9);
  VERIFY_NEAR("its time", "s", sampled.time, 1.453, 1e-9);
  VERIFY_NEAR("peak of the rotation, sampled at 1 ms", "rad", sampled.rotation, 6.76621e-3, 5e-9);
  VERIFY_NEAR("peak of the base moment, sampled at 1 ms", "N m", sampled.moment, 1.368543e6, 0.5);
  VERIFY_NEAR("peak of the uplifted share, sampled at 1 ms", "1", sampled.share, 0.686923, 5e-7);

  struct Curves {
    std::vector<double> x, theta, w;  // every 1 ms
  };
  std::vector<double> steps{1e-4, 5e-5, 2.5e-5}, far;
  std::vector<Curves> all;
  std::vector<double> same;
  for (std::size_t i = 0; i < exact.x.size(); i += 10) same.push_back(exact.x[i]);
  for (const double dt : steps) {
    Oscillator oscillator;
    oscillator.macro_element = true, oscillator.step = dt, oscillator.duration = 3;
    oscillator.every = static_cast<int>(std::lround(1e-3 / dt));
    const History run = run_text(oscillator.text());
    ASSERT_EQ(run.status, "completed") << run.reason;
    all.push_back({run["top.ux"], {}, {}});
    for (const double turned : run["base.rz"]) all.back().theta.push_back(-turned);
    for (const double up : run["base.uy"]) all.back().w.push_back(-up);
    far.push_back(distance(all.back().x, same));
    const Peaks found = peaks_of(all.back().x, all.back().theta, all.back().w, 1, 1e-3);
    VERIFY_NEAR("column of the base moment over that of displacement and rotation", "1", run.peak("soil.moment") / found.moment, 1, 2e-4);
    VERIFY_NEAR("column of the uplifted share", "1", run.peak("soil.uplifted_ratio"), found.share, 1e-9);
  }
  verified_case.curve("step", steps, far);
  VERIFY_NEAR("order in the step", "1", order(steps, far), 2, 0.2);
  // the error of the step, extrapolated from the last two
  Curves at = all[2];
  for (std::size_t i = 0; i < at.x.size(); ++i)
    for (const auto curve : {&Curves::x, &Curves::theta, &Curves::w}) (at.*curve)[i] += ((all[2].*curve)[i] - (all[1].*curve)[i]) / 3;
  const Peaks found = peaks_of(at.x, at.theta, at.w, 1, 1e-3);
  VERIFY_NEAR("peak of the top, extrapolated in the step", "m", found.top, 3.587591e-2, 5e-9);
  VERIFY_NEAR("its time in the run", "s", found.time, 1.453, 1e-9);
  VERIFY_NEAR("peak of the rotation, extrapolated in the step", "rad", found.rotation, 6.76621e-3, 5e-8);
  VERIFY_NEAR("peak of the base moment, extrapolated in the step", "N m", found.moment, 1.368543e6, 0.5);
  VERIFY_NEAR("peak of the uplifted share, extrapolated in the step", "1", found.share, 0.686923, 5e-7);
  const Reference curve = reference("oscillator_A.csv");
  double x_off = 0, theta_off = 0, w_off = 0, m_off = 0, n_off = 0, s_off = 0;  // of all six columns
  for (std::size_t i = 0; i < curve["t"].size(); ++i) {
    const std::size_t row = 4 * i;
    const Contact c = contact(at.w[row], at.theta[row]);
    x_off = std::max(x_off, std::abs(at.x[row] - curve["x_top"][i]) / sampled.top);
    theta_off = std::max(theta_off, std::abs(at.theta[row] - curve["theta"][i]) / sampled.rotation);
    w_off = std::max(w_off, std::abs(at.w[row] - curve["w_centre"][i]) / (load / (2 * half * bed)));
    m_off = std::max(m_off, std::abs(c.moment - curve["M_base"][i]) / sampled.moment);
    n_off = std::max(n_off, std::abs(c.force - curve["N_base"][i]) / load);
    s_off = std::max(s_off, std::abs(c.uplifted - curve["uplift_ratio"][i]));
  }
  VERIFY_LT("motion of the top beside the table, over its peak", "1", x_off, 2e-6);
  VERIFY_LT("rotation beside the table, over its peak", "1", theta_off, 2e-5);
  VERIFY_LT("settlement beside the table, over that at rest", "1", w_off, 1e-5);
  VERIFY_LT("base moment beside the table, over its peak", "1", m_off, 4e-5);
  VERIFY_LT("vertical force beside the table, over the load", "1", n_off, 3e-5);
  VERIFY_LT("uplifted share beside the table", "1", s_off, 2e-5);

  Oscillator element;
  element.macro_element = true, element.step = 1e-4;
  const History one = run_text(element.text());
  std::vector<double> size, off;
  for (const int points : {51, 101, 201, 401}) {
    Oscillator bed_of_points = element;
    bed_of_points.macro_element = false, bed_of_points.points = points;
    size.push_back(1.0 / (points - 1));
    off.push_back(distance(run_text(bed_of_points.text())["top.ux"], one["top.ux"]));
  }
  verified_case.curve("points", size, off);
  VERIFY_NEAR("order in the points", "1", order(size, off), 2, 0.02);
  VERIFY_NEAR("rms distance of 401 points from 201, over that of 201 from the element", "1", off[3] / off[2], 0.25, 0.005);
}

}  // namespace
}  // namespace uplift::verification::oscillator_test
