#pragma once
#include <string>

#include "uplift/base/error.h"
#include "uplift/math/fixed.h"

namespace uplift {

/// Stress [Pa] or strain of a point in the order (xx, yy, zz, xy, yz, zx); tension > 0; shear strains are engineering strains (2 e_xy).
using Stress = Vec6;
using Strain = Vec6;

/// What a plane model keeps zero out of its plane: the strain (long foundations, soil sections) or the stress (thin walls).
enum class PlaneState { strain, stress };

/// Isotropic linear elastic material.
struct ElasticMaterial {
  double young = 0;    // E [Pa], > 0
  double poisson = 0;  // nu, in (-1, 0.5)
  double density = 0;  // rho [kg/m3], >= 0
  bool operator==(const ElasticMaterial&) const = default;

  double shear() const { return young / (2 * (1 + poisson)); }                           // G = mu [Pa]
  double lame() const { return young * poisson / ((1 + poisson) * (1 - 2 * poisson)); }  // lambda [Pa]
  double bulk() const { return young / (3 * (1 - 2 * poisson)); }                        // K [Pa]
  double constrained() const { return lame() + 2 * shear(); }                            // lambda + 2 mu [Pa]: no strain across
  /// lambda [Pa] to be used in the plane: that of plane stress is 2 lambda mu / (lambda + 2 mu) = E nu / (1 - nu^2).
  double plane_lame(PlaneState state) const;
  double p_wave_speed() const;  // Vp = sqrt((lambda + 2 mu)/rho) [m/s], in three dimensions and in plane strain; rho > 0
  double s_wave_speed() const;  // Vs = sqrt(mu/rho) [m/s]; rho > 0
};

/// The material of a soil whose shear wave speed [m/s] was measured.
ElasticMaterial material_of_wave_speed(double s_wave_speed, double poisson, double density);
/// Throws InputError at `where` and `path` ("soil[1]") unless E > 0, -1 < nu < 0.5 and rho >= 0, all finite.
void check_material(const ElasticMaterial& material, const Where& where, const std::string& path);

/// stress = D strain in three dimensions; its rows xx, yy, zz, xy serve in plane strain.
Mat6 elastic_matrix(const ElasticMaterial& material);

}  // namespace uplift
