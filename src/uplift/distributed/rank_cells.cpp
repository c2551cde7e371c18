// A block of cells, one to a lane, is multiplied with the matrix of its class: every number of the matrix is read once for a block. What
// is streamed from memory are the places, 4 bytes an unknown of a cell, where a matrix of entries takes 12 bytes an entry: for bricks a
// tenth.
#include "uplift/distributed/rank_cells.h"

#include <algorithm>
#include <cassert>
#include <iterator>

#include "uplift/math/lanes.h"

namespace uplift {

namespace {

constexpr int registers = 2;  // side by side, so that a number of the matrix is used twice
constexpr int block = registers * static_cast<int>(lanes);

constexpr int rows_at_once(int unknowns) {
  return unknowns % 6 == 0 ? 6 : unknowns % 5 == 0 ? 5 : unknowns % 4 == 0 ? 4 : 3;
}

using Numbers = std::array<Lanes, registers>;

/// y = A x for one block of cells. `matrix`: N x N, symmetric.
template <int N>
void multiply_block(const double* matrix, const Numbers* x, Numbers* y) {
  constexpr int rows = rows_at_once(N);
  static_assert(N % rows == 0);
  for (int i = 0; i < N; i += rows) {
    Numbers sum[rows];
    for (int r = 0; r < rows; ++r)
      for (int k = 0; k < registers; ++k) sum[r][k] = 0;
    const double* column = matrix + i;
    for (int j = 0; j < N; ++j, column += N)
#pragma GCC unroll 8
      for (int r = 0; r < rows; ++r) {
        const Lanes entry = column[r];
#pragma GCC unroll 2
        for (int k = 0; k < registers; ++k) sum[r][k] += entry * x[j][k];
      }
    for (int r = 0; r < rows; ++r) y[i + r] = sum[r];
  }
}

template <int N>
void add_products(const double* matrix, const std::vector<PetscInt>& places, const double* from, double* to) {
  Numbers x[N], y[N];
  alignas(64) double numbers[block];
  for (const PetscInt *place = places.data(), *end = place + places.size(); place != end; place += N * block) {
    for (int i = 0; i < N; ++i) {
      for (int cell = 0; cell < block; ++cell) numbers[cell] = from[place[i * block + cell]];
      for (int k = 0; k < registers; ++k) x[i][k].copy_from(numbers + k * lanes, std::experimental::vector_aligned);
    }
    multiply_block<N>(matrix, x, y);
    for (int i = 0; i < N; ++i) {
      for (int k = 0; k < registers; ++k) y[i][k].copy_to(numbers + k * lanes, std::experimental::vector_aligned);
      for (int cell = 0; cell < block; ++cell) to[place[i * block + cell]] += numbers[cell];
    }
  }
}

using AddProducts = void (*)(const double* matrix, const std::vector<PetscInt>& places, const double* from, double* to);

/// Of the cells with straight lines or parabolas for edges; null: there is none with so many unknowns.
AddProducts add_products_of(int unknowns) {
  switch (unknowns) {
    case 6:
      return add_products<6>;
    case 8:
      return add_products<8>;
    case 12:
      return add_products<12>;
    case 16:
      return add_products<16>;
    case 18:
      return add_products<18>;
    case 24:
      return add_products<24>;
    case 30:
      return add_products<30>;
    case 45:
      return add_products<45>;
    case 60:
      return add_products<60>;
    case 81:
      return add_products<81>;
    default:
      return nullptr;
  }
}

}  // namespace

RankCells::RankCells(PetscInt first, PetscInt count, std::vector<EqualCells> classes) : first_(first), own_(count) {
  const auto is_own = [&](PetscInt row) { return row >= first_ && row < first_ + own_; };
  for (const EqualCells& cells : classes)
    std::ranges::copy_if(cells.rows, std::back_inserter(others_), [&](PetscInt row) { return row >= 0 && !is_own(row); });
  std::ranges::sort(others_);
  others_.erase(std::ranges::unique(others_).begin(), others_.end());
  others_.shrink_to_fit();
  const auto zero = static_cast<PetscInt>(places() - 1);
  const auto place_of = [&](PetscInt row) {
    if (row < 0) return zero;
    if (is_own(row)) return row - first_;
    return own_ + static_cast<PetscInt>(std::ranges::lower_bound(others_, row) - others_.begin());
  };
  for (EqualCells& cells : classes) {
    assert(add_products_of(cells.unknowns) != nullptr);
    const auto unknowns = static_cast<std::size_t>(cells.unknowns);
    Class made{cells.unknowns, cells.rows.size() / unknowns, {}};
    made.place.assign((made.cells + block - 1) / block * block * unknowns, zero);
    for (std::size_t cell = 0; cell < made.cells; ++cell)
      for (std::size_t i = 0; i < unknowns; ++i)
        made.place[(cell / block * unknowns + i) * block + cell % block] = place_of(cells.rows[cell * unknowns + i]);
    std::vector<int>().swap(cells.rows);
    classes_.push_back(std::move(made));
  }
}

void RankCells::add_product(const std::vector<Matrix>& local, const double* x, double* y) const {
  for (std::size_t k = 0; k < classes_.size(); ++k)
    if (local[k].size() > 0) add_products_of(classes_[k].unknowns)(local[k].data(), classes_[k].place, x, y);
}

Vector RankCells::diagonal(const std::vector<Matrix>& local) const {
  Vector sum = Vector::Zero(static_cast<Index>(places()));
  for (std::size_t k = 0; k < classes_.size(); ++k) {
    if (local[k].size() == 0) continue;
    const std::size_t unknowns = static_cast<std::size_t>(classes_[k].unknowns);
    for (std::size_t at = 0; at < classes_[k].place.size(); ++at) {
      const auto i = static_cast<Index>(at / block % unknowns);
      sum[classes_[k].place[at]] += local[k](i, i);
    }
  }
  return sum.head(own_);
}

std::vector<Triplet> RankCells::upper_among(const std::vector<Matrix>& local, const std::vector<double>& scale,
                                            const std::vector<int>& number) const {
  std::vector<Triplet> sum;
  for (std::size_t k = 0; k < classes_.size(); ++k) {
    if (local[k].size() == 0) continue;
    const auto unknowns = static_cast<std::size_t>(classes_[k].unknowns);
    for (std::size_t cell = 0; cell < classes_[k].cells; ++cell) {
      const PetscInt* first = classes_[k].place.data() + cell / block * unknowns * block + cell % block;
      for (std::size_t i = 0; i < unknowns; ++i) {
        const auto row = static_cast<std::size_t>(first[i * block]);
        if (row >= static_cast<std::size_t>(own_) || number[row] < 0) continue;
        for (std::size_t j = 0; j < unknowns; ++j)
          if (const auto column = static_cast<std::size_t>(first[j * block]); number[column] >= number[row])
            sum.emplace_back(number[row], number[column],
                             scale[row] * local[k](static_cast<Index>(i), static_cast<Index>(j)) * scale[column]);
      }
    }
  }
  return sum;
}

double RankCells::bytes() const {
  double sum = sizeof(PetscInt) * static_cast<double>(others_.size());
  for (const Class& one : classes_) sum += sizeof(PetscInt) * static_cast<double>(one.place.size());
  return sum;
}

double RankCells::operations() const {
  double sum = 0;
  for (const Class& one : classes_) sum += static_cast<double>(one.cells) * one.unknowns * one.unknowns;
  return sum;
}

}  // namespace uplift
