#include <cassert>
#include <cmath>

#include "uplift/elements/solid.h"
#include "uplift/elements/solid_rules.h"

// The matrices of a solid, with sizes known to the compiler. For an isotropic material the blocks of K are
//   K_ab = lambda H_ab + mu (H_ab^T + tr H_ab I),   H_ab = int grad N_a (x) grad N_b dV,
// so that only the gradients' products are integrated: 6 blocks of functions x functions instead of B^T D B.
namespace uplift {

namespace {

template <int Functions>
inline constexpr int padded = (Functions + 3) / 4 * 4;  // whole vector registers; the rest is zero

using Jacobian = double[3][3];  // [k][i] = dx_i/dr_k, or its inverse [i][k] = dr_k/dx_i

template <int Dim>
double invert(const Jacobian& j, Jacobian& inverse) {
  if constexpr (Dim == 2) {
    const double det = j[0][0] * j[1][1] - j[0][1] * j[1][0], f = 1 / det;
    inverse[0][0] = f * j[1][1], inverse[0][1] = -f * j[0][1];
    inverse[1][0] = -f * j[1][0], inverse[1][1] = f * j[0][0];
    return det;
  } else {
    const double c0 = j[1][1] * j[2][2] - j[1][2] * j[2][1], c1 = j[1][2] * j[2][0] - j[1][0] * j[2][2],
                 c2 = j[1][0] * j[2][1] - j[1][1] * j[2][0];
    const double det = j[0][0] * c0 + j[0][1] * c1 + j[0][2] * c2, f = 1 / det;
    inverse[0][0] = f * c0, inverse[0][1] = f * (j[0][2] * j[2][1] - j[0][1] * j[2][2]),
    inverse[0][2] = f * (j[0][1] * j[1][2] - j[0][2] * j[1][1]);
    inverse[1][0] = f * c1, inverse[1][1] = f * (j[0][0] * j[2][2] - j[0][2] * j[2][0]),
    inverse[1][2] = f * (j[0][2] * j[1][0] - j[0][0] * j[1][2]);
    inverse[2][0] = f * c2, inverse[2][1] = f * (j[0][1] * j[2][0] - j[0][0] * j[2][1]),
    inverse[2][2] = f * (j[0][0] * j[1][1] - j[0][1] * j[1][0]);
    return det;
  }
}

/// Positions of the nodes by component.
struct Positions {
  alignas(64) double x[3][max_functions];
};

/// Jacobian's inverse and determinant at a point of a rule.
template <int Dim, int Nodes>
double map_point(const Positions& at, const SolidRule& rule, int point, Jacobian& inverse) {
  Jacobian j;
  for (int k = 0; k < Dim; ++k) {
    const double* slope = rule.slopes(point, k);
    for (int i = 0; i < Dim; ++i) {
      double sum = 0;
#pragma omp simd reduction(+ : sum)
      for (int a = 0; a < padded<Nodes>; ++a) sum += slope[a] * at.x[i][a];
      j[k][i] = sum;
    }
  }
  return invert<Dim>(j, inverse);
}

/// The Jacobian at the centre, for the bubbles.
struct Centre {
  Jacobian inverse;
  double determinant;
};

template <int Dim, int Nodes, int Modes>
Centre map_centre(const Positions& at, const SolidTables& tables) {
  Centre centre{};
  if constexpr (Modes > 0) centre.determinant = map_point<Dim, Nodes>(at, tables.centre, 0, centre.inverse);
  return centre;
}

template <int Dim, int Nodes, int Modes>
void point_gradient(const Positions& at, const SolidRule& rule, int point, const Centre& centre, double thickness, PointGradient& out) {
  Jacobian inverse;
  const double det = map_point<Dim, Nodes>(at, rule, point, inverse);
  assert(det > 0);
  const auto p = static_cast<std::size_t>(point);
  out.volume = rule.weight[p] * det * thickness;
  const double* slope[Dim];
  for (int k = 0; k < Dim; ++k) slope[k] = rule.slopes(point, k);
  for (int i = 0; i < Dim; ++i) {
#pragma omp simd
    for (int a = 0; a < padded<Nodes + Modes>; ++a) {
      double sum = inverse[i][0] * slope[0][a] + inverse[i][1] * slope[1][a];
      if constexpr (Dim == 3) sum += inverse[i][2] * slope[2][a];
      out.g[i][a] = sum;
    }
    for (int k = 0; k < Modes; ++k) out.g[i][Nodes + k] = centre.determinant / det * centre.inverse[i][k] * -2 * rule.local[p][k];
  }
}

/// h[a][b] of the pair of components (i <= j).
template <int Functions>
struct Products {
  alignas(64) double h[6][Functions][padded<Functions>] = {};
};

template <int Dim, int Functions>
void add_products(const PointGradient& at, Products<Functions>& sum) {
  int block = 0;
  for (int i = 0; i < Dim; ++i)
    for (int j = i; j < Dim; ++j, ++block)
      for (int a = 0; a < Functions; ++a) {
        const double f = at.volume * at.g[i][a];
        double* row = sum.h[block][a];
        const double* g = at.g[j];
#pragma omp simd
        for (int b = 0; b < padded<Functions>; ++b) row[b] += f * g[b];
      }
}

/// The blocks K_ab, written for b <= a and mirrored; `k` is column-major with n = Dim * Functions rows.
template <int Dim, int Functions>
void expand(const Products<Functions>& sum, double lambda, double mu, double* k) {
  constexpr int n = Dim * Functions;
  constexpr int block[3][3] = {{0, 1, 2}, {1, Dim, Dim + 1}, {2, Dim + 1, 5}};  // in 2D: xx, xy, yy
  for (int a = 0; a < Functions; ++a)
    for (int b = 0; b <= a; ++b) {
      double trace = 0;
      for (int i = 0; i < Dim; ++i) trace += sum.h[block[i][i]][a][b];
      for (int i = 0; i < Dim; ++i)
        for (int j = 0; j < Dim; ++j) {
          const double(&h)[Functions][padded<Functions>] = sum.h[block[i][j]];
          const double ij = i <= j ? h[a][b] : h[b][a], ji = i <= j ? h[b][a] : h[a][b];
          const double value = lambda * ij + mu * (ji + (i == j ? trace : 0));
          k[(Dim * b + j) * n + Dim * a + i] = value;
          k[(Dim * a + i) * n + Dim * b + j] = value;
        }
    }
}

/// Eliminates the last unknowns (of the bubbles) from the symmetric positive `k`: Cholesky from the back, whose rows then leave the rest.
/// `out` gets the Keep x Keep rest, exactly symmetric.
template <int Size, int Keep>
void condense(double* k, double* out) {
  alignas(64) double rows[Size - Keep][padded<Size>] = {};
  for (int q = Size - 1; q >= Keep; --q) {
    double* row = rows[q - Keep];
    const double f = 1 / std::sqrt(k[q * Size + q]);
    for (int r = 0; r < q; ++r) row[r] = f * k[q * Size + r];
    for (int c = Keep; c < q; ++c) {
      const double factor = row[c];
#pragma omp simd
      for (int r = 0; r < Size; ++r) k[c * Size + r] -= factor * row[r];
    }
  }
  for (int c = 0; c < Keep; ++c) {
    double column[Keep];
    for (int r = 0; r < Keep; ++r) column[r] = k[c * Size + r];
    for (int q = 0; q < Size - Keep; ++q) {
      const double factor = rows[q][c];
#pragma omp simd
      for (int r = 0; r < Keep; ++r) column[r] -= factor * rows[q][r];
    }
    for (int r = 0; r < Keep; ++r) out[c * Keep + r] = column[r];
  }
}

template <int Dim, int Nodes, int Modes>
void stiffness(const Positions& at, const SolidTables& tables, double lambda, double mu, double thickness, double* out) {
  constexpr int functions = Nodes + Modes, size = Dim * functions, keep = Dim * Nodes;
  Products<functions> sum;
  const Centre centre = map_centre<Dim, Nodes, Modes>(at, tables);
  PointGradient gradient;
  for (int p = 0; p < tables.stiffness.points(); ++p) {
    point_gradient<Dim, Nodes, Modes>(at, tables.stiffness, p, centre, thickness, gradient);
    add_products<Dim, functions>(gradient, sum);
  }
  if constexpr (Modes == 0) {
    expand<Dim, functions>(sum, lambda, mu, out);
  } else {
    double k[size * size];
    expand<Dim, functions>(sum, lambda, mu, k);
    condense<size, keep>(k, out);
  }
}

/// Scalar mass m_ab of density 1 [m3], and the volume.
template <int Dim, int Nodes>
double scalar_mass(const Positions& at, const SolidRule& rule, double thickness, double (&m)[Nodes][padded<Nodes>]) {
  double volume = 0;
  Jacobian inverse;
  for (int p = 0; p < rule.points(); ++p) {
    const double w = rule.weight[static_cast<std::size_t>(p)] * map_point<Dim, Nodes>(at, rule, p, inverse) * thickness;
    volume += w;
    const double* value = rule.values(p);
    for (int a = 0; a < Nodes; ++a) {
      const double f = w * value[a];
      double* row = m[a];
#pragma omp simd
      for (int b = 0; b < padded<Nodes>; ++b) row[b] += f * value[b];
    }
  }
  return volume;
}

template <int Dim, int Nodes>
void mass(const Positions& at, const SolidRule& rule, double thickness, const SolidSection& section, bool linear_cell, Matrix& out) {
  alignas(64) double m[Nodes][padded<Nodes>] = {};
  const double volume = scalar_mass<Dim, Nodes>(at, rule, thickness, m), density = section.material.density;
  if (section.mass == SolidSection::Mass::consistent) {
    for (int a = 0; a < Nodes; ++a)
      for (int b = 0; b <= a; ++b)
        for (int i = 0; i < Dim; ++i) out(Dim * a + i, Dim * b + i) = out(Dim * b + i, Dim * a + i) = density * m[a][b];
    return;
  }
  double diagonal[Nodes], sum = 0;
  for (int a = 0; a < Nodes; ++a) {
    diagonal[a] = linear_cell ? 0 : m[a][a];
    for (int b = 0; linear_cell && b < Nodes; ++b) diagonal[a] += m[a][b];
    sum += diagonal[a];
  }
  for (int a = 0; a < Nodes; ++a)
    for (int i = 0; i < Dim; ++i) out(Dim * a + i, Dim * a + i) = density * volume * diagonal[a] / sum;
}

/// Calls action.operator()<Dim, Nodes, Modes>() of the cell.
template <class Action>
void with_sizes(Cell cell, bool modes, const Action& action) {
  switch (cell) {
    case Cell::tri3:
      return action.template operator()<2, 3, 0>();
    case Cell::tri6:
      return action.template operator()<2, 6, 0>();
    case Cell::quad4:
      return modes ? action.template operator()<2, 4, 2>() : action.template operator()<2, 4, 0>();
    case Cell::quad8:
      return action.template operator()<2, 8, 0>();
    case Cell::quad9:
      return action.template operator()<2, 9, 0>();
    case Cell::tet4:
      return action.template operator()<3, 4, 0>();
    case Cell::tet10:
      return action.template operator()<3, 10, 0>();
    case Cell::wedge6:
      return action.template operator()<3, 6, 0>();
    case Cell::wedge15:
      return action.template operator()<3, 15, 0>();
    case Cell::hex8:
      return modes ? action.template operator()<3, 8, 3>() : action.template operator()<3, 8, 0>();
    case Cell::hex20:
      return action.template operator()<3, 20, 0>();
    case Cell::hex27:
      return action.template operator()<3, 27, 0>();
    default:
      assert(false && "a solid needs a cell of dimension 2 or 3");
  }
}

Positions gather(std::span<const int> nodes, const std::vector<Vec3>& coordinates) {
  Positions at{};
  for (std::size_t a = 0; a < nodes.size(); ++a)
    for (int i = 0; i < 3; ++i) at.x[i][a] = coordinates[static_cast<std::size_t>(nodes[a])][i];
  return at;
}

}  // namespace

void Solid::form_stiffness(Matrix& out) const {
  out.resize(unknowns(), unknowns());
  const Positions at = gather(nodes(), *coordinates_);
  const std::shared_ptr<const SolidTables> made = tables();
  const double lambda = dimension_ == 2 ? section_->material.plane_lame(section_->plane) : section_->material.lame();
  const double mu = section_->material.shear(), thickness = dimension_ == 2 ? section_->thickness : 1;
  with_sizes(cell_, section_->incompatible_modes,
             [&]<int Dim, int Nodes, int Modes>() { stiffness<Dim, Nodes, Modes>(at, *made, lambda, mu, thickness, out.data()); });
}

void Solid::form_mass(Matrix& out) const {
  out.setZero(unknowns(), unknowns());
  if (section_->mass == SolidSection::Mass::none) return;
  const Positions at = gather(nodes(), *coordinates_);
  const std::shared_ptr<const SolidTables> made = tables();
  const SolidRule& rule = made->mass;
  const double thickness = dimension_ == 2 ? section_->thickness : 1;
  const bool linear_cell = info(cell_).nodes == info(cell_).corners;
  with_sizes(cell_, false, [&]<int Dim, int Nodes, int Modes>() { mass<Dim, Nodes>(at, rule, thickness, *section_, linear_cell, out); });
}

std::vector<PointGradient> Solid::gradients() const {
  std::vector<PointGradient> all;
  find_gradients(all);
  return all;
}

void Solid::find_gradients(std::vector<PointGradient>& all) const {
  const Positions at = gather(nodes(), *coordinates_);
  const std::shared_ptr<const SolidTables> of_cell = this->tables();
  const SolidTables& tables = *of_cell;
  const double thickness = dimension_ == 2 ? section_->thickness : 1;
  all.resize(static_cast<std::size_t>(tables.stiffness.points()));
  with_sizes(cell_, section_->incompatible_modes, [&]<int Dim, int Nodes, int Modes>() {
    const Centre centre = map_centre<Dim, Nodes, Modes>(at, tables);
    for (std::size_t p = 0; p < all.size(); ++p)
      point_gradient<Dim, Nodes, Modes>(at, tables.stiffness, static_cast<int>(p), centre, thickness, all[p]);
  });
}

}  // namespace uplift
