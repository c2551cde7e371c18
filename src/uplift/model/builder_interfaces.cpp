#include <fmt/format.h>

#include <algorithm>

#include "uplift/model/builder.h"

namespace uplift {

namespace {

/// One side of one joint: its displacement along the axis, or its rotation about it, as entries of a row of B.
void add_side(Space space, const std::vector<Node>& nodes, const JointPoint& point, bool upper, const ComponentAxis& along, int row,
              std::vector<Triplet>& entries) {
  const double sign = upper ? 1 : -1;
  for (const auto& [node, shape] : upper ? point.upper : point.lower) {
    const bool rigid = upper ? point.rigid_upper : point.rigid_lower;
    const Vec3 r = point.position - nodes[node].position;
    for (int k = 0; k < (rigid ? space.unknowns() : space.dimension); ++k) {
      const bool turns = k >= space.dimension;
      const double moved = !along.rotation ? space.motion(k, r).dot(along.axis) : turns ? space.axis(k).dot(along.axis) : 0;
      if (moved != 0) entries.emplace_back(row, space.unknowns() * node + k, sign * shape * moved);
    }
  }
}

}  // namespace

/// Where supports and constraints leave no tangential motion at any point, the interface is reduced to its normal components: nothing can
/// slide there, and the laws then skip the tangential part.
void ModelBuilder::drop_dead_tangents(const Model& model, const Matrix& motion_shapes) {
  for (InterfaceSpec& spec : interfaces_) {
    if (spec.components == 1 || spec.rotations > 0) continue;
    std::vector<Triplet> entries;
    int row = 0;
    for (const JointPoint& point : spec.points) {
      for (int c = 0; c + 1 < spec.components; ++c, ++row)
        for (const bool upper : {true, false})
          add_side(space_, nodes_, point, upper, {local_axis(space_, point.normal.normalized(), c)}, row, entries);
    }
    Sparse rows(row, model.full_unknowns());
    rows.setFromTriplets(entries.begin(), entries.end());
    const Sparse free_rows = rows * model.reduction();
    const Matrix moved = rows * motion_shapes;
    const bool alive = (free_rows.nonZeros() > 0 && free_rows.coeffs().abs().maxCoeff() > 1e-14) ||
                       (moved.size() > 0 && moved.cwiseAbs().maxCoeff() > 1e-14);
    if (!alive) spec.components = 1;
  }
}

void ModelBuilder::place_interfaces(Model& model) {
  std::vector<Triplet> entries;
  int first = 0;
  for (std::size_t k = 0; k < interfaces_.size(); ++k) {
    InterfaceSpec& spec = interfaces_[k];
    refuse_inside_out(spec, interface_where_[k]);
    Interface face;
    const int points = static_cast<int>(spec.points.size());
    face.name = spec.name;
    face.space = space_;
    face.batch.points = points;
    face.batch.components = spec.components;
    face.batch.rotations = spec.rotations;
    face.reference = spec.reference;
    face.footprint = spec.footprint;
    face.area.resize(points), face.weight.resize(points);
    face.gap = Vector::Zero(face.rows());
    for (int i = 0; i < points; ++i) {
      const JointPoint& point = spec.points[i];
      face.position.push_back(point.position);
      face.normal.push_back(point.normal.normalized());
      face.area[i] = point.area;
      face.weight[i] = point.area * point.stiffness;
      face.gap[face.batch.normal() + i] = point.gap;
      for (const bool upper : {true, false}) {
        for (int c = 0; c < spec.components; ++c)
          add_side(space_, nodes_, point, upper, component_axis(face, i, c), first + c * points + i, entries);
        if (!(upper ? point.rigid_upper : point.rigid_lower)) continue;
        for (const auto& [node, shape] : upper ? point.upper : point.lower)
          model.assembly.arms.push_back({node, static_cast<int>(k), i, shape, upper ? -1.0 : 1.0, point.position - nodes_[node].position});
      }
    }
    face.law = std::move(spec.law);
    face.cone = std::move(spec.cone);
    face.behaviour = spec.behaviour;
    first += face.rows();
    model.interfaces.push_back(std::move(face));
  }
  model.assembly.b.resize(first, space_.unknowns() * static_cast<Index>(nodes_.size()));
  model.assembly.b.setFromTriplets(entries.begin(), entries.end());
  model.assembly.interface_where = interface_where_;
}

/// The water in a joint pushes both faces apart: with p = -u A at every point its load is -B^T p.
Vector ModelBuilder::water_load(const Model& model, std::size_t interface) const {
  Index first = 0;
  for (std::size_t k = 0; k < interface; ++k) first += model.interfaces[k].rows();
  const Interface& face = model.interfaces[interface];
  Vector thrust = Vector::Zero(model.assembly.b.rows());
  for (int i = 0; i < face.batch.points; ++i)
    thrust[first + face.batch.normal() + i] = interfaces_[interface].points[static_cast<std::size_t>(i)].water * face.area[i];
  return model.assembly.b.transpose() * thrust;
}

/// Places of what is connected to one side, through elements and rigid bodies: nodes and centres of masses.
std::vector<Vec3> ModelBuilder::structure_of(const InterfaceSpec& spec, bool upper, std::vector<int>& nodes) const {
  std::vector<std::vector<int>> neighbours(nodes_.size());
  const auto connect = [&](int a, int b) {
    neighbours[a].push_back(b);
    neighbours[b].push_back(a);
  };
  for (const auto& element : elements_)
    for (const int node : element->nodes()) connect(element->nodes()[0], node);
  for (const Pair& tie : ties_) connect(tie.first, tie.second);
  std::vector<char> seen(nodes_.size(), 0);
  for (const JointPoint& point : spec.points)
    for (const auto& [node, shape] : upper ? point.upper : point.lower)
      if (!seen[node]) seen[node] = 1, nodes.push_back(node);
  for (std::size_t next = 0; next < nodes.size(); ++next)
    for (const int node : neighbours[nodes[next]])
      if (!seen[node]) seen[node] = 1, nodes.push_back(node);
  std::vector<Vec3> places;
  for (const int node : nodes) places.push_back(nodes_[node].position);
  for (const auto& element : elements_) {
    const int node = element->nodes()[0];
    if (!seen[node] || element->first_moment().isZero()) continue;
    Matrix mass;
    element->form({.mass = &mass});
    places.push_back(nodes_[node].position + element->first_moment() / mass(0, 0));
  }
  return places;
}

/// The structure on the upper side must not lie altogether below a plane interface, nor the lower side above it.
void ModelBuilder::refuse_inside_out(const InterfaceSpec& spec, const Where& where) const {
  const Vec3 n = spec.points.front().normal.normalized();
  Vec3 middle = Vec3::Zero();
  for (const JointPoint& point : spec.points) {
    if ((point.normal.normalized() - n).norm() > 1e-9) return;  // not plane: the sides are not that easily told
    middle += point.position / static_cast<double>(spec.points.size());
  }
  double extent = 0;  // of the interface: beside it the place of a single node on its plane is round-off
  for (const JointPoint& point : spec.points) extent = std::max(extent, (point.position - middle).norm());
  std::vector<int> upper_nodes, lower_nodes;
  const std::vector<Vec3> upper = structure_of(spec, true, upper_nodes), lower = structure_of(spec, false, lower_nodes);
  std::ranges::sort(upper_nodes);
  for (const int node : lower_nodes)
    if (std::ranges::binary_search(upper_nodes, node)) return;  // both sides hang together
  for (const bool is_upper : {true, false}) {
    double least = 0, most = 0, size = extent;
    for (const Vec3& place : is_upper ? upper : lower) {
      size = std::max(size, (place - middle).norm());
      const double height = (is_upper ? 1 : -1) * (place - middle).dot(n);
      least = std::min(least, height);
      most = std::max(most, height);
    }
    if (least < -1e-6 * size && most <= 1e-6 * size)
      throw InputError(
          where, "interface." + spec.name, "a normal from the lower side (soil) to the upper side (structure)",
          fmt::format("an interface inside out: with the normal {} the whole {} side, which holds \"{}\", lies on the wrong side of it",
                      to_string(n, space_), is_upper ? "upper" : "lower",
                      nodes_[(is_upper ? spec.points.front().upper : spec.points.front().lower).front().first].name));
  }
}

}  // namespace uplift
