#pragma once
#include <memory>
#include <string>
#include <vector>

#include "uplift/base/declare.h"

// Behaviours that MFront compiled with its generic interface: the C symbols of their shared library, and the data of one integration point.
// Facts: T. Helfer et al., The MFrontGenericInterfaceSupport project, J. Open Source Software 5 (2020) 2003; MFront's documentation of the
// generic interface, version 1 (TFEL 3.4.1 and later). Neither MFront nor MGIS is needed (docs/decisions/0007-mfront.md).
namespace uplift {

/// One end of the step. Tensors: xx, yy, zz, xy, xz, yz (plane strain: the first four), shear components times sqrt(2).
struct MfrontState {
  const double* strain;
  double* stress;
  const double *density, *properties;
  double *variables, *stored_energy, *dissipated_energy;
  const double* external_variables;
};

/// The data of a behaviour's function; MFront fixes order and types of the members.
struct MfrontPoint {
  char* message;  // room for mfront_message characters
  double duration;
  double* tangent;      // first number in: 4 asks for the consistent tangent, 0 for none; out: its rows, one after another
  double* step_factor;  // in: largest factor for the next step; out: the one that the behaviour asks for
  double* speed_of_sound;
  MfrontState begin, end;
};
inline constexpr int mfront_message = 512;

/// Returns 1 for a good step, 0 for one that should be shorter, -1 for a failure.
using MfrontFunction = int (*)(MfrontPoint*);

struct MfrontVariable {
  std::string name;
  int size;  // numbers
};

/// A behaviour of isotropic material for small strains.
struct MfrontBehaviour {
  std::shared_ptr<void> library;  // stays loaded
  std::string name;
  MfrontFunction function = nullptr;
  int components = 6;                     // of a symmetric tensor; 4 in plane strain
  std::vector<std::string> properties;    // material properties, in their order
  std::vector<MfrontVariable> variables;  // internal state variables, in their order
  bool stores_energy = false;             // it computes the stored energy

  int num_variables() const;  // numbers of all variables
};

/// Loads the behaviour that `library` and `behaviour` of a law name, for a mesh of this dimension. Throws InputError with the reason at
/// one of these two keys.
MfrontBehaviour load_mfront(const Values& law, int dimension);

}  // namespace uplift
