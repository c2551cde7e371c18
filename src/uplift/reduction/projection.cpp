#include "uplift/reduction/projection.h"

namespace uplift {

namespace {

Sparse as_sparse(const Matrix& dense) {
  return dense.sparseView(1, 0);  // all but zeros
}

/// V^T A V, symmetric to the last bit.
Sparse projected(const Sparse& a, const Matrix& basis) {
  if (a.nonZeros() == 0) return {basis.cols(), basis.cols()};
  const Matrix product = basis.transpose() * (a * basis);
  return as_sparse(0.5 * (product + product.transpose()));
}

}  // namespace

void project(Model& model, const Matrix& basis) {
  for (Sparse* matrix : {&model.stiffness, &model.mass, &model.damping}) *matrix = projected(*matrix, basis);
  model.reduction = as_sparse(model.reduction * basis);
  model.expansion = model.reduction.transpose();
  for (Interface& interface : model.interfaces) interface.b = as_sparse(interface.b * basis);
  for (TimeLoad& load : model.time_loads) load.shape = (basis.transpose() * load.shape).eval();
  for (TimeLoadTable& table : model.time_load_tables) table.pattern = as_sparse(basis.transpose() * table.pattern);
  model.assembly.modal_damping.resize(0, 0);
  model.kept.clear();
  model.unknown_names.clear();
}

void append(const EnergyProduct& product, const Vector& x, double least, Matrix& basis) {
  const double size = product.norm(x);
  Vector rest = x;
  for (int pass = 0; pass < 2; ++pass) rest -= basis * (basis.transpose() * product.times(rest));
  const double left = product.norm(rest);
  if (!(left > least * size)) return;
  rest /= left;
  rest -= basis * (basis.transpose() * product.times(rest));
  basis.conservativeResize(basis.rows(), basis.cols() + 1);
  basis.col(basis.cols() - 1) = rest / product.norm(rest);
}

}  // namespace uplift
