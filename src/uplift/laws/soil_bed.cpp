#include "uplift/laws/soil_bed.h"

#include <algorithm>
#include <cmath>

namespace uplift {
namespace {

/// The weights w exp(c xi^2), and what Newton's method needs of them.
struct Tilted {
  Vector stiffness;  // exp(c xi^2) over its weighted mean
  double ratio;      // 3 <xi^2>
  double slope;      // d ratio/d c = 3 (<xi^4> - <xi^2>^2)

  Tilted(const Quadrature& points, double exponent) {
    const Vector square = points.point.cwiseAbs2();
    const double largest = (exponent * square).maxCoeff();
    stiffness = (exponent * square).array() - largest;
    stiffness = stiffness.array().exp();
    stiffness *= points.weight.sum() / points.weight.dot(stiffness);
    const Vector share = points.weight.cwiseProduct(stiffness) / points.weight.sum();
    const double mean = share.dot(square);
    ratio = 3 * mean;
    slope = 3 * share.dot(Vector((square.array() - mean).square()));
  }
};

/// Of equal distance from the middle: two points of the nodal rule. Their ratio is what it is.
constexpr double round_off = 1e-12;

}  // namespace

BedOfSoil bed_of_soil(const FootingOnSoil& footing, int dimension) {
  using enum SoilMotion;
  const SoilSprings springs = soil_springs(footing);
  const double area = footing.width * footing.length;
  const auto ratio = [&](SoilMotion rocking) {
    return springs[rocking].at_surface > 0 ? 1 / share_of_uniform_bed(footing, springs, rocking) : 0;
  };
  BedOfSoil made;
  made.normal = springs[vertical].stiffness() / area;
  made.damping = springs[vertical].damping / area;
  made.tangential = springs[along_width].stiffness() / area;
  if (dimension == 3) made.tangential = 0.5 * (made.tangential + springs[along_length].stiffness() / area);
  made.ratio_width = ratio(tilting_width), made.ratio_length = ratio(tilting_length);
  return made;
}

BedReach bed_reach(const Quadrature& points) {
  const Vector square = points.point.cwiseAbs2();
  const double range = square.maxCoeff() - square.minCoeff();
  const double most = range > round_off ? std::log(most_contrast) / range : 0;
  return {Tilted(points, -most).ratio, Tilted(points, most).ratio};
}

std::optional<double> bed_exponent(const Quadrature& points, double ratio) {
  const Vector square = points.point.cwiseAbs2();
  const double range = square.maxCoeff() - square.minCoeff();
  if (!(range > round_off)) {
    if (std::abs(3 * square.maxCoeff() - ratio) > round_off) return {};
    return 0.0;
  }
  double low = -std::log(most_contrast) / range, high = -low, exponent = 0;
  if (!(ratio >= Tilted(points, low).ratio && ratio <= Tilted(points, high).ratio)) return {};
  // the ratio grows with the exponent: Newton's method in a bracket
  for (int iteration = 0; iteration < 200; ++iteration) {
    const Tilted at(points, exponent);
    if (std::abs(at.ratio - ratio) <= 1e-15 * ratio) break;
    (at.ratio > ratio ? high : low) = exponent;
    double next = exponent - (at.ratio - ratio) / at.slope;
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    if (next == exponent) break;
    exponent = next;
  }
  return exponent;
}

std::optional<Vector> bed_distribution(const Quadrature& points, double ratio) {
  const std::optional<double> exponent = bed_exponent(points, ratio);
  if (!exponent) return {};
  return Tilted(points, *exponent).stiffness;
}

std::optional<BedProfile> bed_profile(double ratio) {
  const Quadrature fine = gauss_legendre(64);
  const std::optional<double> exponent = bed_exponent(fine, ratio);
  if (!exponent) return {};
  const Vector falling = (*exponent * (fine.point.cwiseAbs2().array() - 1)).exp();  // over that of the edge
  const double edge = fine.weight.sum() / fine.weight.dot(falling);
  return BedProfile{edge * std::exp(-*exponent), edge};
}

}  // namespace uplift
