#include "uplift/model/mechanism.h"

#include <algorithm>

#include "uplift/model/eliminate.h"
#include "uplift/model/rigid_parts.h"

namespace uplift {

namespace {

using Row = Elimination::Row;

/// The largest extent of the model [m], which makes translations and rotations comparable.
double extent(const Model& model) {
  Vec3 low = model.nodes.front().position, high = low;
  for (const Node& node : model.nodes) {
    low = low.cwiseMin(node.position);
    high = high.cwiseMax(node.position);
  }
  const double size = (high - low).norm();
  return size > 0 ? size : 1;
}

/// Unknowns: the free unknowns of the model, then the rigid motions of each part.
class Equations {
 public:
  Equations(const Model& model, Resistance resistance, const std::vector<char>* holds = nullptr)
      : model_(model), holds_(holds), parts_(rigid_parts(model)), each_(model.space.unknowns()), follows_(model.free(), -1) {
    const bool dynamic = resistance != Resistance::stiffness;
    collect_other_rows(dynamic);
    if (resistance != Resistance::dynamic_open) collect_interface_rows();
    find_followers();
    if (dynamic) hold_massive_parts();
    add_part_rows();
  }

  std::vector<Vector> motions(std::size_t most) const {
    Elimination elimination(scales(), 0);
    for (const auto& [row, preferred] : rows_) elimination.add(row, preferred);
    const std::vector<int> kept = elimination.kept();
    std::vector<Vector> found;
    for (std::size_t c = 0; c < kept.size() && found.size() < most; ++c)
      if (kept[c] >= model_.free() || follows_[kept[c]] < 0) found.push_back(expand(elimination.reduction().col(static_cast<Index>(c))));
    return found;
  }

 private:
  int unknown_of(int part, int motion) const { return model_.free() + each_ * part + motion; }

  std::vector<double> scales() const {
    std::vector<double> scale(unknown_of(static_cast<int>(parts_.size()), 0), 1.0);
    const double rotation = 1 / extent(model_);
    for (int i = 0; i < model_.free(); ++i)
      if (model_.space.is_rotation(model_.kept[i])) scale[i] = rotation;
    for (int p = 0; p < static_cast<int>(parts_.size()); ++p)
      for (int j = model_.space.dimension; j < each_; ++j) scale[unknown_of(p, j)] = rotation;
    return scale;
  }

  void add_full(Row& row, int full, double factor) const {
    for (Sparse::InnerIterator entry(model_.expansion, full); entry; ++entry)
      row.unknowns[static_cast<int>(entry.row())] += factor * entry.value();
  }

  /// The rigid motion of a part at a full unknown, subtracted.
  void add_part(Row& row, int part, int full) const {
    const Space space = model_.space;
    const int index = space.index_of(full);
    const Vec3 r = model_.nodes[space.node_of(full)].position - parts_[part].middle;
    if (space.is_rotation(full)) {
      row.unknowns[unknown_of(part, index)] -= 1;
      return;
    }
    for (int j = 0; j < each_; ++j)
      if (const double moved = space.motion(j, r).dot(space.axis(index)); moved != 0) row.unknowns[unknown_of(part, j)] -= moved;
  }

  /// Columns of an element's matrix: no motion without energy has a product with one of them.
  void add_columns(const Element& element, const Matrix& matrix) {
    const auto nodes = element.nodes();
    const int each = element.unknowns_per_node();
    for (Index j = 0; j < matrix.cols(); ++j) {
      Row row;
      for (Index i = 0; i < matrix.rows(); ++i)
        if (matrix(i, j) != 0) add_full(row, each_ * nodes[i / each] + static_cast<int>(i % each), matrix(i, j));
      if (!row.unknowns.empty()) rows_.emplace_back(std::move(row), -1);
    }
  }

  void collect_other_rows(bool dynamic) {
    for (const auto& element : model_.elements) {
      if (element->continuum() != nullptr) continue;
      Matrix stiffness, mass, damping;
      const bool rigid = element->has_axis();
      element->form(
          {.stiffness = rigid ? nullptr : &stiffness, .mass = dynamic ? &mass : nullptr, .damping = dynamic ? &damping : nullptr});
      for (const Matrix* matrix : {&stiffness, &mass, &damping}) add_columns(*element, *matrix);
    }
  }

