#include "uplift/model/element_sum.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace uplift {

namespace {

/// Some lists of numbers one after another.
struct Lists {
  std::vector<int> start{0}, member;
  int count() const { return static_cast<int>(start.size()) - 1; }
  std::span<const int> of(int list) const { return {member.data() + start[list], static_cast<std::size_t>(start[list + 1] - start[list])}; }
};

/// For each number below `bound` the lists that hold it.
Lists lists_of_members(const Lists& lists, Index bound) {
  Lists turned;
  turned.start.assign(static_cast<std::size_t>(bound) + 1, 0);
  for (const int member : lists.member) ++turned.start[member + 1];
  std::partial_sum(turned.start.begin(), turned.start.end(), turned.start.begin());
  turned.member.resize(lists.member.size());
  std::vector<int> next(turned.start.begin(), turned.start.end() - 1);
  for (int list = 0; list < lists.count(); ++list)
    for (const int member : lists.of(list)) turned.member[next[member]++] = list;
  return turned;
}

/// T^T A_e T of one element: its free unknowns, ascending, and the matrix on them. `sizes`: |T| in the place of T.
class ReducedElement {
 public:
  explicit ReducedElement(const Sparse& expansion, bool sizes = false) : expansion_(expansion), sizes_(sizes) {}
  void reduce(std::span<const int> full, const Matrix& local) {
    unknowns.clear();
    for (const int unknown : full)
      for (Sparse::InnerIterator entry(expansion_, unknown); entry; ++entry) unknowns.push_back(static_cast<int>(entry.row()));
    std::ranges::sort(unknowns);
    unknowns.erase(std::ranges::unique(unknowns).begin(), unknowns.end());
    parts_.resize(full.size());
    for (std::size_t i = 0; i < full.size(); ++i) {
      parts_[i].clear();
      for (Sparse::InnerIterator entry(expansion_, full[i]); entry; ++entry)
        parts_[i].emplace_back(std::ranges::lower_bound(unknowns, static_cast<int>(entry.row())) - unknowns.begin(),
                               sizes_ ? std::abs(entry.value()) : entry.value());
    }
    block.setZero(std::ssize(unknowns), std::ssize(unknowns));
    for (Index j = 0; j < local.cols(); ++j)
      for (Index i = 0; i < local.rows(); ++i)
        for (const auto& [row, of_row] : parts_[i])
          for (const auto& [column, of_column] : parts_[j]) block(row, column) += of_row * local(i, j) * of_column;
  }
  std::vector<int> unknowns;
  Matrix block;

 private:
  const Sparse& expansion_;
  const bool sizes_;
  std::vector<std::vector<std::pair<Index, double>>> parts_;  // of T, for each unknown of the element
};

/// Numbers the groups of unknowns that a matrix couples; -1: an empty row.
int number_groups(const Matrix& block, std::vector<int>& group) {
  const Index n = block.rows();
  int count = 0;
  group.assign(static_cast<std::size_t>(n), -1);
  std::vector<Index> reached;
  for (Index first = 0; first < n; ++first) {
    if (group[first] >= 0 || (block.col(first).isZero(0) && block.row(first).isZero(0))) continue;
    reached.assign(1, first);
    group[first] = count;
    while (!reached.empty()) {
      const Index i = reached.back();
      reached.pop_back();
      for (Index j = 0; j < n; ++j)
        if (group[j] < 0 && (block(i, j) != 0 || block(j, i) != 0)) group[j] = count, reached.push_back(j);
    }
    ++count;
  }
  return count;
}

}  // namespace

void ElementSum::each_element(const TakeElement& take, const Wanted& is_wanted) const {
  Matrix local, stiffness;
  std::vector<int> unknowns;
  for (std::size_t e = 0; e < elements_.size(); ++e) {
    if (!left_out_.empty() && left_out_[e] != 0) continue;
    const Element& element = *elements_[e];
    unknowns.clear();
    for (const int node : element.nodes())
      for (int i = 0; i < element.unknowns_per_node(); ++i) unknowns.push_back(space_.unknowns() * node + i);
    if (is_wanted && !is_wanted(unknowns)) continue;
    form(element, wanted_, local, stiffness);
    if (!local.isZero(0)) take(unknowns, local);
  }
}

void ElementSum::form(const Element& element, Matrix* Local::*wanted, Matrix& local, Matrix& stiffness) {
  const bool proportional = wanted == &Local::damping && element.beta != 0;
  Local one;
  one.*wanted = &local;
  if (proportional) one.stiffness = &stiffness;
  element.form(one);
  if (proportional) local += element.beta * stiffness;
}

