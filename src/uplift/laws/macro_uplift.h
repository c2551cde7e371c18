#pragma once
#include <cstdint>

#include "uplift/math/fixed.h"

// Uplift of a shallow foundation as a potential (docs/theory/macro_element.md, eqs M1 to M4): elastic ground, contact that only pushes.
// The vectors of the macro-element: forces (N, H_1, H_2, M_1, M_2) [N, N m] and displacements (w, u_1, u_2, theta_1, theta_2) [m, rad],
// N > 0 compression, w > 0 settlement. Index 1 is the motion in the plane (t1, n), index 2 that in the plane (t2, n).
namespace uplift {

using MacroVector = Fixed<5, 1>;
using MacroMatrix = Fixed<5, 5>;
enum MacroRow { macro_n, macro_h1, macro_h2, macro_m1, macro_m2 };

/// Elastic constants of the foundation and its ground.
struct MacroElasticity {
  bool disc = false;              // true: isotropic, with the values of index 0; else each axis lifts for itself (strip, rectangle)
  double shape = 6;               // alpha > 2: uplift begins at M = N D/alpha
  double length[2] = {0, 0};      // D: plan dimension along t1, t2 [m]; diameter of a disc
  double vertical = 0;            // K_z [N/m]
  double horizontal[2] = {0, 0};  // K_h along t1, t2 [N/m]
  double rocking[2] = {0, 0};     // K_r in the planes (t1, n), (t2, n) [N m/rad]
};

/// Forces at an elastic displacement.
struct MacroElastic {
  bool contact = true;
  MacroVector force = MacroVector::Zero();
  MacroMatrix stiffness = MacroMatrix::Zero();  // d force/d displacement
  double energy = 0;                            // J, of w and theta
  double shear_energy = 0;                      // J, of u
  double heave = 0;                             // upward displacement of the centre through uplift [m]
  double contact_share = 1;                     // of the base
};

/// The part of (w, theta_1, theta_2), which does not depend on the shear; in the plane theta_2 has no meaning.
struct MacroRocking {
  bool contact = true;
  Vec3 force = Vec3::Zero();      // N, M_i
  Mat3 stiffness = Mat3::Zero();  // d force/d displacement
  double energy = 0;              // J
  double heave = 0;               // m
  double contact_share = 1;       // of the base
};

/// Powers of x = theta/theta_0 of one axis, beyond the beginning of its uplift.
struct MacroRise {
  double y = 1;         // x^(1/gamma)
  double log_like = 0;  // (y^(gamma - 1) - 1)/(gamma - 1); ln y for gamma = 1
};

/// The foundation without yielding.
class MacroUplift {
 public:
  explicit MacroUplift(const MacroElasticity& elasticity);
  const MacroElasticity& elasticity() const { return elastic_; }
  /// K_z, K_h, K_h, K_r, K_r of the foundation in full contact.
  const MacroVector& stiffness() const { return stiffness_; }

  /// Forces from displacements; without contact there are none. The stiffness is left zero where it is not wanted. R = 1: there is no
  /// motion but that in the plane (t1, n).
  template <int R = 2>
  MacroElastic respond(const MacroVector& displacement, bool with_stiffness = true) const;
  /// Whether a vertical force that vanishes at these rotations exceeds V times the product of 1 - 2 |M_i|/(N D_i): V is `capacity` [N].
  bool beyond_capacity(const MacroVector& displacement, double capacity) const;
  /// Displacements from forces with N > 0 and |M| < N D/2 (the derivative of the complementary energy).
  MacroVector displacement(const MacroVector& force) const;
  /// Forces of (w, theta) alone, theta about R axes. `at_rest`: no load and no displacement, neither u; the footing stands on the ground
  /// all the same.
  template <int R>
  MacroRocking rock(const Vec3& displacement, bool with_stiffness, bool at_rest = false) const;
  /// The same with the stiffness, not at rest; computed once for the displacements that this thread has asked for last, since a step needs
  /// those of its two ends several times. Valid until the next call but one.
  template <int R>
  const MacroRocking& recall(const Vec3& displacement) const;
  /// The path average of the force between two displacements: discrete gradient (M12), so that average . (to - from) is the change of
  /// energy, and its derivatives with respect to both ends. The stiffness of `at_from` and `at_to` is not needed.
  struct Average {
    MacroVector force;
    MacroMatrix by_from, by_to;
  };
  Average average(const MacroVector& from, const MacroElastic& at_from, const MacroVector& to, const MacroElastic& at_to) const;
  /// The same for (w, theta); `with_from`: else by_from has no meaning.
  struct RockingAverage {
    Vec3 force = Vec3::Zero();
    Mat3 by_from = Mat3::Zero(), by_to = Mat3::Zero();
  };
  template <int R>
  RockingAverage average(const Vec3& from, const MacroRocking& at_from, const Vec3& to, const MacroRocking& at_to, bool with_from) const;

 private:
  struct Axes;
  Axes axes_of(const double* theta, int count) const;
  double vertical_force(double w, const Axes& axes, MacroRise* rises) const;
  double lifted_force(double w, const Axes& axes, MacroRise* rises) const;
  static double strip_root(double s);

  std::uint64_t version_;  // tells foundations apart; copies are the same one
  MacroElasticity elastic_;
  MacroVector stiffness_;
  double beta_, gamma_;
  // of each axis: D/alpha [m], (D/alpha)^2/K_r [m/N], and N x for a rotation of one [N]
  double arm_[2], factor_[2], offset_[2];
};

}  // namespace uplift
