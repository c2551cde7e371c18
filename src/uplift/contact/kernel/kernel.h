#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "uplift/contact/held_rows.h"
#include "uplift/math/linalg.h"

// The small quadratic problem under constraint contact and impact alike:
//     minimise |z|^2/2     opening = target + C z     opening_i >= 0 (rows that may open)     opening_i = 0 (fixed rows)
//     z + C^T p = 0        p_i <= 0 and p_i opening_i = 0 on rows that may open
// z is unique. p is not when rows are redundant (a rigid footing on many points): of all admissible p the one of least sum p_i^2 / weight_i
// is returned, which under a rigid footing is the tensionless Navier distribution. Its dual is p = weight * min(0, C y) on the closed rows,
// y in R^r. Signs: opening > 0 apart, force p > 0 tension. Units: any consistent set (m and N for contact, m/s and N s for impact).
namespace uplift {

/// A view of the problem's data.
struct Rows {
  std::ptrdiff_t count = 0;        // rows
  std::ptrdiff_t columns = 0;      // r
  std::ptrdiff_t stride = 0;       // between the columns of C
  const double* factor = nullptr;  // C, column-major
  const double* target = nullptr;  // opening at z = 0
  const double* limit = nullptr;   // weight of the rows that may only open; 0 where a row is not one of them
  const double* fixed = nullptr;   // weight of the rows held both ways, 0 elsewhere; null when there is none
  double tolerance = 1e-12;        // opening that counts as closed, or as not penetrating
  double relative = 1e-14;         // the same relative to the norm of the targets; the larger of the two counts
};

/// The sets already tried, so that a repeated one is recognised.
struct Visited {
  std::array<std::uint64_t, 64> hash{};
  int count = 0;
  /// Notes the set of rows with held > 0. False when it was noted before or when there is no room left: the iteration must stop.
  bool note(std::ptrdiff_t rows, const double* held);
};

/// Work space of the dual method.
struct DualScratch {
  Matrix q, triangle;  // r x r: rows of the set as C_A^T = Q R
  Vector z, opening, normal, direction, coefficients, again, change, solution, field, rest, part;
  std::vector<std::ptrdiff_t> set, behind, closed;
  std::vector<double> signs, multipliers, behind_signs, behind_multipliers, weight;
  std::vector<char> in, pressed;
};

/// Work space, sized at the first call.
struct KernelScratch {
  Vector next;  // the set of the next iteration
  Visited visited;
  // more than three columns
  HeldRows closed_rows;
  std::vector<std::ptrdiff_t> closed;
  Vector z, opening, field, right, root, multiplier, step;
  DualScratch dual;
};

enum class KernelEnd {
  solved,
  inconsistent,  // no motion opens all rows (or holds the fixed ones); `worst` is a row that cannot be satisfied
  not_finite,
  stuck  // the bounded iteration ended without an answer
};

struct KernelReply {
  KernelEnd end = KernelEnd::stuck;
  int iterations = 0;
  int cycles = 0;       // repeated sets met
  bool exact = false;   // the answer comes from the dual active-set fallback
  double residual = 0;  // balance |z + C^T p| / |z| and openings of the closed rows / largest target
  std::ptrdiff_t worst = -1;
  bool solved() const { return end == KernelEnd::solved; }
};

/// Solves the problem. `held` (rows) is weight where a row is closed and 0 where it is open: the first guess on entry, the set found on
/// return. `z` (r), `opening`, `force` (rows) are outputs. Primal-dual active set (Hintermueller, Ito & Kunisch, SIAM J. Optim. 13, 2002);
/// when a set repeats or contradicts itself, the dual method of Goldfarb & Idnani (Math. Programming 27, 1983), which is finite, takes
/// over. No allocation after the first call.
KernelReply solve_rows(const Rows&, double* held, double* z, double* opening, double* force, KernelScratch&);

/// The primal-dual active set for r <= 3 alone; `stuck` when the fallback is needed.
KernelReply small_active_set(const Rows&, double* held, double* z, double* opening, double* force, KernelScratch&);
/// The same for any r.
KernelReply general_active_set(const Rows&, double* held, double* z, double* opening, double* force, KernelScratch&);
/// The fallback alone.
KernelReply dual_active_set(const Rows&, double* held, double* z, double* opening, double* force, KernelScratch&);

/// Inverse of a symmetric positive semidefinite matrix of order r <= 3 in the sense of Moore and Penrose; packed lower triangles by columns
/// (r = 3: 00 10 20 11 21 22). Returns the rank, judged by pivots relative to the largest one.
template <int R>
int pseudo_inverse(const double* gram, double* inverse);
extern template int pseudo_inverse<1>(const double*, double*);
extern template int pseudo_inverse<2>(const double*, double*);
extern template int pseudo_inverse<3>(const double*, double*);

}  // namespace uplift
