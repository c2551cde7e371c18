#pragma once
#include <cstddef>

// Triangular solves with one right-hand side through a supernodal factor. A call of BLAS per supernode costs more than its arithmetic when
// supernodes are narrow (plane models), so the loops stand here; what is left is streaming the factor from memory once per solve.
namespace uplift {

/// L in supernodes as CHOLMOD stores them: supernode s holds the columns super[s] ... super[s + 1] - 1 as one dense column-major block of
/// pi[s + 1] - pi[s] rows at values + px[s]; the rows' numbers stand at rows + pi[s], the columns themselves first.
struct Supernodes {
  std::size_t count = 0;
  const int *super = nullptr, *pi = nullptr, *px = nullptr, *rows = nullptr;
  const double* values = nullptr;
};

/// x = L^-1 x in place. `scratch` holds as many values as the highest supernode has rows.
void solve_lower(const Supernodes& factor, double* x, double* scratch);
/// x = L^-T x in place.
void solve_lower_transposed(const Supernodes& factor, double* x, double* scratch);

/// Right-hand sides that are solved together stand in groups of so many columns; columns that are not needed are zero.
inline constexpr std::size_t columns_of_a_group = 8;
/// The same for `groups` groups of columns: number (i, c) of a group stands at i columns_of_a_group + c, the groups one behind the other.
/// What becomes of a column depends on nothing but its own numbers.
void solve_lower_columns(const Supernodes& factor, std::size_t groups, double* x);
void solve_lower_transposed_columns(const Supernodes& factor, std::size_t groups, double* x);

}  // namespace uplift
