#pragma once
#include "uplift/linear/solver.h"

namespace uplift {

/// How fast this machine is just now, on one thread.
struct Rates {
  double bytes_per_second = 0;       // streaming from where a factor of the asked size lies: caches or memory
  double operations_per_second = 0;  // product of dense matrices of order 256
};

/// Measured, in some hundredths of a second: a sum over a buffer of the factor's size (at most 128 MB), and a product by the BLAS that
/// CHOLMOD uses.
Rates measure_rates(double factor_bytes);

/// Seconds of a factorisation: supernodal factors reach two thirds of the speed of the dense product where they are large, and every entry
/// is taken from the system, filled and assembled once, about 10 ns (measured on soil in 2D and 3D from 10 000 to 70 000 unknowns).
double factor_seconds(const FactorCost& cost, const Rates& rates);
/// Seconds of one back-solve: the factor streams past once forward and once backward.
double solve_seconds(const FactorCost& cost, const Rates& rates);

}  // namespace uplift
