#pragma once
#include <petscsys.h>

#include <vector>

#include "uplift/math/symmetric_sum.h"

namespace uplift {

/// The equal cells that reach the rows of one rank: their sums are multiplied with cell by cell, from one small matrix for each class.
/// The rank's numbers of a vector stand in one array of places: its own rows, then the rows of other ranks that its cells reach (both
/// in their order), then a zero for the unknowns that are held. Cells between two ranks are multiplied by both, each for its own rows.
class RankCells {
 public:
  /// The rank's rows begin at `first`. `classes`: their cells that reach one of the rows; any rows of the whole matrix, -1: held.
  RankCells(PetscInt first, PetscInt count, std::vector<EqualCells> classes);
  const std::vector<PetscInt>& others() const { return others_; }  // rows of other ranks
  std::size_t classes() const { return classes_.size(); }
  PetscInt first() const { return first_; }
  PetscInt own() const { return own_; }
  std::size_t places() const { return static_cast<std::size_t>(own_) + others_.size() + 1; }
  /// y += sum of A_c x over the cells, on places; right in the rank's own rows alone. `local`: the matrix of each class, symmetric; empty
  /// where it is zero.
  void add_product(const std::vector<Matrix>& local, const double* x, double* y) const;
  /// The diagonal of the sum in the rank's own rows.
  Vector diagonal(const std::vector<Matrix>& local) const;
  /// What the cells add to the rank's own rows between chosen places, scaled, by the numbers of these (-1: not chosen): upper triangle, a
  /// summand of every cell.
  std::vector<Triplet> upper_among(const std::vector<Matrix>& local, const std::vector<double>& scale,
                                   const std::vector<int>& number) const;
  double bytes() const;
  /// Multiplications of one product.
  double operations() const;

 private:
  struct Class {
    int unknowns = 0;
    std::size_t cells = 0;
    std::vector<PetscInt> place;  // block of cells x unknowns x cells of a block; the last block is filled up with the zero
  };
  PetscInt first_, own_;
  std::vector<PetscInt> others_;
  std::vector<Class> classes_;
};

}  // namespace uplift
