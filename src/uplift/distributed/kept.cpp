// The rows that the ranks keep of stiffness, mass and damping. Every rank makes its own ones from the elements that reach them, which rank
// 0 sends to one rank after another; from then on it multiplies with them and makes its rows of any sum.
#include "uplift/distributed/kept.h"

#include <algorithm>
#include <iterator>
#include <limits>
#include <optional>

#include "uplift/distributed/messages.h"
#include "uplift/distributed/rank_elements.h"
#include "uplift/distributed/ranks.h"
#include "uplift/linear/memory.h"
#include "uplift/model/element_sum.h"

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

Vector KeptMatrix::diagonal() const {
  return Ranks::all().diagonal(number_, firsts_.back());
}

KeptCells::~KeptCells() {
  Ranks::all().drop(number_);
}

int HomeOnRanks::processes() const {
  return Ranks::all().count();
}

std::vector<int> HomeOnRanks::divide(const CoupledVertices& graph) const {
  return Ranks::all().divide(graph);
}

std::vector<std::shared_ptr<const DistributedMatrix>> HomeOnRanks::keep(const std::vector<int>& firsts, const ElementsOfModel& elements,
                                                                        const std::vector<MatrixOfElements>& matrices) const {
  const auto* cells = dynamic_cast<const KeptCells*>(matrices.front().cells.cells.get());
  std::vector<std::shared_ptr<const DistributedMatrix>> made;
  for (Ranks::Kept& kept : Ranks::all().keep(firsts, {elements, matrices, cells != nullptr ? cells->number() : 0}))
    made.push_back(std::make_shared<const KeptMatrix>(kept.matrix, firsts, std::move(kept.entries)));
  return made;
}

std::shared_ptr<const DistributedCells> HomeOnRanks::keep_cells(const std::vector<int>& firsts,
                                                                const std::vector<EqualCells>& classes) const {
  if (classes.empty()) return nullptr;
  Ranks::KeptCells kept = Ranks::all().keep_cells(firsts, classes);
  return std::make_shared<const KeptCells>(kept.cells, std::move(kept.bytes));
}

Ranks::KeptCells Ranks::keep_cells(const std::vector<int>& firsts, const std::vector<EqualCells>& classes) {
  const std::lock_guard lock(one_at_a_time_);
  HalfWay half_way(half_way_);
  const Shares shares(firsts);
  const Order order{What::keep_cells, ++made_, shares.rows(), 0, 0, std::ssize(classes)};
  tell(order);
  KeptCells kept = keep_cells_together(order, &shares, &classes);
  half_way.done();
  return kept;
}

namespace {

/// Those that reach rows from `first` to below `end`.
EqualCells cells_at(const EqualCells& all, int first, int end) {
  EqualCells some{all.unknowns, {}};
  const auto each = [&](const auto& take) {
    for (auto cell = all.rows.begin(); cell != all.rows.end(); cell += all.unknowns)
      if (std::any_of(cell, cell + all.unknowns, [&](int row) { return row >= first && row < end; })) take(cell);
  };
  std::size_t count = 0;
  each([&](auto) { ++count; });
  some.rows.reserve(count * static_cast<std::size_t>(all.unknowns));
  each([&](auto cell) { some.rows.insert(some.rows.end(), cell, cell + all.unknowns); });
  return some;
}

}  // namespace

/// `given` and `classes`: on rank 0.
Ranks::KeptCells Ranks::keep_cells_together(const Order& order, const Shares* given, const std::vector<EqualCells>* classes) {
  const Shares shares = spread_shares(given);
  std::vector<EqualCells> mine(static_cast<std::size_t>(order.terms));
  for (std::size_t k = 0; k < mine.size(); ++k) {
    if (classes == nullptr) {
      std::int64_t sizes[2] = {};
      receive(sizes, 2, MPI_INT64_T, ranks_);
      mine[k].unknowns = static_cast<int>(sizes[0]);
      mine[k].rows.resize(static_cast<std::size_t>(sizes[1]));
      receive(mine[k].rows.data(), sizes[1], MPI_INT, ranks_);
      continue;
    }
    for (int rank = count_ - 1; rank > 0; --rank) {
      const EqualCells theirs = cells_at((*classes)[k], shares.first(rank), shares.first(rank + 1));
      const std::int64_t sizes[2] = {theirs.unknowns, std::ssize(theirs.rows)};
      send(sizes, 2, MPI_INT64_T, rank, ranks_);
      send(theirs.rows.data(), sizes[1], MPI_INT, rank, ranks_);
    }
    mine[k] = cells_at((*classes)[k], 0, shares.first(1));
  }
  auto made = std::make_shared<const RankCells>(shares.first(rank_), shares.count(rank_), std::move(mine));
  KeptCells kept{order.system, std::vector<double>(static_cast<std::size_t>(count_))};
  const double bytes = made->bytes();
  MPI_Gather(&bytes, 1, MPI_DOUBLE, kept.bytes.data(), 1, MPI_DOUBLE, 0, ranks_);
  cells_[order.system] = std::move(made);
  return kept;
}

