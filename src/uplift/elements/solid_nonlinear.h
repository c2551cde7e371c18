#pragma once
#include <memory>

#include "uplift/elements/bulk_law.h"
#include "uplift/elements/scratch.h"
#include "uplift/elements/solid.h"

namespace uplift {

/// Solid of any bulk law: plane strain and three dimensions. `form` gives the elastic stiffness (the first tangent), the mass and so on;
/// the outer Newton calls `respond`. The incompatible modes stay inside the element: their amplitudes are part of the memory, and respond
/// solves for them so that no force works on them. Where no point yields they are linear in the displacements and the inelastic strains;
/// else by Newton's method with a share of the elastic stiffness that grows when a step does not help (the kinks between elastic, cone and
/// apex) and fades when it does.
/// Memory: that of the law at every integration point, then the amplitudes of the modes [m]. The tangent is not symmetric when the flow is
/// not associated.
class NonlinearSolid : public Solid {
 public:
  /// section.material is not looked at: the elastic part is that of the law. Plane stress is not available (assertion).
  NonlinearSolid(Cell cell, std::span<const int> nodes, Coordinates coordinates, SolidSection section, std::shared_ptr<const BulkLaw> law,
                 const CellRule* part = nullptr);

  using Scratch = ElementScratch;
  int num_history() const override;
  BulkResponse respond(const Vector& displacement, std::span<const double> old, std::span<double> now, Scratch& scratch, Vector* force,
                       Matrix* tangent) const override;
  bool has_yielded(std::span<const double> history) const override;
  bool yields(std::span<const double> old, std::span<const double> now) const override;
  void find_inelastic(std::span<const double> history, Scratch& scratch, Inelastic& made) const override;
  void find_inelastic_of_response(std::span<const double> history, Scratch& scratch, Inelastic& made) const override;
  double dissipated(const Vector& from, std::span<const double> old, const Vector& to, std::span<const double> now) const override;

  /// The stress, then what the law puts out.
  std::vector<ElementOutput> outputs() const override;
  std::vector<double> at_nodes(std::size_t k, const Vector& displacement, std::span<const double> history) const override;

  /// Stress at the integration points and at the nodes of a state.
  std::vector<Stress> point_stress(const Vector& displacement, std::span<const double> history) const;
  std::vector<Stress> node_stress(const Vector& displacement, std::span<const double> history) const;
  /// Energy [J] of a state: recoverable and locked.
  double stored_energy(const Vector& displacement, std::span<const double> history) const;
  const BulkLaw& law() const { return *law_; }

 private:
  void keep_gradients(const std::vector<PointGradient>& all);
  /// The gradients of the points: those kept, or computed where none are.
  void recall_gradients(std::vector<PointGradient>& all) const;
  void recall_gradient(int point, PointGradient& at) const;
  /// With kept gradients; false for a law that cannot tell. Fills the amplitudes in any case, `force` (null: not wanted) for an answer of
  /// true only.
  bool stays_elastic(const Vector& displacement, std::span<const double> old, std::span<double> now, Scratch& scratch, Vector* force) const;
  template <int dim>
  bool stays_elastic_in(const double* displacement, std::span<const double> old, std::span<double> now, Scratch& scratch,
                        double* force) const;
  Strain strain(const PointGradient& at, const Vector& displacement, const double* amplitudes) const;
  BulkResponse evaluate(const Vector& displacement, std::span<const double> old, std::span<double> now, bool tangents,
                        Scratch& scratch) const;
  /// Of the nodes and the modes.
  Matrix full_tangent(const Scratch& scratch, double elastic_share) const;
  /// Of the modes alone, into scratch.mode_stiffness.
  void find_mode_tangent(Scratch& scratch, double elastic_share) const;
  /// Adds the amplitudes that the inelastic strains cause in an elastic element; scratch.gradient is that of the element.
  void add_inelastic_amplitudes(std::span<const double> history, const Scratch& scratch, double* amplitudes) const;
  double mode_gradient(const PointGradient& at) const;  // 1/m: size of the bubbles' gradients
  double node_gradient(const PointGradient& at) const;  // 1/m: largest of the nodes
  /// `tangents`: those of the response in the scratch are there.
  BulkResponse balance_modes(const Vector& displacement, std::span<const double> old, std::span<double> now, bool tangents,
                             Scratch& scratch) const;
  int num_amplitudes() const { return dimension() * modes_; }
  int first_amplitude() const { return size_ * points_; }
  /// Recoverable energy and stress need the strain less this one.
  ConstMap inelastic_strain(std::span<const double> history, std::size_t point) const {
    return {history.data() + static_cast<std::size_t>(size_) * point, 6};
  }
  double locked_energy(std::span<const double> history, std::size_t point) const {
    return law_->locked_energy(history.data() + static_cast<std::size_t>(size_) * point);
  }

  std::shared_ptr<const BulkLaw> law_;
  int size_, points_, modes_;  // size_: numbers that a point remembers
  // The volumes of all points, then their gradients: of a direction and a function (nodes, then modes), of all points side by side. Filled
  // up with zeros to `side_by_side_` points. Empty for second-order cells, which have many of both.
  std::vector<double> gradient_;
  int side_by_side_;
  Matrix modes_of_nodes_;    // amplitudes of the elastic element for nodal displacements: -K_aa^-1 K_au
  Matrix mode_flexibility_;  // m/N: K_aa^-1 of the elastic element
};

}  // namespace uplift
