#include "uplift/laws/macro_uplift.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace uplift {
namespace {

constexpr int most_iterations = 100;
constexpr double quadratic = 1e-8;  // relative: after a step of Newton's method so small the error is round-off

/// The uplift curve of one axis at x = theta/theta_0 (eq M2).
struct Curve {
  double y = 1;         // x^(1/gamma), 1 before uplift: contact share 1/y
  double moment;        // m = M/M_0
  double compliance;    // g'' = d x/d m
  double slack;         // 1 - 2 M/(N D), distance from the edge
  double log_like = 0;  // (y^(gamma - 1) - 1)/(gamma - 1); ln y for gamma = 1
  double heave;         // -h = m x - 2 g
  double from_edge;     // h + beta x
};

Curve curve(double x, double beta, double gamma) {
  Curve c;
  if (x <= 1) {
    c.moment = x;
    c.compliance = 1;
    c.slack = 1 - x / beta;
    c.heave = 0;
    c.from_edge = beta * x;
    return c;
  }
  if (gamma == 2) {  // the usual case, without logarithms
    c.y = std::sqrt(x);
    c.log_like = c.y - 1;
  } else if (gamma == 1) {  // strips
    c.y = x;
    c.log_like = std::log(x);
  } else if (gamma == 3) {
    c.y = std::cbrt(x);
    c.log_like = 0.5 * (c.y * c.y - 1);
  } else {
    const double log_y = std::log(x) / gamma, t = (gamma - 1) * log_y;
    c.y = std::exp(log_y);
    c.log_like = std::abs(t) < 1e-14 ? log_y : std::expm1(t) / t * log_y;
  }
  c.moment = beta - gamma / c.y;
  c.compliance = x * c.y;
  c.slack = gamma / (beta * c.y);
  const double twice_energy = 1 + 2 * gamma * c.log_like;
  c.heave = c.moment * x - twice_energy;
  c.from_edge = twice_energy + gamma * x / c.y;
  return c;
}

}  // namespace

/// What the rotation about each axis brings; a disc has one axis, that of its rotation.
struct MacroUplift::Axes {
  int count = 2;
  double rotation[2];    // |theta| [rad]
  double offset[2];      // x N [N]
  double factor[2];      // (D/alpha)^2/K_r [m/N]
  MacroVector along[2];  // direction of the rotation

  Axes(const MacroElasticity& e, const MacroVector& q) {
    along[0].setZero(), along[1].setZero();
    if (e.disc) {
      count = 1;
      rotation[0] = std::hypot(q[macro_m1], q[macro_m2]);
      if (rotation[0] > 0) along[0].tail<2>() = q.tail<2>() / rotation[0];
    } else {
      for (int i = 0; i < 2; ++i) {
        rotation[i] = std::abs(q[macro_m1 + i]);
        along[i][macro_m1 + i] = q[macro_m1 + i] < 0 ? -1 : 1;
      }
    }
    for (int i = 0; i < count; ++i) {
      const double arm = e.length[i] / e.shape;
      offset[i] = e.rocking[i] * rotation[i] / arm;
      factor[i] = arm * arm / e.rocking[i];
    }
  }
};

MacroUplift::MacroUplift(const MacroElasticity& elasticity)
    : elastic_(elasticity), beta_(elasticity.shape / 2), gamma_(elasticity.shape / 2 - 1) {
  const auto second = [](double(&value)[2]) {
    if (!(value[1] > 0)) value[1] = value[0];
  };
  second(elastic_.length), second(elastic_.horizontal), second(elastic_.rocking);
  if (elastic_.disc) elastic_.length[1] = elastic_.length[0], elastic_.rocking[1] = elastic_.rocking[0];
  stiffness_ << elastic_.vertical, elastic_.horizontal[0], elastic_.horizontal[1], elastic_.rocking[0], elastic_.rocking[1];
}

/// z - ln z = s, z >= 1: the vertical force of strips. Newton's method from either side (eq M28).
double MacroUplift::strip_root(double s) {
  const double sigma = std::max(s - 1, 0.0), t = 0.3361 * std::sqrt(0.5 * sigma);
  double z = 1 + sigma + 2 / 0.3361 * t / (1 + t);  // within 0.6 % of the root: after Barry, Culligan-Hensley & Barry 1995
  for (int iteration = 0; iteration < most_iterations && z > 1; ++iteration) {
    const double next = z * (sigma + std::log(z)) / (z - 1), moved = std::abs(next - z);
    z = next;
    if (moved <= quadratic * (z - 1)) break;
  }
  return z;
}

