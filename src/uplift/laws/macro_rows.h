#pragma once
#include <cassert>

#include "uplift/laws/macro_element.h"
#include "uplift/laws/macro_filter.h"

// How the macro-element reads and writes the rows of its points (docs/theory/macro_element.md).
namespace uplift {

/// What a point remembers besides the plastic displacements.
enum MacroMemory { macro_memory_settlement, macro_memory_slip, macro_memory_dissipated, macro_scalars };

/// Where the rows of a point stand among the variables of the macro-element.
struct MacroElement::Rows {
  int points, point, components, count;  // count: rows with plastic displacements
  const int* variable;
  // rows: shear, normal, rotations, in space torsion
  template <int R>
  static constexpr int normal = R;
  template <int R>
  static constexpr int of_point = R == 1 ? 3 : 6;
  template <int R>
  static constexpr int rotation[2] = {R == 1 ? 2 : 4, 3};

  Rows(int all_points, int i, int c) : points(all_points), point(i), components(c) {
    static constexpr int plane[] = {macro_h1, macro_n, macro_m1};
    static constexpr int space[] = {macro_h1, macro_h2, macro_n, macro_m2, macro_m1};
    assert(c == 3 || c == 6);
    variable = c == 3 ? plane : space;
    count = c == 3 ? 3 : 5;
  }
  bool has_torsion() const { return components == 6; }
  int at(int row) const { return row * points + point; }
  int at(int row, int column) const { return (row * components + column) * points + point; }
  double sign(int row) const { return variable[row] == macro_n ? -1 : 1; }

  MacroVector get(const double* values) const {
    MacroVector out = MacroVector::Zero();
    for (int r = 0; r < count; ++r) out[variable[r]] = sign(r) * values[at(r)];
    return out;
  }
  void put(const MacroVector& vector, double* values) const {
    for (int r = 0; r < count; ++r) values[at(r)] = sign(r) * vector[variable[r]];
  }
  void put(const MacroMatrix& matrix, double factor, double* values) const {
    for (int r = 0; r < count; ++r)
      for (int c = 0; c < count; ++c) values[at(r, c)] = factor * sign(r) * sign(c) * matrix(variable[r], variable[c]);
  }
  void put_torsion(double stiffness, double* slope) const {
    for (int r = 0; r < components; ++r) slope[at(r, components - 1)] = slope[at(components - 1, r)] = 0;
    slope[at(components - 1, components - 1)] = stiffness;
  }
  /// (w, theta) of the elastic displacement at the openings q; R: axes of rocking, 1 in the plane and 2 in space.
  template <int R>
  Vec3 rocking(const double* q, const double* plastic) const {
    Vec3 e = Vec3::Zero();
    e[0] = plastic[at(normal<R>)] - q[at(normal<R>)];
    for (int i = 0; i < R; ++i) e[1 + i] = q[at(rotation<R>[i])] - plastic[at(rotation<R>[i])];
    return e;
  }
  /// Writes the stiffness of an elastic footing: `factor` times that of (w, theta), `share` times that of shear and torsion.
  template <int R>
  void put_elastic(const Mat3& k, double factor, double share, const MacroVector& closed, double torsion, double* out) const {
    for (int r = 0; r < of_point<R>; ++r)
      for (int c = 0; c < of_point<R>; ++c) out[at(r, c)] = 0;
    out[at(normal<R>, normal<R>)] = factor * k(0, 0);
    for (int i = 0; i < R; ++i) {
      const int row = rotation<R>[i];
      out[at(i, i)] = share * closed[macro_h1 + i];
      out[at(normal<R>, row)] = -factor * k(0, 1 + i);
      out[at(row, normal<R>)] = -factor * k(1 + i, 0);
      for (int j = 0; j < R; ++j) out[at(row, rotation<R>[j])] = factor * k(1 + i, 1 + j);
    }
    if constexpr (R == 2) out[at(of_point<R> - 1, of_point<R> - 1)] = share * torsion;
  }
  void filter_torsion(const MacroFilter& filter, double coefficient, const Batch& batch, const double* from, const double* to,
                      const LawResponse&) const;
  void take_end(const double* from, const double* to, const LawResponse&) const;
};

}  // namespace uplift
