#pragma once
#include <initializer_list>
#include <vector>

#include "uplift/math/symmetric_sum.h"
#include "uplift/model/model.h"

namespace uplift {

/// Up to this number of free unknowns the matrices of a model are never distributed: messages would take longer than products.
inline constexpr int most_undistributed = 300;

/// The upper triangle of k K + c C + m M; a factor of 0 leaves a matrix out.
Sparse upper_sum_of(const Sparse& stiffness, const Sparse& damping, const Sparse& mass, double k, double c, double m);
/// The same of a model, whose matrices may be distributed.
OwnedSum matrix_sum(const Model& model, double k, double c, double m);
/// The same terms where the matrices are distributed; else none.
std::vector<DistributedTerm> distributed_terms(const Model& model, double k, double c, double m);

/// Diagonal of K or M, which of distributed matrices the processes are asked for.
Vector diagonal_of(const Model& model, Sparse Model::*matrix);

/// K u
Vector stiffness_times(const Model& model, const Vector& u);

/// A block of K or M: S^T A S, S a choice of free unknowns (free x chosen).
Sparse chosen_block(const Model& model, Sparse Model::*matrix, const Sparse& choice);

/// Stiffness and mass for what needs them whole: those of the model, or where they are distributed made again for as long as this lives.
class WholeMatrices {
 public:
  explicit WholeMatrices(const Model& model);
  const Sparse& stiffness() const { return distributed_ ? stiffness_ : model_.stiffness; }
  const Sparse& mass() const { return distributed_ ? mass_ : model_.mass; }

 private:
  const Model& model_;
  bool distributed_;
  Sparse stiffness_, mass_;
};

/// Takes distributed matrices of a model back: it has them whole then and its unknowns in the same order, as any other. `also`: vectors on
/// its free unknowns.
void make_whole(Model& model, std::initializer_list<Vector*> also = {});

}  // namespace uplift
