#include "uplift/math/quadrature.h"

#include <cassert>
#include <cmath>
#include <numbers>

namespace uplift {

namespace {

struct Legendre {
  double value, previous;  // P_n, P_(n-1)
};

Legendre legendre(int n, double x) {
  double p0 = 1, p1 = x;
  if (n == 0) return {1, 0};
  for (int k = 2; k <= n; ++k) {
    const double p2 = ((2 * k - 1) * x * p1 - (k - 1) * p0) / k;
    p0 = p1;
    p1 = p2;
  }
  return {p1, p0};
}

}  // namespace

Quadrature gauss_legendre(int n) {
  assert(n >= 1);
  Quadrature rule{Vector(n), Vector(n)};
  for (int i = 0; i < (n + 1) / 2; ++i) {
    double x = std::cos(std::numbers::pi * (i + 0.75) / (n + 0.5)), slope = 0;
    if (2 * i + 1 == n) x = 0;
    for (int iteration = 0; iteration < 20; ++iteration) {
      const Legendre p = legendre(n, x);
      slope = n * (x * p.value - p.previous) / (x * x - 1);
      const double step = p.value / slope;
      x -= step;
      if (std::abs(step) < 1e-15) break;
    }
    if (2 * i + 1 == n) x = 0;
    const Legendre p = legendre(n, x);
    slope = n * (x * p.value - p.previous) / (x * x - 1);
    rule.point[n - 1 - i] = x;
    rule.point[i] = -x;
    rule.weight[i] = rule.weight[n - 1 - i] = 2 / ((1 - x * x) * slope * slope);
  }
  return rule;
}

Quadrature gauss_lobatto(int n) {
  assert(n >= 2);
  Quadrature rule{Vector(n), Vector(n)};
  const int m = n - 1;  // the inner points are the zeros of P'_m
  for (int i = 0; i < n; ++i) {
    double x = -std::cos(std::numbers::pi * i / m);
    if (i > 0 && i < m) {
      for (int iteration = 0; iteration < 50; ++iteration) {
        const Legendre p = legendre(m, x);
        const double first = m * (x * p.value - p.previous) / (x * x - 1);
        const double second = (2 * x * first - m * (m + 1) * p.value) / (1 - x * x);  // Legendre's differential equation
        const double step = first / second;
        x -= step;
        if (std::abs(step) < 1e-15) break;
      }
      if (2 * i == m) x = 0;
    }
    const double p = legendre(m, x).value;
    rule.point[i] = x;
    rule.weight[i] = 2 / (m * n * p * p);
  }
  return rule;
}

Quadrature trapezoid(int n) {
  assert(n >= 2);
  Quadrature rule{Vector::LinSpaced(n, -1, 1), Vector::Constant(n, 2.0 / (n - 1))};
  rule.weight[0] = rule.weight[n - 1] = 1.0 / (n - 1);
  return rule;
}

Quadrature midpoint(int n) {
  assert(n >= 1);
  Quadrature rule{Vector(n), Vector::Constant(n, 2.0 / n)};
  for (int i = 0; i < n; ++i) rule.point[i] = -1 + (2 * i + 1.0) / n;
  return rule;
}

}  // namespace uplift
