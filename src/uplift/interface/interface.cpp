#include "uplift/interface/interface.h"

#include <cmath>

namespace uplift {

Vec3 local_axis(Space space, const Vec3& normal, int axis) {
  if (axis == space.dimension - 1) return normal;
  if (space.dimension == 2) return {normal.y(), -normal.x(), 0};
  const Vec3 along = std::abs(normal.x()) < 0.9 ? Vec3::UnitX() : Vec3::UnitY();
  const Vec3 first = (along - along.dot(normal) * normal).normalized();
  return axis == 0 ? first : cross(normal, first);
}

Vec3 turned_axis(const Vec3& normal, double azimuth, int axis) {
  constexpr Space space{3};
  if (axis == 2) return normal;
  const double c = std::cos(azimuth), s = std::sin(azimuth);
  const Vec3 first = local_axis(space, normal, 0), second = local_axis(space, normal, 1);
  return axis == 0 ? Vec3(c * first + s * second) : Vec3(c * second - s * first);
}

ComponentAxis component_axis(const Interface& interface, int point, int component) {
  const Space space = interface.space;
  const Vec3& normal = interface.normal[static_cast<std::size_t>(point)];
  const int translations = interface.batch.translations();
  const bool rotation = component >= translations;
  if (space.dimension == 2 && rotation) return {Vec3::UnitZ(), true};
  const int axis = rotation ? component - translations : component + space.dimension - translations;
  const double azimuth = interface.footprint ? interface.footprint->azimuth : 0;
  return {azimuth == 0 ? local_axis(space, normal, axis) : turned_axis(normal, azimuth, axis), rotation};
}

Vec3 mean_normal(const Interface& interface) {
  Vec3 sum = Vec3::Zero();
  for (int i = 0; i < interface.batch.points; ++i) sum += interface.area[i] * interface.normal[static_cast<std::size_t>(i)];
  constexpr double a_direction = 0.5;  // of the area; half a cylinder has 2/pi, two opposite walls have nothing
  return sum.norm() > a_direction * interface.area.sum() ? Vec3(sum.normalized()) : interface.space.axis(interface.space.up());
}

Matrix resultant_rows(const Interface& interface) {
  const Space space = interface.space;
  const int points = interface.batch.points, components = interface.batch.components, d = space.dimension;
  const Vec3 mean = mean_normal(interface);
  Matrix rows(space.unknowns(), interface.rows());
  for (int i = 0; i < points; ++i) {
    const Vec3 arm = interface.position[static_cast<std::size_t>(i)] - interface.reference;
    for (int c = 0; c < components; ++c) {
      const auto [axis, rotation] = component_axis(interface, i, c);
      const Vec3 force = rotation ? Vec3(Vec3::Zero()) : axis, moment = rotation ? axis : cross(arm, axis);
      auto column = rows.col(c * points + i);
      for (int k = 0; k < d; ++k) column[k] = force.dot(local_axis(space, mean, k));
      for (int k = 0; k < space.rotations(); ++k) column[d + k] = d == 2 ? moment.z() : moment.dot(local_axis(space, mean, k));
    }
  }
  return rows;
}

Resultant resultant_of(Space space, const double* sums) {
  if (space.dimension == 2) return {.axial = sums[1], .shear = sums[0], .moment = sums[2]};
  return {.axial = sums[2],
          .shear = std::hypot(sums[0], sums[1]),
          .moment = std::hypot(sums[3], sums[4]),
          .shear_1 = sums[0],
          .shear_2 = sums[1],
          .moment_1 = sums[3],
          .moment_2 = sums[4],
          .torsion = sums[5]};
}

Resultant resultant(const Interface& interface, const double* force) {
  const Vector sums = resultant_rows(interface) * ConstMap(force, interface.rows());
  return resultant_of(interface.space, sums.data());
}

double uplifted_ratio(const Interface& interface, const double* opening, double tolerance) {
  const double* normal_opening = opening + interface.batch.normal();
  double open = 0;
  for (int i = 0; i < interface.batch.points; ++i)
    if (normal_opening[i] > tolerance) open += interface.area[i];
  return open / interface.area.sum();
}

}  // namespace uplift
