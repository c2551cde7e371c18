#include "uplift/laws/macro_uplift.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

namespace uplift {
namespace {

std::atomic<std::uint64_t> versions = 0;  // of foundations

constexpr int most_iterations = 100;
// relative: after a step so small the error of an iteration of second or fourth order is round-off
constexpr double quadratic = 1e-8, quartic = 1e-4;

/// For x > 1.
MacroRise rise_to(double x, double gamma) {
  MacroRise rise;
  if (gamma == 2) {  // the usual case, without logarithms
    rise.y = std::sqrt(x);
    rise.log_like = rise.y - 1;
  } else if (gamma == 1) {  // strips
    rise.y = x;
    rise.log_like = std::log(x);
  } else if (gamma == 3) {
    rise.y = std::cbrt(x);
    rise.log_like = 0.5 * (rise.y * rise.y - 1);
  } else {
    const double log_y = std::log(x) / gamma, t = (gamma - 1) * log_y;
    rise.y = std::exp(log_y);
    rise.log_like = std::abs(t) < 1e-14 ? log_y : std::expm1(t) / t * log_y;
  }
  return rise;
}

/// The uplift curve of one axis at x (eq M2).
struct Curve {
  double moment;             // m = M/M_0
  double compliance = 1;     // g'' = d x/d m
  double secant;             // x/g''
  double slack;              // 1 - 2 M/(N D), distance from the edge
  double contact_share = 1;  // 1/y
  double log_like = 0;
  double heave = 0;  // -h = m x - 2 g
  double from_edge;  // h + beta x