/// (M27): P N + Q N^(1/gamma) = T, for strips N (P + Q ln(N_1/N)) = T, over the axes that lift. The second one does where the left side at
/// its offset exceeds the right side.
double MacroUplift::lifted_force(double w, const Axes& axes) const {
  const int first = axes.count == 2 && axes.offset[1] > axes.offset[0] ? 1 : 0;
  const double largest = axes.offset[first];
  double p = 1 / elastic_.vertical, q = 0, toe = w;
  for (int k = 0; k < axes.count; ++k) {
    const int i = k == 0 ? first : 1 - first;
    const double offset = axes.offset[i], factor = axes.factor[i];
    if (!(offset > 0)) break;
    if (gamma_ == 1) {
      const double log = k == 0 ? 0 : std::log(largest / offset);
      if (k > 0 && (p + q * log) * offset <= toe) break;
      p += 2 * factor * (1 - log), q += 2 * factor;
    } else {
      const double root = gamma_ == 2 ? std::sqrt(offset) : std::cbrt(offset);
      if (k > 0 && p * offset + q * root <= toe) break;
      p -= factor * beta_ / (gamma_ - 1), q += factor * gamma_ * beta_ / (gamma_ - 1) * offset / root;
    }
    toe += 0.5 * elastic_.length[i] * axes.rotation[i];
  }
  if (gamma_ == 1) return toe / (q * strip_root(p / q - std::log(toe / (q * largest))));
  if (gamma_ == 2) {
    const double root = 2 * toe / (q + std::sqrt(std::max(0.0, q * q + 4 * p * toe)));
    return root * root;
  }
  double root = toe / q;  // beyond it for p > 0, before it for p < 0: from there Newton's method keeps its side
  for (int iteration = 0; iteration < most_iterations; ++iteration) {
    const double square = root * root, next = (2 * p * square * root + toe) / (3 * p * square + q), moved = std::abs(next - root);
    root = next;
    if (moved <= quadratic * root) break;
  }
  return root * root * root;
}

/// N at the settlement w; zero without contact. Shape numbers without a form of their own: Newton's method on (M26), from a force that is
/// too small on, or from where the tangent leads to one.
double MacroUplift::vertical_force(double w, const Axes& axes) const {
  double toe = w, largest = 0, sum = 0, all = 0;
  for (int i = 0; i < axes.count; ++i) {
    toe += 0.5 * elastic_.length[i] * axes.rotation[i];
    largest = std::max(largest, axes.offset[i]);
    sum += axes.factor[i] * axes.offset[i], all += axes.factor[i];
  }
  if (w > 0 && largest <= elastic_.vertical * w) return elastic_.vertical * w;
  if (!(toe > 0)) return 0;
  if (gamma_ == 1 || gamma_ == 2 || gamma_ == 3) return lifted_force(w, axes);
  double n = std::min(elastic_.vertical * toe, sum / all / std::pow(std::max(1.0, 2 * beta_ * sum / toe), gamma_));
  for (int iteration = 0; iteration < most_iterations; ++iteration) {
    double slope = toe, intercept = 1 / elastic_.vertical;  // of the tangent, the slope with its sign changed
    for (int i = 0; i < axes.count; ++i) {
      const Curve c = curve(axes.offset[i] / n, beta_, gamma_);
      slope -= axes.factor[i] * beta_ * axes.offset[i] / c.y;
      intercept += axes.factor[i] * (c.from_edge - beta_ * axes.offset[i] / (n * c.y));
    }
    const double next = slope > 0 ? slope / intercept : 0.1 * n, moved = std::abs(next - n);
    n = next;
    if (moved <= quadratic * n) break;
  }
  return n;
}

