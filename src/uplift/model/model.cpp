#include "uplift/model/model.h"

#include <fmt/format.h>

#include "uplift/math/small.h"

namespace uplift {

double TimeLoad::factor(double time) const {
  return derivative_of(*function, static_cast<int>(order), time);
}

int Model::rows() const {
  int rows_of_all = 0;
  for (const Interface& face : interfaces) rows_of_all += face.rows();
  return rows_of_all;
}

Vec3 Model::up() const {
  return assembly.gravity.isZero(0) ? space.axis(space.up()) : Vec3(-assembly.gravity.normalized());
}

int Model::find_node(std::string_view name) const {
  for (std::size_t i = 0; i < nodes.size(); ++i)
    if (nodes[i].name == name) return static_cast<int>(i);
  const auto second = second_names.find(name);
  return second != second_names.end() ? second->second : -1;
}

std::string Model::name_of(int full_unknown) const {
  const std::string& node = nodes[static_cast<std::size_t>(space.node_of(full_unknown))].name;
  return fmt::format("{}.{}", node, to_string(space.dof(space.index_of(full_unknown))));
}

std::string Model::unknown_name(Index free) const {
  return free < std::ssize(kept) ? name_of(kept[static_cast<std::size_t>(free)]) : fmt::format("{}", free);
}

double Model::full(int full_unknown, const Vector& q, int derivative, MotionInstant at) const {
  double value = 0;
  for (Sparse::InnerIterator entry(expansion, full_unknown); entry; ++entry) value += entry.value() * q[entry.row()];
  for (const PrescribedMotion& motion : motions)
    if (motion.shape[full_unknown] != 0)
      value += at.share * motion.shape[full_unknown] * derivative_of(*motion.function, derivative, at.time);
  return value;
}

Vector Model::expand(const Vector& q) const {
  Vector full(full_unknowns());
  for (Index i = 0; i < full.size(); ++i) {
    double sum = 0;
    for (Sparse::InnerIterator entry(expansion, i); entry; ++entry) sum += entry.value() * q[entry.row()];
    full[i] = sum;
  }
  return full;
}

Vector Model::full(const Vector& q, int derivative, MotionInstant at) const {
  Vector value = expand(q);
  for (const PrescribedMotion& motion : motions) value += motion.shape * (at.share * derivative_of(*motion.function, derivative, at.time));
  return value;
}

double Model::ground_acceleration(const Vec3& direction, double time) const {
  double value = 0;
  for (const GroundAcceleration& ground : grounds)
    if (const double share = ground.direction.dot(direction); share != 0) value += share * ground.function->value(time);
  return value;
}

void Model::add_force(double time, Vector& force) const {
  add_constant_force(force);
  add_varying_force(time, force);
}

void Model::add_constant_force(Vector& force) const {
  for (const TimeLoad& time_load : time_loads)
    if (time_load.constant) force += time_load.shape;
}

void Model::add_varying_force(double time, Vector& force) const {
  for (const TimeLoad& time_load : time_loads)
    if (!time_load.constant)
      if (const double factor = time_load.factor(time); factor != 0) small::add(force.size(), factor, time_load.shape.data(), force.data());
  if (time_load_tables.empty()) return;
  Vector values;
  for (const TimeLoadTable& table : time_load_tables) {
    table.functions->values(time, values);
    force += table.pattern * values;
  }
}

void Model::add_prescribed_opening(double time, Vector& opening) const {
  for (const PrescribedMotion& motion : motions) opening += motion.function->value(time) * motion.opening;
}

}  // namespace uplift
