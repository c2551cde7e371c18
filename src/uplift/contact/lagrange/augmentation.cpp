#include "uplift/contact/lagrange/augmentation.h"

namespace uplift {

void augmentation(const ContactModel& model, double factor, Vector& stiffness) {
  stiffness.resize(model.rows());
  double largest = 0;
  for (Index i = 0; i < stiffness.size(); ++i) largest = std::max(largest, stiffness[i] = model.factor.row(i).squaredNorm());
  for (const Block& block : model.blocks) {
    const int n = block.batch.points;
    for (int i = block.first; block.batch.components == 3 && i < block.first + n; ++i)
      stiffness[i] = stiffness[i + n] = 0.5 * (stiffness[i] + stiffness[i + n]);
  }
  for (double& value : stiffness) value = factor / divisor(value, largest);
}

}  // namespace uplift
