#include "uplift/contact/jumps.h"

namespace uplift {

void JumpFactor::spread(const Vector& z, Vector& jump, Vector& opening) const {
  jump.noalias() = lower.triangularView<lower_triangle>() * z;
  opening.noalias() += rows * jump;
}

void JumpFactor::gather(const Vector& force, Vector& pull, Vector& gradient) const {
  pull.noalias() = rows.transpose() * force;
  gradient.noalias() += lower.transpose().triangularView<upper_triangle>() * pull;
}

}  // namespace uplift
