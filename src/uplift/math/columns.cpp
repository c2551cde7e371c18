#include "uplift/math/columns.h"

#include "uplift/math/lanes.h"

namespace uplift {
namespace {

/// So many registers of rows from `a` and `y` on: their sums stay in the registers while the columns go by.
template <int registers>
void add_rows(const double* a, std::ptrdiff_t stride, double scale, const std::vector<Index>& chosen, const double* x, double* y) {
  Lanes sums[registers] = {};
  for (const Index j : chosen) {
    const double* column = a + j * stride;
    const Lanes factor = x[j];
#pragma GCC unroll 8
    for (int k = 0; k < registers; ++k) sums[k] += factor * WholeLanes{k * lanes}(column);
  }
#pragma GCC unroll 8
  for (int k = 0; k < registers; ++k) {
    const WholeLanes at{k * lanes};
    at.put(y, at(y) + scale * sums[k]);
  }
}

}  // namespace

Index whole_registers(Index rows) {
  return (rows + lanes - 1) / lanes * lanes;
}

void add_columns_of(const Matrix& a, double scale, const std::vector<Index>& chosen, const double* x, double* y) {
  constexpr int many = 8;
  const std::ptrdiff_t rows = a.rows();
  const double* from = a.data();
  std::ptrdiff_t i = 0;
  for (; i + many * lanes <= rows; i += many * lanes) add_rows<many>(from + i, rows, scale, chosen, x, y + i);
  for (; i + 2 * lanes <= rows; i += 2 * lanes) add_rows<2>(from + i, rows, scale, chosen, x, y + i);
  for (; i + lanes <= rows; i += lanes) add_rows<1>(from + i, rows, scale, chosen, x, y + i);
  for (; i < rows; ++i) {
    double sum = 0;
    for (const Index j : chosen) sum += from[j * rows + i] * x[j];
    y[i] += scale * sum;
  }
}

}  // namespace uplift
