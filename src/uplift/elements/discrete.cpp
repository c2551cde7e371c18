#include "uplift/elements/discrete.h"

#include <cassert>

namespace uplift {

namespace {

/// value * g g^T with g the row that gives the relative displacement.
Matrix connect(const Connection& connection, double value) {
  const auto ends = static_cast<int>(connection.nodes.size());
  assert(ends == 1 || ends == 2);
  Vec3 axis = Vec3::UnitZ();
  if (connection.direction) axis << connection.direction->normalized(), 0;
  Vector row = Vector::Zero(dofs_per_node * ends);
  row.head<3>() = -axis;
  if (ends == 2) row.tail<3>() = axis;
  return value * row * row.transpose();
}

void form_one(Matrix* wanted, const Matrix& matrix) {
  if (wanted) *wanted = matrix;
}
void form_none(Matrix* wanted, Index size) {
  if (wanted) wanted->setZero(size, size);
}

}  // namespace

PointMass::PointMass(int node, double mass, double inertia, Vec2 offset) : node_(node), mass_(mass), inertia_(inertia), offset_(offset) {}

void PointMass::form(Local local) const {
  form_none(local.stiffness, 3);
  form_none(local.damping, 3);
  if (!local.mass) return;
  const double m = mass_, x = offset_.x(), y = offset_.y();
  local.mass->resize(3, 3);
  *local.mass << m, 0, -m * y, 0, m, m * x, -m * y, m * x, inertia_ + m * (x * x + y * y);
}

Spring::Spring(Connection connection, double stiffness) : nodes_(connection.nodes), stiffness_(connect(connection, stiffness)) {}

void Spring::form(Local local) const {
  form_one(local.stiffness, stiffness_);
  form_none(local.mass, stiffness_.rows());
  form_none(local.damping, stiffness_.rows());
}

Dashpot::Dashpot(Connection connection, double damping) : nodes_(connection.nodes), damping_(connect(connection, damping)) {}

void Dashpot::form(Local local) const {
  form_none(local.stiffness, damping_.rows());
  form_none(local.mass, damping_.rows());
  form_one(local.damping, damping_);
}

}  // namespace uplift
