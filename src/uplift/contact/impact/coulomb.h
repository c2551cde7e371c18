#pragma once
#include <memory>
#include <vector>

#include "uplift/contact/method.h"

// Coulomb's law at the level of rates, for the points of cones that are pressed:
//     rate = free + C z     z + C^T p = 0     p_n <= 0, rate_n >= 0, p_n rate_n = 0     |p_t| <= -mu p_n, p_t along rate_t
// with C C^T = B M^-1 B^T. Rates are velocities [m/s] and p impulses [N s] (Moreau's law of impact without restitution), or what a short
// time makes of accelerations and forces. z belongs to the motion X z (Spread).
namespace uplift {

/// Whether points of cones may slide against friction.
bool any_friction(const std::vector<Block>& blocks);

class CoulombRates {
 public:
  /// Blocks of laws are left out. `factor` is C of the mass, rows x r.
  CoulombRates(const std::vector<Block>& blocks, const Matrix& factor);
  ~CoulombRates();
  /// `free`: rates of all rows without contact [m/s]. `takes_part`: > 0 on the normal rows of the points that may press. `at_rest`: a
  /// smaller rate is none [m/s]. False when no solution was found.
  bool solve(const Vector& free, const Vector& takes_part, double at_rest);
  const Vector& impulse() const { return solution_.force; }  // rows [N s], tension > 0
  const Vector& rate() const { return solution_.opening; }   // rows [m/s]; of rows that take no part shifted
  const Vector& z() const { return solution_.z; }            // r

 private:
  InterfaceProblem problem_;
  InterfaceSolution fresh_, solution_;  // fresh_: without memory of the step before
  std::unique_ptr<MethodWork> work_;
};

}  // namespace uplift
