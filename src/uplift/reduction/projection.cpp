#include "uplift/reduction/projection.h"

#include "uplift/linear/blas.h"
#include "uplift/math/dense.h"

namespace uplift {

namespace {

Sparse as_sparse(const Matrix& dense) {
  return dense.sparseView(1, 0);  // all but zeros
}

/// V^T A V.
Sparse projected(const Sparse& a, const Matrix& basis) {
  if (a.nonZeros() == 0) return {basis.cols(), basis.cols()};
  return as_sparse(symmetric_projection(a, basis));
}

/// The rows T V of some full unknowns, zero for the others: of all of them the matrix is full.
Sparse shown_rows(const Model& model, const Matrix& basis, const std::vector<int>& shown) {
  Sparse columns(basis.cols(), model.full_unknowns());
  columns.reserve(static_cast<Index>(shown.size()) * basis.cols());
  auto next = shown.begin();
  for (Index full = 0; full < columns.cols(); ++full) {
    columns.startVec(full);
    if (next == shown.end() || *next != full) continue;
    ++next;
    Vector row = Vector::Zero(basis.cols());
    for (Sparse::InnerIterator entry(model.expansion, full); entry; ++entry) row += entry.value() * basis.row(entry.row()).transpose();
    for (Index k = 0; k < row.size(); ++k)
      if (row[k] != 0) columns.insertBack(k, full) = row[k];
  }
  columns.finalize();
  return columns;
}

Sparse diagonal(const Vector& values) {
  Sparse matrix(values.size(), values.size());
  matrix.reserve(Vector::Ones(values.size()).cast<int>());
  for (Index i = 0; i < values.size(); ++i) matrix.insert(i, i) = values[i];
  return matrix;
}

/// Without entries beside the diagonal, where these are round-off.
Sparse without_round_off(const Sparse& matrix) {
  const Vector values = matrix.diagonal();
  const double least = 1e-12 * values.cwiseAbs().maxCoeff();
  for (Index column = 0; column < matrix.outerSize(); ++column)
    for (Sparse::InnerIterator entry(matrix, column); entry; ++entry)
      if (entry.row() != entry.col() && std::abs(entry.value()) > least) return matrix;
  return diagonal(values);
}

/// All but the matrices.
void project_all_else(Model& model, const Matrix& basis, const std::vector<int>* shown) {
  if (shown != nullptr)
    shown_rows(model, basis, *shown).swap(model.expansion);
  else
    model.expansion = as_sparse(model.reduction() * basis).transpose();
  for (Interface& interface : model.interfaces) interface.b = as_sparse(interface.b * basis);
  project_loads(model, basis);
}

}  // namespace

Matrix symmetric_projection(const Sparse& a, const Matrix& v) {
  constexpr Index at_once = 64;  // columns of A V that exist at the same time
  Matrix projected(v.cols(), v.cols());
  for (Index first = 0; first < v.cols(); first += at_once) {
    const Matrix some = v.middleCols(first, std::min(at_once, v.cols() - first));
    Matrix product = Matrix::Zero(some.rows(), some.cols());
    add_symmetric_product(1, a, some, product);
    projected.middleCols(first, some.cols()) = transposed_product(v, product);
  }
  return 0.5 * (projected + projected.transpose());
}

void project(Model& model, const Matrix& basis, const std::vector<int>* shown) {
  for (Sparse* matrix : {&model.stiffness, &model.mass, &model.damping}) *matrix = projected(*matrix, basis);
  project_all_else(model, basis, shown);
}

void project_on_modes(Model& model, double w, Matrix& basis, const std::vector<int>* shown) {
  const Matrix stiffness = symmetric_projection(model.stiffness, basis), mass = symmetric_projection(model.mass, basis);
  const GeneralisedEigen modes(mass, stiffness + (w * w) * mass);  // M x = m (K + w^2 M) x
  const Vector& m = modes.eigenvalues();
  if (!(m.minCoeff() > 1e-13 * m.maxCoeff())) return project(model, basis, shown);
  Matrix turned = Matrix::Zero(basis.rows(), basis.cols());
  add_product(1, basis, modes.eigenvectors(), turned);
  basis.swap(turned);
  model.stiffness = diagonal(modes.eigenvectors().cwiseProduct(stiffness * modes.eigenvectors()).colwise().sum());
  model.mass = diagonal(m);
  model.damping = without_round_off(projected(model.damping, basis));
  project_all_else(model, basis, shown);
}

void project_loads(Model& model, const Matrix& basis) {
  for (TimeLoad& load : model.time_loads) load.shape = (basis.transpose() * load.shape).eval();
  for (TimeLoadTable& table : model.time_load_tables) table.pattern = as_sparse(basis.transpose() * table.pattern);
  model.assembly.modal_damping.resize(0, 0);
  model.kept.clear();
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

Index orthonormalise(const EnergyProduct& product, const Eigen::Ref<const Matrix>& basis, double least, Matrix& vectors) {
  Matrix products = product.times(vectors);
  const Vector sizes = vectors.cwiseProduct(products).colwise().sum().cwiseMax(0).cwiseSqrt();
  for (int pass = 0; pass < 2; ++pass) {
    add_product(-1, basis, transposed_product(basis, products), vectors);
    products = product.times(vectors);
  }
  Matrix kept(vectors.rows(), 0);
  for (Index k = 0; k < vectors.cols(); ++k) {
    const Index before = kept.cols();
    append(product, vectors.col(k), sizes[k] > 0 ? least * sizes[k] / product.norm(vectors.col(k)) : 1, kept);
    if (kept.cols() == before) continue;
    Vector added = kept.col(before);
    added -= basis * (basis.transpose() * product.times(added));
    kept.col(before) = added / product.norm(added);
  }
  vectors = std::move(kept);
  return vectors.cols();
}

}  // namespace uplift
