// The rows that the ranks keep of stiffness, mass and damping. Rank 0 makes them, those of one rank after another; from then on every rank
// multiplies with its own ones and makes its own of any sum.
#include "uplift/distributed/kept.h"

#include <algorithm>
#include <limits>

#include "uplift/distributed/messages.h"
#include "uplift/distributed/ranks.h"

namespace uplift {

namespace {

/// Runs along one row of a matrix.
struct Cursor {
  const int *column, *end;
  const double* value;
  double factor;
};

/// Calls take(column, sum) for a row, columns ascending.
template <class Take>
void each_sum(std::vector<Cursor>& row, const Take& take) {
  for (;;) {
    int column = std::numeric_limits<int>::max();
    bool any = false;
    for (const Cursor& at : row)
      if (at.column != at.end) column = std::min(column, *at.column), any = true;
    if (!any) return;
    double sum = 0;
    for (Cursor& at : row)
      if (at.column != at.end && *at.column == column) {
        sum += at.factor * *at.value++;
        ++at.column;
      }
    take(column, sum);
  }
}

}  // namespace

KeptMatrix::~KeptMatrix() {
  Ranks::all().drop(number_);
}

void KeptMatrix::multiply(std::span<const DistributedTerm> sum, const Vector& x, Vector& y) const {
  Ranks::all().multiply(sum, x, y);
}

std::shared_ptr<const DistributedMatrix> HomeOnRanks::keep(Vector diagonal, const MakeColumns& make) const {
  Ranks::Kept kept = Ranks::all().keep(diagonal.size(), make);
  return std::make_shared<const KeptMatrix>(kept.matrix, std::move(diagonal), std::move(kept.entries));
}

Ranks::Kept Ranks::keep(std::int64_t rows, const MatrixHome::MakeColumns& make) {
  const std::lock_guard lock(one_at_a_time_);
  HalfWay half_way(half_way_);
  const Order order{What::keep, ++made_, rows, 0, 0, 0};
  tell(order);
  Kept kept = keep_together(order, &make);
  half_way.done();
  return kept;
}

/// `make`: on rank 0, whose own rows are made last.
Ranks::Kept Ranks::keep_together(const Order& order, const MatrixHome::MakeColumns* make) {
  const Shares shares(static_cast<PetscInt>(order.rows), count_);
  Sparse mine(order.rows, shares.count(rank_));
  if (make == nullptr) {
    std::int64_t entries = 0;
    receive(&entries, 1, MPI_INT64_T, ranks_);
    mine.resizeNonZeros(entries);
    receive(mine.outerIndexPtr(), mine.cols() + 1, MPI_INT, ranks_);
    receive(mine.innerIndexPtr(), entries, MPI_INT, ranks_);
    receive(mine.valuePtr(), entries, MPI_DOUBLE, ranks_);
  } else {
    for (int rank = count_ - 1; rank > 0; --rank) {
      const Sparse theirs = (*make)(shares.first(rank), shares.count(rank));
      const std::int64_t entries = theirs.nonZeros();
      send(&entries, 1, MPI_INT64_T, rank, ranks_);
      send(theirs.outerIndexPtr(), theirs.cols() + 1, MPI_INT, rank, ranks_);
      send(theirs.innerIndexPtr(), entries, MPI_INT, rank, ranks_);
      send(theirs.valuePtr(), entries, MPI_DOUBLE, rank, ranks_);
    }
    (*make)(0, shares.count(0)).swap(mine);
    mine.data().squeeze();
  }
  Kept kept{order.system, std::vector<double>(static_cast<std::size_t>(count_))};
  const auto entries = static_cast<double>(mine.nonZeros());
  MPI_Gather(&entries, 1, MPI_DOUBLE, kept.entries.data(), 1, MPI_DOUBLE, 0, ranks_);
  kept_[order.system].swap(mine);
  return kept;
}

void Ranks::drop(std::int64_t matrix) {
  const std::lock_guard lock(one_at_a_time_);
  Order order;
  order.what = What::drop, order.system = matrix;
  tell(order);
  kept_.erase(matrix);
}

void Ranks::multiply(std::span<const DistributedTerm> sum, const Vector& x, Vector& y) {
  const std::lock_guard lock(one_at_a_time_);
  HalfWay half_way(half_way_);
  const Order order{What::multiply, 0, x.size(), 0, 0, std::ssize(sum)};
  tell(order);
  multiply_together(order, sum, &x, &y);
  half_way.done();
}

void Ranks::multiply_together(const Order& order, std::span<const DistributedTerm> sum, const Vector* x, Vector* y) const {
  const Shares shares(static_cast<PetscInt>(order.rows), count_);
  const std::vector<KeptTerm> terms = spread_terms(order, sum);
  const Vector given = spread_vector(order.rows, x);
  Vector product = Vector::Zero(shares.count(rank_));
  for (const KeptTerm& term : terms) product += term.factor * (term.columns.transpose() * given);
  std::vector<int> counts, firsts;
  for (int rank = 0; rank < count_; ++rank) counts.push_back(shares.count(rank)), firsts.push_back(shares.first(rank));
  MPI_Gatherv(product.data(), shares.count(rank_), MPI_DOUBLE, y == nullptr ? nullptr : y->data(), counts.data(), firsts.data(), MPI_DOUBLE,
              0, ranks_);
}

/// `sum`: on rank 0.
std::vector<Ranks::KeptTerm> Ranks::spread_terms(const Order& order, std::span<const DistributedTerm> sum) const {
  const auto count = static_cast<std::size_t>(order.terms);
  std::vector<std::int64_t> numbers(count);
  std::vector<double> factors(count);
  for (std::size_t k = 0; k < sum.size(); ++k) {
    numbers[k] = dynamic_cast<const KeptMatrix&>(*sum[k].matrix).number();
    factors[k] = sum[k].factor;
  }
  MPI_Bcast(numbers.data(), static_cast<int>(count), MPI_INT64_T, 0, ranks_);
  MPI_Bcast(factors.data(), static_cast<int>(count), MPI_DOUBLE, 0, ranks_);
  std::vector<KeptTerm> terms;
  for (std::size_t k = 0; k < count; ++k) terms.push_back({factors[k], kept_.at(numbers[k])});
  return terms;
}

/// `vector`: on rank 0.
Vector Ranks::spread_vector(std::int64_t size, const Vector* vector) const {
  Vector whole = vector != nullptr ? *vector : Vector(size);
  MPI_Bcast(whole.data(), static_cast<int>(size), MPI_DOUBLE, 0, ranks_);
  return whole;
}

/// The rank's rows of S (sum of terms) S + also.
LocalRows Ranks::rows_of_sum(const std::vector<KeptTerm>& terms, const Vector& scale, const LocalRows& also) const {
  const Shares shares(static_cast<PetscInt>(scale.size()), count_);
  const PetscInt first = shares.first(rank_), count = shares.count(rank_);
  std::vector<Cursor> row;
  LocalRows sum;
  const auto each_entry = [&](PetscInt local, const auto& take) {
    row.clear();
    for (const KeptTerm& term : terms) {
      const int *start = term.columns.outerIndexPtr() + local, *column = term.columns.innerIndexPtr();
      row.push_back({column + start[0], column + start[1], term.columns.valuePtr() + start[0], term.factor});
    }
    const int *more = also.column.data() + also.start[local], *end = also.column.data() + also.start[local + 1];
    const double* value = also.value.data() + also.start[local];
    const auto take_with = [&](PetscInt column, double of_terms) {
      for (; more != end && *more < column; ++more) take(*more, *value++);
      double entry = scale[first + local] * of_terms * scale[column];
      if (more != end && *more == column) entry += *value++, ++more;
      take(column, entry);
    };
    each_sum(row, take_with);
    for (; more != end; ++more) take(*more, *value++);
  };
  sum.start.assign(static_cast<std::size_t>(count) + 1, 0);
  for (PetscInt local = 0; local < count; ++local) {
    PetscInt& next = sum.start[static_cast<std::size_t>(local) + 1] = sum.start[static_cast<std::size_t>(local)];
    each_entry(local, [&](PetscInt, double) { ++next; });
  }
  sum.column.resize(static_cast<std::size_t>(sum.start.back()));
  sum.value.resize(sum.column.size());
  std::size_t place = 0;
  for (PetscInt local = 0; local < count; ++local)
    each_entry(local, [&](PetscInt column, double value) {
      sum.column[place] = column;
      sum.value[place++] = value;
    });
  return sum;
}

}  // namespace uplift
