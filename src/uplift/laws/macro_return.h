#pragma once
#include "uplift/laws/macro_surfaces.h"

// Implicit return of a trial state to the yield surfaces of a shallow foundation (docs/theory/macro_element.md, eqs M11).
namespace uplift {

/// The end of an increment of the macro-element, from the elastic displacement e_trial that it would have without further yielding.
struct MacroReturned {
  bool converged = true;
  bool yielded = false;
  MacroVector elastic;                              // e: displacement less plastic displacement
  MacroElastic at;                                  // forces at e
  MacroMatrix by_trial = MacroMatrix::Identity();   // d e/d e_trial
  MacroVector by_settlement = MacroVector::Zero();  // d e/d p at the beginning
};

/// Whether a force N > 0 lies within the surfaces, at the accumulated plastic settlement [m].
bool macro_holds(const MacroSurfaces& surfaces, const MacroVector& force, double settlement);

/// Solves, with the accumulated plastic settlement p [m] at the beginning,
///     e + lambda_2 n_2 + lambda_1 n_1 = e_trial,   f_i <= 0,  lambda_i >= 0,  lambda_i f_i = 0,   V = V(p + |e_trial,w - e_w|)
/// A footing without contact forgets its shear: e_u = 0 then. Not converged: the increment is to be cut.
/// `every_guess`: also first guesses that help only sometimes, so that round-off decides whether the increment is cut.
MacroReturned macro_return(const MacroUplift& uplift, const MacroSurfaces& surfaces, const MacroVector& trial, double settlement,
                           bool every_guess);

}  // namespace uplift
