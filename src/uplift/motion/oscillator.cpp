#include "uplift/motion/oscillator.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "uplift/math/linalg.h"

namespace uplift {

// With s = t/h from 0 to 1 and tau = w h: p' = tau q, q' = -tau (p + 2 zeta q + a), a' = a1 - a0. The exponential of this matrix of four
// rows is the step. The closed form of Nigam and Jennings takes differences of nearly equal numbers, of order (w h)^-3; the series does
// not.
OscillatorStep oscillator_step(double frequency, double damping, double step) {
  const double tau = 2 * std::numbers::pi * frequency * step;
  Mat4 rates = Mat4::Zero();
  rates(0, 1) = tau;
  rates.row(1) << -tau, -2 * damping * tau, -tau, 0;
  rates(2, 3) = 1;
  int halvings = 0;
  for (double size = tau * (2 + 2 * damping); size > 1; size /= 2) ++halvings;
  rates = std::ldexp(1.0, -halvings) * rates;

  constexpr int terms = 20;  // 1/20! < 1e-18
  Mat4 e = Mat4::Identity();
  for (int k = terms; k >= 1; --k) e = Mat4::Identity() + rates * e / k;  // Horner
  for (int k = 0; k < halvings; ++k) e = (e * e).eval();
  return {e(0, 0), e(0, 1), e(0, 2) - e(0, 3), e(0, 3), e(1, 0), e(1, 1), e(1, 2) - e(1, 3), e(1, 3)};
}

int sub_steps(double frequency, double step) {
  constexpr double per_period = 20, most = 200, round_off = 1e-9;
  return static_cast<int>(std::clamp(std::ceil(per_period * frequency * step - round_off), 1.0, most));
}

}  // namespace uplift
