#include "uplift/laws/soil_stiffness.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace uplift {
namespace {

using std::pow;
using std::sqrt;
using enum SoilMotion;
constexpr double pi = std::numbers::pi;

/// Half of the sides of a rectangle, L >= B (formulas call the long axis x), and whether L lies along the width.
struct Plan {
  double L = 0, B = 0;
  bool long_width = false;
  double ratio() const { return L / B; }
  /// The motions along (tilting) the long and the short side.
  SoilMotion along_long() const { return long_width ? along_width : along_length; }
  SoilMotion along_short() const { return long_width ? along_length : along_width; }
  SoilMotion tilting_long() const { return long_width ? tilting_width : tilting_length; }
  SoilMotion tilting_short() const { return long_width ? tilting_length : tilting_width; }
};

Plan plan_of(const FootingOnSoil& footing) {
  const bool long_width = footing.width >= footing.length;
  return {0.5 * std::max(footing.width, footing.length), 0.5 * std::min(footing.width, footing.length), long_width};
}

double radius_of(const FootingOnSoil& footing) {
  return 0.5 * footing.width;
}

/// (H2): half the side of the square with the same area, or the same second moment of area for a rotation.
double depth_of(const FootingOnSoil& footing, SoilMotion motion) {
  const double a = footing.width, b = footing.length;
  const bool disc = footing.formulas == SoilFormulas::disc;
  if (motion <= along_length) return 0.5 * sqrt(disc ? pi / 4 * a * a : a * b);
  const double disc_moment = pi / 64 * pow(a, 4);
  if (motion == tilting_width) return 0.5 * pow(12 * (disc ? disc_moment : b * a * a * a / 12), 0.25);
  if (motion == tilting_length) return 0.5 * pow(12 * (disc ? disc_moment : a * b * b * b / 12), 0.25);
  return 0.5 * pow(6 * (disc ? 2 * disc_moment : a * b * (a * a + b * b) / 12), 0.25);
}

/// (H1): time of travel of shear waves, means over the depth of the density and of Poisson's ratio.
Ground mean_ground(const FootingOnSoil& footing, double depth) {
  if (footing.layers.size() == 1) return footing.layers.front().ground;
  double top = -footing.embedment, time = 0, mass = 0, poisson = 0;  // m, below the underside
  for (std::size_t k = 0; k < footing.layers.size(); ++k) {
    const GroundLayer& layer = footing.layers[k];
    const double bottom = k + 1 < footing.layers.size() ? top + layer.thickness : depth;
    const double part = std::clamp(bottom, 0.0, depth) - std::clamp(top, 0.0, depth);
    top = bottom;
    if (part <= 0) continue;
    time += part / layer.ground.wave_velocity();
    mass += part * layer.ground.density;
    poisson += part * layer.ground.poisson;
  }
  const double velocity = depth / time, density = mass / depth;
  return {density * velocity * velocity, poisson / depth, density};
}

/// Velocity of the waves that a face radiates along its normal over that of shear waves: (H5).
double normal_velocity_ratio(double poisson) {
  return poisson < 0.5 ? std::min(sqrt(2 * (1 - poisson) / (1 - 2 * poisson)), 2.5) : 2.5;
}

void pais_kausel(const FootingOnSoil& footing, SoilSprings& springs) {
  const Plan plan = plan_of(footing);
  const double B = plan.B, r = plan.ratio(), d = footing.embedment / B;
  const auto a0 = [&](const Ground& ground) {
    return footing.frequency > 0 ? 2 * pi * footing.frequency * B / ground.wave_velocity() : 0.0;
  };
  /// share of a^2/(b + a^2) by which a rotation has reached its limit at high frequency
  const auto reached = [](double a, double b) { return a * a / (b + a * a); };
  const auto impedance = [](const Ground& ground) { return ground.density > 0 ? ground.density * ground.wave_velocity() : 0.0; };
  {
    SoilSpring& s = springs[vertical];
    const double a = a0(s.ground), psi = normal_velocity_ratio(s.ground.poisson);
    s.at_surface = s.ground.shear_modulus * B / (1 - s.ground.poisson) * (3.1 * pow(r, 0.75) + 1.6);
    s.embedment = 1 + (0.25 + 0.25 / r) * pow(d, 0.8);
    s.dynamic = 1 - (0.4 + 0.2 / r) * reached(a, 10 / (1 + 3 * (r - 1)));
    s.damping = impedance(s.ground) * 4 * B * B * (psi * r + d * (1 + r));
  }
  for (const SoilMotion motion : {plan.along_long(), plan.along_short()}) {
    SoilSpring& s = springs[motion];
    const bool along = motion == plan.along_long();
    const double psi = normal_velocity_ratio(s.ground.poisson);
    s.at_surface = s.ground.shear_modulus * B / (2 - s.ground.poisson) * (6.8 * pow(r, 0.65) + (along ? 2.4 : 0.8 * r + 1.6));
    s.embedment = 1 + (0.33 + 1.34 / (1 + r)) * pow(d, 0.8);
    s.damping = impedance(s.ground) * 4 * B * B * (r + d * (along ? psi + r : 1 + psi * r));
  }
  {
    SoilSpring& s = springs[plan.tilting_long()];
    const double a = a0(s.ground), psi = normal_velocity_ratio(s.ground.poisson);
    s.at_surface = s.ground.shear_modulus * pow(B, 3) / (1 - s.ground.poisson) * (3.73 * pow(r, 2.4) + 0.27);
    s.embedment = 1 + d + 1.6 / (0.35 + pow(r, 4)) * d * d;
    s.dynamic = 1 - 0.55 * reached(a, 0.6 + 1.4 / pow(r, 3));
    s.damping = impedance(s.ground) * 4.0 / 3 * pow(B, 4) * (psi * pow(r, 3) + d * (pow(r, 3) + 3 * r * r)) *
                reached(a, 1.8 / (1 + 1.75 * (r - 1)));
  }
  {
    SoilSpring& s = springs[plan.tilting_short()];
    const double a = a0(s.ground), psi = normal_velocity_ratio(s.ground.poisson);
    s.at_surface = s.ground.shear_modulus * pow(B, 3) / (1 - s.ground.poisson) * (3.2 * r + 0.8);
    s.embedment = 1 + d + 1.6 / (0.35 + r) * d * d;
    s.dynamic = 1 - (0.55 + 0.01 * sqrt(r - 1)) * reached(a, 2.4 - 0.4 / pow(r, 3));
    s.damping = impedance(s.ground) * 4.0 / 3 * pow(B, 4) * (psi * r + d * (1 + 3 * r)) * reached(a, 2.2 - 0.4 / pow(r, 3));
  }
  {
    SoilSpring& s = springs[torsion];
    const double a = a0(s.ground), psi = normal_velocity_ratio(s.ground.poisson);
    s.at_surface = s.ground.shear_modulus * pow(B, 3) * (4.25 * pow(r, 2.45) + 4.06);
    s.embedment = 1 + (1.3 + 1.32 / r) * pow(d, 0.9);
    s.dynamic = 1 - (0.33 - 0.03 * sqrt(r - 1)) * reached(a, 0.8 / (1 + 0.33 * (r - 1)));
    s.damping = impedance(s.ground) * 4.0 / 3 * pow(B, 4) * (r * (r * r + 1) + d * (psi * (pow(r, 3) + 1) + 3 * r * (1 + r))) *
                reached(a, 1.4 / (1 + 3 * pow(r - 1, 0.7)));
  }
}

void gazetas(const FootingOnSoil& footing, SoilSprings& springs) {
  const Plan plan = plan_of(footing);
  const double B = plan.B, L = plan.L, q = B / L, D = footing.embedment, wall = footing.sidewall;
  const double faces = 4 * wall * (B + L), middle = D - 0.5 * wall;  // m2, m: of the walls in contact
  const double Ix = 4.0 / 3 * L * pow(B, 3), Iy = 4.0 / 3 * B * pow(L, 3);
  const auto along_normal = [](const Ground& g) { return g.density * g.wave_velocity() * 3.4 / (pi * (1 - g.poisson)); };
  const auto in_shear = [](const Ground& g) { return g.density * g.wave_velocity(); };
  {
    SoilSpring& s = springs[vertical];
    s.at_surface = 2 * s.ground.shear_modulus * L / (1 - s.ground.poisson) * (0.73 + 1.54 * pow(q, 0.75));
    s.embedment = (1 + D / (21 * B) * (1 + 1.3 * q)) * (1 + 0.2 * pow(faces / (4 * B * L), 2.0 / 3));
    if (s.ground.density > 0) s.damping = along_normal(s.ground) * 4 * B * L + in_shear(s.ground) * faces;
  }
  for (const SoilMotion motion : {plan.along_long(), plan.along_short()}) {
    SoilSpring& s = springs[motion];
    const bool along = motion == plan.along_long();
    const double g = s.ground.shear_modulus, nu = s.ground.poisson;
    s.at_surface = 2 * g * L / (2 - nu) * (2 + 2.5 * pow(q, 0.85));
    if (along) s.at_surface -= 0.2 * g * L / (0.75 - nu) * (1 - q);
    s.embedment = (1 + 0.15 * sqrt(D / B)) * (1 + 0.52 * pow(middle * faces / (along ? L * B * B : B * L * L), 0.4));
    const double across = along ? B : L, parallel = along ? L : B;  // half lengths of the walls that push and of those that shear
    if (s.ground.density > 0)
      s.damping = in_shear(s.ground) * (4 * B * L + 4 * wall * parallel) + along_normal(s.ground) * 4 * wall * across;
  }
  {
    SoilSpring& s = springs[plan.tilting_short()];
    s.at_surface = s.ground.shear_modulus / (1 - s.ground.poisson) * pow(Ix, 0.75) * pow(1 / q, 0.25) * (2.4 + 0.5 * q);
    if (wall > 0) s.embedment = 1 + 1.26 * wall / B * (1 + wall / B * pow(wall / D, -0.2) * sqrt(q));
  }
  {
    SoilSpring& s = springs[plan.tilting_long()];
    s.at_surface = s.ground.shear_modulus / (1 - s.ground.poisson) * pow(Iy, 0.75) * 3 * pow(1 / q, 0.15);
    if (wall > 0) s.embedment = 1 + 0.92 * pow(wall / L, 0.6) * (1.5 + pow(wall / L, 1.9) * pow(wall / D, -0.6));
  }
  SoilSpring& s = springs[torsion];
  s.at_surface = s.ground.shear_modulus * pow(Ix + Iy, 0.75) * (4 + 11 * pow(1 - q, 10));
  s.embedment = 1 + 1.4 * (1 + q) * pow(wall / B, 0.9);
}

void disc(const FootingOnSoil& footing, SoilSprings& springs) {
  const double R = radius_of(footing), d = footing.embedment / R;
  for (const SoilMotion motion : soil_motions) {
    SoilSpring& s = springs[motion];
    const double g = s.ground.shear_modulus, nu = s.ground.poisson;
    const double per_velocity = s.ground.density > 0 ? R / s.ground.wave_velocity() : 0;
    switch (motion) {
      case vertical:
        s.at_surface = 4 * g * R / (1 - nu), s.embedment = 1 + 0.54 * d;
        s.damping = 0.85 * s.at_surface * per_velocity;
        break;
      case along_width:
      case along_length:
        s.at_surface = 8 * g * R / (2 - nu), s.embedment = 1 + 2.0 / 3 * d;
        s.damping = 0.576 * s.at_surface * per_velocity;
        break;
      case tilting_width:
      case tilting_length:
        s.at_surface = 8 * g * pow(R, 3) / (3 * (1 - nu)), s.embedment = 1 + 2 * d;
        break;
      case torsion:
        s.at_surface = 16.0 / 3 * g * pow(R, 3), s.embedment = 1 + 2.67 * d;
    }
  }
}

void strip(const FootingOnSoil& footing, SoilSprings& springs) {
  const double b = 0.5 * footing.width, h = b / footing.rock_depth;
  const double g = springs[vertical].ground.shear_modulus, nu = springs[vertical].ground.poisson;
  const auto put = [&](SoilMotion motion, double value) { springs[motion].at_surface = value * footing.length; };
  put(vertical, 1.23 * g / (1 - nu) * (1 + 3.5 * h));
  put(along_width, 2.1 * g / (2 - nu) * (1 + 2 * h));
  put(tilting_width, pi * g * b * b / (2 * (1 - nu)) * (1 + 0.2 * h));
}

}  // namespace

