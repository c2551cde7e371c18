#pragma once
#include <limits>
#include <string>
#include <vector>

#include "uplift/case/case.h"

namespace uplift {

/// Nodes that a shear wave needs over its length to be carried by a mesh.
inline constexpr double nodes_per_wavelength = 10;
/// The solid of a case that carries the lowest frequency [Hz]; infinite without a mesh with mass.
struct MeshReach {
  std::string group;
  double frequency = std::numeric_limits<double>::infinity();
};
MeshReach lowest_reach(const Case& read);

/// Share of the energy of a function of time, the integral of its square, above a frequency [Hz]; over `duration` [s].
double energy_above(const TimeFunction& function, int derivative, double duration, double frequency);

/// Warns of solids whose cells carry shear waves up to a frequency (ten nodes a wavelength) above which a load has more than a twentieth of
/// its energy, or up to which floor spectra are asked for.
void warn_content(const Case& read, const BuiltCase& built, std::vector<std::string>& said);

}  // namespace uplift
