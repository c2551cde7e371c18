#pragma once
#include <algorithm>
#include <cmath>

#include "uplift/math/linalg.h"

namespace uplift {

/// The residual of KernelReply. Included by sources only.
inline double kernel_residual(const ConstMatrixMap& c, const Vector& z, const double* force, const double* held, const Vector& opening,
                              const double* target, Vector& work) {
  double largest = 0, closed = 0;
  for (Index i = 0; i < c.rows(); ++i) {
    largest = std::max(largest, std::abs(target[i]));
    if (held[i] > 0) closed = std::max(closed, std::abs(opening[i]));
  }
  work = z;
  work.noalias() += c.transpose() * ConstMap(force, c.rows());
  const double size = z.norm(), balance = size > 0 ? work.norm() / size : 0;
  return largest > 0 ? std::max(balance, closed / largest) : balance;
}

}  // namespace uplift
