#pragma once
#include "uplift/laws/macro_uplift.h"

// The joint filter of the scheme of filtered energy decay for a footing in contact (docs/theory/macro_element.md, eqs M29 to M32): with the
// elastic increment d_e of a step and what the filter remembers, d_f, the force of the step is
//     sigma + theta y,   y = C (d_e - d_f),   C = b * stiffness at the start of the step
// with the largest theta <= 1 that neither pulls at an edge nor takes more from yielding than yielding dissipates.
namespace uplift {

/// A step of the macro-element without the filter. Slopes are those with respect to the end of the path.
struct MacroFilterStep {
  MacroVector increment = MacroVector::Zero();  // of the displacement
  MacroVector elastic = MacroVector::Zero();    // its elastic part, d_e
  MacroMatrix elastic_slope = MacroMatrix::Zero();
  MacroVector mean = MacroVector::Zero();  // path average of the force
  MacroMatrix mean_slope = MacroMatrix::Zero();
  double dissipated = 0;  // by yielding [J], >= 0
  MacroVector dissipated_slope = MacroVector::Zero();
};

/// What the filter adds to it.
struct MacroFilter {
  double share = 0;  // theta
  MacroVector share_slope = MacroVector::Zero();
  MacroVector force = MacroVector::Zero();  // theta y
  MacroMatrix slope = MacroMatrix::Zero();
  double dissipated = 0;  // J: theta y . (plastic increment)
};

/// `coefficient`: C; `pull`: C d_f.
MacroFilter macro_filter(const MacroElasticity& ground, const MacroMatrix& coefficient, const MacroVector& pull,
                         const MacroFilterStep& step);

}  // namespace uplift
