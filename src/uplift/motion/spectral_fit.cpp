#include "uplift/motion/spectral_fit.h"

#include <cmath>

#include "uplift/math/dense.h"
#include "uplift/motion/oscillator.h"
#include "uplift/motion/parallel.h"

namespace uplift {

namespace {

/// The largest response of an oscillator: its value w2 x [m/s2] and the number of sub-steps until then.
struct Extreme {
  double value = 0;
  Index at = 0;
};

Extreme extreme_of(const Vector& acceleration, const OscillatorStep& s, int subs) {
  Extreme found;
  double p = 0, q = 0;
  for (Index i = 1, sub_step = 1; i < acceleration.size(); ++i) {
    const double start = acceleration[i - 1], slope = (acceleration[i] - start) / subs;
    for (int k = 0; k < subs; ++k, ++sub_step) {
      const double from = start + slope * k, to = start + slope * (k + 1);
      const double next = s.pp * p + s.pq * q + s.p0 * from + s.p1 * to;
      q = s.qp * p + s.qq * q + s.q0 * from + s.q1 * to;
      p = next;
      if (std::abs(p) > std::abs(found.value)) found = {p, sub_step};
    }
  }
  return found;
}

/// The response after `at` sub-steps as a linear function of the acceleration's values: its coefficients, by the steps backwards.
Vector row_of(Index points, const OscillatorStep& s, int subs, Index at) {
  Vector row = Vector::Zero(points);
  double p = 1, q = 0;  // what the response owes to p and q at the end of the sub-step
  for (Index sub_step = at; sub_step >= 1; --sub_step) {
    const Index point = (sub_step - 1) / subs;
    const double end = static_cast<double>((sub_step - 1) % subs + 1) / subs, begin = end - 1.0 / subs;  // within the step
    const double from = s.p0 * p + s.q0 * q, to = s.p1 * p + s.q1 * q;
    row[point] += from * (1 - begin) + to * (1 - end);
    row[point + 1] += from * begin + to * end;
    const double before = s.pp * p + s.qp * q;
    q = s.pq * p + s.qq * q;
    p = before;
  }
  return row;
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

/// Adds what is asked of the acceleration as one row, weighted, of norm 1.
void ask(Matrix& rows, Vector& wanted, Index number, const Vector& row, double amount) {
  const double norm = row.norm();
  if (norm > 0) {
    rows.row(number) = row.transpose() / norm;
    wanted[number] = amount / norm;
  }
}

}  // namespace

Vector spectral_change(const Vector& acceleration, const Vector& envelope, const SpectralDemand& demand, double share) {
  const auto count = static_cast<Index>(demand.frequencies.size()), points = acceleration.size();
  Matrix rows = Matrix::Zero(count + 3, points);
  Vector wanted = Vector::Zero(count + 3);
  in_parallel(static_cast<int>(count), 0, [&](int i) {
    const auto at = static_cast<std::size_t>(i);
    const int subs = sub_steps(demand.frequencies[at], demand.step);
    const OscillatorStep step = oscillator_step(demand.frequencies[at], demand.damping, demand.step / subs);
    const Extreme reached = extreme_of(acceleration, step, subs);
    const Vector row = row_of(points, step, subs, reached.at).cwiseProduct(envelope);
    const bool kept = at < demand.limits && std::abs(reached.value) < demand.target[at];
    ask(rows, wanted, i, row, kept ? 0 : std::copysign(demand.target[at], reached.value) - reached.value);
  });
  if (demand.peak > 0) {
    Index at = 0;
    acceleration.cwiseAbs().maxCoeff(&at);
    Vector row = Vector::Zero(points);
    row[at] = envelope[at];
    ask(rows, wanted, count, row, std::copysign(demand.peak, acceleration[at]) - acceleration[at]);
  }
  const Matrix rest = rest_rows(points, demand.step);
  for (Index k = 0; k < 2; ++k)
    ask(rows, wanted, count + 1 + k, rest.row(k).transpose().cwiseProduct(envelope), -rest.row(k).dot(acceleration));

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
