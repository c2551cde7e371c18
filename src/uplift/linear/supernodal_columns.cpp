// Triangular solves with many right-hand sides. One number of the factor serves eight columns at once, as a factor that is broadcast: the
// columns lie side by side in the registers, so that none of them takes part in the sums of another one and every column has the same bits
// whatever stands beside it. A tile of some rows of the factor times the eight columns stays in the registers while a panel of the
// factor's columns passes; the panel is narrow enough to stay in the first-level cache for all groups of eight.
#include <algorithm>
#include <array>
#include <vector>

#include "uplift/linear/supernodal.h"
#include "uplift/math/lanes.h"

namespace uplift {

namespace {

constexpr std::ptrdiff_t width = std::ptrdiff_t{columns_of_a_group};
constexpr int registers = width / lanes;
constexpr int tile = std::max(1, 12 / registers);  // rows: 12 registers of sums, the others for a row of x and the factor's number
constexpr std::ptrdiff_t panel = 60;               // columns of the factor
constexpr std::ptrdiff_t block = 120;              // rows of the factor, of the transposed solve

using Row = std::array<Lanes, registers>;

[[gnu::always_inline]] inline Row load(const double* x) {
  Row row;
  for (int g = 0; g < registers; ++g) row[static_cast<std::size_t>(g)].copy_from(x + g * lanes, std::experimental::element_aligned);
  return row;
}

[[gnu::always_inline]] inline void store(const Row& row, double* x) {
  for (int g = 0; g < registers; ++g) row[static_cast<std::size_t>(g)].copy_to(x + g * lanes, std::experimental::element_aligned);
}

[[gnu::always_inline]] inline void subtract(Row& from, double factor, const Row& x) {
  for (std::size_t g = 0; g < registers; ++g) from[g] -= Lanes(factor) * x[g];
}

/// The rows of x that a tile changes, in the first group of columns.
using Places = std::array<double*, tile>;

/// to[r] -= sum over k of l(r, k) x_k, with l(r, k) = l[r stride_r + k stride_k]
template <int rows, bool transposed>
[[gnu::always_inline]] inline void subtract_tile(std::ptrdiff_t n, const double* l, std::ptrdiff_t stride, const double* x,
                                                 const Places& to, std::ptrdiff_t group) {
  const std::ptrdiff_t of_row = transposed ? stride : 1, of_k = transposed ? 1 : stride;
  std::array<Row, rows> sum;
  for (std::size_t r = 0; r < rows; ++r) sum[r] = load(to[r] + group);
  for (std::ptrdiff_t k = 0; k < n; ++k) {
    const Row xk = load(x + k * width);
    const double* lk = l + k * of_k;
    for (std::size_t r = 0; r < rows; ++r) subtract(sum[r], lk[static_cast<std::ptrdiff_t>(r) * of_row], xk);
  }
  for (std::size_t r = 0; r < rows; ++r) store(sum[r], to[r] + group);
}

template <bool transposed, int rows = tile>
void subtract_rows(int count, std::ptrdiff_t n, const double* l, std::ptrdiff_t stride, const double* x, const Places& to,
                   std::ptrdiff_t group) {
  if (count == rows) return subtract_tile<rows, transposed>(n, l, stride, x, to, group);
  if constexpr (rows > 1) subtract_rows<transposed, rows - 1>(count, n, l, stride, x, to, group);
}

/// One supernode (see Supernodes) and the right-hand sides: `groups` of eight columns, `group` numbers apart, row by row.
struct Node {
  std::ptrdiff_t w, h;
  const double* l;
  const int* rows;
  double* x;  // of the first group, row 0
  std::ptrdiff_t groups, group;

