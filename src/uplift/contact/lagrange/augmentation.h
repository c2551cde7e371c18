#pragma once
#include <algorithm>

#include "uplift/contact/model.h"

namespace uplift {

/// What a stiffness is scaled by: the compliance of a row, or of the whole interface (`largest`) where the row has none.
inline double divisor(double compliance, double largest) {
  return compliance > 1e-12 * largest ? compliance : std::max(largest, 1e-300);
}

/// Stiffness of every row for the augmentation [N/m]: factor / F_ii, of the whole interface where a row has no compliance. The tangential
/// rows of a point share that of their mean compliance: the trial force must not turn.
void augmentation(const ContactModel&, double factor, Vector& stiffness);

}  // namespace uplift
