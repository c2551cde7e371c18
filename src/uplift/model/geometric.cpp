#include "uplift/model/geometric.h"

#include <algorithm>
#include <map>

#include "uplift/math/sparse_solvers.h"

namespace uplift {

namespace {

/// Dead loads - internal forces of elements and interfaces, on the full unknowns: what the constraints must balance.
Vector unbalanced(const Model& model, const State& state) {
  const Assembly& full = model.assembly;
  Vector force = -(full.stiffness * model.full(state.displacement, 0, state.time));
  for (std::size_t i = 0; i < model.drives.size(); ++i)
    if (model.drives[i].dead && full.loads[i].size() > 0) force += model.drives[i].factor(state.time) * full.loads[i];
  if (full.b.rows() > 0) force -= full.b.transpose() * state.force;
  return force;
}

std::pair<int, int> ordered(int a, int b) {
  return std::minmax(a, b);
}

class GeometricEntries {
 public:
  void add_rotation(int node, double value) { entries_.emplace_back(dofs_per_node * node + 2, dofs_per_node * node + 2, value); }

  void add_element(std::span<const int> nodes, const Matrix& local) {
    for (Index j = 0; j < local.cols(); ++j)
      for (Index i = 0; i < local.rows(); ++i)
        if (local(i, j) != 0)
          entries_.emplace_back(dofs_per_node * nodes[i / dofs_per_node] + static_cast<int>(i % dofs_per_node),
                                dofs_per_node * nodes[j / dofs_per_node] + static_cast<int>(j % dofs_per_node), local(i, j));
  }

  /// A string of length |l| with the given tension: N/L across its axis.
  void add_string(int a, int b, const Vec2& l, double tension) {
    const Vec2 across = Vec2(-l.y(), l.x()).normalized();
    Vector row = Vector::Zero(2 * dofs_per_node);
    row.segment<2>(0) = -across;
    row.segment<2>(dofs_per_node) = across;
    const int nodes[] = {a, b};
    add_element(nodes, tension / l.norm() * row * row.transpose());
  }

  Sparse matrix(Index unknowns) const {
    Sparse matrix(unknowns, unknowns);
    matrix.setFromTriplets(entries_.begin(), entries_.end());
    return matrix;
  }

 private:
  std::vector<Triplet> entries_;
};

/// Force that an interface puts on the node of one of its rigidly offset points.
Vec2 arm_force(const Model& model, const State& state, const Assembly::Arm& arm) {
  Index first = 0;
  for (int k = 0; k < arm.interface; ++k) first += model.interfaces[k].rows();
  const Interface& face = model.interfaces[arm.interface];
  const Vec2& n = face.normal[arm.point];
  Vec2 p = state.force[first + face.batch.normal() + arm.point] * n;
  if (face.batch.components == 2) p += state.force[first + arm.point] * tangent(n);
  return arm.sign * arm.weight * p;
}

}  // namespace

Vector constraint_forces(const Model& model, const State& state) {
  const Sparse& g = model.assembly.constraints;
  if (g.rows() == 0) return Vector();
  const SparseLdlt normal(Sparse(g * g.transpose()));  // regular: repeated constraints were refused
  return -normal.solve(g * unbalanced(model, state));
}

Sparse geometric_stiffness(const Model& model, const State& state) {
  const Assembly& full = model.assembly;
  const Vector displacement = model.full(state.displacement, 0, state.time), constraint = constraint_forces(model, state);
  GeometricEntries entries;

  std::map<std::pair<int, int>, double> link_tension;
  for (const Assembly::Link& link : full.links) link_tension[ordered(link.a, link.b)] = -constraint[link.row];
  for (const auto& element : model.elements) {
    const auto nodes = element->nodes();
    Vector local(static_cast<Index>(dofs_per_node * nodes.size()));
    for (std::size_t i = 0; i < nodes.size(); ++i) local.segment<3>(static_cast<Index>(3 * i)) = displacement.segment<3>(3 * nodes[i]);
    double axial = element->axial_force(local);
    if (nodes.size() == 2) {
      const auto link = link_tension.find(ordered(nodes[0], nodes[1]));
      Matrix unit;
      element->geometric(1, unit);
      if (link != link_tension.end() && !unit.isZero(0)) {  // the beam that follows the inextensible axis
        axial += link->second;
        link_tension.erase(link);
      }
    }
    Matrix stiffness;
    element->geometric(axial, stiffness);
    entries.add_element(nodes, stiffness);
    if (const double moment = full.gravity.dot(element->first_moment()); moment != 0) entries.add_rotation(nodes[0], moment);
  }
  for (const auto& [ends, tension] : link_tension)
    entries.add_string(ends.first, ends.second, model.nodes[ends.second].position - model.nodes[ends.first].position, tension);
  // the tie's force on the slave balances everything else that acts on it
  for (const Assembly::Tie& tie : full.ties) entries.add_rotation(tie.slave, -constraint.segment<2>(tie.row).dot(tie.offset));
  for (const Assembly::Arm& arm : full.arms) entries.add_rotation(arm.node, arm_force(model, state, arm).dot(arm.offset));
  return model.reduction.transpose() * entries.matrix(model.full_unknowns()) * model.reduction;
}

}  // namespace uplift
