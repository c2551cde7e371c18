#pragma once
#include <vector>

#include "uplift/contact/impact/impact.h"
#include "uplift/dynamics/bulk.h"
#include "uplift/dynamics/support_motion.h"

namespace uplift {

/// The rows of the interfaces as impacts see them: how forces on them spread through the masses, and which of them are pressed.
struct ContactRows {
  /// B and the motion must stay alive, and what `spread` needs.
  ContactRows(const Model& model, const Bulk& bulk, const Sparse& b, const SupportMotion& motion, Spread spread);
  /// Sets `pressed` and `tangents` by the forces: normal rows of constraints that are pressed (or, where there is no constraint, those of
  /// stiff laws), and the tangential rows of points that stick. False when nothing is pressed.
  bool select_pressed(const std::vector<Block>& blocks, const Vector& forces);
  /// What an impact knows of the rows; it refers to them.
  Impact impact(const Vector& force) const;

  const Sparse& b;
  const SupportMotion& motion;
  Spread mass;
  Matrix dense_b;            // empty when large
  Vector area;               // m2, of the point that a row belongs to
  double closed_gap = 1e-9;  // m: what closes from a smaller gap is no impact
  Vector pressed;            // area of the normal rows that are pressed, else 0 [m2]; of rows that cannot be it stays 0
  std::vector<int> tangents;
};

}  // namespace uplift
