// Supports, rigid bodies and inextensible beams as linear constraints on the full unknowns, eliminated exactly:
//   support       u = prescribed
//   equal tie     u_b = u_a
//   relation      sum of c_i x_i = 0: followers (drawn nodes of cut cells) u_f = sum of w_a u_a,  rotation_f = 0; doubles of cut cells
//   rigid tie     u_s = u_m + rotation_m x r,  rotation_s = rotation_m,   r = slave - master     (small displacements)
//   inextensible  e . (u_b - u_a) = 0,   e the unit vector from a to b
#include <fmt/format.h>

#include "uplift/model/builder.h"
#include "uplift/model/eliminate.h"

namespace uplift {

namespace {

constexpr std::string_view repeated =
    "{}, which follows from the other supports, rigid bodies and inextensible beams: its force would be undetermined; remove it{}";

/// Collects the accepted rows, and turns refusals into messages.
class ConstraintList {
 public:
  explicit ConstraintList(Elimination& elimination) : elimination_(elimination) {}

  /// Returns the number of the row; -1 for one that repeats others where that may be (`repeats`): it is left out.
  int add(const Elimination::Row& row, int preferred, const std::string& what, const std::string& advice,
          const std::vector<std::string>& motions, const Where& where, bool repeats = false) {
    switch (elimination_.add(row, preferred)) {
      case Elimination::Result::independent:
        break;
      case Elimination::Result::redundant:
        if (repeats) return -1;
        throw InputError(where, "", "constraints that do not repeat each other", fmt::format(fmt::runtime(repeated), what, advice));
      case Elimination::Result::contradictory:
        throw InputError(where, "", "constraints that agree",
                         fmt::format("{}, which contradicts the prescribed motion of another constraint (prescribed: {})", what,
                                     fmt::join(motions, ", ")));
    }
    for (const auto& [unknown, value] : row.unknowns) entries_.emplace_back(rows_, unknown, value);
    return rows_++;
  }

  int rows() const { return rows_; }

  Sparse matrix(int unknowns) const {
    Sparse matrix(rows_, unknowns);
    matrix.setFromTriplets(entries_.begin(), entries_.end());
    return matrix;
  }

 private:
  Elimination& elimination_;
  std::vector<Triplet> entries_;
  int rows_ = 0;
};

double size_of(const std::vector<Node>& nodes) {
  if (nodes.empty()) return 1;
  Vec3 low = nodes.front().position, high = low;
  for (const Node& node : nodes) {
    low = low.cwiseMin(node.position);
    high = high.cwiseMax(node.position);
  }
  const double size = (high - low).norm();
  return size > 0 ? size : 1;
}

}  // namespace

void ModelBuilder::eliminate(Model& model, Matrix& motion_shapes) const {
  const int unknowns = space_.unknowns() * static_cast<int>(nodes_.size());
  std::vector<double> scale(unknowns, 1.0);
  const double size = size_of(nodes_);
  for (int i = 0; i < unknowns; ++i)
    if (space_.is_rotation(i)) scale[i] = 1 / size;
  Elimination elimination(scale, static_cast<int>(motions_.size()));
  ConstraintList list(elimination);
  std::vector<std::string> names;
  for (const Motion& motion : motions_) names.push_back(motion.name);

  for (const Pair& tie : ties_) {
    const int m = tie.first, s = tie.second;
    const Vec3 r = nodes_[s].position - nodes_[m].position;
    const std::string what = fmt::format("a rigid body that ties \"{}\" to \"{}\"", nodes_[s].name, nodes_[m].name);
    if (m == s) throw InputError(tie.where, "", "a rigid body of different nodes", what);
    const int each = space_.unknowns();
    for (int i = 0; i < each; ++i) {
      Elimination::Row row{{{each * s + i, 1}}, {}};
      if (space_.is_rotation(i))
        row.unknowns[each * m + i] = -1;
      else
        for (int j = 0; j < each; ++j)
          if (const double moved = space_.motion(j, r).dot(space_.axis(i)); moved != 0) row.unknowns[each * m + j] = -moved;
      const int number = list.add(row, each * s + i, what, "", names, tie.where);
      if (i == 0) model.assembly.ties.push_back({s, number, r});
    }
  }
  model.assembly.first_support = list.rows();
  for (const Support& support : supports_) {
    const int unknown = space_.at(support.node, support.dof);
    Elimination::Row row{{{unknown, 1}}, {}};
    if (support.motion >= 0) row.motions[support.motion] = 1;
    list.add(row, unknown, fmt::format("a {} of {}", support.motion < 0 ? "support" : "prescribed motion", name_of(unknown)), "", names,
             support.where, support.repeats);
  }
  model.assembly.first_equal = list.rows();
  for (const Equal& tie : equals_) {
    const int a = space_.at(tie.first, tie.dof), b = space_.at(tie.second, tie.dof);
    list.add({{{a, -1}, {b, 1}}, {}}, b, fmt::format("a tie of {} to {}", name_of(a), name_of(b)), "", names, tie.where, true);
  }
  for (const Relation& relation : relations_) {
    const int unknown = relation.terms.front().first;
    Elimination::Row row;
    for (const auto& [each, factor] : relation.terms) row.unknowns[each] += factor;
    list.add(row, unknown, fmt::format("a motion of {} that follows those of others", name_of(unknown)), "", names, relation.where);
  }
  model.assembly.first_link = list.rows();
  for (const Pair& link : links_) {
    const int a = link.first, b = link.second;
    const Vec3 e = (nodes_[b].position - nodes_[a].position).normalized();
    Elimination::Row row;
    for (int k = 0; k < space_.dimension; ++k) {
      row.unknowns[space_.unknowns() * a + k] = -e[k];
      row.unknowns[space_.unknowns() * b + k] = e[k];
    }
    const std::string what = fmt::format("an inextensible beam from \"{}\" to \"{}\"", nodes_[a].name, nodes_[b].name);
    model.assembly.links.push_back({a, b, list.add(row, -1, what, ", or give the beam its area A", names, link.where)});
  }
  model.assembly.constraints = list.matrix(unknowns);
  model.expansion = elimination.reduction().transpose();
  model.kept = elimination.kept();
  motion_shapes = elimination.motions();
}

}  // namespace uplift