  Curve(double x, const MacroRise& rise, double beta, double gamma) {
    if (x <= 1) {
      moment = secant = x;
      slack = 1 - x / beta;
      from_edge = beta * x;
      return;
    }
    contact_share = secant = 1 / rise.y;
    moment = beta - gamma * contact_share;
    compliance = x * rise.y;
    slack = gamma / beta * contact_share;
    log_like = rise.log_like;
    const double twice_energy = 1 + 2 * gamma * log_like;
    heave = moment * x - twice_energy;
    from_edge = twice_energy + gamma * x * contact_share;
  }
};

Curve curve(double x, double beta, double gamma) {
  return {x, x <= 1 ? MacroRise() : rise_to(x, gamma), beta, gamma};
}

/// Writes the stiffness of (w, theta) into that of all displacements.
void spread(const Mat3& rocking, int rotations, MacroMatrix& all) {
  constexpr int at[] = {macro_n, macro_m1, macro_m2};
  for (int i = 0; i <= rotations; ++i)
    for (int k = 0; k <= rotations; ++k) all(at[i], at[k]) = rocking(i, k);
}

}  // namespace

/// What the rotation about each axis brings; a disc has one axis, that of its rotation.
struct MacroUplift::Axes {
  int count;
  double rotation[2];            // |theta| [rad]
  double offset[2];              // x N [N]
  double sign[2];                // of the rotation
  double direction[2] = {0, 0};  // of the rotation of a disc
};

/// `count`: of the rotations theta.
[[gnu::always_inline]] inline MacroUplift::Axes MacroUplift::axes_of(const double* theta, int count) const {
  Axes axes;
  if (count == 2 && elastic_.disc) {
    axes.count = 1;
    axes.rotation[0] = std::sqrt(theta[0] * theta[0] + theta[1] * theta[1]);
    for (int i = 0; i < 2 && axes.rotation[0] > 0; ++i) axes.direction[i] = theta[i] / axes.rotation[0];
  } else {
    axes.count = count;
    for (int i = 0; i < count; ++i) {
      axes.rotation[i] = std::abs(theta[i]);
      axes.sign[i] = theta[i] < 0 ? -1 : 1;
    }
  }
  for (int i = 0; i < axes.count; ++i) axes.offset[i] = offset_[i] * axes.rotation[i];
  return axes;
}

MacroUplift::MacroUplift(const MacroElasticity& elasticity)
    : version_(++versions), elastic_(elasticity), beta_(elasticity.shape / 2), gamma_(elasticity.shape / 2 - 1) {
  const auto second = [](double(&value)[2]) {
    if (!(value[1] > 0)) value[1] = value[0];
  };
  second(elastic_.length), second(elastic_.horizontal), second(elastic_.rocking);
  if (elastic_.disc) elastic_.length[1] = elastic_.length[0], elastic_.rocking[1] = elastic_.rocking[0];
  stiffness_ << elastic_.vertical, elastic_.horizontal[0], elastic_.horizontal[1], elastic_.rocking[0], elastic_.rocking[1];
  for (int i = 0; i < 2; ++i) {
    arm_[i] = elastic_.length[i] / elastic_.shape;
    factor_[i] = arm_[i] * arm_[i] / elastic_.rocking[i];
    offset_[i] = elastic_.rocking[i] / arm_[i];
  }
}

/// z - ln z = s, z >= 1: the vertical force of strips (eq M28). Each iteration of Fritsch, Shafer & Crowley raises the error to its fourth
/// power.
double MacroUplift::strip_root(double s) {
  const double sigma = std::max(s - 1, 0.0), t = 0.3361 * std::sqrt(0.5 * sigma);
  double z = 1 + sigma + 2 / 0.3361 * t / (1 + t);  // within 0.6 % of the root: after Barry, Culligan-Hensley & Barry 1995
  for (int iteration = 0; iteration < most_iterations && z > 1; ++iteration) {
    const double over = z - 1, lacking = over - sigma - std::log(z), q = 2 * over * (over - 2.0 / 3 * lacking);
    const double moved = z * lacking / over * (q - lacking) / (q - 2 * lacking);
    z -= moved;
    if (std::abs(moved) <= quartic * over) break;
  }
  return z;
}

/// (M27): P N + Q N^(1/gamma) = T, for strips N (P + Q ln(N_1/N)) = T, over the axes that lift. The second one does where the left side at
/// its offset exceeds the right side.
double MacroUplift::lifted_force(double w, const Axes& axes, MacroRise* rises) const {
  const int first = axes.count == 2 && axes.offset[1] > axes.offset[0] ? 1 : 0;
  const double largest = axes.offset[first];
  double p = 1 / elastic_.vertical, q = 0, toe = w, root[2], behind[2];  // offset^(1/gamma), ln(N_1/N_i)
  int lifting = 0;
  const auto axis = [&](int k) { return k == 0 ? first : 1 - first; };
  for (; lifting < axes.count; ++lifting) {
    const int i = axis(lifting);
    const double offset = axes.offset[i], factor = factor_[i];
    if (!(offset > 0)) break;
    if (gamma_ == 1) {
      behind[i] = lifting == 0 ? 0 : std::log(largest / offset);
      if (lifting > 0 && (p + q * behind[i]) * offset <= toe) break;
      p += 2 * factor * (1 - behind[i]), q += 2 * factor;
    } else {
      root[i] = gamma_ == 2 ? std::sqrt(offset) : std::cbrt(offset);
      if (lifting > 0 && p * offset + q * root[i] <= toe) break;
      const double each = factor * beta_ / (gamma_ - 1);
      p -= each, q += each * gamma_ * (gamma_ == 2 ? root[i] : root[i] * root[i]);
    }
    toe += 0.5 * elastic_.length[i] * axes.rotation[i];
  }
  if (gamma_ == 1) {
    const double z = strip_root(p / q - std::log(toe / (q * largest))), n = toe / (q * z);
    for (int k = 0; k < lifting; ++k)
      rises[axis(k)] = {std::max(1.0, axes.offset[axis(k)] / n), std::max(0.0, z - p / q - behind[axis(k)])};
    return n;
  }
  if (gamma_ == 2) {
    const double of_force = 2 * toe / (q + std::sqrt(std::max(0.0, q * q + 4 * p * toe)));
    for (int k = 0; k < lifting; ++k) {
      const double y = std::max(1.0, root[axis(k)] / of_force);
      rises[axis(k)] = {y, y - 1};
    }
    return of_force * of_force;
  }
  double of_force = toe / q;  // beyond it for p > 0, before it for p < 0: from there Newton's method keeps its side
  for (int iteration = 0; iteration < most_iterations; ++iteration) {
    const double square = of_force * of_force, next = (2 * p * square * of_force + toe) / (3 * p * square + q);
    const double moved = std::abs(next - of_force);
    of_force = next;
    if (moved <= quadratic * of_force) break;
  }
  for (int k = 0; k < lifting; ++k) {
    const double y = std::max(1.0, root[axis(k)] / of_force);
    rises[axis(k)] = {y, 0.5 * (y * y - 1)};
  }
  return of_force * of_force * of_force;
}

/// N at the settlement w; zero without contact. Shape numbers without a form of their own: Newton's method on (M26), from a force that is
/// too small on, or from where the tangent leads to one. `rises`: of the axes that lift; the others are left.
double MacroUplift::vertical_force(double w, const Axes& axes, MacroRise* rises) const {
  double toe = w, largest = 0, sum = 0, all = 0;
  for (int i = 0; i < axes.count; ++i) {
    toe += 0.5 * elastic_.length[i] * axes.rotation[i];
    largest = std::max(largest, axes.offset[i]);
    sum += factor_[i] * axes.offset[i], all += factor_[i];
  }
  if (w > 0 && largest <= elastic_.vertical * w) return elastic_.vertical * w;
  if (!(toe > 0)) return 0;
  if (gamma_ == 1 || gamma_ == 2 || gamma_ == 3) return lifted_force(w, axes, rises);
  double n = std::min(elastic_.vertical * toe, sum / all / std::pow(std::max(1.0, 2 * beta_ * sum / toe), gamma_));
  for (int iteration = 0; iteration < most_iterations; ++iteration) {
    double slope = toe, intercept = 1 / elastic_.vertical;  // of the tangent, the slope with its sign changed
    for (int i = 0; i < axes.count; ++i) {
      const Curve c = curve(axes.offset[i] / n, beta_, gamma_);
      slope -= factor_[i] * beta_ * axes.offset[i] * c.contact_share;
      intercept += factor_[i] * (c.from_edge - beta_ * axes.offset[i] / n * c.contact_share);
    }
    const double next = slope > 0 ? slope / intercept : 0.1 * n, moved = std::abs(next - n);
    n = next;
    if (moved <= quadratic * n) break;
  }
  for (int i = 0; i < axes.count; ++i)
    if (axes.offset[i] > n) rises[i] = rise_to(axes.offset[i] / n, gamma_);
  return n;
}

template <int R>
MacroRocking MacroUplift::rock(const Vec3& q, bool with_stiffness, bool at_rest) const {
  MacroRocking out;
  const Axes axes = axes_of(q.data() + 1, R);
  MacroRise rises[R];
  const double n = vertical_force(q[0], axes, rises);
  if (!(n > 0) && !at_rest) {
    out.contact = false;
    out.contact_share = 0;
    return out;
  }
  const bool disc = R == 2 && elastic_.disc;
  out.force[0] = n;
  double toe = q[0], vertical = 1 / elastic_.vertical;  // dw/dN at fixed rotation
  double coupling[1 + R] = {1};                         // -dw/dtheta at fixed N, after 1
  double at_constant_force[R][R] = {};                  // dM/dtheta at fixed N
  for (int i = 0; i < axes.count; ++i) {
    const double x = n > 0 ? axes.offset[i] / n : 0, half = 0.5 * elastic_.length[i];
    const Curve c(x, rises[i], beta_, gamma_);
    const double moment = arm_[i] * n * c.moment, lost = arm_[i] * (c.moment - c.secant), along = elastic_.rocking[i] / c.compliance;
    out.heave += factor_[i] * n * c.heave;
    out.contact_share *= c.contact_share;
    toe += half * axes.rotation[i] * (1 - c.slack);
    vertical += factor_[i] * (gamma_ + 1) * c.log_like;
    if (disc) {
      const double across = axes.rotation[i] > 0 ? moment / axes.rotation[i] : elastic_.rocking[i];
      for (int k = 0; k < R; ++k) out.force[1 + k] = moment * axes.direction[k];
      for (int k = 0; k < R; ++k) coupling[1 + k] = lost * axes.direction[k];
      for (int k = 0; k < R; ++k)
        for (int l = 0; l < R; ++l)
          at_constant_force[k][l] = (along - across) * axes.direction[k] * axes.direction[l] + (k == l ? across : 0);
    } else {
      out.force[1 + i] = axes.sign[i] * moment;
      coupling[1 + i] = axes.sign[i] * lost;
      at_constant_force[i][i] = along;
    }
  }
  if (with_stiffness) {
    const double inverse = 1 / vertical;
    for (int i = 0; i <= R; ++i)
      for (int k = 0; k <= R; ++k)
        out.stiffness(i, k) = coupling[i] * coupling[k] * inverse + (i > 0 && k > 0 ? at_constant_force[i - 1][k - 1] : 0);
  }
  out.energy = 0.5 * n * toe;  // (N w + M theta)/2, homogeneous of degree two
  return out;
}

template <int R>
MacroElastic MacroUplift::respond(const MacroVector& q, bool with_stiffness) const {
  MacroElastic out;
  Vec3 part(q[macro_n], 0, 0);
  for (int i = 0; i < R; ++i) part[1 + i] = q[macro_m1 + i];
  // at rest without load the stiffness is that of the closed base, so that the first load finds something to stand on
  const MacroRocking rocking = q.cwiseAbs().maxCoeff() == 0 ? rock<R>(part, with_stiffness, true) : recall<R>(part);
  out.contact = rocking.contact;
  out.contact_share = rocking.contact_share;
  if (!out.contact) return out;
  out.force[macro_n] = rocking.force[0];
  out.heave = rocking.heave;
  out.energy = rocking.energy;
  for (int i = 0; i < R; ++i) {
    out.force[macro_m1 + i] = rocking.force[1 + i];
    out.force[macro_h1 + i] = stiffness_[macro_h1 + i] * q[macro_h1 + i];
    out.shear_energy += 0.5 * out.force[macro_h1 + i] * q[macro_h1 + i];
  }
  if (!with_stiffness) return out;
  out.stiffness.diagonal() = stiffness_;
  spread(rocking.stiffness, R, out.stiffness);
  return out;
}

/// Every axis that lifts has 1 - 2 |M|/(N D) = (gamma/beta) (N/offset)^(1/gamma).
bool MacroUplift::beyond_capacity(const MacroVector& q, double capacity) const {
  const Axes axes = axes_of(q.data() + macro_m1, 2);
  double power = 0, share = capacity;
  for (int i = 0; i < axes.count; ++i) {
    if (!(axes.offset[i] > 0)) continue;
    power += 1 / gamma_;
    share *= gamma_ / beta_ * std::pow(axes.offset[i], -1 / gamma_);
  }
  constexpr double round_off = 1e-12;
  return power > 1 + round_off || (power > 1 - round_off && share <= 1);
}

MacroVector MacroUplift::displacement(const MacroVector& force) const {
  MacroVector q = force.cwiseQuotient(stiffness_);
  const double n = force[macro_n];
  const Axes axes = axes_of(q.data() + macro_m1, 2);  // of a disc: the direction
  for (int i = 0; i < axes.count; ++i) {
    const double m = axes.offset[i] / n;
    if (!(m > 1)) continue;
    const double x = std::pow(gamma_ / (beta_ - m), gamma_), more = (x / m - 1) * axes.rotation[i];
    q[macro_n] -= factor_[i] * n * curve(x, beta_, gamma_).heave;
    if (elastic_.disc)
      for (int k = 0; k < 2; ++k) q[macro_m1 + k] += more * axes.direction[k];
    else
      q[macro_m1 + i] += axes.sign[i] * more;
  }
  return q;
}

template <int R>
MacroUplift::RockingAverage MacroUplift::average(const Vec3& from, const MacroRocking& at_from, const Vec3& to, const MacroRocking& at_to,
                                                 bool with_from) const {
  using Part = Fixed<1 + R, 1>;
  using Slope = Fixed<1 + R, 1 + R>;
  const Part middle = 0.5 * (from + to).template head<1 + R>(), step = (to - from).template head<1 + R>();
  Part stiffness;
  stiffness[0] = elastic_.vertical;
  for (int i = 0; i < R; ++i) stiffness[1 + i] = elastic_.rocking[i];
  Vec3 at_middle = Vec3::Zero();
  at_middle.head<1 + R>() = middle;
  const MacroRocking half = rock<R>(at_middle, true, middle.cwiseAbs().maxCoeff() == 0);
  Part force = half.force.head<1 + R>();
  const Part half_force = force;
  Slope by_to = 0.5 * half.stiffness.topLeftCorner<1 + R, 1 + R>(), by_from = by_to;
  const Part scaled = stiffness.cwiseProduct(step);
  const double square = step.dot(scaled), work = half_force.dot(step), lacking = at_to.energy - at_from.energy - work;
  const double round_off =
      16 * std::numeric_limits<double>::epsilon() * (at_to.energy + at_from.energy + half_force.cwiseProduct(middle).cwiseAbs().sum());
  if (std::abs(lacking) > round_off && square > 0) {
    const double share = lacking / square;
    const Part bend = by_to.transpose() * step, twice = 2 * share * scaled;
    force += share * scaled;
    // derivatives of the share with respect to either end, and of the increment itself
    const auto add = [&](const MacroRocking& end, double sign, Slope& by) {
      const Part by_end = (sign * (end.force.head<1 + R>() - half_force - twice) - bend) / square;
      by += scaled * by_end.transpose();
      by.diagonal() += sign * share * stiffness;
    };
    add(at_to, 1, by_to);
    if (with_from) add(at_from, -1, by_from);
  }
  RockingAverage out;
  out.force.head<1 + R>() = force;
  out.by_to.topLeftCorner<1 + R, 1 + R>() = by_to;
  if (with_from) out.by_from.topLeftCorner<1 + R, 1 + R>() = by_from;
  return out;
}

MacroUplift::Average MacroUplift::average(const MacroVector& from, const MacroElastic& at_from, const MacroVector& to,
                                          const MacroElastic& at_to) const {
  const auto part = [](const MacroVector& v) { return Vec3(v[macro_n], v[macro_m1], v[macro_m2]); };
  const auto rocking = [&](const MacroElastic& at) {
    MacroRocking out;
    out.force = part(at.force);
    out.energy = at.energy;
    return out;
  };
  const RockingAverage without_shear = average<2>(part(from), rocking(at_from), part(to), rocking(at_to), true);
  Average out{MacroVector::Zero(), MacroMatrix::Zero(), MacroMatrix::Zero()};
  out.force[macro_n] = without_shear.force[0];
  out.force.tail<2>() = without_shear.force.tail<2>();
  spread(without_shear.by_from, 2, out.by_from);
  spread(without_shear.by_to, 2, out.by_to);
  for (const int i : {macro_h1, macro_h2}) {  // linear while in contact: the plain mean
    out.force[i] = 0.5 * (at_from.force[i] + at_to.force[i]);
    out.by_from(i, i) = at_from.contact ? 0.5 * stiffness_[i] : 0;
    out.by_to(i, i) = at_to.contact ? 0.5 * stiffness_[i] : 0;
  }
  return out;
}

template MacroElastic MacroUplift::respond<1>(const MacroVector&, bool) const;
template MacroElastic MacroUplift::respond<2>(const MacroVector&, bool) const;
template MacroRocking MacroUplift::rock<1>(const Vec3&, bool, bool) const;
template MacroRocking MacroUplift::rock<2>(const Vec3&, bool, bool) const;
template MacroUplift::RockingAverage MacroUplift::average<1>(const Vec3&, const MacroRocking&, const Vec3&, const MacroRocking&,
                                                             bool) const;
template MacroUplift::RockingAverage MacroUplift::average<2>(const Vec3&, const MacroRocking&, const Vec3&, const MacroRocking&,
                                                             bool) const;

}  // namespace uplift
