#pragma once
#include <optional>

#include "uplift/elements/element.h"

namespace uplift {

/// Mass on a node, its centre rigidly offset by c. In the plane
///   M = [m, 0, -m cy; 0, m, m cx; -m cy, m cx, J + m |c|^2],   J about the centre;
/// in space J is a diagonal tensor in the global axes.
class PointMass : public Element {
 public:
  /// Plane: mass [kg] >= 0, inertia about the centre [kg m2] >= 0, offset of the centre from the node [m].
  PointMass(int node, double mass, double inertia = 0, Place offset = {});
  /// Inertia about the three axes; in the plane only the last one counts.
  PointMass(Space space, int node, double mass, const Vec3& inertia, const Place& offset = {});
  std::span<const int> nodes() const override { return {&node_, 1}; }
  int unknowns_per_node() const override { return space_.unknowns(); }
  void form(Local local) const override;
  Vec3 first_moment() const override { return mass_ * offset_; }

 private:
  Space space_;
  int node_;
  double mass_;
  Vec3 inertia_, offset_;
};

/// Dashpots from one point to fixed ground, as tensors in the global axes for its velocity [N s/m] and its angular velocity [N m s/rad];
/// the point is rigidly offset from the node [m]. In the plane rotations about z alone count.
class PointDashpot : public Element {
 public:
  PointDashpot(Space space, int node, const Mat3& along, const Mat3& about, const Vec3& offset);
  std::span<const int> nodes() const override { return {&node_, 1}; }
  int unknowns_per_node() const override { return space_.unknowns(); }
  void form(Local local) const override;

 private:
  Space space_;
  int node_;
  Mat3 along_, about_;
  Vec3 offset_;
};

/// What a spring or dashpot connects: one node to fixed ground, or two nodes; their translations or rotations along a fixed direction.
/// Its force is value * d . (u_b - u_a), the direction d does not turn with the nodes.
struct Connection {
  std::vector<int> nodes;          // 1 (to ground) or 2
  std::optional<Place> direction;  // unit vector is made; absent: rotations about z
  Space space{};
  bool rotational = false;  // of the direction: rotations about it (space only)
};

/// A spring or a dashpot.
class Connector : public Element {
 public:
  /// `part`: the matrix that it adds to.
  Connector(const Connection& connection, double value, Matrix* Local::*part);
  std::span<const int> nodes() const override { return nodes_; }
  int unknowns_per_node() const override { return space_.unknowns(); }
  void form(Local local) const override;

 private:
  Space space_;
  std::vector<int> nodes_;
  Matrix matrix_;
  Matrix* Local::*part_;
};

/// Linear spring, stiffness in N/m or N m/rad.
struct Spring final : Connector {
  Spring(const Connection& connection, double stiffness) : Connector(connection, stiffness, &Local::stiffness) {}
};

/// Linear dashpot, damping in N s/m or N m s/rad.
struct Dashpot final : Connector {
  Dashpot(const Connection& connection, double damping) : Connector(connection, damping, &Local::damping) {}
};

}  // namespace uplift
