#pragma once
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "uplift/elements/bulk_law.h"
#include "uplift/elements/space.h"
#include "uplift/mesh/cells.h"

namespace uplift {

/// What an element is asked for, in global axes; null is not wanted. Sizes: unknowns per node x number of nodes.
struct Local {
  Matrix* stiffness = nullptr;  // N/m, N, N m
  Matrix* mass = nullptr;       // kg, kg m, kg m2
  Matrix* damping = nullptr;    // N s/m ...: the element's own dashpots, not Rayleigh damping
};

/// The section forces at one position of an element with an axis as linear functions of its end unknowns, global axes:
///   stiffness (u + beta v) + N0 geometric u + mass (a + alpha v)
/// with the absolute acceleration less that of gravity, Rayleigh's alpha and beta and the axial force N0 of P-Delta (docs/theory, section
/// 13). Rows: what the part beyond the section, towards b, exerts on the part before it, in local axes. Plane: N, V, M; space: N, V_y, V_z,
/// T, M_y, M_z. Tension > 0; V along the local axes; T and M right-handed about them, so that dM_z/dx = -V_y and M_z = E I w''.
struct SectionRows {
  Matrix stiffness, geometric, mass;
};

/// What inelastic strains add to a linear element: its internal force is K u + force with K of `form`, its stored energy
/// u.(K u)/2 + u.force + energy. Both depend on the memory alone.
struct Inelastic {
  Vector force;       // N
  double energy = 0;  // J
};

/// A field that an element gives at its nodes: 1 component, or the 6 of a symmetric tensor in the order of Stress.
struct ElementOutput {
  std::string name, unit;
  int components = 1;
};

struct ElementScratch;  // elements/scratch.h: room for one element at a time
struct SolidSection;    // elements/solid.h

/// A part of the model between nodes. `form` is its linear part. The other functions are for what not every element has; their defaults
/// say that this one has none.
class Element {
 public:
  virtual ~Element() = default;
  /// Indices of the element's nodes.
  virtual std::span<const int> nodes() const = 0;
  /// How many unknowns of each node the element knows: the first ones of those in elements/space.h. A solid knows the translations only.
  virtual int unknowns_per_node() const = 0;
  int unknowns() const { return unknowns_per_node() * static_cast<int>(nodes().size()); }
  /// Fills (overwrites) what is wanted.
  virtual void form(Local local) const = 0;
  /// Stiffness-proportional damping factor of this part [s]: its damping matrix gets beta * stiffness.
  double beta = 0;

  // ---- P-Delta ----
  /// Axial force [N], tension > 0, of the state with the given end displacements; zero for elements without an axis and for inextensible
  /// ones, whose axial force comes from equilibrium.
  virtual double axial_force(const Vector& displacement) const;
  /// Geometric stiffness for a given axial force [N], tension > 0; zero by default.
  virtual void geometric(double axial, Matrix& stiffness) const;
  /// Mass times the offset of its centre from the first node [kg m]: gravity acts there.
  virtual Vec3 first_moment() const;

  // ---- an axis between two nodes: sections, rigid connection of the rotations at the nodes ----
  virtual bool has_axis() const { return false; }
  /// Asked for elements with an axis only. At the share `xi` of the length, 0 (first node) to 1 (second node).
  virtual SectionRows section(double xi) const;
  /// Rows: local x (from the first node to the second), y, z in global axes.
  virtual Mat3 axes() const;
  /// The axial force comes from a constraint, inextensible() of the model builder.
  virtual bool inextensible() const { return false; }

  // ---- a continuum that fills a cell ----
  /// What fills it; null: this is no solid.
  virtual const SolidSection* continuum() const { return nullptr; }
  /// Asked for solids only.
  virtual Cell cell() const;

  // ---- memory ----
  /// Numbers that the element remembers, all zero in the natural state; 0: it is linear, and nothing below is asked.
  virtual int num_history() const { return 0; }
  /// Internal force [N] and consistent tangent [N/m] (each null: not wanted) for nodal displacements [m], from the memory of the last
  /// accepted state; fills `now`. Where `now` has yielded from `old`, as after an update nearby, an iteration may begin there.
  virtual BulkResponse respond(const Vector& displacement, std::span<const double> old, std::span<double> now, ElementScratch& scratch,
                               Vector* force, Matrix* tangent) const;
  /// Whether the memory holds inelastic strains; whether they differ between two memories.
  virtual bool has_yielded(std::span<const double> history) const;
  virtual bool yields(std::span<const double> old, std::span<const double> now) const;
  virtual void find_inelastic(std::span<const double> history, ElementScratch& scratch, Inelastic& made) const;
  /// The same of a memory that `respond` has just found with this scratch.
  virtual void find_inelastic_of_response(std::span<const double> history, ElementScratch& scratch, Inelastic& made) const;
  /// Work of the mean internal force of two states less the change of the stored energy [J].
  virtual double dissipated(const Vector& from, std::span<const double> old, const Vector& to, std::span<const double> now) const;

  // ---- field files ----
  virtual std::vector<ElementOutput> outputs() const { return {}; }
  /// Of output k: component after component of the first node, then of the next one. An empty history is the natural state.
  virtual std::vector<double> at_nodes(std::size_t k, const Vector& displacement, std::span<const double> history) const;
};

}  // namespace uplift
