#pragma once
#include <cstdint>

#include "uplift/math/linalg.h"
#include "uplift/statistics/refused.h"

namespace uplift {

struct LatinHypercube {
  Matrix probability;       // samples x variables, in (0, 1): one number in each of the strata [i/n, (i + 1)/n) of every column
  Matrix rank_correlation;  // variables x variables, Spearman's, as reached
};

/// n >= 1 samples of the variables by Latin hypercube sampling (McKay, Beckman & Conover 1979) from counter-based random numbers. A value
/// of variable j of sample i is quantile(distribution j, probability(i, j)).
/// Variables have the rank correlation `target` (symmetric, 1 on the diagonal), by Iman & Conover's method (Commun. Stat. Simul. Comput.
/// 11, 1982), repeated with the target corrected by what is missing; the best of them is improved by exchanges of two samples of a
/// variable. The error is below 0.05 from 50 samples on, for up to 20 variables. Refused where the target is not positive definite, or
/// where there are not more samples than variables.
OrRefused<LatinHypercube> latin_hypercube(Index samples, const Matrix& target, std::uint64_t seed);
/// The same without a target: independent variables, whose random correlation is removed where there are enough samples.
LatinHypercube latin_hypercube(Index samples, Index variables, std::uint64_t seed);

/// Spearman's rank correlation of the columns; ties have their mean rank. A constant column has the correlation 0 with all others.
Matrix rank_correlation(const Matrix& columns);

}  // namespace uplift
