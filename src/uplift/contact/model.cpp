#include "uplift/contact/model.h"

#include <algorithm>

namespace uplift {

double flexibility(const ContactModel& model, const Block& block) {
  double largest = 0;
  for (int i = 0; i < block.batch.points; ++i) {
    const double compliance = model.factor.row(block.normal_row() + i).squaredNorm();
    largest = std::max(largest, compliance * block.area[static_cast<std::size_t>(i)]);
  }
  return largest;
}

void add_weighted_gram(const ContactModel& model, Index left, Index right, const ConstMap& weight, Matrix& work, Matrix& hessian) {
  const Index n = weight.size();
  work.topRows(n) = weight.asDiagonal() * model.factor.middleRows(right, n);
  hessian.noalias() += model.factor.middleRows(left, n).transpose() * work.topRows(n);
}

}  // namespace uplift