  void collect_interface_rows() {
    std::size_t first = 0;
    for (const Interface& face : model_.interfaces) {
      const int components = face.batch.components, points = face.batch.points;
      std::vector<double> closed(components, 0.0);
      if (face.law) {
        face.law->closed_stiffness(components, closed.data());
      } else {
        closed.back() = 1;
        if (face.cone->friction() > 0) std::ranges::fill(closed, 1.0);
      }
      const SparseRows openings = face.b;
      for (int r = 0; r < face.rows(); ++r) {
        if (holds_ != nullptr ? (*holds_)[first + static_cast<std::size_t>(r)] == 0 : !(closed[r / points] > 0)) continue;
        Row row;
        for (SparseRows::InnerIterator entry(openings, r); entry; ++entry) row.unknowns[static_cast<int>(entry.col())] = entry.value();
        if (!row.unknowns.empty()) rows_.emplace_back(std::move(row), -1);
      }
      first += static_cast<std::size_t>(face.rows());
    }
  }

  template <class Visit>
  void each_unknown_of_parts(const Visit& visit) const {
    for (int p = 0; p < static_cast<int>(parts_.size()); ++p)
      for (const int node : parts_[p].nodes)
        for (int d = 0; d < (parts_[p].beams ? each_ : model_.space.dimension); ++d) visit(p, each_ * node + d);
  }

  /// Free unknowns that one part moves and that occur in no other equation: they follow the part, and need no equation.
  void find_followers() {
    std::vector<char> wanted(model_.free(), 0);
    for (const auto& [row, preferred] : rows_)
      for (const auto& [unknown, value] : row.unknowns) wanted[unknown] = 1;
    std::vector<int> uses(model_.free(), 0), parts(model_.full_unknowns(), 0);
    for (Index full = 0; full < model_.expansion.cols(); ++full)
      for (Sparse::InnerIterator entry(model_.expansion, full); entry; ++entry) ++uses[entry.row()];
    each_unknown_of_parts([&](int, int full) { ++parts[full]; });
    for (int i = 0; i < model_.free(); ++i)
      if (!wanted[i] && uses[i] == 1 && parts[model_.kept[i]] == 1) follows_[i] = 0;
    each_unknown_of_parts([&](int part, int full) {
      const Sparse::InnerIterator entry(model_.expansion, full);
      if (entry && model_.kept[entry.row()] == full && follows_[entry.row()] >= 0) follows_[entry.row()] = part;
    });
  }

  void hold_massive_parts() {
    for (int p = 0; p < static_cast<int>(parts_.size()); ++p)
      for (int j = 0; parts_[p].massive && j < each_; ++j) rows_.insert(rows_.begin(), {Row{{{unknown_of(p, j), 1.0}}, {}}, -1});
  }

  /// Supports come first: what they hold need not be carried along.
  void add_part_rows() {
    std::vector<std::pair<Row, int>> supports, nodes;
    each_unknown_of_parts([&](int part, int full) {
      Sparse::InnerIterator entry(model_.expansion, full);
      const bool supported = !entry;
      const int first = supported ? -1 : static_cast<int>(entry.row());
      if (!supported && model_.kept[first] == full && follows_[first] >= 0) return;
      Row row;
      add_full(row, full, 1);
      add_part(row, part, full);
      const bool single = row.unknowns.size() > 0 && !supported && !(++entry);
      (supported ? supports : nodes).emplace_back(std::move(row), single ? first : -1);
    });
    supports.insert(supports.end(), std::make_move_iterator(nodes.begin()), std::make_move_iterator(nodes.end()));
    rows_.insert(rows_.begin(), std::make_move_iterator(supports.begin()), std::make_move_iterator(supports.end()));
  }

  Vector expand(const Vector& unknowns) const {
    Vector motion = unknowns.head(model_.free());
    for (int i = 0; i < model_.free(); ++i) {
      if (follows_[i] < 0) continue;
      Row row;
      add_part(row, follows_[i], model_.kept[i]);
      motion[i] = 0;
      for (const auto& [unknown, value] : row.unknowns) motion[i] -= value * unknowns[unknown];
    }
    return motion;
  }

  const Model& model_;
  const std::vector<char>* holds_;  // of every interface row; null: those with a closed stiffness
  std::vector<RigidPart> parts_;
  int each_;
  std::vector<int> follows_;               // of each free unknown: the part that it follows; -1: it has its own equations
  std::vector<std::pair<Row, int>> rows_;  // with the unknown that each is to eliminate, or -1
};

}  // namespace

Vector unresisted_motion(const Model& model, Resistance resistance) {
  if (model.free() == 0) return {};
  const std::vector<Vector> found = Equations(model, resistance).motions(1);
  return found.empty() ? Vector() : found.front();
}

Matrix unresisted_motions(const Model& model, const std::vector<char>& holds) {
  std::vector<Vector> found;
  if (model.free() > 0) found = Equations(model, Resistance::stiffness, &holds).motions(static_cast<std::size_t>(model.free()));
  Matrix motions(model.free(), static_cast<Index>(found.size()));
  for (std::size_t k = 0; k < found.size(); ++k) motions.col(static_cast<Index>(k)) = found[k];
  return motions;
}

}  // namespace uplift
