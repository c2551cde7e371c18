#pragma once
#include <string_view>

#include "uplift/elements/drucker_prager.h"
#include "uplift/elements/solid.h"
#include "uplift/elements/solid_rules.h"

namespace uplift {

/// How the update of an element ended; not converged: the step is to be cut.
struct BulkResponse {
  bool converged = true;
  std::string_view why;
};

/// Solid of Drucker-Prager material: plane strain and three dimensions. `form` gives the elastic stiffness (the first tangent), the mass
/// and so on; the outer Newton calls `respond`. The incompatible modes stay inside the element: their amplitudes are part of the history,
/// and respond solves for them so that no force works on them. Where no point yields they are linear in the displacements and the plastic
/// strains; else by Newton's method with a share of the elastic stiffness that grows when a step does not help (the kinks between elastic,
/// cone and apex) and fades when it does.
class NonlinearSolid : public Solid {
 public:
  /// section.material is not looked at: the elastic part is law.elastic. Plane stress is not available (assertion).
  NonlinearSolid(Cell cell, std::span<const int> nodes, Coordinates coordinates, SolidSection section, const DruckerPragerParameters& law);

  /// Room for the integration points of one element during an update. Updates allocate nothing once it has served the largest element.
  struct Scratch {
    std::vector<PointGradient> gradient;
    std::vector<Stress> stress;
    std::vector<Mat6> tangent;
    Vector mode_force;  // N: zero when the modes are in balance
    Matrix mode_stiffness;
  };

  /// Numbers that the element remembers; all zero in the natural state: DruckerPrager::num_history of every integration point, then the
  /// amplitudes of the modes [m].
  int num_history() const;
  /// Internal force [N] and consistent tangent [N/m] (null: not wanted) for nodal displacements [m], from the history of the last accepted
  /// state; fills `now`. The tangent is not symmetric when the flow is not associated.
  BulkResponse respond(const Vector& displacement, std::span<const double> old, std::span<double> now, Scratch& scratch, Vector& force,
                       Matrix* tangent) const;

  /// Stress at the integration points and at the nodes of a state.
  std::vector<Stress> point_stress(const Vector& displacement, std::span<const double> history) const;
  std::vector<Stress> node_stress(const Vector& displacement, std::span<const double> history) const;
  /// Recoverable energy [J] of a state.
  double stored_energy(const Vector& displacement, std::span<const double> history) const;
  const DruckerPrager& law() const { return law_; }

  /// What the plastic strains and the modes that go with them add to the linear solid. The internal force is K u + force with K of `form`,
  /// the recoverable energy u.(K u)/2 + u.force + energy. Both depend on the history alone.
  struct Yielded {
    Vector force;       // N
    double energy = 0;  // J
  };
  void find_yielded(std::span<const double> history, Scratch& scratch, Yielded& made) const;
  /// The same of a history that `respond` has just found with this scratch.
  void find_yielded_of_response(std::span<const double> history, const Scratch& scratch, Yielded& made) const;
  /// True when a point has ever yielded; when one has between two histories.
  bool has_yielded(std::span<const double> history) const;
  bool yields(std::span<const double> old, std::span<const double> now) const;
  /// Work of the mean stress of two states on the change of the plastic strain [J]: what the mean internal force does, less the change of
  /// the recoverable energy.
  double dissipated(const Vector& from, std::span<const double> old, const Vector& to, std::span<const double> now) const;

 private:
  Strain strain(const PointGradient& at, const Vector& displacement, const double* amplitudes) const;
  void evaluate(const Vector& displacement, std::span<const double> old, std::span<double> now, bool tangents, Scratch& scratch) const;
  /// Of the nodes and the modes.
  Matrix full_tangent(const Scratch& scratch, double elastic_share) const;
  /// Of the modes alone, into scratch.mode_stiffness.
  void find_mode_tangent(Scratch& scratch, double elastic_share) const;
  /// Adds the amplitudes that the plastic strains cause by themselves in an elastic element; scratch.gradient is that of the element.
  void add_plastic_amplitudes(std::span<const double> history, const Scratch& scratch, double* amplitudes) const;
  double mode_gradient(const PointGradient& at) const;  // 1/m: size of the bubbles' gradients
  double node_gradient(const PointGradient& at) const;  // 1/m: largest of the nodes
  BulkResponse balance_modes(const Vector& displacement, std::span<const double> old, std::span<double> now, Scratch& scratch) const;
  int num_amplitudes() const { return dimension() * modes_; }
  int first_amplitude() const { return DruckerPrager::num_history * points_; }

  DruckerPrager law_;
  int points_, modes_;
  Matrix modes_of_nodes_;    // amplitudes of the elastic element for nodal displacements: -K_aa^-1 K_au
  Matrix mode_flexibility_;  // m/N: K_aa^-1 of the elastic element
};

}  // namespace uplift
