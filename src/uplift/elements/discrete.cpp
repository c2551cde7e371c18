#include "uplift/elements/discrete.h"

#include <fmt/format.h>

#include <cassert>

#include "uplift/elements/element_entry.h"

namespace uplift {

namespace {

/// value * g g^T with g the row that gives the relative displacement.
Matrix connect(const Connection& connection, double value) {
  const auto ends = static_cast<int>(connection.nodes.size());
  assert(ends == 1 || ends == 2);
  const Space space = connection.space;
  const bool rotational = connection.rotational || !connection.direction;
  const Vec3 direction = connection.direction ? connection.direction->normalized() : Vec3(Vec3::UnitZ());
  Vector axis = Vector::Zero(space.unknowns());
  for (int i = 0; i < space.unknowns(); ++i)
    if (space.is_rotation(i) == rotational) axis[i] = space.axis(i).dot(direction);
  Vector row(ends * axis.size());
  row.head(axis.size()) = -axis;
  if (ends == 2) row.tail(axis.size()) = axis;
  return value * row * row.transpose();
}

void form_none(Matrix* wanted, Index size) {
  if (wanted) wanted->setZero(size, size);
}

/// On the unknowns of a node, of a point that is rigidly offset from it: tensors that act on its translation and on its rotation.
Matrix at_point(Space space, const Mat3& along, const Mat3& about, const Vec3& offset) {
  const int n = space.unknowns();
  Matrix matrix(n, n);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      matrix(i, j) = space.motion(i, offset).dot(along * space.motion(j, offset));
      if (space.is_rotation(i) && space.is_rotation(j)) matrix(i, j) += space.axis(i).dot(about * space.axis(j));
    }
  return matrix;
}

}  // namespace

PointMass::PointMass(int node, double mass, double inertia, Place offset) : PointMass({2}, node, mass, {0, 0, inertia}, offset) {}

PointMass::PointMass(Space space, int node, double mass, const Vec3& inertia, const Place& offset)
    : space_(space), node_(node), mass_(mass), inertia_(inertia), offset_(offset) {}

void PointMass::form(Local local) const {
  form_none(local.stiffness, space_.unknowns());
  form_none(local.damping, space_.unknowns());
  if (local.mass) *local.mass = at_point(space_, mass_ * Mat3::Identity(), Mat3(inertia_.asDiagonal()), offset_);
}

PointDashpot::PointDashpot(Space space, int node, const Mat3& along, const Mat3& about, const Vec3& offset)
    : space_(space), node_(node), along_(along), about_(about), offset_(offset) {}

void PointDashpot::form(Local local) const {
  form_none(local.stiffness, space_.unknowns());
  form_none(local.mass, space_.unknowns());
  if (local.damping) *local.damping = at_point(space_, along_, about_, offset_);
}

Connector::Connector(const Connection& connection, double value, Matrix* Local::*part)
    : space_(connection.space), nodes_(connection.nodes), matrix_(connect(connection, value)), part_(part) {}

void Connector::form(Local local) const {
  for (Matrix* Local::*part : {&Local::stiffness, &Local::mass, &Local::damping}) form_none(local.*part, matrix_.rows());
  if (Matrix* wanted = local.*part_) *wanted = matrix_;
}

namespace {

Connection connection_of(const ElementSite& site, const Values& table, bool along) {
  if (site.nodes.empty() || site.nodes.size() > 2) fail(table, "nodes", "one node or two nodes", fmt::format("{}", site.nodes.size()));
  Connection connection{.nodes = site.nodes, .direction = {}, .space = site.space, .rotational = !along};
  const bool needed = along || site.space.dimension == 3;
  if (needed != table.has("direction"))
    fail(table, needed ? "" : "direction", needed ? "a direction" : "no direction for a rotational one", needed ? "none" : "one");
  if (needed) {
    connection.direction = vector_of(table, "direction", site.space);
    if (connection.direction->norm() == 0) fail(table, "direction", "a direction", "one of length zero");
  }
  return connection;
}

/// The keys of springs and dashpots: where they act, and one of two values.
std::vector<Field> connection_fields(const Field& along, const Field& rotational) {
  return {text("name", "name").optional(), texts("nodes", "two nodes, or one (to the ground)"),
          vector("direction", "1", "direction in which it acts; in space also the axis of a rotational one").optional(),
          along.positive().optional(), rotational.positive().optional()};
}

}  // namespace

const ElementEntry& entry_element_spring() {
  static const ElementEntry entry{
      {{.name = "spring",
        .summary = "a linear spring between two nodes, or from one node to fixed ground",
        .equations = "force = stiffness d . (u_b - u_a), d: direction, does not turn with the nodes; the same with rotations",
        .source = "docs/theory, section 1",
        .params = connection_fields(number("stiffness", "N/m", "stiffness along direction"),
                                    number("rotational_stiffness", "N m/rad", "stiffness of a rotational spring"))},
       [](const ElementSite& site, const Values& table) -> std::unique_ptr<const Element> {
         const bool along = first_of_two(table, "stiffness", "rotational_stiffness");
         return std::make_unique<Spring>(connection_of(site, table, along), table.number(along ? "stiffness" : "rotational_stiffness"));
       }},
      "spring"};
  return entry;
}

const ElementEntry& entry_element_dashpot() {
  static const ElementEntry entry{
      {{.name = "dashpot",
        .summary = "a linear dashpot between two nodes, or from one node to fixed ground",
        .equations = "force = damping d . (v_b - v_a), d: direction, does not turn with the nodes; the same with rotations",
        .source = "docs/theory, section 1",
        .params = connection_fields(number("damping", "N s/m", "damping along direction"),
                                    number("rotational_damping", "N m s/rad", "damping of a rotational dashpot"))},
       [](const ElementSite& site, const Values& table) -> std::unique_ptr<const Element> {
         const bool along = first_of_two(table, "damping", "rotational_damping");
         return std::make_unique<Dashpot>(connection_of(site, table, along), table.number(along ? "damping" : "rotational_damping"));
       }},
      "dashpot"};
  return entry;
}

}  // namespace uplift
