#pragma once
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "uplift/distributed/rank_cells.h"
#include "uplift/distributed/system.h"
#include "uplift/linear/large.h"
#include "uplift/math/symmetric_sum.h"

namespace uplift {

/// The ranks of the job. Rank 0 runs the program and orders the others what to do together with it; they serve. Orders may come from
/// several threads of rank 0; one at a time is carried out.
class Ranks {
 public:
  /// Those of this process.
  static Ranks& all();
  Ranks(const Ranks&) = delete;
  Ranks& operator=(const Ranks&) = delete;

  // ---- rank 0 ----

  struct Made {
    std::int64_t system = 0;  // its number
    SystemOutcome outcome;
    double nonzeros = 0;
    std::string remark;  // see System
  };
  /// Shares a symmetric matrix as S A S with the diagonal S, and prepares its solver. Of what stands on rank 0 rows are sent; the terms are
  /// kept matrices, whose rows the ranks have. `motions`: what deforms A least, may have none. `stiff`: unknowns of stiff parts, ascending.
  Made make(const SymmetricSum& matrix, const Vector& scale, const std::string& options, const RigidMotions& motions = {},
            const std::vector<int>& stiff = {});
  struct Forecast {
    SystemOutcome outcome;
    SystemCost mine;            // of rank 0
    double most_elsewhere = 0;  // bytes of the other rank that takes most
    double beside = 0;          // bytes of all other ranks on the machine of rank 0
  };
  /// What `make` would take.
  Forecast foretell(const SymmetricSum& matrix, const Vector& scale, const std::string& options, const std::vector<int>& stiff = {});
  struct Kept {
    std::int64_t matrix = 0;      // its number
    std::vector<double> entries;  // of each rank
  };
  /// Every rank keeps its rows of symmetric matrices, to which cells that the ranks keep may add; see MatrixHome::keep.
  struct Elements {
    const ElementsOfModel& model;
    const std::vector<MatrixOfElements>& matrices;
    std::int64_t cells = 0;  // their number; 0: there are none
  };
  std::vector<Kept> keep(const std::vector<int>& firsts, const Elements& elements);
  /// Every rank keeps the cells that reach its rows; see MatrixHome::keep_cells.
  struct KeptCells {
    std::int64_t cells = 0;     // their number
    std::vector<double> bytes;  // of each rank
  };
  KeptCells keep_cells(const std::vector<int>& firsts, const std::vector<EqualCells>& classes);
  /// See MatrixHome::divide.
  std::vector<int> divide(const CoupledVertices& graph);
  int count() const { return count_; }
  /// A matrix or cells.
  void drop(std::int64_t kept);
  /// y = sum of factor * A x of kept matrices.
  void multiply(std::span<const DistributedTerm> sum, const Vector& x, Vector& y);
  /// Of a kept matrix.
  Vector diagonal(std::int64_t matrix, std::int64_t rows);
  /// x = A^-1 b; x has the shape of b and may be b. `residual`: see System::solve.
  SystemOutcome solve(std::int64_t system, const Matrix& b, Matrix& x, double residual = 0);
  /// The entries of A^-1 between chosen unknowns. Every rank makes its rows of the loads and hands out those of the answers that are
  /// chosen: nothing as long as A is ever on rank 0.
  SystemOutcome flexibility(std::int64_t system, std::int64_t rows, const std::vector<int>& chosen, Matrix& entries);
  /// The options of which nothing is known to PETSc, or what is wrong with them, tried on a chain of springs; empty when all is well.
  std::string refuse(const std::string& options);
  /// All memory of a system.
  void release(std::int64_t system);
  /// Sends the others home. An order that was left half way, by an exception, ends the job instead.
  void end();
  /// Of the first solve that failed; empty: none did.
  const std::string& failure() const { return failure_; }
  /// Of all solves so far, for each right-hand side; a back-solve counts as one.
  long iterations() const { return iterations_; }

  // ---- the others ----

  /// Does what rank 0 orders, until it ends.
  void serve();

