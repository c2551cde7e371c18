#include "uplift/model/matrix_sum.h"

#include <cassert>

#include "uplift/math/upper_sum.h"
#include "uplift/model/damping.h"
#include "uplift/model/element_sum.h"
#include "uplift/model/numbering.h"

namespace uplift {

namespace {

ElementSum sum_of_elements(const Model& model, Matrix* Local::*wanted) {
  return {model.space, model.elements, wanted};
}

}  // namespace

std::vector<DistributedTerm> distributed_terms(const Model& model, double k, double c, double m) {
  std::vector<DistributedTerm> terms;
  if (model.distributed == nullptr) return terms;
  const DistributedMatrices& there = *model.distributed;
  const double of_stiffness = k + c * model.assembly.stiffness_damping, of_mass = m + c * model.assembly.mass_damping;
  if (of_stiffness != 0) terms.push_back({of_stiffness, there.stiffness});
  if (c != 0 && there.damping != nullptr) terms.push_back({c, there.damping});
  if (of_mass != 0) terms.push_back({of_mass, there.mass, true});
  return terms;
}

Sparse upper_sum_of(const Sparse& stiffness, const Sparse& damping, const Sparse& mass, double k, double c, double m) {
  std::vector<Term> terms;
  if (k != 0) terms.push_back({k, stiffness});
  if (c != 0) terms.push_back({c, damping});
  if (m != 0) terms.push_back({m, mass});
  return upper_sum(terms);
}

OwnedSum matrix_sum(const Model& model, double k, double c, double m) {
  if (model.distributed == nullptr) return {upper_sum_of(model.stiffness, model.damping, model.mass, k, c, m), {}};
  return {Sparse(model.free(), model.free()), distributed_terms(model, k, c, m)};
}

Vector diagonal_of(const Model& model, Sparse Model::*matrix) {
  assert(matrix == &Model::mass || matrix == &Model::stiffness);
  if (model.distributed == nullptr) return (model.*matrix).diagonal();
  return (matrix == &Model::mass ? model.distributed->mass : model.distributed->stiffness)->diagonal();
}

Vector stiffness_times(const Model& model, const Vector& u) {
  if (model.distributed == nullptr) return model.stiffness * u;
  Vector force(u.size());
  const DistributedTerm term[] = {{1, model.distributed->stiffness}};
  term[0].matrix->multiply(term, u, force);
  return force;
}

Sparse chosen_block(const Model& model, Sparse Model::*matrix, const Sparse& choice) {
  if (model.distributed == nullptr) return choice.transpose() * (model.*matrix) * choice;
  return sum_of_elements(model, matrix == &Model::mass ? &Local::mass : &Local::stiffness).reduced(choice.transpose() * model.expansion);
}

WholeMatrices::WholeMatrices(const Model& model) : model_(model), distributed_(model.distributed != nullptr) {
  if (!distributed_) return;
  sum_of_elements(model, &Local::stiffness).reduced(model.expansion).swap(stiffness_);
  sum_of_elements(model, &Local::mass).reduced(model.expansion).swap(mass_);
}

void make_whole(Model& model, std::initializer_list<Vector*> also) {
  if (model.distributed == nullptr) return;
  if (const std::vector<int> number = numbers_by_nodes(model); !number.empty()) {
    renumber(number, model);
    for (Vector* vector : also) renumber(number, *vector);
  }
  sum_of_elements(model, &Local::stiffness).reduced(model.expansion).swap(model.stiffness);
  sum_of_elements(model, &Local::mass).reduced(model.expansion).swap(model.mass);
  add_rayleigh(model, sum_of_elements(model, &Local::damping).reduced(model.expansion), model.damping);
  model.distributed.reset();
}

}  // namespace uplift