double Ground::wave_velocity() const {
  return sqrt(shear_modulus / density);
}

std::string_view to_string(SoilMotion motion) {
  static constexpr std::array<std::string_view, 6> names{"vertical",          "along the width",    "along the length",
                                                         "tilting the width", "tilting the length", "torsion"};
  return names[static_cast<std::size_t>(motion)];
}

std::string_view source_of(SoilFormulas formulas) {
  switch (formulas) {
    case SoilFormulas::pais_kausel:
      return "Pais & Kausel, Soil Dynamics and Earthquake Engineering 7 (1988) 213-227; NIST GCR 12-917-21 (2012), tables 2-2 and 2-3";
    case SoilFormulas::gazetas:
      return "Gazetas, in Foundation Engineering Handbook (1991), chapter 15; NIST GCR 12-917-21 (2012), table 2-2";
    case SoilFormulas::disc:
      return "rigid disc on the half-space (Boussinesq, Bycroft 1956, Reissner & Sagoci 1944); embedment after Kausel; dashpots of Lysmer "
             "& "
             "Richart 1966";
    case SoilFormulas::strip:
      return "rigid strip on a layer over rock: Gazetas, Soil Dynamics and Earthquake Engineering 2 (1983) 2-42";
  }
  return {};
}

SoilSprings soil_springs(const FootingOnSoil& footing) {
  SoilSprings springs;
  for (const SoilMotion motion : soil_motions) {
    springs[motion].depth = depth_of(footing, motion);
    springs[motion].ground = mean_ground(footing, springs[motion].depth);
  }
  switch (footing.formulas) {
    case SoilFormulas::pais_kausel:
      pais_kausel(footing, springs);
      break;
    case SoilFormulas::gazetas:
      gazetas(footing, springs);
      break;
    case SoilFormulas::disc:
      disc(footing, springs);
      break;
    case SoilFormulas::strip:
      strip(footing, springs);
  }
  return springs;
}

double footing_area(const FootingOnSoil& footing) {
  return (footing.formulas == SoilFormulas::disc ? pi / 4 : 1) * footing.width * footing.length;
}

double share_of_uniform_bed(const FootingOnSoil& footing, const SoilSprings& springs, SoilMotion rocking) {
  const double side = rocking == tilting_width ? footing.width : footing.length;
  const double radius2 = footing.formulas == SoilFormulas::disc ? side * side / 16 : side * side / 12;  // second moment over area
  return springs[vertical].stiffness() * radius2 / springs[rocking].stiffness();
}

}  // namespace uplift