std::vector<Ranks::Kept> Ranks::keep(const std::vector<int>& firsts, const Elements& elements) {
  const std::lock_guard lock(one_at_a_time_);
  HalfWay half_way(half_way_);
  const Shares shares(firsts);
  const Order order{What::keep, made_ + 1, shares.rows(), 0, 0, std::ssize(elements.matrices), 0, elements.cells};
  made_ += order.terms;
  tell(order);
  std::vector<Kept> kept = keep_together(order, &shares, &elements);
  half_way.done();
  return kept;
}

/// The same on all ranks; `shares`: on rank 0.
Shares Ranks::spread_shares(const Shares* shares) const {
  std::vector<PetscInt> firsts = shares != nullptr ? shares->firsts() : std::vector<PetscInt>(static_cast<std::size_t>(count_) + 1);
  MPI_Bcast(firsts.data(), count_ + 1, MPI_INT, 0, ranks_);
  return Shares(std::move(firsts));
}

/// `given` and `elements`: on rank 0.
std::vector<Ranks::Kept> Ranks::keep_together(const Order& order, const Shares* given, const Elements* elements) {
  const Shares shares = spread_shares(given);
  std::optional<RankElements> mine;
  if (elements == nullptr) mine.emplace(order.rows, ranks_);
  for (int rank = 1; rank < count_ && elements != nullptr; ++rank)
    send_elements(elements->model, shares.first(rank), shares.first(rank + 1), rank, ranks_);
  std::vector<Kept> kept;
  for (std::int64_t k = 0; k < order.terms; ++k) {
    Kept& matrix = kept.emplace_back(Kept{order.system + k, std::vector<double>(static_cast<std::size_t>(count_))});
    const MatrixOfElements* of = elements != nullptr ? &elements->matrices[static_cast<std::size_t>(k)] : nullptr;
    KeptRows& rows = kept_[matrix.matrix];
    rows.shares = shares;
    if (order.cells != 0) {
      rows.cells = cells_.at(order.cells);
      rows.local = spread_local(rows.cells->classes(), of != nullptr ? &of->cells.local : nullptr);
    }
    make_columns(elements != nullptr ? elements->model : mine->model(), spread_wanted(of), rows);
    const auto entries = static_cast<double>(rows.columns.nonZeros());
    MPI_Gather(&entries, 1, MPI_DOUBLE, matrix.entries.data(), 1, MPI_DOUBLE, 0, ranks_);
  }
  mine.reset();
  give_back_free_memory();
  return kept;
}

/// Which matrix of the elements; `matrix`: on rank 0.
Matrix* Local::*Ranks::spread_wanted(const MatrixOfElements* matrix) const {
  constexpr Matrix* Local::*all[] = {&Local::stiffness, &Local::mass, &Local::damping};
  std::int64_t which = matrix != nullptr ? std::ranges::find(all, matrix->wanted) - std::begin(all) : 0;
  MPI_Bcast(&which, 1, MPI_INT64_T, 0, ranks_);
  return all[which];
}

/// The rank's rows. What is round-off depends on the diagonal in the rows of all ranks.
void Ranks::make_columns(const ElementsOfModel& elements, Matrix* Local::*wanted, KeptRows& rows) const {
  const ElementSum sum(elements.space, elements.elements, wanted, elements.left_out);
  const PetscInt first = rows.shares.first(rank_), count = rows.shares.count(rank_);
  Vector own = sum.diagonal(elements.expansion, first, count), diagonal(rows.shares.rows());
  if (rows.cells != nullptr) own += rows.cells->diagonal(rows.local);
  MPI_Allgatherv(own.data(), count, MPI_DOUBLE, diagonal.data(), rows.shares.counts().data(), rows.shares.firsts().data(), MPI_DOUBLE,
                 ranks_);
  sum.columns(elements.expansion, diagonal, first, count).swap(rows.columns);
  rows.columns.data().squeeze();
}