  double* row(std::ptrdiff_t i) const { return x + static_cast<std::ptrdiff_t>(rows[i]) * width; }
  Places places(std::ptrdiff_t first, int count) const {
    Places to{};
    for (int r = 0; r < count; ++r) to[static_cast<std::size_t>(r)] = row(first + r);
    return to;
  }
};

Node node(const Supernodes& factor, std::size_t s, double* x, std::size_t groups) {
  const int w = factor.super[s + 1] - factor.super[s], h = factor.pi[s + 1] - factor.pi[s];
  return {w,
          h,
          factor.values + factor.px[s],
          factor.rows + factor.pi[s],
          x,
          static_cast<std::ptrdiff_t>(groups),
          factor.super[factor.count] * width};
}

/// x = L_tt^-1 x for the triangle of a tile.
void solve_tile(const double* l, std::ptrdiff_t h, int count, double* x) {
  for (int j = 0; j < count; ++j) {
    Row xj = load(x + j * width);
    for (int k = 0; k < j; ++k) subtract(xj, l[j + k * h], load(x + k * width));
    for (Lanes& part : xj) part /= l[j + j * h];
    store(xj, x + j * width);
  }
}

/// x = L_tt^-T x
void solve_tile_transposed(const double* l, std::ptrdiff_t h, int count, double* x) {
  for (int j = count; j-- > 0;) {
    Row xj = load(x + j * width);
    for (int k = j + 1; k < count; ++k) subtract(xj, l[k + j * h], load(x + k * width));
    for (Lanes& part : xj) part /= l[j + j * h];
    store(xj, x + j * width);
  }
}

/// A block of rows below a panel of the factor, column by column, as tiles: number (r, k) of a tile of `tile` rows stands at k tile + r.
void pack(const double* l, std::ptrdiff_t h, std::ptrdiff_t rows, std::ptrdiff_t columns, double* packed) {
  for (std::ptrdiff_t k = 0; k < columns; ++k) {
    const double* lk = l + k * h;
    if (k + 3 < columns)  // the columns of a high supernode are far apart, where no processor expects them
      for (std::ptrdiff_t line = 0; line < rows; line += 8) __builtin_prefetch(lk + 3 * h + line);
    std::ptrdiff_t i = 0;
    for (; i + tile <= rows; i += tile)
      for (std::ptrdiff_t r = 0; r < tile; ++r) packed[i * columns + k * tile + r] = lk[i + r];
    for (std::ptrdiff_t r = 0; i + r < rows; ++r) packed[i * columns + k * tile + r] = lk[i + r];
  }
}

void solve_lower(const Node& node, double* packed) {
  for (std::ptrdiff_t p = 0; p < node.w; p += panel) {
    const std::ptrdiff_t q = std::min(p + panel, node.w);
    double* given = node.row(p);  // the columns of a supernode follow one another
    for (std::ptrdiff_t c = p; c < q; c += tile) {
      const int count = static_cast<int>(std::min<std::ptrdiff_t>(tile, q - c));
      const Places to = node.places(c, count);
      for (std::ptrdiff_t g = 0; g < node.groups; ++g) {
        subtract_rows<false>(count, c - p, node.l + c + p * node.h, node.h, given + g * node.group, to, g * node.group);
        solve_tile(node.l + c + c * node.h, node.h, count, to[0] + g * node.group);
      }
    }
    for (std::ptrdiff_t from = q; from < node.h; from += block) {
      const std::ptrdiff_t n = std::min(block, node.h - from);
      pack(node.l + from + p * node.h, node.h, n, q - p, packed);
      for (std::ptrdiff_t i = 0; i < n; i += tile) {
        const int count = static_cast<int>(std::min<std::ptrdiff_t>(tile, n - i));
        const Places to = node.places(from + i, count);
        for (std::ptrdiff_t g = 0; g < node.groups; ++g)
          subtract_rows<false>(count, q - p, packed + i * (q - p), tile, given + g * node.group, to, g * node.group);
      }
    }
  }
}

/// `rest`: room for a block of rows of all groups.
void solve_lower_transposed(const Node& node, double* rest) {
  for (std::ptrdiff_t p = (node.w - 1) / panel * panel; p >= 0; p -= panel) {
    const std::ptrdiff_t q = std::min(p + panel, node.w);
    for (std::ptrdiff_t from = q; from < node.h; from += block) {
      const std::ptrdiff_t n = std::min(block, node.h - from);
      for (std::ptrdiff_t g = 0; g < node.groups; ++g)
        for (std::ptrdiff_t i = 0; i < n; ++i) store(load(node.row(from + i) + g * node.group), rest + (g * block + i) * width);
      for (std::ptrdiff_t c = p; c < q; c += tile) {
        const int count = static_cast<int>(std::min<std::ptrdiff_t>(tile, q - c));
        const Places to = node.places(c, count);
        for (std::ptrdiff_t g = 0; g < node.groups; ++g)
          subtract_rows<true>(count, n, node.l + from + c * node.h, node.h, rest + g * block * width, to, g * node.group);
      }
    }
    for (std::ptrdiff_t c = p + (q - p - 1) / tile * tile; c >= p; c -= tile) {
      const int count = static_cast<int>(std::min<std::ptrdiff_t>(tile, q - c));
      const Places to = node.places(c, count);
      const std::ptrdiff_t below = c + count;
      for (std::ptrdiff_t g = 0; g < node.groups; ++g) {
        if (below < q)
          subtract_rows<true>(count, q - below, node.l + below + c * node.h, node.h, node.row(below) + g * node.group, to, g * node.group);
        solve_tile_transposed(node.l + c + c * node.h, node.h, count, to[0] + g * node.group);
      }
    }
  }
}

}  // namespace

void solve_lower_columns(const Supernodes& factor, std::size_t groups, double* x) {
  std::vector<double> packed(static_cast<std::size_t>(panel * block));
  for (std::size_t s = 0; s < factor.count; ++s) solve_lower(node(factor, s, x, groups), packed.data());
}

void solve_lower_transposed_columns(const Supernodes& factor, std::size_t groups, double* x) {
  std::vector<double> rest(groups * static_cast<std::size_t>(block * width));
  for (std::size_t s = factor.count; s-- > 0;) solve_lower_transposed(node(factor, s, x, groups), rest.data());
}

}  // namespace uplift
