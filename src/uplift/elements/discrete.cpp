#include "uplift/elements/discrete.h"

#include <cassert>

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

void form_one(Matrix* wanted, const Matrix& matrix) {
  if (wanted) *wanted = matrix;
}
void form_none(Matrix* wanted, Index size) {
  if (wanted) wanted->setZero(size, size);
}

}  // namespace

PointMass::PointMass(int node, double mass, double inertia, Place offset) : PointMass({2}, node, mass, {0, 0, inertia}, offset) {}

PointMass::PointMass(Space space, int node, double mass, const Vec3& inertia, const Place& offset)
    : space_(space), node_(node), mass_(mass), inertia_(inertia), offset_(offset) {}

void PointMass::form(Local local) const {
  const int n = space_.unknowns();
  form_none(local.stiffness, n);
  form_none(local.damping, n);
  if (!local.mass) return;
  local.mass->resize(n, n);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      (*local.mass)(i, j) = mass_ * space_.motion(i, offset_).dot(space_.motion(j, offset_));
      if (i == j && space_.is_rotation(i)) (*local.mass)(i, j) += inertia_.dot(space_.axis(i));
    }
}

Spring::Spring(Connection connection, double stiffness)
    : space_(connection.space), nodes_(connection.nodes), stiffness_(connect(connection, stiffness)) {}

void Spring::form(Local local) const {
  form_one(local.stiffness, stiffness_);
  form_none(local.mass, stiffness_.rows());
  form_none(local.damping, stiffness_.rows());
}

Dashpot::Dashpot(Connection connection, double damping)
    : space_(connection.space), nodes_(connection.nodes), damping_(connect(connection, damping)) {}

void Dashpot::form(Local local) const {
  form_none(local.stiffness, damping_.rows());
  form_none(local.mass, damping_.rows());
  form_one(local.damping, damping_);
}

}  // namespace uplift
