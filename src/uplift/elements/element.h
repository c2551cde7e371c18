#pragma once
#include <memory>
#include <span>
#include <vector>

#include "uplift/elements/space.h"

namespace uplift {

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
  /// How many unknowns of each node the element knows: the first ones of those in elements/space.h. A solid knows the translations only.
  virtual int unknowns_per_node() const = 0;
  /// Fills (overwrites) what is wanted.
  virtual void form(Local local) const = 0;
  /// Axial force [N], tension > 0, of the state with the given end displacements; zero for elements without an axis and for inextensible
  /// ones, whose axial force comes from equilibrium.
  virtual double axial_force(const Vector& displacement) const;
  /// Geometric stiffness for a given axial force [N], tension > 0 (P-Delta); zero by default.
  virtual void geometric(double axial, Matrix& stiffness) const;
  /// Mass times the offset of its centre from the first node [kg m]: gravity acts there (P-Delta of an offset mass).
  virtual Vec3 first_moment() const;
  /// Stiffness-proportional damping factor of this part [s]: its damping matrix gets beta * stiffness.
  double beta = 0;
};

}  // namespace uplift
