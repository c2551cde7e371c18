#include "uplift/laws/macro_power_law.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace uplift {
namespace {

/// Below this n the exponents of n are at most `small_exponent`, so that uplift governs as N vanishes.
constexpr double log_small = -2.995732273553991;  // ln 0.05
constexpr double small_exponent = 0.9;

/// EN 1998-5:2004, Table F.1, with the letters of the standard.
struct TableF1 {
  double a, b, c, d, e, f, m, k, k_prime, c_t, c_m, c_m_prime, beta, gamma;
};

const TableF1& table_f1(En1998Soil soil) {
  static constexpr TableF1 cohesive{0.70, 1.29, 2.14, 1.81, 0.21, 0.44, 0.21, 1.22, 1.00, 2.00, 2.00, 1.00, 2.57, 1.85};
  static constexpr TableF1 cohesionless{0.92, 1.25, 0.92, 1.25, 0.41, 0.32, 0.96, 1.00, 0.39, 1.14, 1.01, 1.01, 2.90, 2.80};
  return soil == En1998Soil::cohesive ? cohesive : cohesionless;
}

}  // namespace

double MacroPowerLaw::Term::low_at(double log_n) const {
  return log_n < log_small ? std::min(low, small_exponent) : low;
}

double MacroPowerLaw::Term::log_low(double log_n) const {
  return low * std::max(log_n, log_small) + low_at(log_n) * std::min(log_n - log_small, 0.0);
}

double MacroPowerLaw::Term::at(double n) const {
  return n > 0 ? size * std::exp(log_low(std::log(n))) * std::pow(1 - n, high) : low > 0 ? 0 : size;
}

double MacroPowerLaw::Term::most() const {
  return at(low / (low + high));
}

/// With u = ln(1 - share), terms t = power (ln(v/size) - low ln n - high u): ln sum exp t is convex and falls with u, so that Newton's
/// method from below never passes the root. One term alone gives the start.
MacroPowerLaw::Left MacroPowerLaw::left(double n, double h, double m) const {
  const Term* const terms[2] = {&shear, &moment};
  const double value[2] = {h, m}, log_n = std::log(n);
  double constant[2] = {0, 0}, weight[2] = {0, 0}, u = -std::numeric_limits<double>::infinity(), fall = 0;
  for (int i = 0; i < 2; ++i) {
    if (!(value[i] > 0)) continue;
    constant[i] = std::log(value[i] / terms[i]->size) - terms[i]->log_low(log_n);
    u = std::max(u, constant[i] / terms[i]->high);
  }
  if (!(u > -std::numeric_limits<double>::infinity())) return {};
  for (int iteration = 0; iteration < 50; ++iteration) {
    double sum = 0;
    for (int i = 0; i < 2; ++i) sum += weight[i] = value[i] > 0 ? std::exp(terms[i]->power * (constant[i] - terms[i]->high * u)) : 0;
    fall = 0;
    for (int i = 0; i < 2; ++i) fall += (weight[i] /= sum) * terms[i]->power * terms[i]->high;
    const double moved = std::log(sum) / fall;
    u += moved;
    if (!(moved > 4 * std::numeric_limits<double>::epsilon() * std::max(1.0, std::abs(u)))) break;
  }
  const double y = std::exp(u);
  Left out{1 - y, Vec3::Zero()};
  for (int i = 0; i < 2; ++i) {
    const double share = terms[i]->power * weight[i] / fall;
    out.rate[0] += y * share * terms[i]->low_at(log_n) / n;
    if (value[i] > 0) out.rate[1 + i] = -y * share / value[i];
  }
  return out;
}

double en_1998_5_largest_inertia(En1998Soil soil) {
  const TableF1& t = table_f1(soil);
  return std::min({std::pow(1 / t.m, 1 / t.k), 1 / t.e, 1 / t.f});
}

std::optional<En1998Surface> en_1998_5_surface(En1998Soil soil, double inertia) {
  if (!(inertia < en_1998_5_largest_inertia(soil))) return std::nullopt;
  const TableF1& t = table_f1(soil);
  const double top = std::pow(1 - t.m * std::pow(inertia, t.k), t.k_prime);
  const double shear = std::pow(top, (t.a + t.b) / t.c_t - 1) / (t.beta * (1 - t.e * inertia));
  const double moment = std::pow(top, (t.c + t.d) / t.c_m - 1) / (t.gamma * std::pow(1 - t.f * inertia, t.c_m_prime / t.c_m));
  return En1998Surface{{{shear, t.a / t.c_t, t.b / t.c_t, t.c_t}, {moment, t.c / t.c_m, t.d / t.c_m, t.c_m}}, top};
}

}  // namespace uplift
