#include "uplift/distributed/ranks.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <chrono>
#include <numeric>
#include <thread>
#include <utility>

#include "uplift/distributed/messages.h"

namespace uplift {

namespace {

constexpr PetscInt most_columns = 32;  // that are sent and solved at once

/// A chain of springs to ground at both ends, the rank's rows of it.
LocalRows chain_of_springs(PetscInt rows, const Shares& shares, int rank) {
  LocalRows local;
  local.start.push_back(0);
  for (PetscInt i = shares.first(rank); i < shares.first(rank + 1); ++i) {
    for (const PetscInt j : {i - 1, i, i + 1})
      if (j >= 0 && j < rows) {
        local.column.push_back(j);
        local.value.push_back(i == j ? 1 : -0.49);
      }
    local.start.push_back(static_cast<PetscInt>(local.column.size()));
  }
  return local;
}

}  // namespace

Ranks::Ranks() {
  MPI_Comm_rank(ranks_, &rank_);
  MPI_Comm_size(ranks_, &count_);
}

Ranks& Ranks::all() {
  static Ranks ranks;
  return ranks;
}

void Ranks::tell(const Order& order) {
  std::int64_t numbers[] = {
      static_cast<std::int64_t>(order.what),       order.system, order.rows, order.columns, order.letters, order.terms,
      std::bit_cast<std::int64_t>(order.residual), order.cells};
  MPI_Request sent = MPI_REQUEST_NULL;
  MPI_Ibcast(numbers, 8, MPI_INT64_T, 0, ranks_, &sent);
  MPI_Wait(&sent, MPI_STATUS_IGNORE);
}

/// MPI waits by spinning. While rank 0 computes alone, the others leave the cores to it.
Ranks::Order Ranks::hear() const {
  std::int64_t numbers[8] = {};
  MPI_Request wanted = MPI_REQUEST_NULL;
  MPI_Ibcast(numbers, 8, MPI_INT64_T, 0, ranks_, &wanted);
  using Clock = std::chrono::steady_clock;
  const Clock::time_point start = Clock::now();
  for (int here = 0;;) {
    MPI_Test(&wanted, &here, MPI_STATUS_IGNORE);
    if (here != 0) break;
    if (Clock::now() - start > std::chrono::milliseconds(2)) std::this_thread::sleep_for(std::chrono::microseconds(100));
  }
  return {static_cast<What>(numbers[0]),     numbers[1], numbers[2], numbers[3], numbers[4], numbers[5],
          std::bit_cast<double>(numbers[6]), numbers[7]};
}

void Ranks::serve() {
  for (;;) {
    const Order order = hear();
    switch (order.what) {
      case What::make:
        make_together(order, nullptr, {});
        break;
      case What::foretell:
        foretell_together(order, nullptr, {});
        break;
      case What::solve:
        solve_together(order, nullptr, nullptr);
        break;
      case What::flexibility:
        flexibility_together(order, {}, nullptr);
        break;
      case What::refuse:
        refuse_together(order, {});
        break;
      case What::divide:
        divide_together(order, nullptr);
        break;
      case What::keep:
        keep_together(order, nullptr, nullptr);
        break;
      case What::keep_cells:
        keep_cells_together(order, nullptr, nullptr);
        break;
      case What::drop:
        kept_.erase(order.system);
        cells_.erase(order.system);
        break;
      case What::diagonal:
        diagonal_together(order, nullptr);
        break;
      case What::multiply:
        multiply_together(order, {}, nullptr, nullptr);
        break;
      case What::release:
        systems_.erase(order.system);
        break;
      case What::end:
        systems_.clear();
        kept_.clear();
        cells_.clear();
        return;
    }
  }
}

Ranks::Made Ranks::make(const SymmetricSum& matrix, const Vector& scale, const std::string& options, const RigidMotions& motions,
                        const std::vector<int>& stiff) {
  const std::lock_guard lock(one_at_a_time_);
  HalfWay half_way(half_way_);
  const Order order{What::make, ++made_, matrix.rows(), motions.motions.cols(), std::ssize(options), std::ssize(matrix.there)};
  tell(order);
  const Scaled scaled{matrix, scale, motions, stiff};
  Made made = make_together(order, &scaled, options);
  half_way.done();
  return made;
}

Ranks::Made Ranks::make_together(const Order& order, const Scaled* matrix, std::string options) {
  Made made{order.system, {}, 0, {}};
  const SolverOptions given(spread_text(order.letters, std::move(options)));
  auto system = std::make_unique<System>(ranks_);
  const Sum sum = spread_sum(order, matrix);
  const std::vector<int> node = spread_nodes(order, sum.shares, matrix);
  made.outcome = set_sum(*system, sum, matrix, node);
  if (made.outcome.ok() && order.columns > 0)
    made.outcome = system->set_motions(spread_motions(order, sum.shares, matrix), static_cast<PetscInt>(order.columns));
  system->set_stiff(spread_stiff(matrix));
  if (made.outcome.ok()) made.outcome = system->prepare(given);
  made.nonzeros = system->nonzeros();
  made.remark = system->remark();
  std::vector<double> scale = own_rows(sum.shares, matrix != nullptr ? matrix->scale.data() : nullptr);
  if (made.outcome.ok()) systems_[order.system] = {std::move(system), std::move(scale), sum.shares};
  return made;
}

Ranks::Forecast Ranks::foretell(const SymmetricSum& matrix, const Vector& scale, const std::string& options,
                                const std::vector<int>& stiff) {
  const std::lock_guard lock(one_at_a_time_);
  HalfWay half_way(half_way_);
  const Order order{What::foretell, 0, matrix.rows(), 0, std::ssize(options), std::ssize(matrix.there)};
  tell(order);
  const RigidMotions none;
  const Scaled scaled{matrix, scale, none, stiff};
  Forecast forecast = foretell_together(order, &scaled, options);
  half_way.done();
  return forecast;
}

Ranks::Forecast Ranks::foretell_together(const Order& order, const Scaled* matrix, std::string options) {
  Forecast forecast;
  const SolverOptions given(spread_text(order.letters, std::move(options)));
  System system(ranks_);
  forecast.outcome = set_sum(system, spread_sum(order, matrix), matrix, {});
  system.set_stiff(spread_stiff(matrix));
  if (forecast.outcome.ok()) forecast.outcome = system.foretell(given, forecast.mine);
  MPI_Comm machine = MPI_COMM_NULL;
  MPI_Comm_split_type(ranks_, MPI_COMM_TYPE_SHARED, rank_, MPI_INFO_NULL, &machine);
  double elsewhere = rank_ == 0 ? 0 : forecast.mine.bytes;
  if (rank_ > 0) {  // rank 0 has its own ones already
    for (const auto& [number, kept] : kept_) elsewhere += static_cast<double>(kept.columns.nonZeros()) * (sizeof(double) + sizeof(int));
    for (const auto& [number, cells] : cells_) elsewhere += cells->bytes();
  }
  MPI_Allreduce(&elsewhere, &forecast.most_elsewhere, 1, MPI_DOUBLE, MPI_MAX, ranks_);
  MPI_Allreduce(&elsewhere, &forecast.beside, 1, MPI_DOUBLE, MPI_SUM, machine);
  MPI_Comm_free(&machine);
  return forecast;
}

SystemOutcome Ranks::solve(std::int64_t system, const Matrix& b, Matrix& x, double residual) {
  const std::lock_guard lock(one_at_a_time_);
  if (&x != &b) x.resize(b.rows(), b.cols());
  SystemOutcome outcome;
  HalfWay half_way(half_way_);
  for (Index first = 0; first < b.cols() && outcome.ok(); first += most_columns) {
    const Order order{What::solve, system, b.rows(), std::min<Index>(most_columns, b.cols() - first), 0, 0, residual};
    tell(order);
    outcome = solve_together(order, b.col(first).data(), x.col(first).data());
  }
  half_way.done();
  if (!outcome.ok() && failure_.empty()) failure_ = outcome.why;
  return outcome;
}

SystemOutcome Ranks::solve_together(const Order& order, const double* b, double* x) {
  const auto columns = static_cast<PetscInt>(order.columns);
  const auto& [asked, scale, shares] = systems_.at(order.system);
  const int local = shares.count(rank_);
  const std::vector<int> counts = shares.counts();
  std::vector<double> given(static_cast<std::size_t>(local) * static_cast<std::size_t>(columns)), solved(given.size());
  const auto scale_column = [&, factors = scale.data()](double* column) {
    for (int i = 0; i < local; ++i) column[i] *= factors[i];
  };
  for (PetscInt c = 0; c < columns; ++c) {
    double* column = given.data() + static_cast<std::ptrdiff_t>(local) * c;
    MPI_Scatterv(b == nullptr ? nullptr : b + order.rows * c, counts.data(), shares.firsts().data(), MPI_DOUBLE, column, local, MPI_DOUBLE,
                 0, ranks_);
    scale_column(column);
  }
  SystemOutcome outcome = asked->solve(given.data(), solved.data(), columns, order.residual);
  iterations_ += asked->iterations();
  for (PetscInt c = 0; c < columns; ++c) {
    double* column = solved.data() + static_cast<std::ptrdiff_t>(local) * c;
    scale_column(column);
    MPI_Gatherv(column, local, MPI_DOUBLE, x == nullptr ? nullptr : x + order.rows * c, counts.data(), shares.firsts().data(), MPI_DOUBLE,
                0, ranks_);
  }
  return outcome;
}

SystemOutcome Ranks::flexibility(std::int64_t system, std::int64_t rows, const std::vector<int>& chosen, Matrix& entries) {
  const std::lock_guard lock(one_at_a_time_);
  HalfWay half_way(half_way_);
  const Order order{What::flexibility, system, rows, std::ssize(chosen), 0, 0};
  tell(order);
  entries.resize(std::ssize(chosen), std::ssize(chosen));
  const SystemOutcome outcome = flexibility_together(order, chosen, &entries);
  half_way.done();
  if (!outcome.ok() && failure_.empty()) failure_ = outcome.why;
  return outcome;
}

/// `entries`: on rank 0. A row is chosen on one rank; the others add a zero to it.
SystemOutcome Ranks::flexibility_together(const Order& order, std::vector<int> chosen, Matrix* entries) {
  constexpr std::int64_t most_numbers = 1 << 22;  // of the loads, on each rank
  chosen.resize(static_cast<std::size_t>(order.columns));
  MPI_Bcast(chosen.data(), static_cast<int>(order.columns), MPI_INT, 0, ranks_);
  const auto& [asked, scale, shares] = systems_.at(order.system);
  const std::int64_t first_row = shares.first(rank_), local = shares.count(rank_), count = order.columns;
  const auto each_of_mine = [&](std::int64_t begin, std::int64_t end, const auto& take) {  // number of the chosen one, row of this rank
    for (std::int64_t k = begin; k < end; ++k)
      if (const std::int64_t row = chosen[static_cast<std::size_t>(k)] - first_row; row >= 0 && row < local) take(k, row);
  };
  const std::int64_t block = std::clamp<std::int64_t>(most_numbers / (std::ranges::max(shares.counts()) + 1), 1, most_columns);
  for (std::int64_t first = 0; first < count; first += block) {
    const std::int64_t columns = std::min(block, count - first);
    std::vector<double> given(static_cast<std::size_t>(local * columns)), solved(given.size());
    each_of_mine(first, first + columns, [&](std::int64_t k, std::int64_t row) {
      given[static_cast<std::size_t>(row + local * (k - first))] = scale[static_cast<std::size_t>(row)];
    });
    SystemOutcome outcome = asked->solve(given.data(), solved.data(), static_cast<PetscInt>(columns));
    iterations_ += asked->iterations();
    if (!outcome.ok()) return outcome;
    Matrix answer = Matrix::Zero(count, columns);
    each_of_mine(0, count, [&](std::int64_t k, std::int64_t row) {
      for (std::int64_t c = 0; c < columns; ++c)
        answer(k, c) = scale[static_cast<std::size_t>(row)] * solved[static_cast<std::size_t>(row + local * c)];
    });
    MPI_Reduce(entries == nullptr ? answer.data() : MPI_IN_PLACE, answer.data(), static_cast<int>(answer.size()), MPI_DOUBLE, MPI_SUM, 0,
               ranks_);
    if (entries != nullptr) entries->middleCols(first, columns) = answer;
  }
  return {};
}

/// The rank's rows of a vector on rank 0.
std::vector<double> Ranks::own_rows(const Shares& shares, const double* vector) const {
  const int count = shares.count(rank_);
  std::vector<double> own(static_cast<std::size_t>(count));
  MPI_Scatterv(vector, shares.counts().data(), shares.firsts().data(), MPI_DOUBLE, own.data(), count, MPI_DOUBLE, 0, ranks_);
  return own;
}

/// The whole vector; `all`: on rank 0.
void Ranks::gather(const Vector& own, const Shares& shares, Vector* all) const {
  MPI_Gatherv(own.data(), static_cast<int>(own.size()), MPI_DOUBLE, all == nullptr ? nullptr : all->data(), shares.counts().data(),
              shares.firsts().data(), MPI_DOUBLE, 0, ranks_);
}

/// The node of each of the rank's rows; empty without motions.
std::vector<int> Ranks::spread_nodes(const Order& order, const Shares& shares, const Scaled* matrix) const {
  if (order.columns == 0) return {};
  const int count = shares.count(rank_);
  std::vector<int> node(static_cast<std::size_t>(count));
  MPI_Scatterv(matrix == nullptr ? nullptr : matrix->motions.node.data(), shares.counts().data(), shares.firsts().data(), MPI_INT,
               node.data(), count, MPI_INT, 0, ranks_);
  return node;
}

std::vector<PetscInt> Ranks::spread_stiff(const Scaled* matrix) const {
  std::vector<PetscInt> stiff;
  if (matrix != nullptr) stiff.assign(matrix->stiff.begin(), matrix->stiff.end());
  int count = static_cast<int>(stiff.size());
  MPI_Bcast(&count, 1, MPI_INT, 0, ranks_);
  stiff.resize(static_cast<std::size_t>(count));
  MPI_Bcast(stiff.data(), count, MPIU_INT, 0, ranks_);
  return stiff;
}

/// The rank's rows of the motions of S A S, which are S^-1 times those of A, one column after another.
std::vector<double> Ranks::spread_motions(const Order& order, const Shares& shares, const Scaled* matrix) const {
  std::vector<double> rows;
  Vector motion;
  for (std::int64_t c = 0; c < order.columns; ++c) {
    if (matrix != nullptr) motion = matrix->motions.motions.col(c).cwiseQuotient(matrix->scale);
    const std::vector<double> own = own_rows(shares, motion.data());
    rows.insert(rows.end(), own.begin(), own.end());
  }
  return rows;
}

std::string Ranks::refuse(const std::string& options) {
  const std::lock_guard lock(one_at_a_time_);
  HalfWay half_way(half_way_);
  constexpr PetscInt rows = 2000;  // enough for a multigrid method to have several levels
  const Order order{What::refuse, 0, rows, 0, std::ssize(options), 0};
  tell(order);
  std::string why = refuse_together(order, options);
  half_way.done();
  return why;
}

std::string Ranks::refuse_together(const Order& order, std::string options) {
  const SolverOptions given(spread_text(order.letters, std::move(options)));
  const auto rows = static_cast<PetscInt>(order.rows);
  const Shares shares(rows, count_);
  LocalRows local = chain_of_springs(rows, shares, rank_);
  const std::vector<double> ones(static_cast<std::size_t>(shares.count(rank_)), 1.0);
  std::vector<double> solved(ones.size());
  System chain(ranks_);
  SystemOutcome outcome = chain.set(std::move(local), rows);
  if (outcome.ok()) outcome = chain.prepare(given);
  if (outcome.ok()) outcome = chain.solve(ones.data(), solved.data(), 1);
  if (!outcome.ok()) return outcome.why;
  if (const std::vector<std::string> left = given.left(); !left.empty())
    return fmt::format("no part of the solver that they choose reads {}", fmt::join(left, ", "));
  // far from both ends: (1 - 2 * 0.49) x = 1
  double worst = 0;
  for (PetscInt i = shares.first(rank_); i < shares.first(rank_ + 1); ++i)
    if (i > rows / 4 && i < 3 * rows / 4)
      worst = std::max(worst, std::abs(solved[static_cast<std::size_t>(i - shares.first(rank_))] / 50 - 1));
  MPI_Allreduce(MPI_IN_PLACE, &worst, 1, MPI_DOUBLE, MPI_MAX, ranks_);
  return worst <= 1e-9 ? "" : fmt::format("a chain of springs under equal forces is solved with an error of {:.1e} by them", worst);
}

std::string Ranks::spread_text(std::int64_t letters, std::string text) const {
  text.resize(static_cast<std::size_t>(letters));
  MPI_Bcast(text.data(), static_cast<int>(letters), MPI_CHAR, 0, ranks_);
  return text;
}

/// Complete rows of the scaled matrix, from its upper triangle: an entry (i, j) is one of row j and, turned round, one of row i. Column
/// after column, each row gets its entries from left to right.
LocalRows Ranks::rows_of(const Scaled& matrix, Index first, Index count) {
  const Sparse& upper = matrix.matrix.here;
  const auto each_entry = [&](const auto& take) {  // row from `first` on, column, value
    for (Index j = first; j < upper.cols(); ++j)
      for (Sparse::InnerIterator entry(upper, j); entry && entry.row() <= j; ++entry) {
        const double value = matrix.scale[entry.row()] * entry.value() * matrix.scale[j];
        if (j < first + count) take(j - first, entry.row(), value);
        if (entry.row() < j && entry.row() >= first && entry.row() < first + count) take(entry.row() - first, j, value);
      }
  };
  LocalRows rows;
  rows.start.assign(static_cast<std::size_t>(count) + 1, 0);
  each_entry([&](Index row, Index, double) { ++rows.start[static_cast<std::size_t>(row) + 1]; });
  std::partial_sum(rows.start.begin(), rows.start.end(), rows.start.begin());
  rows.column.resize(static_cast<std::size_t>(rows.start.back()));
  rows.value.resize(rows.column.size());
  std::vector<PetscInt> next(rows.start.begin(), rows.start.end() - 1);
  each_entry([&](Index row, Index column, double value) {
    const auto place = static_cast<std::size_t>(next[static_cast<std::size_t>(row)]++);
    rows.column[place] = static_cast<PetscInt>(column);
    rows.value[place] = value;
  });
  return rows;
}

/// `matrix`: on rank 0, which makes the rows of one rank after another, its own ones last.
LocalRows Ranks::spread_rows(const Shares& shares, const Scaled* matrix) const {
  if (matrix == nullptr) {
    LocalRows local;
    std::int64_t entries = 0;
    receive(&entries, 1, MPI_INT64_T, ranks_);
    local.start.resize(static_cast<std::size_t>(shares.count(rank_)) + 1);
    local.column.resize(static_cast<std::size_t>(entries)), local.value.resize(static_cast<std::size_t>(entries));
    receive(local.start.data(), std::ssize(local.start), MPI_INT, ranks_);
    receive(local.column.data(), entries, MPI_INT, ranks_);
    receive(local.value.data(), entries, MPI_DOUBLE, ranks_);
    return local;
  }
  for (int rank = count_ - 1; rank > 0; --rank) {
    const LocalRows theirs = rows_of(*matrix, shares.first(rank), shares.count(rank));
    const std::int64_t entries = std::ssize(theirs.column);
    send(&entries, 1, MPI_INT64_T, rank, ranks_);
    send(theirs.start.data(), std::ssize(theirs.start), MPI_INT, rank, ranks_);
    send(theirs.column.data(), entries, MPI_INT, rank, ranks_);
    send(theirs.value.data(), entries, MPI_DOUBLE, rank, ranks_);
  }
  return rows_of(*matrix, 0, shares.count(0));
}

Ranks::Sum Ranks::spread_sum(const Order& order, const Scaled* matrix) const {
  Sum sum{{}, Shares(static_cast<PetscInt>(order.rows), count_)};
  if (order.terms == 0) return sum;
  sum.terms = spread_terms(order, matrix != nullptr ? matrix->matrix.there : std::span<const DistributedTerm>());
  sum.shares = sum.terms.front().matrix.shares;
  return sum;
}

/// A sum, of which `matrix` is on rank 0: the rank's rows of its entries, and its cells.
SystemOutcome Ranks::set_sum(System& system, const Sum& sum, const Scaled* matrix, const std::vector<int>& node) const {
  const PetscInt rows = sum.shares.rows();
  if (sum.terms.empty()) return system.set(spread_rows(sum.shares, matrix), rows, node);
  Vector received;
  const Vector& scale = spread_vector(rows, matrix != nullptr ? &matrix->scale : nullptr, received);
  ScaledCells cells = cells_of_sum(sum.terms);
  if (cells.cells != nullptr) {
    const double* first = scale.data() + cells.cells->first();
    cells.scale.assign(first, first + cells.cells->own());
  }
  return system.set(rows_of_sum(sum, scale, spread_rows(sum.shares, matrix)), rows, node, std::move(cells));
}

void Ranks::release(std::int64_t system) {
  const std::lock_guard lock(one_at_a_time_);
  Order order;
  order.what = What::release, order.system = system;
  tell(order);
  systems_.erase(system);
}

void Ranks::end() {
  const std::lock_guard lock(one_at_a_time_);
  if (half_way_) MPI_Abort(ranks_, 1);
  tell({});
  systems_.clear();
}

}  // namespace uplift
