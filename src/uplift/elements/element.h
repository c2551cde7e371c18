#pragma once
#include <memory>
#include <span>
#include <vector>

#include "uplift/math/linalg.h"

// Elements of the plane: every node has the three unknowns (ux [m], uy [m], rz [rad], counter-clockwise), in this order.
namespace uplift {

inline constexpr int dofs_per_node = 3;

/// What an element is asked for, in global axes; null is not wanted. Sizes: unknowns per node x number of nodes.
struct Local {
  Matrix* stiffness = nullptr;  // N/m, N, N m
  Matrix* mass = nullptr;       // kg, kg m, kg m2
  Matrix* damping = nullptr;    // N s/m ...: the element's own dashpots, not Rayleigh damping
};

class Element {
 public:
  virtual ~Element() = default;
  /// Indices of the element's nodes.
  virtual std::span<const int> nodes() const = 0;
  /// How many unknowns of each node the element knows: the first ones of (ux, uy, rz). A solid knows the displacements only.
  virtual int unknowns_per_node() const { return dofs_per_node; }
  /// Fills (overwrites) what is wanted.
  virtual void form(Local local) const = 0;
  /// Axial force [N], tension > 0, of the state with the given end displacements; zero for elements without an axis and for inextensible
  /// ones, whose axial force comes from equilibrium.
  virtual double axial_force(const Vector& displacement) const;
  /// Geometric stiffness for a given axial force [N], tension > 0 (P-Delta); zero by default.
  virtual void geometric(double axial, Matrix& stiffness) const;
  /// Mass times the offset of its centre from the first node [kg m]: gravity acts there (P-Delta of an offset mass).
  virtual Vec2 first_moment() const;
  /// Stiffness-proportional damping factor of this part [s]: its damping matrix gets beta * stiffness.
  double beta = 0;
};

}  // namespace uplift
