#pragma once
#include "uplift/math/linalg.h"

namespace uplift {

/// C = W L of an interface with more rows than jumps, as on a cut through hexahedra: each row feels the jumps at the nodes of its cell
/// alone, and the compliance of the jumps is L L^T. Products with C go through both factors.
struct JumpFactor {
  SparseRows rows;  // W: rows x r [1]; empty where C has no such form
  Matrix lower;     // L: r x r, lower triangle [m/sqrt(J)]
  bool given() const { return rows.size() > 0; }
  /// opening += C z; `jump` (r) receives L z.
  void spread(const Vector& z, Vector& jump, Vector& opening) const;
  /// gradient += C^T force; `pull` (r) receives W^T force.
  void gather(const Vector& force, Vector& pull, Vector& gradient) const;
};

}  // namespace uplift