std::vector<Matrix> Ranks::spread_local(std::size_t classes, const std::vector<Matrix>* local) const {
  std::vector<Matrix> all = local != nullptr ? *local : std::vector<Matrix>(classes);
  for (Matrix& one : all) {
    std::int64_t size = one.rows();
    MPI_Bcast(&size, 1, MPI_INT64_T, 0, ranks_);
    one.resize(size, size);
    MPI_Bcast(one.data(), static_cast<int>(one.size()), MPI_DOUBLE, 0, ranks_);
  }
  return all;
}

void Ranks::drop(std::int64_t kept) {
  const std::lock_guard lock(one_at_a_time_);
  Order order;
  order.what = What::drop, order.system = kept;
  tell(order);
  kept_.erase(kept);
  cells_.erase(kept);
}

Vector Ranks::diagonal(std::int64_t matrix, std::int64_t rows) {
  const std::lock_guard lock(one_at_a_time_);
  HalfWay half_way(half_way_);
  const Order order{What::diagonal, matrix, rows};
  tell(order);
  Vector diagonal(rows);
  diagonal_together(order, &diagonal);
  half_way.done();
  return diagonal;
}

/// `diagonal`: on rank 0.
void Ranks::diagonal_together(const Order& order, Vector* diagonal) const {
  const KeptRows& kept = kept_.at(order.system);
  Vector own(kept.columns.cols());
  for (Index i = 0; i < own.size(); ++i) own[i] = kept.columns.coeff(kept.shares.first(rank_) + i, i);
  if (kept.cells != nullptr) own += kept.cells->diagonal(kept.local);
  gather(own, kept.shares, diagonal);
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
  const std::vector<KeptTerm> terms = spread_terms(order, sum);
  const Shares& shares = terms.front().matrix.shares;
  Vector received;
  const Vector& given = spread_vector(order.rows, x, received);
  Vector product = Vector::Zero(shares.count(rank_));
  for (const KeptTerm& term : terms) product += term.factor * (term.matrix.columns.transpose() * given);
  if (const ScaledCells sum_of_cells = cells_of_sum(terms); sum_of_cells.cells != nullptr) {
    const RankCells& cells = *sum_of_cells.cells;
    Vector from(static_cast<Index>(cells.places())), to = Vector::Zero(from.size());
    from << given.segment(cells.first(), cells.own()), given(cells.others()), 0;
    cells.add_product(sum_of_cells.local, from.data(), to.data());
    product += to.head(cells.own());
  }
  gather(product, shares, y);
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

/// Of all terms together, which are those of one model; their scale is left to the caller.
ScaledCells Ranks::cells_of_sum(const std::vector<KeptTerm>& terms) {
  ScaledCells sum;
  for (const auto& [factor, matrix] : terms) {
    if (matrix.cells == nullptr) continue;
    sum.cells = matrix.cells;
    sum.local.resize(matrix.local.size());
    for (std::size_t k = 0; k < matrix.local.size(); ++k) {
      if (matrix.local[k].size() == 0) continue;
      if (sum.local[k].size() == 0)
        sum.local[k] = factor * matrix.local[k];
      else
        sum.local[k] += factor * matrix.local[k];
    }
  }
  return sum;
}

/// `vector`: on rank 0, where it is not copied; on the others it is received.
const Vector& Ranks::spread_vector(std::int64_t size, const Vector* vector, Vector& received) const {
  if (vector == nullptr) received.resize(size);
  auto* numbers = vector != nullptr ? const_cast<double*>(vector->data()) : received.data();  // MPI: one function sends and receives
  MPI_Bcast(numbers, static_cast<int>(size), MPI_DOUBLE, 0, ranks_);
  return vector != nullptr ? *vector : received;
}

/// The rank's rows of S (sum of terms) S + also.
LocalRows Ranks::rows_of_sum(const Sum& given, const Vector& scale, const LocalRows& also) const {
  const PetscInt first = given.shares.first(rank_), count = given.shares.count(rank_);
  std::vector<Cursor> row;
  LocalRows sum;
  const auto each_entry = [&](PetscInt local, const auto& take) {
    row.clear();
    for (const KeptTerm& term : given.terms) {
      const Sparse& columns = term.matrix.columns;
      const int *start = columns.outerIndexPtr() + local, *column = columns.innerIndexPtr();
      row.push_back({column + start[0], column + start[1], columns.valuePtr() + start[0], term.factor});
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
