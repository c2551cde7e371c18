#include "uplift/model/tuned_mass.h"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>
#include <set>

#include "uplift/math/dense.h"
#include "uplift/math/sparse_solvers.h"
#include "uplift/model/eliminate.h"
#include "uplift/model/matrix_sum.h"

namespace uplift {

Sparse base_held(const Model& model) {
  std::set<int> held;
  for (Index unknown = 0; unknown < model.assembly.b.cols(); ++unknown)
    for (Sparse::InnerIterator entry(model.assembly.b, unknown); entry; ++entry)
      if (entry.value() != 0) held.insert(model.space.node_of(unknown));
  double size = 0;
  for (const Node& node : model.nodes) size = std::max(size, (node.position - model.nodes.front().position).norm());
  std::vector<double> scale(model.free(), 1.0);
  for (int i = 0; i < model.free(); ++i)
    if (model.space.is_rotation(model.kept[i]) && size > 0) scale[i] = 1 / size;
  Elimination elimination(scale, 0);
  for (const int node : held)
    for (int i = 0; i < model.space.unknowns(); ++i) {
      Elimination::Row row;
      for (Sparse::InnerIterator entry(model.expansion, model.space.unknowns() * node + i); entry; ++entry)
        row.unknowns[static_cast<int>(entry.row())] = entry.value();
      if (!row.unknowns.empty()) elimination.add(row);
    }
  return elimination.reduction();
}

double tuned_mass(const Model& model, int node, double frequency, const Where& where) {
  const Sparse held = base_held(model);
  const double omega_squared = std::pow(2 * std::numbers::pi * frequency, 2);
  const WholeMatrices whole(model);
  Sparse dynamic = held.transpose() * (whole.stiffness() - omega_squared * whole.mass()) * held;
  const Matrix at_node = Matrix(model.expansion.middleCols(model.space.unknowns() * node, model.space.dimension));
  const Matrix direction = held.transpose() * at_node;
  const auto refuse = [&](const std::string& found) {
    throw InputError(where, "mass.tuned_frequency",
                     fmt::format("a first fixed-base frequency of {:g} Hz by the mass on \"{}\"", frequency, model.nodes[node].name),
                     found);
  };
  if (direction.isZero(1e-12)) refuse("a node that cannot move when the base is held");
  // unknowns that only the missing mass would resist, or nothing at all, play no part
  for (Index i = 0; i < dynamic.rows(); ++i)
    if (dynamic.coeff(i, i) == 0) {
      if (direction.row(i).isZero(1e-12))
        dynamic.coeffRef(i, i) = 1;
      else
        refuse("a node that nothing holds");
    }
  const Vector diagonal = dynamic.diagonal();
  const SparseLdlt ldlt(dynamic);
  const Vector pivots = ldlt.permutationPinv() * Vector(ldlt.vectorD());
  for (Index i = 0; i < pivots.size(); ++i)
    if (!(pivots[i] > 1e-13 * diagonal[i])) refuse("a structure that is loose or has its first frequency below already without this mass");
  const Matrix flexibility = direction.transpose() * Matrix(ldlt.solve(direction));
  return 1 / (omega_squared * SymmetricEigen(flexibility).eigenvalues().maxCoeff());
}

}  // namespace uplift
