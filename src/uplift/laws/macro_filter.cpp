#include "uplift/laws/macro_filter.h"

#include <algorithm>
#include <cmath>

namespace uplift {
namespace {

/// How far a force is from pulling at an edge, min N - 2 |M|/D >= 0: concave. `gradient`: of it, or null.
double reserve(const MacroElasticity& ground, const MacroVector& force, MacroVector* gradient) {
  const double one = 2 * force[macro_m1] / ground.length[0], two = 2 * force[macro_m2] / ground.length[1];
  const double tilt = ground.disc ? std::hypot(one, two) : std::max(std::abs(one), std::abs(two));
  if (gradient != nullptr) {
    gradient->setZero();
    (*gradient)[macro_n] = 1;
    const auto along = [&](int i, double each) {
      const double part = tilt > 0 ? each / tilt : 0;
      if (ground.disc || std::abs(each) == tilt) (*gradient)[macro_m1 + i] = -2 / ground.length[i] * part;
    };
    along(0, one), along(1, two);
  }
  return force[macro_n] - tilt;
}

/// The largest theta <= 1 for which mean + theta y has no smaller reserve than the mean, or than none. Newton's method on the concave
/// reserve falls to it from 1.
double admissible(const MacroElasticity& ground, const MacroVector& mean, const MacroVector& y, double least) {
  double theta = 1;
  MacroVector gradient;
  for (int iteration = 0; iteration < 50 && theta > 0; ++iteration) {
    const double lacking = least - reserve(ground, mean + theta * y, &gradient), slope = gradient.dot(y);
    if (!(lacking > 0) || !(slope < 0)) break;
    const double next = theta + lacking / slope;
    if (next >= theta) break;
    theta = std::max(next, 0.0);
  }
  return theta;
}

}  // namespace

MacroFilter macro_filter(const MacroElasticity& ground, const MacroMatrix& coefficient, const MacroVector& pull,
                         const MacroFilterStep& step) {
  MacroFilter out;
  const MacroVector y = coefficient * step.elastic - pull, yielded = step.increment - step.elastic;
  const MacroMatrix y_slope = coefficient * step.elastic_slope;
  const double mean_reserve = reserve(ground, step.mean, nullptr), least = std::min(mean_reserve, 0.0);
  out.share = admissible(ground, step.mean, y, least);
  if (out.share < 1) {
    MacroVector gradient;
    reserve(ground, step.mean + out.share * y, &gradient);
    const double rate = gradient.dot(y);
    if (rate < 0) out.share_slope = -((step.mean_slope + out.share * y_slope).transpose() * gradient) / rate;
    if (rate < 0 && mean_reserve < 0) {
      reserve(ground, step.mean, &gradient);
      out.share_slope += step.mean_slope.transpose() * gradient / rate;
    }
  }
  const double given_back = y.dot(yielded);
  if (step.dissipated + out.share * given_back < 0) {
    out.share = std::clamp(-step.dissipated / given_back, 0.0, 1.0);
    const MacroVector slope = y_slope.transpose() * yielded + (MacroMatrix::Identity() - step.elastic_slope).transpose() * y;
    out.share_slope = -(step.dissipated_slope + out.share * slope) / given_back;
  }
  out.force = out.share * y;
  out.slope = out.share * y_slope + y * out.share_slope.transpose();
  out.dissipated = out.share * given_back;
  return out;
}

}  // namespace uplift
