#include "uplift/laws/macro_surfaces.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace uplift {
namespace {

/// The corners of the bearing surface at H = 0 and M = 0 are rounded for the associated flow over this share of V, so that it has a normal
/// there.
constexpr double rounding_share = 1e-6;
/// A footing that carries less than this share of V uses none of it: the return keeps a force only within a share of V.
constexpr double least_share = 1e-9;

/// |M/D| of both axes together, for the power law.
double moment_over_length(const MacroVector& force, const double (&length)[2]) {
  return std::hypot(force[macro_m1] / length[0], force[macro_m2] / length[1]);
}

}  // namespace

/// Forces without their direction: N and v = (|H|, 2 |M_1|/D_1, 2 |M_2|/D_2), which all lie between 0 and N.
struct MacroSurfaces::Reduced {
  double n;
  Vec3 v;
  Fixed<3, 5> by_force;    // d v/d force
  MacroMatrix curving[3];  // second derivatives of v

  /// v_k = factor |part of the force|, rounded near zero.
  void put(int k, double factor, int first, int size, const MacroVector& force, double rounding) {
    const auto part = force.segment(first, size);
    const double length = std::sqrt(part.squaredNorm() + rounding * rounding);
    v[k] = factor * (length - rounding);
    if (!(length > 0)) return;
    by_force.row(k).segment(first, size) = factor / length * part.transpose();
    curving[k].block(first, first, size, size).diagonal().setConstant(factor / length);
    curving[k].block(first, first, size, size) -= factor / (length * length * length) * part * part.transpose();
  }
};

/// E = (1 - r_0)^power (1 - r_1)(1 - r_2), r = v/N, with power 3 or 0, and its derivatives with respect to the forces.
struct MacroSurfaces::Product {
  double value;
  MacroVector gradient;
  MacroMatrix second;

  Product(const Reduced& f, int power, bool with_second) {
    const Vec3 r = f.v / f.n;
    const double shear = power == 0 ? 1 : std::pow(1 - r[0], 3), b1 = 1 - r[1], b2 = 1 - r[2];
    const double rate = power == 0 ? 0 : -3 * (1 - r[0]) * (1 - r[0]), rate_rate = power == 0 ? 0 : 6 * (1 - r[0]);
    value = shear * b1 * b2;
    const Vec3 d(rate * b1 * b2, -shear * b2, -shear * b1);
    MacroVector by_n = MacroVector::Zero();
    by_n[macro_n] = 1;
    gradient = (f.by_force.transpose() * d - r.dot(d) * by_n) / f.n;
    if (!with_second) return;
    Mat3 dd;
    dd << rate_rate * b1 * b2, -rate * b2, -rate * b1, -rate * b2, 0, shear, -rate * b1, shear, 0;
    const Vec3 cross_n = d + dd * r;
    const MacroVector cross = f.by_force.transpose() * cross_n;
    second = f.by_force.transpose() * dd * f.by_force - cross * by_n.transpose() - by_n * cross.transpose();
    second(macro_n, macro_n) += 2 * r.dot(d) + r.dot(dd * r);
    second /= f.n * f.n;
    for (int k = 0; k < 3; ++k) second += d[k] / f.n * f.curving[k];
  }
};

MacroSurfaces::MacroSurfaces(const MacroElasticity& e, const MacroStrength& strength)
    : disc_(e.disc), length_{e.length[0], e.length[1]}, strength_(strength) {
  if (!(strength_.ultimate > strength_.service)) strength_.ultimate = strength_.service;
  const double v = strength_.service, radius = strength_.settlement_share * v;
  const double h = radius * (strength_.power_law ? strength_.power_law->shear.most() : 27.0 / 256);
  const double most_moment = strength_.power_law ? strength_.power_law->moment.most() : 1.0 / 8;
  ellipsoid_ << 1 / v, v / (h * h), v / (h * h), 0, 0;
  for (int i = 0; i < 2; ++i) {
    const double m = radius * length_[i] * most_moment;
    ellipsoid_[macro_m1 + i] = v / (m * m);
  }
}

