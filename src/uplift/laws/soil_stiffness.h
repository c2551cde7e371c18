#pragma once
#include <array>
#include <limits>
#include <string_view>
#include <vector>

#include "uplift/base/declare.h"

// Stiffness and radiation damping of the ground under a rigid footing from published formulas: docs/theory/soil_stiffness.md.
namespace uplift {

struct Footprint;

/// The keys of [foundation.soil], also those of `uplift soil`.
const Section& footing_soil_section();

/// Homogeneous ground.
struct Ground {
  double shear_modulus = 0;  // Pa
  double poisson = 0;
  double density = 0;            // kg/m3; 0: not given
  double wave_velocity() const;  // m/s, of shear waves
};
struct GroundLayer {
  Ground ground;
  double thickness = std::numeric_limits<double>::infinity();  // m
};

enum class SoilFormulas {
  pais_kausel,  // rectangle: static, embedment, frequency, radiation
  gazetas,      // rectangle: static, embedment; radiation of translations
  disc,         // half-space: exact static stiffness (horizontal: no rocking), embedment; radiation of translations
  strip         // on a layer over rock: static
};

struct FootingOnSoil {
  SoilFormulas formulas = SoilFormulas::pais_kausel;
  double width = 0, length = 0;     // m, of the underside; of a disc its diameter, of a strip the length out of the plane
  std::vector<GroundLayer> layers;  // from the surface down; the last one goes on
  double embedment = 0;             // m: depth of the underside
  double sidewall = 0;              // m: height of the walls that is in contact with the ground
  double rock_depth = std::numeric_limits<double>::infinity();  // m, below the underside
  double frequency = 0;                                         // Hz: of the dynamic stiffness and of the dashpots
  bool radiation = false;                                       // dashpots beside the stiffness
};

/// The motions of a footing, in the order of the results.
enum class SoilMotion { vertical, along_width, along_length, tilting_width, tilting_length, torsion };
inline constexpr std::array soil_motions{SoilMotion::vertical,      SoilMotion::along_width,    SoilMotion::along_length,
                                         SoilMotion::tilting_width, SoilMotion::tilting_length, SoilMotion::torsion};
std::string_view to_string(SoilMotion);

/// What the ground does against one motion. Rotational ones in N m/rad and N m s/rad.
struct SoilSpring {
  Ground ground;          // mean of the layers that this motion reaches
  double depth = 0;       // m, below the underside: of this mean
  double at_surface = 0;  // N/m: static, of a footing on the surface; 0: no formula
  double embedment = 1;   // factor on it
  double dynamic = 1;     // factor at the frequency
  double damping = 0;     // N s/m
  double stiffness() const { return at_surface * embedment * dynamic; }
};
class SoilSprings {
 public:
  SoilSpring& operator[](SoilMotion motion) { return springs_[static_cast<std::size_t>(motion)]; }
  const SoilSpring& operator[](SoilMotion motion) const { return springs_[static_cast<std::size_t>(motion)]; }

 private:
  std::array<SoilSpring, 6> springs_;
};
/// docs/theory/soil_stiffness.md, eqs (H1) to (H12).
SoilSprings soil_springs(const FootingOnSoil& footing);
/// Area of the underside [m2]; of a strip that of its length.
double footing_area(const FootingOnSoil& footing);
/// Where the formulas come from.
std::string_view source_of(SoilFormulas formulas);

/// A bed of springs, the same everywhere, with the right vertical stiffness has this share of the rocking stiffness about one axis. See
/// (H14).
double share_of_uniform_bed(const FootingOnSoil& footing, const SoilSprings& springs, SoilMotion rocking);

/// Throws InputError for what the formulas of this shape do not cover.
FootingOnSoil footing_on_soil(const Values& soil, const Footprint& footprint);

}  // namespace uplift