void ElementSum::each_group(const Sparse& expansion, Columns columns, const TakeGroup& take) const {
  ReducedElement reduced(expansion);
  std::vector<int> group, unknowns;
  Matrix block;
  const auto reaches = [&](std::span<const int> full) {
    for (const int unknown : full)
      for (Sparse::InnerIterator entry(expansion, unknown); entry; ++entry)
        if (columns.has(entry.row())) return true;
    return false;
  };
  const auto take_element = [&](std::span<const int> full, const Matrix& local) {
    reduced.reduce(full, local);
    const int count = number_groups(reduced.block, group);
    for (int g = 0; g < count; ++g) {
      unknowns.clear();
      std::vector<Index> chosen;
      for (std::size_t i = 0; i < group.size(); ++i)
        if (group[i] == g) chosen.push_back(static_cast<Index>(i)), unknowns.push_back(reduced.unknowns[i]);
      if (std::ranges::none_of(unknowns, [&](int unknown) { return columns.has(unknown); })) continue;
      block = reduced.block(chosen, chosen);
      take(unknowns, block);
    }
  };
  each_element(take_element, reaches);
}

Matrix ElementSum::times(const Matrix& x) const {
  Matrix product = Matrix::Zero(x.rows(), x.cols());
  if (x.cols() == 0) return product;
  each_element(
      [&](std::span<const int> unknowns, const Matrix& local) { product(unknowns, Eigen::all) += local * x(unknowns, Eigen::all); });
  return product;
}

Vector ElementSum::size_of_diagonal(const Sparse& expansion) const {
  Vector diagonal = Vector::Zero(expansion.rows());
  ReducedElement reduced(expansion, true);
  each_element([&](std::span<const int> full, const Matrix& local) {
    reduced.reduce(full, local.cwiseAbs());
    diagonal(reduced.unknowns) += reduced.block.diagonal();
  });
  return diagonal;
}

Vector ElementSum::diagonal(const Sparse& expansion, Index first, Index count) const {
  const Columns columns{first, count};
  Vector diagonal = Vector::Zero(count);
  each_group(expansion, columns, [&](std::span<const int> unknowns, const Matrix& block) {
    for (std::size_t i = 0; i < unknowns.size(); ++i)
      if (columns.has(unknowns[i])) diagonal[unknowns[i] - first] += block(static_cast<Index>(i), static_cast<Index>(i));
  });
  return diagonal;
}

/// The places of the sum, with zeros.
Sparse ElementSum::places(const Sparse& expansion, Columns columns) const {
  Lists groups;
  each_group(expansion, columns, [&](std::span<const int> unknowns, const Matrix&) {
    groups.member.insert(groups.member.end(), unknowns.begin(), unknowns.end());
    groups.start.push_back(static_cast<int>(groups.member.size()));
  });
  const Index free = expansion.rows();
  const Lists groups_of = lists_of_members(groups, free);
  std::vector<int> seen(static_cast<std::size_t>(free), -1);  // the last column that has this row
  const auto rows_of = [&](Index column, const auto& take) {
    for (const int group : groups_of.of(static_cast<int>(columns.first + column)))
      for (const int row : groups.of(group))
        if (std::exchange(seen[row], static_cast<int>(column)) != column) take(row);
  };
  Sparse sum(free, columns.count);
  int* start = sum.outerIndexPtr();
  for (Index column = 0; column < columns.count; ++column) {
    start[column + 1] = start[column];
    rows_of(column, [&](int) { ++start[column + 1]; });
  }
  sum.resizeNonZeros(start[columns.count]);
  std::ranges::fill(seen, -1);
  for (Index column = 0; column < columns.count; ++column) {
    int* next = sum.innerIndexPtr() + start[column];
    rows_of(column, [&](int row) { *next++ = row; });
    std::sort(sum.innerIndexPtr() + start[column], next);
  }
  sum.coeffs().setZero();
  return sum;
}

/// The sum with the entries that are only round-off.
Sparse ElementSum::filled(const Sparse& expansion, Columns columns) const {
  Sparse sum = places(expansion, columns);
  each_group(expansion, columns, [&](std::span<const int> unknowns, const Matrix& block) {
    for (Index j = 0; j < block.cols(); ++j) {
      if (!columns.has(unknowns[j])) continue;
      const int* start = sum.outerIndexPtr() + (unknowns[j] - columns.first);
      const int *place = sum.innerIndexPtr() + start[0], *end = sum.innerIndexPtr() + start[1];
      for (Index i = 0; i < block.rows(); ++i) {  // ascending: the next place is behind the last one
        place = std::lower_bound(place, end, unknowns[i]);
        sum.valuePtr()[place - sum.innerIndexPtr()] += block(i, j);
      }
    }
  });
  return sum;
}

namespace {

void drop_round_off(const Vector& diagonal, Index first, Sparse& columns) {
  const Vector size = diagonal.cwiseAbs().cwiseSqrt();
  columns.prune([&](Index i, Index j, double value) { return std::abs(value) > 1e-15 * size[i] * size[first + j]; });
}

}  // namespace

Sparse ElementSum::reduced(const Sparse& expansion) const {
  Sparse sum = filled(expansion, {0, expansion.rows()});
  drop_round_off(sum.diagonal(), 0, sum);
  return sum;
}

Sparse ElementSum::columns(const Sparse& expansion, const Vector& diagonal, Index first, Index count) const {
  Sparse sum = filled(expansion, {first, count});
  drop_round_off(diagonal, first, sum);
  return sum;
}

}  // namespace uplift