MacroSurfaces::Reduced MacroSurfaces::reduce(const MacroVector& force, double rounding) const {
  Reduced out{force[macro_n], Vec3::Zero(), Fixed<3, 5>::Zero(), {MacroMatrix::Zero(), MacroMatrix::Zero(), MacroMatrix::Zero()}};
  out.put(0, 1, macro_h1, 2, force, rounding);
  if (disc_) {
    out.put(1, 2 / length_[0], macro_m1, 2, force, rounding * length_[0]);
  } else {
    out.put(1, 2 / length_[0], macro_m1, 1, force, rounding * length_[0]);
    out.put(2, 2 / length_[1], macro_m2, 1, force, rounding * length_[1]);
  }
  return out;
}

bool MacroSurfaces::has_bearing() const {
  return std::isfinite(strength_.service);
}

bool MacroSurfaces::has_sliding() const {
  return std::isfinite(strength_.friction);
}

double MacroSurfaces::capacity(double p) const {
  if (!(strength_.ultimate > strength_.service)) return strength_.service;
  return strength_.service + (strength_.ultimate - strength_.service) * p / (p + strength_.reference);
}

double MacroSurfaces::hardening(double p) const {
  if (!(strength_.ultimate > strength_.service)) return 0;
  const double sum = p + strength_.reference;
  return (strength_.ultimate - strength_.service) * strength_.reference / (sum * sum);
}

bool MacroSurfaces::bears(const MacroVector& force) const {
  return strength_.power_law || std::hypot(force[macro_h1], force[macro_h2]) < force[macro_n];
}

MacroPowerLaw::Left MacroSurfaces::left(const MacroVector& force, double capacity) const {
  return strength_.power_law->left(force[macro_n] / capacity, std::hypot(force[macro_h1], force[macro_h2]) / capacity,
                                   moment_over_length(force, length_) / capacity);
}

/// f_2 = N - V left(N/V, |H|/V, |M|/(D V)).
MacroSurface MacroSurfaces::power_bearing(const MacroVector& force, double capacity) const {
  const MacroPowerLaw::Left left = this->left(force, capacity);
  const double shear = std::hypot(force[macro_h1], force[macro_h2]), moment = moment_over_length(force, length_);
  MacroSurface out{force[macro_n] - capacity * left.share, MacroVector::Zero(), 0};
  out.gradient[macro_n] = 1 - left.rate[0];
  if (shear > 0) out.gradient.segment<2>(macro_h1) = -left.rate[1] / shear * force.segment<2>(macro_h1);
  for (int i = 0; i < 2 && moment > 0; ++i)
    out.gradient[macro_m1 + i] = -left.rate[2] / moment * force[macro_m1 + i] / (length_[i] * length_[i]);
  out.by_capacity = -left.share + left.rate.dot(Vec3(force[macro_n], shear, moment)) / capacity;
  return out;
}

MacroSurface MacroSurfaces::bearing(const MacroVector& force, double capacity) const {
  if (strength_.power_law) return power_bearing(force, capacity);
  const bool associated = strength_.flow == MacroStrength::Flow::associated;
  const Product e(reduce(force, associated ? rounding_share * strength_.service : 0), 3, false);
  MacroSurface out{force[macro_n] - capacity * e.value, -capacity * e.gradient, -e.value};
  out.gradient[macro_n] += 1;
  return out;
}

double MacroSurfaces::bearing_value(const MacroVector& force, double capacity) const {
  if (strength_.power_law) return force[macro_n] - capacity * left(force, capacity).share;
  if (strength_.flow == MacroStrength::Flow::associated) return bearing(force, capacity).value;
  const double n = force[macro_n], shear = 1 - std::hypot(force[macro_h1], force[macro_h2]) / n;
  const double one = disc_ ? std::hypot(force[macro_m1], force[macro_m2]) : std::abs(force[macro_m1]);
  const double left = shear * shear * shear * (1 - 2 * one / (n * length_[0]));
  const bool second = !disc_ && force[macro_m2] != 0;
  return n - capacity * (second ? left * (1 - 2 * std::abs(force[macro_m2]) / (n * length_[1])) : left);
}

