#include "uplift/verdict/foundation.h"

#include <algorithm>
#include <cmath>

#include "uplift/verdict/numbers.h"

namespace uplift {
namespace {

/// A force and its moment in the global axes.
struct Wrench {
  Vec3 force = Vec3::Zero(), moment = Vec3::Zero();  // N, N m
};

/// The resultant of one interface, whose parts are given in its own axes, moved to another point.
class Mover {
 public:
  Mover(const Interface& interface, const Place& to) : plane_(interface.space.dimension == 2), arm_(interface.reference - to) {
    const Vec3 normal = mean_normal(interface);
    for (int k = 0; k < interface.space.dimension; ++k) axes_[static_cast<std::size_t>(k)] = local_axis(interface.space, normal, k);
  }
  Wrench at(const StepRecord::Instant& now) const {
    Wrench made;
    const Vec3& normal = axes_[plane_ ? 1 : 2];
    made.force = now.axial * normal + now.shear_1 * axes_[0];
    if (plane_) {
      made.moment = now.moment_1 * Vec3::UnitZ();
    } else {
      made.force += now.shear_2 * axes_[1];
      made.moment = now.moment_1 * axes_[0] + now.moment_2 * axes_[1] + now.torsion * normal;
    }
    made.moment += cross(arm_, made.force);
    return made;
  }

 private:
  bool plane_;
  Vec3 arm_;
  std::array<Vec3, 3> axes_{};
};

Vec3 without(const Vec3& vector, const Vec3& axis) {
  return vector - vector.dot(axis) * axis;
}

/// The point to which the moments of all interfaces refer: that of the base, of several their middle by area.
Place middle_of_bases(const BuiltCase& built) {
  const std::vector<Interface>& interfaces = built.model.interfaces;
  if (built.bases() < 2) return interfaces.front().reference;
  Vec3 sum = Vec3::Zero();
  double area = 0;
  for (std::size_t k = 0; k < built.bases(); ++k) {
    sum += built.facts[k].area * (interfaces[k].reference - interfaces.front().reference);
    area += built.facts[k].area;
  }
  return interfaces.front().reference + sum / area;
}

}  // namespace

FoundationForces foundation_forces(const BuiltCase& built, const RunResult& run) {
  const Model& model = built.model;
  const StepRecord& steps = run.steps;
  FoundationForces made;
  std::vector<Mover> movers;
  const Place middle = middle_of_bases(built);
  for (const Interface& interface : model.interfaces) movers.emplace_back(interface, middle);
  const Vec3 up = model.up();
  const auto shear_of = [&](std::size_t i, std::size_t k) { return without(movers[k].at(steps.at(i, k)).force, up); };
  const auto moment_of = [&](std::size_t i, std::size_t k) { return without(movers[k].at(steps.at(i, k)).moment, up); };
  const auto total = [&](std::size_t i, const auto& of) {
    Vec3 sum = Vec3::Zero();
    for (std::size_t k = 0; k < movers.size(); ++k) sum += of(i, k);
    return sum;
  };
  Vec3 rest = Vec3::Zero();
  std::size_t at_shear = 0, at_moment = 0;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    Vec3 force = Vec3::Zero();
    for (std::size_t k = 0; k < movers.size(); ++k) force += movers[k].at(steps.at(i, k)).force;
    if (i == 0) rest = force;
    made.least = std::max({made.least, noise_share * (force - rest).norm(), round_off_share * force.norm()});
    if (const double shear = without(force, up).norm(); shear > made.shear.value) made.shear = {shear, steps.time[i]}, at_shear = i;
    if (const double moment = total(i, moment_of).norm(); moment > made.moment.value) made.moment = {moment, steps.time[i]}, at_moment = i;
  }
  const auto shares = [&](std::size_t i, const auto& of) {
    const Vec3 sum = total(i, of);
    std::vector<double> found(movers.size(), 0.0);
    for (std::size_t k = 0; k < movers.size(); ++k)
      if (sum.squaredNorm() > 0) found[k] = of(i, k).dot(sum) / sum.squaredNorm();
    return found;
  };
  if (steps.size() > 0) made.share_of_shear = shares(at_shear, shear_of), made.share_of_moment = shares(at_moment, moment_of);
  return made;
}

}  // namespace uplift
