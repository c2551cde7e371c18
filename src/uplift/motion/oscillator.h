#pragma once

namespace uplift {

/// One step of a damped oscillator whose base has an acceleration a that is straight within the step (Nigam and Jennings 1969), in the
/// variables p = w2 x and q = w v (x, v relative to the base), all in m/s2:
///
///   x'' + 2 zeta w x' + w2 x = -a,      p1 = pp p + pq q + p0 a0 + p1 a1,      q1 = qp p + qq q + q0 a0 + q1 a1
struct OscillatorStep {
  double pp, pq, p0, p1;
  double qp, qq, q0, q1;
};

/// Exact for any step [s], frequency > 0 [Hz] and damping ratio >= 0; short steps lose no digits.
OscillatorStep oscillator_step(double frequency, double damping, double step);

/// Into how many equal sub-steps a step is divided so that there are twenty in a period at least: a largest value among the points is then
/// at most 1 - cos(pi/20) = 1.2 % below the peak. No more than 200: a base motion so slow against the oscillator makes no peaks of its own.
int sub_steps(double frequency, double step);

}  // namespace uplift
