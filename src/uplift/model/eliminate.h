#pragma once
#include <map>
#include <set>
#include <vector>

#include "uplift/math/linalg.h"

namespace uplift {

/// Exact elimination of linear constraints  sum a_j x_j = sum b_m d_m  (d: prescribed motions): Gauss-Jordan with sparse rows, so that
/// every eliminated unknown is an expression in the kept unknowns and the motions at any time.
class Elimination {
 public:
  /// `scale`: typical size of each unknown (1 for a displacement, 1/length for a rotation), to compare coefficients of different units.
  Elimination(std::vector<double> scale, int motions);

  /// Coefficients of unknowns (first) and motions (second).
  struct Row {
    std::map<int, double> unknowns, motions;
  };
  enum class Result {
    independent,   // an unknown was eliminated
    redundant,     // follows from the earlier rows
    contradictory  // the earlier rows forbid the prescribed motion
  };
  /// `preferred`: unknown to eliminate if the row allows it well enough; -1: none.
  Result add(const Row& row, int preferred = -1);

  /// Unknowns that are left, ascending.
  std::vector<int> kept() const;
  /// x = reduction * x[kept] + motions * d.
  Sparse reduction() const;
  Matrix motions() const;

 private:
  Row substitute(const Row& row) const;
  int choose_pivot(const Row& row, int preferred) const;

  std::vector<double> scale_;
  int motions_;
  std::map<int, Row> expression_;      // eliminated unknown -> kept unknowns and motions
  std::map<int, std::set<int>> used_;  // kept unknown -> eliminated ones that contain it
};

}  // namespace uplift
