#include <Spectra/SymEigsSolver.h>

#include <cmath>
#include <numbers>

#include "uplift/linear/solver.h"
#include "uplift/math/sparse_solvers.h"
#include "uplift/math/vibration.h"

namespace uplift {

const Entry<LinearSolver>& entry_solver_cholmod();

namespace {

constexpr Index largest_dense = 500, largest_dense_matrix = 1500;  // massive unknowns, all unknowns

std::vector<Mode> to_modes(const Vibration& vibration) {
  std::vector<Mode> modes;
  for (Index i = 0; i < vibration.omega_squared.size(); ++i)
    modes.push_back({std::sqrt(std::max(vibration.omega_squared[i], 0.0)) / (2 * std::numbers::pi), vibration.shape.col(i)});
  return modes;
}

/// W with W W^T = M on all unknowns, sparse; a massless unknown has an empty row.
Sparse sparse_root(const Sparse& mass, const std::vector<int>& massive) {
  const auto size = static_cast<Index>(massive.size());
  Sparse select(mass.rows(), size);
  for (Index k = 0; k < size; ++k) select.insert(massive[k], k) = 1;
  Sparse block = select.transpose() * mass * select;
  const Vector scale = Vector(block.diagonal()).cwiseSqrt();
  block = scale.cwiseInverse().asDiagonal() * block * scale.cwiseInverse().asDiagonal();
  // a trace of mass (relative 1e-13) keeps the factorisation of a semidefinite block going; its pivots are dropped again
  for (Index k = 0; k < size; ++k) block.coeffRef(k, k) += 1e-13;
  const SparseLdlt ldlt(block);
  const Vector pivots = ldlt.vectorD();
  std::vector<Triplet> entries;
  Index rank = 0;
  for (Index k = 0; k < size; ++k)
    if (pivots[k] > 1e-12) entries.emplace_back(k, rank++, std::sqrt(pivots[k]));
  Sparse diagonal(size, rank);
  diagonal.setFromTriplets(entries.begin(), entries.end());
  const Sparse lower = ldlt.matrixL();
  const Sparse permuted = ldlt.permutationPinv() * Sparse(lower * diagonal);
  return select * Sparse(scale.asDiagonal() * permuted);
}

/// y -> W^T A^-1 W y: the flexibility seen by the masses.
class Flexibility {
 public:
  using Scalar = double;
  Flexibility(const Factor& factor, const Sparse& root) : factor_(factor), root_(root) {}
  Index rows() const { return root_.cols(); }
  Index cols() const { return root_.cols(); }
  void perform_op(const double* x, double* y) const {
    const Matrix force = root_ * ConstMap(x, rows());
    Matrix answer;
    factor_.solve(force, answer);
    Map(y, rows()) = root_.transpose() * answer.col(0);
  }

 private:
  const Factor& factor_;
  const Sparse& root_;
};

Vibration lanczos(const Factor& factor, const Sparse& root, double shift, int count) {
  Flexibility flexibility(factor, root);
  const Index size = root.cols(), wanted = std::min<Index>(count, size - 1);
  const Index basis = std::min<Index>(size, std::max<Index>(2 * wanted + 10, 20));
  Spectra::SymEigsSolver<Flexibility> solver(flexibility, wanted, basis);
  solver.init();
  const Index found = solver.compute(Spectra::SortRule::LargestAlge, 300, 1e-12);
  Vibration result{Vector(found), Matrix(root.rows(), found)};
  if (found == 0) return result;
  const Vector mu = solver.eigenvalues();
  const Matrix y = solver.eigenvectors();
  Matrix force = root * y;
  factor.solve(force, result.shape);
  for (Index i = 0; i < found; ++i) {
    result.omega_squared[i] = 1 / mu[i] - shift;
    Index largest = 0;
    result.shape.col(i).cwiseAbs().maxCoeff(&largest);
    result.shape.col(i) /= result.shape(largest, i) < 0 ? -mu[i] : mu[i];
  }
  return result;
}

Vibration sparse_vibration(const Sparse& stiffness, const Sparse& mass, const std::vector<int>& massive, int count) {
  const auto solver = entry_solver_cholmod().make(Values());
  const Sparse root = sparse_root(mass, massive);
  Factorisation plain = solver->factorise(stiffness);
  if (plain.factor) return lanczos(*plain.factor, root, 0, count);
  // Rigid motions: K + shift M. The shift is placed near the first elastic w^2, so that rigid motions are told from slow ones and Lanczos
  // finds the slow ones quickly. The first guess lies far below the smallest Rayleigh quotient of a single unknown.
  double shift = 0;
  for (const int i : massive) {
    const double quotient = stiffness.coeff(i, i) / mass.coeff(i, i);
    if (quotient > 0 && (shift == 0 || quotient < shift)) shift = quotient;
  }
  shift *= 1e-9;
  constexpr double rigid = 1e-7;
  constexpr int extra = 6;  // enough elastic modes beside the rigid ones to place the shift
  Vibration result;
  for (int pass = 0; pass < 8 && shift > 0; ++pass) {
    const Factorisation shifted = solver->factorise(stiffness + shift * mass);
    if (!shifted.factor) {
      shift *= 1e3;  // lost in the round-off of K, or a massless mechanism that no shift helps
      continue;
    }
    result = lanczos(*shifted.factor, root, shift, count + extra);
    double first = 0;
    for (Index i = 0; i < result.omega_squared.size() && first == 0; ++i)
      if (result.omega_squared[i] > rigid * shift) first = result.omega_squared[i];
    if (first == 0 || (first > 1e-3 * shift && first < 1e5 * shift)) break;
    shift = first;
  }
  for (double& value : result.omega_squared)
    if (value <= rigid * shift) value = 0;
  const Index found = std::min<Index>(count, result.omega_squared.size());
  return {result.omega_squared.head(found), result.shape.leftCols(found)};
}

}  // namespace

std::vector<Mode> modes(const Sparse& stiffness, const Sparse& mass, int count) {
  std::vector<int> massive;
  for (int i = 0; i < mass.rows(); ++i)
    if (mass.coeff(i, i) > 0) massive.push_back(i);
  if (static_cast<Index>(massive.size()) <= largest_dense && mass.rows() <= largest_dense_matrix)
    return to_modes(vibration(Matrix(stiffness), Matrix(mass), count));
  return to_modes(sparse_vibration(stiffness, mass, massive, count));
}

}  // namespace uplift
