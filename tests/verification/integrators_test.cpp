// Numerical damping and period error of the time integration: a linear oscillator, 50 cycles, against the
// eigenvalues of the scheme's own amplification matrix, worked out here from the equations of the scheme (not from the program), and
// against the reference table.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <complex>
#include <numbers>

#include "manual.h"
#include "support.h"

namespace uplift::verification::integrators_test {
namespace {

using std::numbers::pi;
using Complex = std::complex<double>;

struct Coefficients {
  std::string name, text;  // as in the reference table; as in a case file
  double beta, gamma, alpha_m, alpha_f;
};

Coefficients newmark(std::string name, std::string text, double gamma) {
  return {std::move(name), std::move(text), std::pow(gamma + 0.5, 2) / 4, gamma, 0, 0};
}
Coefficients hht(double alpha) {
  const std::string value = std::to_string(alpha);
  return {"hht" + value, "{ type = \"hht\", alpha = " + value + " }", std::pow(1 - alpha, 2) / 4, 0.5 - alpha, 0, -alpha};
}
Coefficients generalised(double rho) {
  const double m = (2 * rho - 1) / (rho + 1), f = rho / (rho + 1);
  return {"genalpha", "{ type = \"generalised_alpha\", rho = " + std::to_string(rho) + " }", std::pow(1 - m + f, 2) / 4, 0.5 - m + f, m, f};
}

std::vector<Coefficients> all_schemes() {
  return {newmark("trapezoidal", "\"average_acceleration\"", 0.5),
          hht(-0.05),
          hht(-0.1),
          hht(-0.3),
          {"newmark_g0.6", "{ type = \"newmark\", gamma = 0.6, beta = 0.3025 }", 0.3025, 0.6, 0, 0},
          generalised(0.9),
          generalised(0.8),
          generalised(0.5),
          generalised(0.0)};
}

/// x1 = A x0 for x = (u, dt v, dt^2 a) and u'' + w^2 u = 0: columns by unit states through the equations of the scheme.
std::array<std::array<double, 3>, 3> amplification(const Coefficients& s, double w_dt) {
  std::array<std::array<double, 3>, 3> a{};
  const double k = w_dt * w_dt;
  for (int column = 0; column < 3; ++column) {
    const double u = column == 0, v = column == 1, acc = column == 2;
    // (1-am) a1 + am a0 + k ((1-af) u1 + af u0) = 0 with u1 = u + v + (1/2 - beta) a0 + beta a1
    const double free = u + v + (0.5 - s.beta) * acc;
    const double a1 = -(s.alpha_m * acc + k * ((1 - s.alpha_f) * free + s.alpha_f * u)) / (1 - s.alpha_m + k * (1 - s.alpha_f) * s.beta);
    a[0][column] = free + s.beta * a1;
    a[1][column] = v + (1 - s.gamma) * acc + s.gamma * a1;
    a[2][column] = a1;
  }
  return a;
}

/// The complex root of det(A - x) with the largest argument part near exp(i w dt), by Newton's method.
Complex principal_root(const std::array<std::array<double, 3>, 3>& a, double w_dt) {
  const auto minor = [&](int i, int j) { return a[i][i] * a[j][j] - a[i][j] * a[j][i]; };
  const double trace = a[0][0] + a[1][1] + a[2][2], second = minor(0, 1) + minor(0, 2) + minor(1, 2);
  const double det =
      a[0][0] * minor(1, 2) - a[0][1] * (a[1][0] * a[2][2] - a[1][2] * a[2][0]) + a[0][2] * (a[1][0] * a[2][1] - a[1][1] * a[2][0]);
  Complex x = std::exp(Complex(0, w_dt));
  for (int i = 0; i < 100; ++i) x -= (((x - trace) * x + second) * x - det) / ((3.0 * x - 2 * trace) * x + second);
  return x;
}

/// Damping ratio and period error of one scheme, as the table defines them: x = exp((-zeta + i) theta), T_num/T = w dt/theta.
struct Error {
  double zeta = 0, period = 0;
};
Error error_of(Complex root, double w_dt) {
  const double theta = std::arg(root);
  return {-std::log(std::abs(root)) / theta, w_dt / theta - 1};
}

/// The oscillator of period 1 s in the program, released at u = 1 m; its displacements.
std::vector<double> oscillation(const Coefficients& s, double dt, double cycles) {
  char text[1200];
  std::snprintf(text, sizeof text,
                "title = \"Oscillator\"\n[nodes]\nm = [0, 0]\nidle = [1, 0]\n[[mass]]\nnode = \"m\"\nmass = 2\n[[spring]]\nnodes = "
                "[\"m\"]\ndirection = [1, 0]\n"
                "stiffness = %.17g\n"
                // a case has an interface: one that stays open beside the oscillator
                "[[interface]]\nname = \"far\"\ngap = 10\npairs = { upper = [\"idle\"], area = 1 }\nlaw = \"unilateral\"\n"
                "[[mass]]\nnode = \"idle\"\nmass = 1\n[[spring]]\nnodes = [\"idle\"]\ndirection = [0, 1]\nstiffness = 1\n"
                "[[support]]\nnode = \"idle\"\nfixed = [\"ux\", \"rz\"]\n[[support]]\nnode = \"m\"\nfixed = [\"uy\", "
                "\"rz\"]\n[[initial]]\nnode = \"m\"\ndisplacement = [1, 0]\n"
                "[[stage]]\ntype = \"dynamic\"\nduration = %.17g\nstep = %.17g\nscheme = %s\n[energy]\ncreated_limit = 1e9\n"
                "[output]\nframes = 0\nautomatic = false\nhistory = [{ name = \"u\", node = \"m\", quantity = \"ux\" }]\n",
                2 * 4 * pi * pi, cycles, dt, s.text.c_str());
  return run_text(text)["u"];
}

// Claim: after 50 cycles the program's displacement is that of the amplification matrix, u_n = (A^n x0)_0 with the consistent initial
// acceleration: amplitude and phase, hence period and damping, to 1e-6 (relative to T and to the amplitude); it is far better, so 1e-9 is
// asked.
TEST(Integrators, FiftyCyclesFollowTheAmplificationMatrix) {
  VERIFIES({"Time integration", "Fifty cycles of an oscillator, every scheme",
            "Amplification matrix of the scheme (Hughes, The Finite Element Method (1987), chapter 9)"});
  for (const Coefficients& scheme : all_schemes())
    for (const double dt : {0.01, 0.02, 0.05, 0.1, 0.2}) {
      const std::vector<double> u = oscillation(scheme, dt, 50);
      const auto a = amplification(scheme, 2 * pi * dt);
      std::array<double, 3> x{1, 0, -std::pow(2 * pi * dt, 2)};
      double worst = 0;
      for (std::size_t i = 0; i < u.size(); ++i) {
        worst = std::max(worst, std::abs(u[i] - x[0]));
        std::array<double, 3> next{};
        for (int r = 0; r < 3; ++r)
          for (int c = 0; c < 3; ++c) next[r] += a[r][c] * x[c];
        x = next;
      }
      ASSERT_EQ(u.size(), static_cast<std::size_t>(std::lround(50 / dt)) + 1);
      VERIFY_LT("largest difference from the powers of the amplification matrix", "1", worst, 1e-9) << scheme.text << " " << dt;
    }
}

// Claim: damping ratio and period error of the program's oscillation, measured from the run alone: 1e-6 of T. Three neighbouring values of
// u = Re(c x^n) give x: u_{n+1} - 2 Re(x) u_n + |x|^2 u_{n-1} = 0, fitted over the run (the third, strongly damped root has died out).
TEST(Integrators, DampingAndPeriodMeasured) {
  VERIFIES({"Time integration", "Numerical damping and period error, every scheme",
            "Eigenvalues of the amplification matrix (Hughes, The Finite Element Method (1987), chapter 9)"});
  for (const Coefficients& scheme : all_schemes())
    for (const double dt : {0.01, 0.02, 0.05, 0.1, 0.2}) {
      const double w_dt = 2 * pi * dt;
      const Error expected = error_of(principal_root(amplification(scheme, w_dt), w_dt), w_dt);
      const std::vector<double> u = oscillation(scheme, dt, 50);
      double a11 = 0, a12 = 0, a22 = 0, b1 = 0, b2 = 0;
      for (std::size_t i = 30; i + 1 < u.size(); ++i) {
        const double weight = 1 / (u[i] * u[i] + u[i - 1] * u[i - 1]);  // strongly damped runs: every cycle counts alike
        a11 += weight * u[i] * u[i], a12 += weight * u[i] * u[i - 1], a22 += weight * u[i - 1] * u[i - 1];
        b1 += weight * u[i + 1] * u[i], b2 += weight * u[i + 1] * u[i - 1];
      }
      const double det = a11 * a22 - a12 * a12, sum = (b1 * a22 - b2 * a12) / det, product = -(a11 * b2 - a12 * b1) / det;
      const Error found = error_of(Complex(sum / 2, std::sqrt(product - sum * sum / 4)), w_dt);
      VERIFY_NEAR("damping ratio", "1", found.zeta, expected.zeta, 1e-6) << scheme.text << " " << dt;
      VERIFY_NEAR("relative period error", "1", found.period, expected.period, 1e-6) << scheme.text << " " << dt;
    }
}

// Claim: the closed form used above is that of the reference table (spectral radius, damping, period error): 1e-9. This is what ties the
// program to the table.
TEST(Integrators, ReferenceTable) {
  VERIFIES({"Time integration", "Closed form of damping, period error and spectral radius", "tests/data/reference/integrators.csv"});
  const Reference table = reference("integrators.csv");
  const std::pair<std::string, Coefficients> rows[] = {
      {"trapezoidal", all_schemes()[0]},     {"hht-0.05", all_schemes()[1]},        {"hht-0.1", all_schemes()[2]},
      {"hht-0.3", all_schemes()[3]},         {"newmark_g0.6", all_schemes()[4]},    {"genalpha_rho0.9", all_schemes()[5]},
      {"genalpha_rho0.8", all_schemes()[6]}, {"genalpha_rho0.5", all_schemes()[7]}, {"genalpha_rho0", all_schemes()[8]}};
  int seen = 0;
  for (const auto& [name, scheme] : rows)
    for (std::size_t i = 0; i < table.words.size(); ++i) {
      if (table.words[i] != name) continue;
      ++seen;
      const double w_dt = 2 * pi * table["dt/T"][i];
      const Complex root = principal_root(amplification(scheme, w_dt), w_dt);
      const Error error = error_of(root, w_dt);
      VERIFY_NEAR("damping ratio", "1", error.zeta, table["zeta_num"][i], 1e-9) << name << i;
      VERIFY_NEAR("relative period error", "1", error.period, table["T_num/T-1"][i], 1e-9) << name << i;
      VERIFY_NEAR("spectral radius", "1", std::abs(root), table["spectral_radius"][i], 1e-9) << name << i;
    }
  VERIFY_EQ("rows of the table that were compared", "1", seen, 45);
}

// Claim: every scheme but Newmark with gamma > 1/2 is of second order, that one of first order (smooth dynamics
// dt^2).
TEST(Integrators, Orders) {
  VERIFIES({"Time integration", "Order of the time schemes", "Order of the Newmark family: 2 for γ = 1/2 and its α-modifications, else 1"});
  for (const Coefficients& scheme : all_schemes()) {
    std::vector<double> step, error;
    for (const int per_cycle : {50, 100, 200, 400}) {
      const std::vector<double> u = oscillation(scheme, 1.0 / per_cycle, 2.25);  // a zero of the cosine: sensitive to the period
      const std::vector<double> whole = oscillation(scheme, 1.0 / per_cycle, 2);
      step.push_back(1.0 / per_cycle);
      error.push_back(std::abs(u.back() - std::cos(2 * pi * 1.0 / per_cycle * static_cast<double>(u.size() - 1))) +
                      std::abs(whole.back() - 1));
    }
    verified_case.curve(scheme.name, step, error);
    VERIFY_NEAR("order of convergence", "1", order(step, error), scheme.name == "newmark_g0.6" ? 1 : 2, 0.1) << scheme.text;
  }
}

}  // namespace
}  // namespace uplift::verification::integrators_test
