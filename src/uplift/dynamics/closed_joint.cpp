#include "uplift/dynamics/closed_joint.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "uplift/model/base_size.h"
#include "uplift/model/element_sum.h"
#include "uplift/model/reduced.h"

namespace uplift {
namespace {

/// Diagonal of K at the unknowns that interfaces touch, zero where it is but the round-off of terms that cancel: solids inside a rigid body
/// resist none of its motions. The sizes of the terms take a pass over all elements, which is made only where a diagonal is small. Unknowns
/// of a reduced model reach all elements, and are left as they are.
Vector resisting_diagonal(const Model& model, Vector diagonal, const Sparse& b) {
  constexpr double small = 1e-9, round_off = 1e-13;
  const double suspicious = diagonal.size() > 0 ? small * diagonal.maxCoeff() : 0;
  const std::vector<int> touched = touched_unknowns(b);
  if (is_reduced(model) || std::ranges::none_of(touched, [&](int i) { return diagonal[i] > 0 && diagonal[i] < suspicious; }))
    return diagonal;
  const Vector size = ElementSum(model.space, model.elements, &Local::stiffness).size_of_diagonal(model.expansion);
  for (const int i : touched)
    if (diagonal[i] < round_off * size[i]) diagonal[i] = 0;
  return diagonal;
}

/// N/m, of constraints under rigid bodies: the largest dead load moves them by 1e-4 of the size of the interfaces.
double stiffness_under_rigid_bodies(const Model& model) {
  double largest = 0;
  for (std::size_t k = 0; k < model.time_loads.size(); ++k) {
    if (!model.time_loads[k].dead) continue;
    double sum = 0;
    for (SparseVector::InnerIterator entry(model.assembly.loads[k]); entry; ++entry)
      if (!model.space.is_rotation(model.space.index_of(static_cast<int>(entry.index())))) sum += std::abs(entry.value());
    largest = std::max(largest, sum);
  }
  const double stiffness = 1e4 * largest / base_size(model);
  return stiffness > 0 && std::isfinite(stiffness) ? stiffness : 1;  // without a load nothing moves
}

}  // namespace

Sparse joint_stiffness(const Sparse& b, const Vector& d) {
  return b.transpose() * d.asDiagonal() * b;
}

Vector stiffness_of_parts(const Model& model, const Vector& stiffness_diagonal, const Sparse& b) {
  const Vector diagonal = resisting_diagonal(model, stiffness_diagonal, b);
  Vector compliance = Vector::Zero(b.rows());
  for (int column = 0; column < b.outerSize(); ++column)
    for (Sparse::InnerIterator entry(b, column); entry; ++entry)
      if (diagonal[column] > 0) compliance[entry.row()] += entry.value() * entry.value() / diagonal[column];
  return compliance.unaryExpr([](double each) { return each > 0 ? 1 / each : std::numeric_limits<double>::infinity(); });
}

Vector closed_joint(const Model& model, const Vector& stiffness_diagonal, const Sparse& b, const Behaviours& behaviours) {
  int rows = 0;
  for (const Interface& interface : model.interfaces) rows += interface.rows();
  Vector result = Vector::Zero(rows);
  double largest = 0;
  for (int i = 0; i < model.free(); ++i) largest = std::max(largest, stiffness_diagonal[i]);
  const bool rigid = !(largest > 0);
  if (rigid) largest = stiffness_under_rigid_bodies(model);
  // A joint far stiffer than the structure would leave nothing of the structure's stiffness in the factored sum once it is taken back.
  constexpr double stiffest = 1e6, beside_parts = 1e3;
  const Vector parts = stiffness_of_parts(model, stiffness_diagonal, b);
  int first = 0;
  for (std::size_t i = 0; i < model.interfaces.size(); ++i) {
    const Interface& interface = model.interfaces[i];
    const int n = interface.batch.points, components = interface.batch.components;
    double stiffness[most_components] = {};
    if (behaviours.interfaces[i].law != nullptr) behaviours.interfaces[i].law->closed_stiffness(components, stiffness);
    for (int c = 0; c < components; ++c)
      for (int p = 0; p < n; ++p) {
        const int row = first + c * n + p;
        double& value = result[row];
        if (behaviours.interfaces[i].law != nullptr)
          value = rigid ? stiffness[c] * interface.weight[p] : std::min(stiffness[c] * interface.weight[p], stiffest * largest);
        else if (c == components - 1 || behaviours.interfaces[i].cone->friction() > 0)
          value = std::min(largest / n, beside_parts * parts[row]);
      }
    first += interface.rows();
  }
  return result;
}

}  // namespace uplift
