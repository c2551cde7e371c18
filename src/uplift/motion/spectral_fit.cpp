#include "uplift/motion/spectral_fit.h"

#include <algorithm>
#include <cmath>

#include "uplift/math/dense.h"
#include "uplift/motion/oscillator.h"

namespace uplift {

namespace {

constexpr Index at_once = 32;
using Numbers = double[at_once];

/// Oscillators with the same number of sub-steps: where each of them responds most, and what its response there owes to every value of the
/// acceleration. Every loop over them is one that the compiler turns into vector instructions.
struct Oscillators {
  alignas(64) Numbers pp, pq, p0, p1, qp, qq, q0, q1;
  alignas(64) Numbers p, q;
  alignas(64) Numbers size, value;  // of the largest response w2 x [m/s2]
  alignas(64) Numbers at;           // number of sub-steps until then
  int subs = 1;

  void set(Index lane, const OscillatorStep& s) {
    pp[lane] = s.pp, pq[lane] = s.pq, p0[lane] = s.p0, p1[lane] = s.p1;
    qp[lane] = s.qp, qq[lane] = s.qq, q0[lane] = s.q0, q1[lane] = s.q1;
  }
  void find_extremes(const Vector& acceleration);
  void fill_rows(const Vector& envelope, Index first, Index count, Matrix& rows);
};

void Oscillators::find_extremes(const Vector& acceleration) {
  for (Index j = 0; j < at_once; ++j) p[j] = q[j] = size[j] = value[j] = at[j] = 0;
  double sub_step = 0;
  for (Index i = 1; i < acceleration.size(); ++i) {
    const double start = acceleration[i - 1], slope = (acceleration[i] - start) / subs;
    for (int k = 0; k < subs; ++k) {
      const double from = start + slope * k, to = start + slope * (k + 1);
      ++sub_step;
      for (Index j = 0; j < at_once; ++j) {
        const double next = pp[j] * p[j] + pq[j] * q[j] + p0[j] * from + p1[j] * to;
        q[j] = qp[j] * p[j] + qq[j] * q[j] + q0[j] * from + q1[j] * to;
        p[j] = next;
        const bool more = std::abs(next) > size[j];
        size[j] = more ? std::abs(next) : size[j];
        value[j] = more ? next : value[j];
        at[j] = more ? sub_step : at[j];
      }
    }
  }
}

/// The responses after `at` sub-steps as linear functions of the acceleration's values, times the envelope: their coefficients, by the
/// steps backwards, as rows first, first + 1, ...
void Oscillators::fill_rows(const Vector& envelope, Index first, Index count, Matrix& rows) {
  for (Index j = 0; j < at_once; ++j) p[j] = q[j] = 0;      // what a response owes to p and q at the end of the sub-step
  const double last = *std::max_element(at, at + at_once);  // before it, in these loops, none owes anything
  Numbers left, right, carried{};                           // what it owes to the values at both ends of a step; to the right one so far
  for (Index point = (static_cast<Index>(last) + subs - 1) / subs - 1; point >= 0; --point) {
    for (Index j = 0; j < at_once; ++j) left[j] = 0, right[j] = carried[j];
    for (int k = subs; k >= 1; --k) {
      const double end = static_cast<double>(k) / subs, begin = end - 1.0 / subs;  // within the step
      const double sub_step = static_cast<double>(point * subs + k);
      for (Index j = 0; j < at_once; ++j) {
        p[j] = sub_step == at[j] ? 1 : p[j];
        const double from = p0[j] * p[j] + q0[j] * q[j], to = p1[j] * p[j] + q1[j] * q[j];
        left[j] += from * (1 - begin) + to * (1 - end);
        right[j] += from * begin + to * end;
        const double before = pp[j] * p[j] + qp[j] * q[j];
        q[j] = pq[j] * p[j] + qq[j] * q[j];
        p[j] = before;
      }
    }
    double* column = &rows(first, point + 1);
    for (Index j = 0; j < count; ++j) column[j] = right[j] * envelope[point + 1];
    std::copy_n(left, at_once, carried);
  }
  for (Index j = 0; j < count; ++j) rows(first + j, 0) = carried[j] * envelope[0];
}

/// Velocity and displacement at the end as linear functions of the acceleration's values, which is straight between them.
Matrix rest_rows(Index points, double step) {
  Matrix rows = Matrix::Zero(2, points);
  for (Index i = 0; i + 1 < points; ++i) {
    const double left = static_cast<double>(points - 1 - i);  // steps from the begin of this one to the end
    rows(0, i) += step / 2;
    rows(0, i + 1) += step / 2;
    rows(1, i) += step * step * (left / 2 - 1.0 / 6);
    rows(1, i + 1) += step * step * (left / 2 - 1.0 / 3);
  }
  return rows;
}

}  // namespace

Vector spectral_change(const Vector& acceleration, const Vector& envelope, const SpectralDemand& demand, double share) {
  const auto count = static_cast<Index>(demand.frequencies.size()), points = acceleration.size();
  Matrix rows = Matrix::Zero(count + 3, points);
  Vector wanted = Vector::Zero(count + 3);
  for (Index first = 0, together = 0; first < count; first += together) {
    const auto frequency = [&](Index j) { return demand.frequencies[static_cast<std::size_t>(first + j)]; };
    Oscillators oscillators;
    oscillators.subs = sub_steps(frequency(0), demand.step);
    for (together = 1; together < std::min(at_once, count - first) && sub_steps(frequency(together), demand.step) == oscillators.subs;)
      ++together;
    for (Index j = 0; j < at_once; ++j)  // places without an oscillator of their own repeat the last one
      oscillators.set(j, oscillator_step(frequency(std::min(j, together - 1)), demand.damping, demand.step / oscillators.subs));
    oscillators.find_extremes(acceleration);
    oscillators.fill_rows(envelope, first, together, rows);
    for (Index j = 0; j < together; ++j) {
      const auto at = static_cast<std::size_t>(first + j);
      const bool kept = at < demand.limits && oscillators.size[j] < demand.target[at];
      wanted[first + j] = kept ? 0 : std::copysign(demand.target[at], oscillators.value[j]) - oscillators.value[j];
    }
  }
  if (demand.peak > 0) {
    Index at = 0;
    acceleration.cwiseAbs().maxCoeff(&at);
    rows(count, at) = envelope[at];
    wanted[count] = std::copysign(demand.peak, acceleration[at]) - acceleration[at];
  }
  const Matrix rest = rest_rows(points, demand.step);
  for (Index k = 0; k < 2; ++k) {
    rows.row(count + 1 + k) = rest.row(k).cwiseProduct(envelope.transpose());
    wanted[count + 1 + k] = -rest.row(k).dot(acceleration);
  }

  const Vector norms = rows.rowwise().norm(), weights = (norms.array() > 0).select(norms.cwiseInverse(), 0);  // rows of norm 1
  rows = weights.asDiagonal() * rows;
  wanted = weights.cwiseProduct(wanted);

  constexpr double small = 0.01;  // against rows that say nearly the same with different amounts
  Matrix products = small * Matrix::Identity(count + 3, count + 3);
  products.selfadjointView<lower_triangle>().rankUpdate(rows);
  const Cholesky factor(products);
  return share * envelope.cwiseProduct(rows.transpose() * factor.solve(wanted));
}

Vector rest_change(const Vector& acceleration, const Vector& envelope, double step) {
  const Matrix rest = rest_rows(acceleration.size(), step), weighted = rest * envelope.asDiagonal();
  const Vector amounts = -rest * acceleration;
  return envelope.cwiseProduct(weighted.transpose() * PartialLu(weighted * weighted.transpose()).solve(amounts));
}

}  // namespace uplift
