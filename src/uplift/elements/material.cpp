#include "uplift/elements/material.h"

#include <fmt/format.h>

#include <cmath>

namespace uplift {

double ElasticMaterial::plane_lame(PlaneState state) const {
  return state == PlaneState::strain ? lame() : young * poisson / (1 - poisson * poisson);
}

double ElasticMaterial::p_wave_speed() const {
  return std::sqrt(constrained() / density);
}

double ElasticMaterial::s_wave_speed() const {
  return std::sqrt(shear() / density);
}

ElasticMaterial material_of_wave_speed(double s_wave_speed, double poisson, double density) {
  return {2 * (1 + poisson) * density * s_wave_speed * s_wave_speed, poisson, density};
}

void check_material(const ElasticMaterial& material, const Where& where, const std::string& path) {
  const auto require = [&](bool good, const char* name, const char* wanted, double found) {
    if (!good || !std::isfinite(found)) throw InputError(where, path + "." + name, wanted, fmt::format("{}", found));
  };
  require(material.young > 0, "young", "a modulus above 0 Pa", material.young);
  require(material.poisson > -1 && material.poisson < 0.5, "poisson", "a ratio between -1 and 0.5, both excluded", material.poisson);
  require(material.density >= 0, "density", "a density of at least 0 kg/m3", material.density);
}

Mat6 elastic_matrix(const ElasticMaterial& material) {
  Mat6 d = Mat6::Zero();
  d.topLeftCorner<3, 3>().setConstant(material.lame());
  d.diagonal().head<3>().array() += 2 * material.shear();
  d.diagonal().tail<3>().setConstant(material.shear());
  return d;
}

}  // namespace uplift
