#include "uplift/run/base_motion.h"

#include <map>

namespace uplift {
namespace {

using Weights = std::map<int, double>;  // of the full unknowns

/// The vertical motion of the point `reference` of a rigid body, downwards, and its rotations.
std::array<Weights, 3> weights_of_body(const Model& model, int node, const Place& reference) {
  const Space space = model.space;
  const Vec3 up = model.up(), arm = reference - model.nodes[static_cast<std::size_t>(node)].position;
  std::array<Weights, 3> weights;
  for (int k = 0; k < space.unknowns(); ++k) weights[0][model.at(node, space.dof(k))] = -space.motion(k, arm).dot(up);
  if (space.dimension == 2) {
    weights[1][model.at(node, rz)] = 1;
  } else {
    for (const int tilt : {0, 1})
      for (int k = space.dimension; k < space.unknowns(); ++k)
        weights[static_cast<std::size_t>(tilt) + 1][model.at(node, space.dof(k))] = local_axis(space, up, tilt).dot(space.axis(k));
  }
  return weights;
}

/// What a tilt about each horizontal axis lifts at a place: x in the plane, (y, -x) in space, along the axes at right angles to gravity.
Vec3 lifted(const Model& model, const Vec3& place) {
  const Space space = model.space;
  const Vec3 up = model.up(), along(local_axis(space, up, 0).dot(place), local_axis(space, up, 1).dot(place), 0);
  return space.dimension == 2 ? along : Vec3(along.y(), -along.x(), 0);
}

/// Plane u_up = c + tilt . shape that fits the nodes best, and its settlement at the point `reference`, which does not depend on how close
/// the nodes stand here and there; shape: see lifted(). No tilt where they do not span it.
std::array<Weights, 3> weights_of_nodes(const Model& model, const std::vector<int>& nodes, const Place& reference) {
  const Space space = model.space;
  const auto count = static_cast<Index>(nodes.size()), tilts = static_cast<Index>(space.dimension - 1);
  Matrix shape(count, tilts);
  for (Index i = 0; i < count; ++i) {
    const Vec3& place = model.nodes[static_cast<std::size_t>(nodes[static_cast<std::size_t>(i)])].position;
    shape.row(i) = lifted(model, place).head(tilts).transpose();
  }
  const Vector mean = shape.colwise().mean().transpose();
  shape.rowwise() -= mean.transpose();
  const Matrix inertia = shape.transpose() * shape;
  Matrix inverse = Matrix::Zero(tilts, tilts);
  const double size = inertia.trace();
  if (tilts == 1 && size > 0) inverse(0, 0) = 1 / size;
  const double det = tilts == 2 ? inertia(0, 0) * inertia(1, 1) - inertia(0, 1) * inertia(1, 0) : 0;
  if (det > 1e-12 * size * size) inverse << inertia(1, 1) / det, -inertia(0, 1) / det, -inertia(1, 0) / det, inertia(0, 0) / det;
  const Matrix slope = shape * inverse;
  const Vector away = Vector(lifted(model, reference).head(tilts)) - mean;
  const Vec3 up = model.up();
  std::array<Weights, 3> weights;
  for (Index i = 0; i < count; ++i)
    for (int axis = 0; axis < space.dimension; ++axis) {
      if (up[axis] == 0) continue;
      const int unknown = model.at(nodes[static_cast<std::size_t>(i)], space.dof(axis));
      weights[0][unknown] = up[axis] * (-1.0 / static_cast<double>(count) - slope.row(i).dot(away));
      for (Index k = 0; k < tilts; ++k) weights[static_cast<std::size_t>(k) + 1][unknown] = up[axis] * slope(i, k);
    }
  return weights;
}

}  // namespace

BaseMotion::BaseMotion(const Model& model, const Interface& interface, const std::vector<int>& nodes) {
  if (nodes.empty()) return;
  const std::array<Weights, 3> weights =
      nodes.size() == 1 ? weights_of_body(model, nodes.front(), interface.reference) : weights_of_nodes(model, nodes, interface.reference);
  for (std::size_t k = 0; k < 3; ++k) {
    Weights free;
    for (const auto& [unknown, weight] : weights[k])
      for (Sparse::InnerIterator entry(model.expansion, unknown); entry; ++entry)
        free[static_cast<int>(entry.row())] += weight * entry.value();
    for (const auto& [unknown, weight] : free)
      if (weight != 0) sums_[k].terms.emplace_back(unknown, weight);
    for (const PrescribedMotion& motion : model.motions) {
      double sum = 0;
      for (const auto& [unknown, weight] : weights[k]) sum += weight * motion.shape[unknown];
      if (sum != 0) sums_[k].functions.emplace_back(motion.function.get(), sum);
    }
  }
}

double BaseMotion::value(const Sum& sum, const State& state) {
  double total = 0;
  for (const auto& [unknown, weight] : sum.terms) total += weight * state.displacement[unknown];
  for (const auto& [function, weight] : sum.functions) total += state.load_factor * weight * function->value(state.time);
  return total;
}

void BaseMotion::look(const State& state, BasePose& pose) const {
  pose.settlement = value(sums_[0], state);
  pose.tilt_1 = value(sums_[1], state);
  pose.tilt_2 = value(sums_[2], state);
}

}  // namespace uplift
