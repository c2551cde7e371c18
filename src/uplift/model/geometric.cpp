#include "uplift/model/geometric.h"

#include <algorithm>
#include <map>

#include "uplift/math/sparse_solvers.h"

namespace uplift {

namespace {

/// Dead loads - internal forces of elements and interfaces, on the full unknowns: what the constraints must balance.
Vector unbalanced(const Model& model, const State& state) {
  const Assembly& full = model.assembly;
  Vector force = -(assembled(model, &Local::stiffness) * model.full(state.displacement, 0, state.time));
  for (std::size_t i = 0; i < model.time_loads.size(); ++i)
    if (model.time_loads[i].dead && full.loads[i].size() > 0) force += model.time_loads[i].factor(state.time) * full.loads[i];
  if (full.b.rows() > 0) force -= full.b.transpose() * state.force;
  return force;
}

std::pair<int, int> ordered(int a, int b) {
  return std::minmax(a, b);
}

class GeometricEntries {
 public:
  explicit GeometricEntries(Space space) : space_(space) {}

  /// A dead force f at the offset r [N m when summed]: potential -f . (theta x (theta x r))/2.
  void add_rotation(int node, const Vec3& f, const Vec3& r) {
    for (int i = space_.dimension; i < space_.unknowns(); ++i)
      for (int j = space_.dimension; j < space_.unknowns(); ++j) {
        const Vec3 a = space_.axis(i), b = space_.axis(j);
        const double value = f.dot(r) * a.dot(b) - (f.dot(a) * r.dot(b) + f.dot(b) * r.dot(a)) / 2;
        if (value != 0) entries_.emplace_back(space_.unknowns() * node + i, space_.unknowns() * node + j, value);
      }
  }

  void add_element(std::span<const int> nodes, int each, const Matrix& local) {
    for (Index j = 0; j < local.cols(); ++j)
      for (Index i = 0; i < local.rows(); ++i)
        if (local(i, j) != 0)
          entries_.emplace_back(space_.unknowns() * nodes[i / each] + static_cast<int>(i % each),
                                space_.unknowns() * nodes[j / each] + static_cast<int>(j % each), local(i, j));
  }

  /// A string of length |l| with the given tension: N/L across its axis.
  void add_string(int a, int b, const Vec3& l, double tension) {
    const int d = space_.dimension, nodes[] = {a, b};
    const Vec3 e = l.normalized();
    const Matrix across = (Matrix::Identity(d, d) - e.head(d) * e.head(d).transpose()) * (tension / l.norm());
    Matrix local(2 * d, 2 * d);
    local << across, -across, -across, across;
    add_element(nodes, d, local);
  }

  Sparse matrix(Index unknowns) const {
    Sparse matrix(unknowns, unknowns);
    matrix.setFromTriplets(entries_.begin(), entries_.end());
    return matrix;
  }

 private:
  Space space_;
  std::vector<Triplet> entries_;
};

/// Force that an interface puts on the node of one of its rigidly offset points.
Vec3 arm_force(const Model& model, const State& state, const Assembly::Arm& arm) {
  Index first = 0;
  for (int k = 0; k < arm.interface; ++k) first += model.interfaces[k].rows();
  const Interface& face = model.interfaces[arm.interface];
  Vec3 p = Vec3::Zero();
  for (int c = 0; c < face.batch.translations(); ++c)
    p += state.force[first + c * face.batch.points + arm.point] * component_axis(face, arm.point, c).axis;
  return arm.sign * arm.weight * p;
}

/// The translations' part of the constraint rows that start at `row`.
Vec3 force_of(const Vector& constraint, int row, Space space) {
  Vec3 force = Vec3::Zero();
  for (int k = 0; k < space.dimension; ++k) force[k] = constraint[row + k];
  return force;
}

}  // namespace

Vector constraint_forces(const Model& model, const State& state) {
  const Sparse& g = model.assembly.constraints;
  if (g.rows() == 0) return Vector();
  const SparseLdlt normal(Sparse(g * g.transpose()));  // regular: repeated constraints were refused
  return -normal.solve(g * unbalanced(model, state));
}

Sparse geometric_stiffness(const Model& model, const State& state) {
  return geometric_stiffness(model, state, model.reduction());
}

Sparse geometric_stiffness(const Model& model, const State& state, const Sparse& reduction) {
  return reduction.transpose() * second_order(model, state).stiffness * reduction;
}

SecondOrder second_order(const Model& model, const State& state) {
  SecondOrder made;
  const Assembly& full = model.assembly;
  const Vector displacement = model.full(state.displacement, 0, state.time), constraint = constraint_forces(model, state);
  const Space space = model.space;
  GeometricEntries entries(space);

  std::map<std::pair<int, int>, double> link_tension;
  for (const Assembly::Link& link : full.links) link_tension[ordered(link.a, link.b)] = -constraint[link.row];
  for (const auto& element : model.elements) {
    const auto nodes = element->nodes();
    const int each = element->unknowns_per_node();
    Vector local(each * static_cast<Index>(nodes.size()));
    for (std::size_t i = 0; i < nodes.size(); ++i)
      local.segment(each * static_cast<Index>(i), each) = displacement.segment(space.unknowns() * nodes[i], each);
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
    made.axial.push_back(axial);
    Matrix stiffness;
    element->geometric(axial, stiffness);
    entries.add_element(nodes, each, stiffness);
    entries.add_rotation(nodes[0], full.gravity, element->first_moment());
  }
  for (const auto& [ends, tension] : link_tension)
    entries.add_string(ends.first, ends.second, model.nodes[ends.second].position - model.nodes[ends.first].position, tension);
  // the tie's force on the slave balances everything else that acts on it
  for (const Assembly::Tie& tie : full.ties) entries.add_rotation(tie.slave, -force_of(constraint, tie.row, space), tie.offset);
  for (const Assembly::Arm& arm : full.arms) entries.add_rotation(arm.node, arm_force(model, state, arm), arm.offset);
  made.stiffness = entries.matrix(model.full_unknowns());
  return made;
}

}  // namespace uplift
