#include <cmath>
#include <numbers>

#include "uplift/linear/flexibility.h"
#include "uplift/linear/solver.h"
#include "uplift/math/vibration.h"

namespace uplift {

const Entry<LinearSolver>& entry_solver_cholmod();

namespace {

constexpr Index few_masses = 500, small_matrix = 1500;  // massive unknowns, all unknowns
constexpr double strain_round_off = 1e-14;              // of |x|^T |K| |x|
constexpr double shape_round_off = 1e-14;               // of the largest component
constexpr double rigid_share = 1e-7;                    // of the first elastic w^2

std::vector<Mode> to_modes(const Vibration& vibration) {
  std::vector<Mode> modes;
  for (Index i = 0; i < vibration.omega_squared.size(); ++i) {
    Vector shape = vibration.shape.col(i);
    const double largest = shape.cwiseAbs().maxCoeff();
    for (double& value : shape)
      if (std::abs(value) < shape_round_off * largest) value = 0;
    modes.push_back({std::sqrt(std::max(vibration.omega_squared[i], 0.0)) / (2 * std::numbers::pi), std::move(shape)});
  }
  return modes;
}

/// The strain energy of a shape is only what round-off has left of its terms.
bool without_strain(const Sparse& stiffness, const Sparse& sizes, const Vector& shape) {
  const Vector size = shape.cwiseAbs();
  return std::abs(shape.dot(stiffness * shape)) <= strain_round_off * size.dot(sizes * size);
}

struct Task {
  const Sparse &stiffness, &mass;
  const std::vector<int>& massive;
  bool few() const { return static_cast<Index>(massive.size()) <= few_masses; }

  Vibration through(const Factor& factor, double shift, int count, bool repeated) const {
    const Flexible found = few() ? flexible_dense(factor, mass, massive, count) : flexible_lanczos(factor, mass, count, repeated);
    return {(found.mu.cwiseInverse().array() - shift).matrix(), found.shape};
  }
};

/// K + s M with s near the first elastic w^2, so that rigid motions are told from slow ones and the slow ones keep their digits.
Vibration with_rigid_motions(const Task& task, const LinearSolver& solver, int count) {
  // The first guess lies far below the smallest Rayleigh quotient of a single unknown.
  double shift = 0;
  for (const int i : task.massive) {
    const double quotient = task.stiffness.coeff(i, i) / task.mass.coeff(i, i);
    if (quotient > 0 && (shift == 0 || quotient < shift)) shift = quotient;
  }
  shift *= 1e-6;
  constexpr int extra = 6;  // enough elastic modes beside the rigid ones to place the shift
  Vibration result;
  for (int pass = 0; pass < 8 && shift > 0; ++pass) {
    const Factorisation shifted = solver.factorise(task.stiffness + shift * task.mass);
    if (!shifted.factor) {
      shift *= 1e3;  // lost in the round-off of K, or a massless mechanism that no shift helps
      continue;
    }
    result = task.through(*shifted.factor, shift, count + extra, false);
    double first = 0;
    for (Index i = 0; i < result.omega_squared.size() && first == 0; ++i)
      if (result.omega_squared[i] > rigid_share * shift) first = result.omega_squared[i];
    if (first == 0 || (first > 1e-3 * shift && first < 1e2 * shift)) {
      if (!task.few()) result = task.through(*shifted.factor, shift, count, true);
      break;
    }
    shift = first;
  }
  for (double& value : result.omega_squared)
    if (value <= rigid_share * shift) value = 0;
  const Index found = std::min<Index>(count, result.omega_squared.size());
  return {result.omega_squared.head(found), result.shape.leftCols(found)};
}

Vibration sparse_vibration(const Task& task, int count) {
  const auto solver = entry_solver_cholmod().make(Values());
  if (const Factorisation plain = solver->factorise(task.stiffness); plain.factor) {
    Vibration found = task.through(*plain.factor, 0, count, true);
    const Sparse sizes = task.stiffness.cwiseAbs();
    bool rigid = false;
    for (Index i = 0; i < found.omega_squared.size(); ++i) rigid = rigid || without_strain(task.stiffness, sizes, found.shape.col(i));
    if (!rigid) return found;
  }
  return with_rigid_motions(task, *solver, count);
}

}  // namespace

std::vector<Mode> modes(const Sparse& stiffness, const Sparse& mass, int count) {
  std::vector<int> massive;
  for (int i = 0; i < mass.rows(); ++i)
    if (mass.coeff(i, i) > 0) massive.push_back(i);
  if (massive.empty()) return {};
  const Task task{stiffness, mass, massive};
  if (task.few() && mass.rows() <= small_matrix) return to_modes(vibration(Matrix(stiffness), Matrix(mass), count));
  return to_modes(sparse_vibration(task, count));
}

}  // namespace uplift
