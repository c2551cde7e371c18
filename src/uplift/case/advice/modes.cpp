#include <vector>

#include "uplift/case/case.h"
#include "uplift/case/mesh/mesh.h"
#include "uplift/model/damping.h"
#include "uplift/model/matrix_sum.h"
#include "uplift/model/tuned_mass.h"

namespace uplift {
namespace {

/// Modes of the motions that the columns of `held` span.
std::vector<Mode> modes_within(const Sparse& held, const Sparse& stiffness, const Sparse& mass, int count) {
  if (held.cols() == 0) return {};
  const Sparse to_held = held.transpose();
  std::vector<Mode> found = modes(to_held * stiffness * held, to_held * mass * held, count);
  for (Mode& mode : found) mode.shape = held * mode.shape;
  return found;
}

/// Nodes of all interfaces that are on the upper (lower) side: those whose shape functions have a positive (negative) integral in the
/// normal openings.
std::vector<int> nodes_of_sides(const Model& model, bool upper) {
  Vector integral = Vector::Zero(static_cast<Index>(model.nodes.size()));
  const SparseRows rows = model.assembly.b;
  Index row = 0;
  for (const Interface& face : model.interfaces) {
    row += face.batch.normal();
    for (int i = 0; i < face.batch.points; ++i, ++row)
      for (SparseRows::InnerIterator entry(rows, row); entry; ++entry)
        if (const int dof = model.space.index_of(entry.col()); dof < model.space.dimension)
          integral[model.space.node_of(entry.col())] += face.area[i] * entry.value() * face.normal[static_cast<std::size_t>(i)][dof];
    row += face.rows() - face.batch.normal() - face.batch.points;
  }
  std::vector<int> nodes;
  for (int node = 0; node < static_cast<int>(integral.size()); ++node)
    if (upper ? integral[node] > 0 : integral[node] < 0) nodes.push_back(node);
  return nodes;
}

/// Only the columns that move something else than ground: what is connected to lower sides alone stands still.
Sparse without_ground(const Sparse& held, const Model& model) {
  const std::vector<char> above = part_of(model, nodes_of_sides(model, true)), below = part_of(model, nodes_of_sides(model, false));
  std::vector<Triplet> chosen;
  for (int column = 0, next = 0; column < static_cast<int>(held.cols()); ++column) {
    bool ground = true;
    for (Sparse::InnerIterator entry(held, column); entry; ++entry) {
      const auto node = static_cast<std::size_t>(model.space.node_of(model.kept[static_cast<std::size_t>(entry.row())]));
      ground = ground && below[node] && !above[node];
    }
    if (!ground) chosen.emplace_back(column, next++, 1.0);
  }
  Sparse select(held.cols(), static_cast<Index>(chosen.size()));
  select.setFromTriplets(chosen.begin(), chosen.end());
  return held * select;
}

}  // namespace

std::vector<Mode> bonded_modes(const Model& model, int count) {
  const WholeMatrices whole(model);
  return modes_within(cones_held(model), bonded_stiffness(model, whole.stiffness()), whole.mass(), count);
}

std::vector<Mode> fixed_base_modes(const Model& model, int count) {
  const WholeMatrices whole(model);
  return modes_within(without_ground(base_held(model), model), whole.stiffness(), whole.mass(), count);
}

std::vector<Mode> base_free_modes(const Model& model, int count) {
  const WholeMatrices whole(model);
  return modes(whole.stiffness(), whole.mass(), count);
}

}  // namespace uplift
