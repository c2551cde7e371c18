#pragma once
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "uplift/distributed/system.h"
#include "uplift/math/linalg.h"

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
  };
  /// Shares a symmetric matrix, of which the upper triangle is read, as S A S with the diagonal S, and prepares its solver. `motions`: what
  /// deforms A least, columns; may have none.
  Made make(const Sparse& matrix, const Vector& scale, const std::string& options, const Matrix& motions = {});
  struct Forecast {
    SystemOutcome outcome;
    SystemCost mine;            // of rank 0
    double most_elsewhere = 0;  // bytes of the other rank that takes most
    double beside = 0;          // bytes of all other ranks on the machine of rank 0
  };
  /// What `make` would take.
  Forecast foretell(const Sparse& matrix, const Vector& scale, const std::string& options);
  /// x = A^-1 b; x has the shape of b.
  SystemOutcome solve(std::int64_t system, const Matrix& b, Matrix& x);
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
  enum class What : std::int64_t { make, foretell, solve, flexibility, refuse, release, end };
  struct Order {
    What what = What::end;
    std::int64_t system = 0, rows = 0, columns = 0,
                 letters = 0;  // columns: of the loads, the motions or the flexibility; letters: of the options
  };
  Ranks();
  void tell(const Order& order);
  Order hear() const;
  struct Scaled {
    const Sparse& upper;
    const Vector& scale;
    const Matrix& motions;
  };
  Made make_together(const Order& order, const Scaled* matrix, std::string options);
  Forecast foretell_together(const Order& order, const Scaled* matrix, std::string options);
  SystemOutcome solve_together(const Order& order, const double* b, double* x);
  SystemOutcome flexibility_together(const Order& order, std::vector<int> chosen, Matrix* entries);
  std::string refuse_together(const Order& order, std::string options);
  std::vector<double> spread_motions(const Order& order, const Scaled* matrix) const;
  LocalRows spread_rows(PetscInt rows, const Scaled* matrix) const;
  static LocalRows rows_of(const Scaled& matrix, Index first, Index count);
  std::string spread_text(std::int64_t letters, std::string text) const;

  MPI_Comm ranks_ = PETSC_COMM_WORLD;
  int rank_ = 0, count_ = 1;
  std::mutex one_at_a_time_;
  bool half_way_ = false;
  long iterations_ = 0;
  std::int64_t made_ = 0;
  std::map<std::int64_t, std::unique_ptr<System>> systems_;
  std::string failure_;
};

}  // namespace uplift
