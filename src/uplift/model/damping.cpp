#include "uplift/model/damping.h"

#include <fmt/format.h>

#include <numbers>

#include "uplift/math/upper_sum.h"
#include "uplift/math/vibration.h"
#include "uplift/model/eliminate.h"
#include "uplift/model/matrix_sum.h"

namespace uplift {

void add_rayleigh(const Model& model, Sparse own, Sparse& damping) {
  std::vector<Term> terms{{1, own}};
  if (model.assembly.mass_damping != 0) terms.push_back({model.assembly.mass_damping, model.mass});
  if (model.assembly.stiffness_damping != 0) terms.push_back({model.assembly.stiffness_damping, model.stiffness});
  if (terms.size() == 1)
    own.swap(damping);
  else
    whole_sum(terms).swap(damping);
}

Sparse bonded_stiffness(const Model& model) {
  return bonded_stiffness(model, WholeMatrices(model).stiffness());
}

Sparse bonded_stiffness(const Model& model, const Sparse& without) {
  Sparse sum = without;
  for (const Interface& face : model.interfaces) {
    if (!face.law) continue;
    std::vector<double> closed(face.batch.components);
    face.law->closed_stiffness(face.batch.components, closed.data());
    Vector stiffness(face.rows());
    for (int c = 0; c < face.batch.components; ++c) stiffness.segment(c * face.batch.points, face.batch.points) = closed[c] * face.weight;
    sum += Sparse(face.b.transpose() * stiffness.asDiagonal() * face.b);
  }
  return sum;
}

Sparse cones_held(const Model& model) {
  std::vector<double> scale(model.free(), 1.0);
  double size = 0;
  for (const Node& node : model.nodes) size = std::max(size, (node.position - model.nodes.front().position).norm());
  for (int i = 0; i < model.free(); ++i)
    if (model.space.is_rotation(model.kept[i]) && size > 0) scale[i] = 1 / size;
  Elimination elimination(scale, 0);
  for (const Interface& face : model.interfaces) {
    if (!face.cone) continue;
    const Sparse columns = face.b.transpose();
    for (Index row = 0; row < columns.cols(); ++row) {
      Elimination::Row equation;
      for (Sparse::InnerIterator entry(columns, row); entry; ++entry) equation.unknowns[static_cast<int>(entry.row())] = entry.value();
      if (!equation.unknowns.empty()) elimination.add(equation);  // redundant under a rigid footing, as expected
    }
  }
  return elimination.reduction();
}

Sparse modal_damping(const Model& model, const std::vector<double>& ratios, int count, const Where& where) {
  constexpr int largest = 2000;
  if (model.free() > largest)
    throw InputError(where, "damping.modal",
                     fmt::format("at most {} unknowns: modal damping makes a full matrix (use Rayleigh damping)", largest),
                     fmt::format("{}", model.free()));
  const Sparse held = cones_held(model);
  const Matrix stiffness = Sparse(held.transpose() * bonded_stiffness(model) * held), mass = Sparse(held.transpose() * model.mass * held);
  const auto wanted = count > 0 ? count : static_cast<int>(ratios.size());
  const Vibration modes = vibration(stiffness, mass, wanted);
  Matrix damping = Matrix::Zero(model.free(), model.free());
  for (Index i = 0; i < modes.omega_squared.size(); ++i) {
    const double ratio = ratios[std::min<std::size_t>(i, ratios.size() - 1)];
    const Vector momentum = model.mass * (held * modes.shape.col(i));
    damping += 2 * ratio * std::sqrt(modes.omega_squared[i]) * momentum * momentum.transpose();
  }
  return damping.sparseView();
}

}  // namespace uplift
