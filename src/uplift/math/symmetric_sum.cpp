#include "uplift/math/symmetric_sum.h"

namespace uplift {

Vector SymmetricSum::diagonal() const {
  Vector sum = here.diagonal();
  for (const DistributedTerm& term : there) sum += term.factor * term.matrix->diagonal();
  return sum;
}

Vector SymmetricSum::times(const Vector& x) const {
  Vector product = here.selfadjointView<upper_triangle>() * x;
  if (there.empty()) return product;
  Vector elsewhere(x.size());
  there.front().matrix->multiply(there, x, elsewhere);
  return product + elsewhere;
}

}  // namespace uplift
