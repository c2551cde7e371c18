#pragma once
#include <optional>

#include "uplift/elements/element.h"

namespace uplift {

/// Mass on a node, its centre rigidly offset by c = (cx, cy):
///   M = [m, 0, -m cy; 0, m, m cx; -m cy, m cx, J + m |c|^2],   J about the centre.
class PointMass : public Element {
 public:
  /// mass [kg] >= 0, inertia about the centre [kg m2] >= 0, offset of the centre from the node [m].
  PointMass(int node, double mass, double inertia = 0, Vec2 offset = Vec2::Zero());
  std::span<const int> nodes() const override { return {&node_, 1}; }
  void form(Local local) const override;
  Vec2 first_moment() const override { return mass_ * offset_; }

 private:
  int node_;
  double mass_, inertia_;
  Vec2 offset_;
};

/// What a spring or dashpot connects: one node to fixed ground, or two nodes; along a fixed direction, or the rotations.
/// Its force is value * d . (u_b - u_a), the direction d does not turn with the nodes.
struct Connection {
  std::vector<int> nodes;         // 1 (to ground) or 2
  std::optional<Vec2> direction;  // unit vector is made; absent: rotational
};

/// Linear spring, stiffness in N/m or N m/rad.
class Spring : public Element {
 public:
  Spring(Connection connection, double stiffness);
  std::span<const int> nodes() const override { return nodes_; }
  void form(Local local) const override;

 private:
  std::vector<int> nodes_;
  Matrix stiffness_;
};

/// Linear dashpot, damping in N s/m or N m s/rad.
class Dashpot : public Element {
 public:
  Dashpot(Connection connection, double damping);
  std::span<const int> nodes() const override { return nodes_; }
  void form(Local local) const override;

 private:
  std::vector<int> nodes_;
  Matrix damping_;
};

}  // namespace uplift
