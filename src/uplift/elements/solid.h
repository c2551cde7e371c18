#pragma once
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "uplift/elements/element.h"
#include "uplift/elements/material.h"
#include "uplift/mesh/cell_quadrature.h"
#include "uplift/mesh/cells.h"

namespace uplift {

/// Positions of all nodes of the model [m]; shared by its elements.
using Coordinates = std::shared_ptr<const std::vector<Vec3>>;

/// What a solid is made of and how it is formed.
struct SolidSection {
  ElasticMaterial material;
  PlaneState plane = PlaneState::strain;  // surface cells only
  double thickness = 1;                   // m, surface cells only
  enum class Mass { none, consistent, lumped } mass = Mass::consistent;
  bool incompatible_modes = true;  // quad4 and hex8 only
  bool operator==(const SolidSection&) const = default;
};

struct PointGradient;  // elements/solid_rules.h
struct SolidTables;

/// Small-strain isoparametric solid on any cell of dimension 2 (in the plane z = 0: plane strain or plane stress) or 3; unknowns (ux, uy)
/// or (ux, uy, uz) [m] of each node.
///
///   K = int B^T D B dV,   M = int rho N^T N dV          (Zienkiewicz & Taylor, The Finite Element Method, vol. 1)
///
/// Full integration, exact for cells with straight edges and parallel sides. Points for K (M where it differs): tri3 1 (3), tri6 3 (6),
/// quad4 2x2, quad8 and quad9 3x3, tet4 1 (4), tet10 4 (14), wedge6 3x2, wedge15 6x3, hex8 2x2x2, hex20 and hex27 3x3x3.
///
/// Incompatible modes (default; quad4 and hex8): the bubbles 1 - r^2, 1 - s^2, 1 - t^2 for every displacement component let a single
/// element bend without shear locking. Their gradients are taken with the Jacobian of the centre and scaled by det J0 / det J, so that
/// their integral is zero and constant stress is met exactly on every straight-sided shape (Wilson, Taylor, Doherty & Ghaboussi 1973;
/// Taylor, Beresford & Wilson, IJNME 10 (1976) 1211-1219; an enhanced assumed strain in the sense of Simo & Rifai, IJNME 29 (1990)
/// 1595-1638). They are condensed inside the element and carry no mass.
///
/// Lumped mass: row sums for linear cells, the diagonal of M scaled to the total mass for second-order ones (Hinton, Rock & Zienkiewicz,
/// EESD 4 (1976) 245-249): all masses are positive.
class Solid : public Element {
 public:
  /// `nodes` as many as the cell has, numbered as in VTK, indices into `coordinates`. The Jacobian must be positive at every integration
  /// point (checked by assertion; meshes are checked on reading).
  /// `part`: the cell is filled in part (mesh/cut.h); it has no incompatible modes then, and the stress at its nodes is its mean.
  Solid(Cell cell, std::span<const int> nodes, Coordinates coordinates, std::shared_ptr<const SolidSection> section,
        const CellRule* part = nullptr);
  Solid(Cell cell, std::span<const int> nodes, Coordinates coordinates, const SolidSection& section, const CellRule* part = nullptr)
      : Solid(cell, nodes, std::move(coordinates), std::make_shared<const SolidSection>(section), part) {}
  std::span<const int> nodes() const override { return {nodes_.get(), static_cast<std::size_t>(info(cell_).nodes)}; }
  int unknowns_per_node() const override { return dimension_; }
  void form(Local local) const override;

  const SolidSection* continuum() const override { return section_.get(); }
  Cell cell() const override { return cell_; }
  int dimension() const { return dimension_; }
  bool is_whole() const { return part_ == nullptr; }  // not filled in part
  double volume() const;                              // m3; area times thickness for surface cells

  /// Number of the integration points of the stiffness.
  int num_points() const;
  /// Stress at the integration points, of the element's nodal displacements [m] (size unknowns()); the incompatible modes are included. In
  /// plane strain zz is the stress that keeps the thickness, in plane stress it is zero.
  std::vector<Stress> point_stress(const Vector& displacement) const;
  /// Stress at the nodes: the least-squares fit of the corner shape functions (linear field) to the values at the integration points
  /// (Hinton & Campbell, IJNME 8 (1974) 461-480). To be averaged between elements of the same material.
  std::vector<Stress> node_stress(const Vector& displacement) const;
  /// The stress at the nodes.
  std::vector<ElementOutput> outputs() const override;
  std::vector<double> at_nodes(std::size_t k, const Vector& displacement, std::span<const double> history) const override;

 protected:
  int num_modes() const;  // incompatible bubbles
  /// Gradients of the shape functions, then of the bubbles, at the integration points.
  std::vector<PointGradient> gradients() const;
  void find_gradients(std::vector<PointGradient>& all) const;
  /// Nodal values from values at the integration points, as in node_stress.
  std::vector<Stress> extrapolate(const std::vector<Stress>& at_points) const;
  std::vector<double> extrapolate(const std::vector<double>& at_points) const;
  static std::vector<double> in_one_list(const std::vector<Stress>& all);

 private:
  void form_stiffness(Matrix& stiffness) const;
  void form_mass(Matrix& mass) const;
  /// Of the cell, or made for its part.
  std::shared_ptr<const SolidTables> tables() const;
  Vector mode_amplitudes(const std::vector<PointGradient>& points, const Vector& displacement) const;
  Stress elastic_stress(const Strain& strain) const;

  Cell cell_;
  int dimension_;
  std::unique_ptr<const int[]> nodes_;
  Coordinates coordinates_;
  std::shared_ptr<const SolidSection> section_;  // of all cells of one filling
  std::unique_ptr<const CellRule> part_;         // null: the cell is whole
};

}  // namespace uplift