MacroElastic MacroUplift::respond(const MacroVector& q, bool with_stiffness) const {
  MacroElastic out;
  const Axes axes(elastic_, q);
  const double n = vertical_force(q[macro_n], axes);
  // at rest without load the stiffness is that of the closed base, so that the first load finds something to stand on
  const bool at_rest = q.cwiseAbs().maxCoeff() == 0;
  if (!(n > 0) && !at_rest) {
    out.contact = false;
    out.contact_share = 0;
    return out;
  }
  out.force[macro_n] = n;
  out.force.segment<2>(macro_h1) = stiffness_.segment<2>(macro_h1).cwiseProduct(q.segment<2>(macro_h1));
  out.stiffness.diagonal() << 0, stiffness_[macro_h1], stiffness_[macro_h2], stiffness_[macro_m1], stiffness_[macro_m2];
  out.shear_energy = 0.5 * out.force.segment<2>(macro_h1).dot(q.segment<2>(macro_h1));

  double toe = q[macro_n], vertical = 1 / elastic_.vertical;  // dw/dN at fixed rotation
  MacroVector coupling = MacroVector::Zero();                 // -dw/dtheta at fixed N
  coupling[macro_n] = 1;
  for (int i = 0; i < axes.count; ++i) {
    if (axes.rotation[i] == 0 && !elastic_.disc) continue;
    const double x = n > 0 ? axes.offset[i] / n : 0, arm = elastic_.length[i] / elastic_.shape, half = 0.5 * elastic_.length[i];
    const Curve c = curve(x, beta_, gamma_);
    const double moment = arm * n * c.moment;
    out.force += moment * axes.along[i];
    out.heave += axes.factor[i] * n * c.heave;
    out.contact_share /= c.y;
    toe += half * axes.rotation[i] * (1 - c.slack);
    if (!with_stiffness) continue;
    vertical += axes.factor[i] * (gamma_ + 1) * c.log_like;
    coupling -= arm * (x / c.compliance - c.moment) * axes.along[i];
    const double along = elastic_.rocking[i] / c.compliance;
    if (elastic_.disc) {
      const double across = axes.rotation[i] > 0 ? moment / axes.rotation[i] : elastic_.rocking[i];
      out.stiffness.diagonal().tail<2>().setConstant(across);
      out.stiffness += (along - across) * axes.along[i] * axes.along[i].transpose();
    } else {
      out.stiffness(macro_m1 + i, macro_m1 + i) = along;
    }
  }
  if (with_stiffness) out.stiffness += coupling * coupling.transpose() / vertical;
  out.energy = 0.5 * n * toe;  // (N w + M theta)/2, homogeneous of degree two
  return out;
}

/// Every axis that lifts has 1 - 2 |M|/(N D) = (gamma/beta) (N/offset)^(1/gamma).
bool MacroUplift::beyond_capacity(const MacroVector& q, double capacity) const {
  const Axes axes(elastic_, q);
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
  const Axes axes(elastic_, q);  // of a disc: the direction
  for (int i = 0; i < axes.count; ++i) {
    const double arm = elastic_.length[i] / elastic_.shape, m = axes.rotation[i] * elastic_.rocking[i] / (arm * n);
    if (!(m > 1)) continue;
    const double x = std::pow(gamma_ / (beta_ - m), gamma_);
    q[macro_n] -= axes.factor[i] * n * curve(x, beta_, gamma_).heave;
    q += (x / m - 1) * axes.rotation[i] * axes.along[i];
  }
  return q;
}

MacroUplift::Average MacroUplift::average(const MacroVector& from, const MacroElastic& at_from, const MacroVector& to,
                                          const MacroElastic& at_to, bool with_from) const {
  const MacroVector middle = 0.5 * (from + to);
  const MacroElastic half = respond(middle);
  MacroVector step = to - from, mid_force = half.force;
  step.segment<2>(macro_h1).setZero();  // the shear is linear while in contact: its average is the plain mean below
  mid_force.segment<2>(macro_h1).setZero();

  Average out;
  out.force = mid_force;
  out.by_to = 0.5 * half.stiffness;
  out.by_to.middleRows<2>(macro_h1).setZero();
  if (with_from) out.by_from = out.by_to;
  const MacroVector scaled = stiffness_.cwiseProduct(step);
  const double square = step.dot(scaled), work = mid_force.dot(step), lacking = at_to.energy - at_from.energy - work;
  const double round_off =
      16 * std::numeric_limits<double>::epsilon() * (at_to.energy + at_from.energy + mid_force.cwiseProduct(middle).cwiseAbs().sum());
  if (std::abs(lacking) > round_off && square > 0) {
    const double share = lacking / square;
    const MacroVector bend = out.by_to.transpose() * step, twice = 2 * share * scaled;
    out.force += share * scaled;
    // derivatives of the share with respect to either end, and of the increment itself
    const auto add = [&](const MacroVector& difference, double sign, MacroMatrix& by) {
      MacroVector by_end = (sign * (difference - twice) - bend) / square;
      by_end.segment<2>(macro_h1).setZero();
      by += scaled * by_end.transpose();
      by(macro_n, macro_n) += sign * share * stiffness_[macro_n];
      by.diagonal().tail<2>() += sign * share * stiffness_.tail<2>();
    };
    add(at_to.force - mid_force, 1, out.by_to);
    if (with_from) add(at_from.force - mid_force, -1, out.by_from);
  }
  for (int i = macro_h1; i <= macro_h2; ++i) {
    out.force[i] = 0.5 * (at_from.force[i] + at_to.force[i]);
    if (with_from) out.by_from(i, i) = at_from.contact ? 0.5 * stiffness_[i] : 0;
    out.by_to(i, i) = at_to.contact ? 0.5 * stiffness_[i] : 0;
  }
  return out;
}

}  // namespace uplift