MacroSurface MacroSurfaces::sliding(const MacroVector& force) const {
  const Reduced r = reduce(force, 0);
  MacroSurface out{r.v[0] - force[macro_n] * strength_.friction, r.by_force.row(0).transpose(), 0};
  out.gradient[macro_n] -= strength_.friction;
  if (strength_.cohesion > 0) {
    const Product e(r, 0, false);
    out.value -= strength_.cohesion * e.value;
    out.gradient -= strength_.cohesion * e.gradient;
  }
  return out;
}

MacroFlow MacroSurfaces::bearing_flow(const MacroVector& force, double capacity) const {
  MacroFlow out;
  if (strength_.flow == MacroStrength::Flow::settling) {
    out.direction = ellipsoid_.cwiseProduct(force);
    out.slope.diagonal() = ellipsoid_;
    return out;
  }
  const Product e(reduce(force, rounding_share * strength_.service), 3, true);
  out.direction = -capacity * e.gradient;
  out.direction[macro_n] += 1;
  out.slope = -capacity * e.second;
  out.by_capacity = -e.gradient;
  return out;
}

MacroFlow MacroSurfaces::sliding_flow(const MacroVector& force) const {
  const Reduced r = reduce(force, 0);
  MacroFlow out;
  out.direction = r.by_force.row(0).transpose();
  out.slope = r.curving[0];
  if (strength_.flow == MacroStrength::Flow::settling) {
    out.direction[macro_n] -= strength_.dilation;
    return out;
  }
  out.direction[macro_n] -= strength_.friction;
  if (strength_.cohesion > 0) {
    const Product e(r, 0, true);
    out.direction -= strength_.cohesion * e.gradient;
    out.slope -= strength_.cohesion * e.second;
  }
  return out;
}

/// The product of 1 - 2 |M_i|/(N D_i), for N > 0.
double MacroSurfaces::moment_share(const MacroVector& force) const {
  const double n = force[macro_n], one = 2 * std::abs(force[macro_m1]) / (n * length_[0]);
  if (disc_) return std::max(0.0, 1 - 2 * std::hypot(force[macro_m1], force[macro_m2]) / (n * length_[0]));
  const double two = force[macro_m2] == 0 ? 0 : 2 * std::abs(force[macro_m2]) / (n * length_[1]);
  return std::max(0.0, 1 - one) * std::max(0.0, 1 - two);
}

double MacroSurfaces::bearing_utilisation(const MacroVector& force, double capacity) const {
  const double n = force[macro_n];
  if (!(n > least_share * capacity)) return 0;
  if (strength_.power_law) {
    const double share = left(force, capacity).share;
    return share > 0 ? n / (capacity * share) : std::numeric_limits<double>::infinity();
  }
  const double slope = std::hypot(force[macro_h1], force[macro_h2]) / n, left = std::max(0.0, 1 - slope);
  return n / (capacity * left * left * left * moment_share(force));
}

double MacroSurfaces::sliding_utilisation(const MacroVector& force) const {
  const double shear = std::hypot(force[macro_h1], force[macro_h2]);
  if (!(force[macro_n] > (has_bearing() ? least_share * strength_.service : 0)) || !(shear > 0)) return 0;
  const double cohesion = strength_.cohesion > 0 ? strength_.cohesion * moment_share(force) : 0;
  return shear / (force[macro_n] * strength_.friction + cohesion);
}

double MacroSurfaces::largest_moment(int axis, double n, double capacity) const {
  if (strength_.power_law) return capacity * length_[axis] * strength_.power_law->moment.at(n / capacity);
  return 0.5 * n * length_[axis] * (1 - n / capacity);
}

double MacroSurfaces::largest_shear(double n, double capacity) const {
  if (strength_.power_law) return capacity * strength_.power_law->shear.at(n / capacity);
  return n * (1 - std::cbrt(n / capacity));
}

}  // namespace uplift
