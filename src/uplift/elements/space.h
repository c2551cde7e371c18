#pragma once
#include <cassert>
#include <string>
#include <string_view>

#include "uplift/math/linalg.h"

namespace uplift {

/// What a node can do: translations [m], then rotations [rad], right-handed about the axes.
enum class Dof : unsigned char { ux, uy, uz, rx, ry, rz };
using enum Dof;
std::string_view to_string(Dof dof);

/// Plane or space: which unknowns a node has, in this order. Plane: ux, uy, rz (counter-clockwise). Space: ux, uy, uz, rx, ry, rz.
struct Space {
  int dimension = 2;
  int up() const { return dimension - 1; }  // the vertical axis: y in the plane, z in space
  /// Of one node; the first `dimension` of them are translations.
  int unknowns() const { return dimension == 2 ? 3 : 6; }
  int rotations() const { return unknowns() - dimension; }
  bool has(Dof dof) const { return dimension == 3 || dof == ux || dof == uy || dof == rz; }
  /// Number of an unknown of a node among its own.
  int index(Dof dof) const {
    assert(has(dof));
    return dimension == 2 && dof == rz ? 2 : static_cast<int>(dof);
  }
  Dof dof(int index) const { return dimension == 2 && index == 2 ? rz : static_cast<Dof>(index); }
  /// Number of an unknown among those of all nodes, and back.
  int at(int node, Dof dof) const { return unknowns() * node + index(dof); }
  int node_of(Index unknown) const { return static_cast<int>(unknown) / unknowns(); }
  int index_of(Index unknown) const { return static_cast<int>(unknown) % unknowns(); }
  bool is_rotation(Index unknown) const { return index_of(unknown) >= dimension; }
  /// Direction of a translation, axis of a rotation.
  Vec3 axis(int index) const { return Vec3::Unit(static_cast<int>(dof(index)) % 3); }
  /// What the unknown `index` of a node moves a point that is rigidly offset by r [m] from it.
  Vec3 motion(int index, const Vec3& r) const { return index < dimension ? axis(index) : cross(axis(index), r); }
};

/// "(1, 0)" in the plane, "(1, 0, 0)" in space.
std::string to_string(const Vec3& v, Space space, int digits = 6);

}  // namespace uplift
