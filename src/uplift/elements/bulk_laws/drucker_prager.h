#pragma once
#include <span>
#include <string>

#include "uplift/elements/bulk_law.h"

namespace uplift {

/// Soil that yields under shear, the stronger the more it is compressed.
struct DruckerPragerParameters {
  ElasticMaterial elastic;
  double cohesion = 0;   // c [Pa], >= 0; above 0 when the friction angle is zero
  double friction = 0;   // phi [rad], in [0, pi/2)
  double dilation = 0;   // psi [rad], in [0, phi]; equal to phi: associated
  double hardening = 0;  // H = dc/d(accumulated plastic strain) [Pa], >= 0
  /// How the cone is fitted to Mohr-Coulomb's pyramid: through its compression edges, its extension edges, or so that both collapse at the
  /// same load in plane strain.
  enum class Fit { compression, extension, plane_strain } fit = Fit::compression;
};
/// Throws InputError at `where` and `path` for values outside the ranges above.
void check_drucker_prager(const DruckerPragerParameters& parameters, const Where& where, const std::string& path);

/// Drucker-Prager plasticity of one point (de Souza Neto, Peric & Owen, Computational Methods for Plasticity, 2008, sections 6.4.3
/// and 8.3):
///   yield      sqrt(J2) + eta p - xi c <= 0,   p = tr(stress)/3 (tension > 0),   c = c0 + H e
///   flow       plastic strain rate = gamma' d(sqrt(J2) + eta_bar p)/d stress,    e' = xi gamma'
///   return     to the cone: sqrt(J2) = trial - G dgamma, p = trial - K eta_bar dgamma; where that would pass the apex, to the apex
///              p = xi c/eta with de = eta xi (p_trial - p_apex)/(K eta eta_bar + xi^2 H) and the plastic volume strain (eta_bar/xi) de.
///              This is continuous in eta_bar: for eta_bar = 0 and H > 0 the volume stays elastic and the apex follows p_trial
///              (docs/theory, section 9). Linear hardening: no iteration.
/// All plastic work counts as dissipated. The update is implicit (backward Euler), the tangent consistent with it; not symmetric when psi <
/// phi.
class DruckerPrager final : public BulkLaw {
 public:
  /// Numbers per point: plastic strain (6, order of Strain), accumulated plastic strain e.
  static constexpr int history_size = 7;

  explicit DruckerPrager(const DruckerPragerParameters& parameters);
  const DruckerPragerParameters& parameters() const { return parameters_; }
  int num_history() const override { return history_size; }
  BulkResponse respond(const BulkPoints& points) const override;
  bool stays_elastic(const BulkTrial& trial) const override;
  std::span<const BulkOutput> outputs() const override;
  void find_outputs(const double* history, double* values) const override;

  /// One point: stress [Pa] for the total strain, with the history of the last accepted state; fills `now`; `tangent` = d stress/d strain
  /// unless null.
  Stress respond(const Strain& strain, std::span<const double> old, std::span<double> now, Mat6* tangent) const;
  /// sqrt(J2) + eta p - xi c [Pa]; at most zero (round-off) for every stress that respond returns.
  double yield(const Stress& stress, double accumulated) const;
  /// Mean stress of the apex [Pa], tension > 0; infinite without friction.
  double apex(double accumulated) const;

 private:
  struct Trial;
  double return_to_cone(const Trial& trial, double gamma, Stress& stress, Mat6* tangent) const;
  double return_to_apex(const Trial& trial, Stress& stress, Mat6* tangent) const;

  DruckerPragerParameters parameters_;
  double eta_, eta_bar_, xi_;
};

/// The `fit` of a law of this type that bears too much in plane strain, without friction: a circle around Tresca's hexagon; null: none.
const std::string* fit_too_strong(const Values& law);

}  // namespace uplift
