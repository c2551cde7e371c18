#include "uplift/elements/bulk_laws/drucker_prager.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>

#include "uplift/math/lanes.h"

namespace uplift {

namespace {

/// Slope of the cone over p for an angle: friction gives eta, dilation eta_bar (section 6.4).
double cone_slope(double angle, DruckerPragerParameters::Fit fit) {
  const double s = std::sin(angle), t = std::tan(angle);
  switch (fit) {
    case DruckerPragerParameters::Fit::compression:
      return 6 * s / (std::numbers::sqrt3 * (3 - s));
    case DruckerPragerParameters::Fit::extension:
      return 6 * s / (std::numbers::sqrt3 * (3 + s));
    default:
      return 3 * t / std::sqrt(9 + 12 * t * t);
  }
}

/// Share of the cohesion in the strength of pure shear.
double cohesion_factor(double angle, DruckerPragerParameters::Fit fit) {
  const double s = std::sin(angle), c = std::cos(angle), t = std::tan(angle);
  switch (fit) {
    case DruckerPragerParameters::Fit::compression:
      return 6 * c / (std::numbers::sqrt3 * (3 - s));
    case DruckerPragerParameters::Fit::extension:
      return 6 * c / (std::numbers::sqrt3 * (3 + s));
    default:
      return 3 / std::sqrt(9 + 12 * t * t);
  }
}

double mean(const Stress& stress) {
  return (stress[0] + stress[1] + stress[2]) / 3;
}

Stress deviator(const Stress& stress) {
  Stress s = stress;
  s.head<3>().array() -= mean(stress);
  return s;
}

double root_j2(const Stress& s) {
  return std::sqrt((s[0] * s[0] + s[1] * s[1] + s[2] * s[2]) / 2 + s[3] * s[3] + s[4] * s[4] + s[5] * s[5]);
}

/// The unit tensor as a stress; its outer product with itself.
Stress unit() {
  Stress one = Stress::Zero();
  one.head<3>().setOnes();
  return one;
}

}  // namespace

/// The elastic answer before the return.
struct DruckerPrager::Trial {
  Stress deviator;
  double root_j2, mean, accumulated;
};

void check_drucker_prager(const DruckerPragerParameters& p, const Where& where, const std::string& path) {
  check_material(p.elastic, where, path);
  const auto require = [&](bool good, const char* name, const char* wanted, double found) {
    if (!good || !std::isfinite(found)) throw InputError(where, path + "." + name, wanted, fmt::format("{}", found));
  };
  require(p.friction >= 0 && p.friction < std::numbers::pi / 2, "friction", "an angle from 0 to below 90 degrees", p.friction);
  require(p.dilation >= 0 && p.dilation <= p.friction, "dilation", "an angle from 0 to the friction angle", p.dilation);
  require(p.friction > 0 ? p.cohesion >= 0 : p.cohesion > 0, "cohesion", "at least 0 Pa, and above 0 Pa for a soil without friction",
          p.cohesion);
  require(p.hardening >= 0, "hardening", "at least 0 Pa (softening of a continuum depends on the mesh)", p.hardening);
}

DruckerPrager::DruckerPrager(const DruckerPragerParameters& parameters)
    : BulkLaw(parameters.elastic),
      parameters_(parameters),
      eta_(cone_slope(parameters.friction, parameters.fit)),
      eta_bar_(cone_slope(parameters.dilation, parameters.fit)),
      xi_(cohesion_factor(parameters.friction, parameters.fit)) {}

double DruckerPrager::yield(const Stress& stress, double accumulated) const {
  return root_j2(deviator(stress)) + eta_ * mean(stress) - xi_ * (parameters_.cohesion + parameters_.hardening * accumulated);
}

double DruckerPrager::apex(double accumulated) const {
  if (eta_ == 0) return std::numeric_limits<double>::infinity();
  return xi_ / eta_ * (parameters_.cohesion + parameters_.hardening * accumulated);
}

Stress DruckerPrager::respond(const Strain& strain, std::span<const double> old, std::span<double> now, Mat6* tangent) const {
  assert(old.size() >= history_size && now.size() >= history_size);
  Stress stress = elastic() * (strain - ConstMap(old.data(), 6));
  const double over = yield(stress, old[6]);
  std::copy_n(old.begin(), history_size, now.begin());
  if (tangent) *tangent = elastic();
  if (over <= 0) return stress;

  const double shear = parameters_.elastic.shear(), bulk = parameters_.elastic.bulk();
  const Stress s = deviator(stress);
  const Trial trial{s, root_j2(s), mean(stress), old[6]};
  const double gamma = over / (shear + bulk * eta_ * eta_bar_ + xi_ * xi_ * parameters_.hardening);
  const bool past_apex = eta_ > 0 && trial.root_j2 < shear * gamma;
  now[6] = past_apex ? return_to_apex(trial, stress, tangent) : return_to_cone(trial, gamma, stress, tangent);

  const double p = mean(stress);
  Strain still_elastic = deviator(stress) / (2 * shear);
  still_elastic.tail<3>() *= 2;
  still_elastic.head<3>().array() += p / (3 * bulk);
  Map(now.data(), 6) = strain - still_elastic;
  return stress;
}

double DruckerPrager::return_to_cone(const Trial& trial, double gamma, Stress& stress, Mat6* tangent) const {
  const double shear = parameters_.elastic.shear(), bulk = parameters_.elastic.bulk();
  const double keep = 1 - shear * gamma / trial.root_j2;
  stress = keep * trial.deviator + (trial.mean - bulk * eta_bar_ * gamma) * unit();
  if (tangent) {
    const double a = 1 / (shear + bulk * eta_ * eta_bar_ + xi_ * xi_ * parameters_.hardening);
    const Stress n = trial.deviator / (std::numbers::sqrt2 * trial.root_j2), one = unit();
    const double mixed = std::numbers::sqrt2 * shear * a * bulk;
    const Stress of_n = 2 * shear * (1 - keep - shear * a) * n - mixed * eta_ * one;
    const Stress of_one = (bulk * (1 - bulk * eta_ * eta_bar_ * a) - 2 * shear * keep / 3) * one - mixed * eta_bar_ * n;
    tangent->noalias() = n * of_n.transpose();
    tangent->noalias() += one * of_one.transpose();
    tangent->diagonal() += shear * keep * Stress(2, 2, 2, 1, 1, 1);
  }
  return trial.accumulated + xi_ * gamma;
}

double DruckerPrager::return_to_apex(const Trial& trial, Stress& stress, Mat6* tangent) const {
  const double bulk = parameters_.elastic.bulk(), past = trial.mean - apex(trial.accumulated);
  const double hardening = xi_ * xi_ * parameters_.hardening, volumetric = bulk * eta_ * eta_bar_;
  if (hardening == 0 && volumetric == 0) {  // any e fits: that of associated flow
    stress = (trial.mean - past) * unit();
    if (tangent) tangent->setZero();
    return trial.accumulated + xi_ / eta_ * past / bulk;
  }
  const double share = hardening / (volumetric + hardening);  // of the excess mean stress that the hardening carries
  stress = (trial.mean - (1 - share) * past) * unit();
  if (tangent) *tangent = bulk * share * unit() * unit().transpose();
  return trial.accumulated + eta_ * xi_ * past / (volumetric + hardening);
}

BulkResponse DruckerPrager::respond(const BulkPoints& points) const {
  for (std::size_t p = 0; p < points.strain.size(); ++p) {
    const std::size_t first = history_size * p;
    points.stress[p] = respond(points.strain[p], {points.old + first, history_size}, {points.now + first, history_size},
                               points.tangent != nullptr ? points.tangent + p : nullptr);
  }
  return {};
}

// yield() without the root, for the points side by side
bool DruckerPrager::stays_elastic(const BulkTrial& trial) const {
  for (int first = 0; first < trial.stride; first += static_cast<int>(lanes)) {
    const WholeLanes at{first};
    Lanes s[6];
    for (int c = 0; c < 6; ++c) s[c] = at(trial.stress + c * trial.stride);
    alignas(64) double strength[lanes];
    for (int k = 0; k < lanes; ++k)
      strength[k] =
          xi_ * (parameters_.cohesion + (first + k < trial.points ? parameters_.hardening * trial.old[history_size * (first + k) + 6] : 0));
    const Lanes p = (s[0] + s[1] + s[2]) / 3, bound = WholeLanes{0}(strength)-eta_ * p;
    for (int c = 0; c < 3; ++c) s[c] -= p;
    const Lanes j2 = (s[0] * s[0] + s[1] * s[1] + s[2] * s[2]) / 2 + s[3] * s[3] + s[4] * s[4] + s[5] * s[5];
    if (!std::experimental::all_of(bound >= 0 && j2 <= bound * bound)) return false;
  }
  return true;
}

std::span<const BulkOutput> DruckerPrager::outputs() const {
  static constexpr std::array<BulkOutput, 1> all{{{"plastic_strain", "1"}}};
  return all;
}

void DruckerPrager::find_outputs(const double* history, double* values) const {
  values[0] = history[6];
}

namespace {

std::unique_ptr<const BulkLaw> made(const BulkLawContext& solid, const Values& values) {
  using Fit = DruckerPragerParameters::Fit;
  DruckerPragerParameters law;
  law.elastic = solid.material;
  law.cohesion = values.number("cohesion");
  law.friction = values.number("friction_angle");
  law.dilation = values.number("dilatancy_angle");
  law.hardening = values.number("hardening");
  const std::string& fit = values.text("fit");
  law.fit = fit == "compression" ? Fit::compression : fit == "extension" ? Fit::extension : Fit::plane_strain;
  const auto refuse = [&](const char* key, const char* wanted, const std::string& found) {
    throw InputError(values.where(key), values.path(key), wanted, found);
  };
  if (law.dilation > law.friction)
    refuse("dilatancy_angle", "an angle from 0 to the friction angle", fmt::format("{:g} rad", law.dilation));
  if (law.friction == 0 && law.cohesion == 0) refuse("cohesion", "above 0 Pa for a soil without friction", "0 Pa");
  check_drucker_prager(law, values.where(), values.path());
  return std::make_unique<DruckerPrager>(law);
}

}  // namespace

const std::string* fit_too_strong(const Values& law) {
  if (law.type() != "drucker_prager" || law.number("friction_angle") > 0 || law.text("fit") == "plane_strain") return nullptr;
  return &law.text("fit");
}

const BulkLawEntry& entry_bulk_law_drucker_prager() {
  static const BulkLawEntry entry{
      {.name = "drucker_prager",
       .summary = "a soil that yields under shear, the stronger the more it is compressed: a cone around the axis of equal stresses",
       .equations = "sqrt(J2) + eta p - xi c <= 0, c = cohesion + hardening e, p = tr(stress)/3 (tension > 0)\n"
                    "plastic strain rate = gamma' d(sqrt(J2) + eta_bar p)/d stress, e' = xi gamma'\n"
                    "eta, xi from friction_angle and eta_bar from dilatancy_angle by fit",
       .source = "de Souza Neto, Peric & Owen, Computational Methods for Plasticity (2008), sections 6.4.3 and 8.3; docs/theory, section 9",
       .params = {number("cohesion", "Pa", "cohesion; above 0 without friction").nonnegative(),
                  number("friction_angle", "rad", "angle of internal friction").between(0, 1.5),
                  number("dilatancy_angle", "rad", "0: no change of volume; as the friction angle: associated flow")
                      .between(0, 1.5)
                      .standard(0.0),
                  number("hardening", "Pa", "growth of the cohesion with the accumulated plastic strain").nonnegative().standard(0.0),
                  choice("fit", {"compression", "extension", "plane_strain"},
                         "where the cone meets Mohr-Coulomb's pyramid: at its compression edges, its extension edges, or for the same "
                         "collapse in plane strain")
                      .standard("compression")}},
      made};
  return entry;
}

}  // namespace uplift