 private:
  enum class What : std::int64_t {
    make,
    foretell,
    divide,
    keep,
    keep_cells,
    drop,
    multiply,
    diagonal,
    solve,
    flexibility,
    refuse,
    release,
    end
  };
  struct Order {
    What what = What::end;
    // rows: or vertices; system: or a kept matrix, or cells; columns: of the loads, the motions or the flexibility; letters: of the
    // options; terms: kept matrices, or classes of cells
    std::int64_t system = 0, rows = 0, columns = 0, letters = 0, terms = 0;
    double residual = 0;
    std::int64_t cells = 0;  // that add to kept matrices
  };
  Ranks();
  void tell(const Order& order);
  Order hear() const;
  struct Scaled {
    const SymmetricSum& matrix;
    const Vector& scale;
    const RigidMotions& motions;
    const std::vector<int>& stiff;
  };
  struct KeptRows {
    Shares shares;
    Sparse columns;                          // rows x local: the rank's rows, as columns
    std::shared_ptr<const RankCells> cells;  // null: none
    std::vector<Matrix> local;               // of each class of cells
  };
  struct KeptTerm {
    double factor;
    const KeptRows& matrix;
  };
  Made make_together(const Order& order, const Scaled* matrix, std::string options);
  Forecast foretell_together(const Order& order, const Scaled* matrix, std::string options);
  std::vector<Kept> keep_together(const Order& order, const Shares* given, const Elements* elements);
  Matrix* Local::*spread_wanted(const MatrixOfElements* matrix) const;
  void make_columns(const ElementsOfModel& elements, Matrix* Local::*wanted, KeptRows& rows) const;
  std::vector<int> divide_together(const Order& order, const CoupledVertices* graph) const;
  Shares spread_shares(const Shares* shares) const;
  KeptCells keep_cells_together(const Order& order, const Shares* given, const std::vector<EqualCells>* classes);
  std::vector<Matrix> spread_local(std::size_t classes, const std::vector<Matrix>* local) const;
  void diagonal_together(const Order& order, Vector* diagonal) const;
  void multiply_together(const Order& order, std::span<const DistributedTerm> sum, const Vector* x, Vector* y) const;
  SystemOutcome solve_together(const Order& order, const double* b, double* x);
  SystemOutcome flexibility_together(const Order& order, std::vector<int> chosen, Matrix* entries);
  std::string refuse_together(const Order& order, std::string options);
  std::vector<double> own_rows(const Shares& shares, const double* vector) const;
  void gather(const Vector& own, const Shares& shares, Vector* all) const;
  std::vector<int> spread_nodes(const Order& order, const Shares& shares, const Scaled* matrix) const;
  std::vector<double> spread_motions(const Order& order, const Shares& shares, const Scaled* matrix) const;
  /// The terms of a sum; of one without them every rank has the same number of rows.
  struct Sum {
    std::vector<KeptTerm> terms;
    Shares shares;
  };
  std::vector<PetscInt> spread_stiff(const Scaled* matrix) const;
  Sum spread_sum(const Order& order, const Scaled* matrix) const;
  SystemOutcome set_sum(System& system, const Sum& sum, const Scaled* matrix, const std::vector<int>& node) const;
  LocalRows spread_rows(const Shares& shares, const Scaled* matrix) const;
  std::vector<KeptTerm> spread_terms(const Order& order, std::span<const DistributedTerm> sum) const;
  const Vector& spread_vector(std::int64_t size, const Vector* vector, Vector& received) const;
  static ScaledCells cells_of_sum(const std::vector<KeptTerm>& terms);
  LocalRows rows_of_sum(const Sum& given, const Vector& scale, const LocalRows& also) const;
  static LocalRows rows_of(const Scaled& matrix, Index first, Index count);
  std::string spread_text(std::int64_t letters, std::string text) const;

  MPI_Comm ranks_ = PETSC_COMM_WORLD;
  int rank_ = 0, count_ = 1;
  std::mutex one_at_a_time_;
  bool half_way_ = false;
  long iterations_ = 0;
  std::int64_t made_ = 0;
  struct ScaledSystem {
    std::unique_ptr<System> system;  // of S A S
    std::vector<double> scale;       // diagonal of S, the rank's rows
    Shares shares;
  };
  std::map<std::int64_t, ScaledSystem> systems_;
  std::map<std::int64_t, KeptRows> kept_;
  std::map<std::int64_t, std::shared_ptr<const RankCells>> cells_;
  std::string failure_;
};

}  // namespace uplift
