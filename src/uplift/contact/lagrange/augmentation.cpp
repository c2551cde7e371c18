#include "uplift/contact/lagrange/augmentation.h"

namespace uplift {

double row_compliances(const ContactModel& model, Vector& compliance) {
  const Index rows = model.rows();
  compliance.setZero(rows);
  for (Index k = 0; k < model.factor.cols(); ++k)
    for (Index i = 0; i < rows; ++i) compliance[i] += model.factor(i, k) * model.factor(i, k);
  return rows > 0 ? compliance.maxCoeff() : 0;
}

void augmentation(const ContactModel& model, double factor, Vector& stiffness) {
  const double largest = row_compliances(model, stiffness);
  for (const Block& block : model.blocks) {
    const int n = block.batch.points;
    for (int i = block.first; block.batch.components == 3 && i < block.first + n; ++i)
      stiffness[i] = stiffness[i + n] = 0.5 * (stiffness[i] + stiffness[i + n]);
  }
  for (double& value : stiffness) value = factor / divisor(value, largest);
}

}  // namespace uplift
