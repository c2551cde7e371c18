#include "uplift/math/upper_sum.h"

#include <algorithm>
#include <cassert>
#include <vector>

namespace uplift {

namespace {

/// Calls take(row, sum) for the entries of a column down to the row `last`, from the top.
template <class Take>
void each_entry(std::span<const Term> terms, Index column, Index last, std::vector<Sparse::InnerIterator>& at, const Take& take) {
  at.clear();
  for (const Term& term : terms) at.emplace_back(term.matrix, column);
  for (;;) {
    Index row = last + 1;
    for (const Sparse::InnerIterator& entry : at)
      if (entry) row = std::min<Index>(row, entry.row());
    if (row > last) return;
    double sum = 0;
    for (std::size_t k = 0; k < at.size(); ++k)
      if (at[k] && at[k].row() == row) {
        sum += terms[k].factor * at[k].value();
        ++at[k];
      }
    take(row, sum);
  }
}

/// Two passes: the places are counted before they are filled.
Sparse sum_of(std::span<const Term> terms, bool upper) {
  const Index size = terms.front().matrix.rows();
  for ([[maybe_unused]] const Term& term : terms) assert(term.matrix.rows() == size);
  const auto last = [&](Index column) { return upper ? column : size - 1; };
  Sparse sum(size, size);
  std::vector<Sparse::InnerIterator> at;
  int* start = sum.outerIndexPtr();
  for (Index column = 0; column < size; ++column) {
    start[column + 1] = start[column];
    each_entry(terms, column, last(column), at, [&](Index, double) { ++start[column + 1]; });
  }
  sum.resizeNonZeros(start[size]);
  for (Index column = 0; column < size; ++column) {
    Index place = start[column];
    each_entry(terms, column, last(column), at, [&](Index row, double value) {
      sum.innerIndexPtr()[place] = static_cast<int>(row);
      sum.valuePtr()[place++] = value;
    });
  }
  return sum;
}

}  // namespace

Sparse upper_sum(std::span<const Term> terms) {
  return sum_of(terms, true);
}

Sparse whole_sum(std::span<const Term> terms) {
  return sum_of(terms, false);
}

}  // namespace uplift
