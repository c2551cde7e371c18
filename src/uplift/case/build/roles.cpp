#include "uplift/case/build/roles.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "uplift/interface/face_joint.h"

namespace uplift {
namespace {

constexpr double cosine_of_45_degrees = 0.70710678118654752;
constexpr double round_off = 1e-9;  // a face at exactly 45 degrees belongs to the base

/// Mean normal of a face of the mesh, from the lower to the upper side. Zero for a face that cannot open.
Vec3 normal_of_face(const Mesh& mesh, const FacePair& face) {
  Vec3 sum = Vec3::Zero();
  for (const JointPoint& point : face_points(mesh, {face}, FaceQuadrature::gauss, 1, 0)) sum += point.area * point.normal;
  return sum.norm() > 0 ? Vec3(sum.normalized()) : sum;
}

/// Which of these unit normals belong to a base.
std::vector<bool> base_normals(const std::vector<Vec3>& normals, const Vec3& up) {
  std::vector<bool> found;
  for (const double sense : {1.0, -1.0}) {
    found.clear();
    for (const Vec3& normal : normals) found.push_back(sense * normal.dot(up) >= cosine_of_45_degrees - round_off);
    if (std::ranges::count(found, true) > 0) break;
  }
  return found;
}

template <class Item>
std::pair<std::vector<Item>, std::vector<Item>> divided(const std::vector<Item>& items, const std::vector<bool>& first) {
  std::pair<std::vector<Item>, std::vector<Item>> made;
  for (std::size_t i = 0; i < items.size(); ++i) (first[i] ? made.first : made.second).push_back(items[i]);
  return made;
}

/// The joints of one [[interface]] with their roles: one, or base and walls.
std::vector<Joint> joints_of(const CaseInterface& table, const std::vector<FacePair>& open, const std::vector<CutFace>& cut, const Vec3& up,
                             bool rigid_ground, ModelBuilder& builder, CaseNames& names) {
  const auto joint_of = [&](const std::vector<FacePair>& faces) { return make_joint(table, faces, cut, rigid_ground, builder, names); };
  if (table.role) {
    Joint joint = joint_of(open);
    joint.facts.role = *table.role;
    return {std::move(joint)};
  }
  std::vector<Vec3> normals;
  if (!open.empty()) {
    for (const FacePair& face : open) normals.push_back(normal_of_face(names.solids->mesh(), face));
    const auto [bases, walls] = divided(open, base_normals(normals, up));
    if (bases.empty() || walls.empty()) {
      std::vector<Joint> made{joint_of(open)};
      if (bases.empty()) made.front().facts.role = Role::wall;
      return made;
    }
    std::vector<Joint> made{joint_of(bases), joint_of(walls)};
    made.back().facts.role = Role::wall;
    return made;
  }
  Joint joint = joint_of(open);
  for (const JointPoint& point : joint.points) normals.push_back(point.normal.normalized());
  auto [bases, walls] = divided(joint.points, base_normals(normals, up));
  if (bases.empty()) joint.facts.role = Role::wall;
  if (bases.empty() || walls.empty()) return {std::move(joint)};
  std::vector<Joint> made{with_points(joint, std::move(bases)), with_points(joint, std::move(walls))};
  made.back().facts.role = Role::wall;
  return made;
}

}  // namespace

Vec3 upward(const CaseInput& input) {
  const Vec3 down = input.gravity ? input.gravity->acceleration : Vec3::Zero();
  return down.norm() > 0 ? Vec3(-down.normalized()) : input.space.axis(input.space.up());
}

std::vector<InterfacePart> interface_parts(const Case& read, bool rigid_ground, ModelBuilder& builder, CaseNames& names) {
  const std::vector<CaseInterface>& tables = read.input->interfaces;
  const Vec3 up = upward(*read.input);
  std::vector<InterfacePart> parts;
  for (std::size_t k = 0; k < tables.size(); ++k) {
    const std::string& name = tables[k].name.name;
    names.interfaces.add(tables[k].name);
    const std::vector<FacePair> none;
    const std::vector<CutFace> no_cut;
    std::vector<Joint> joints = joints_of(tables[k], read.mesh ? read.mesh->open[k] : none, read.mesh ? read.mesh->cut[k] : no_cut, up,
                                          rigid_ground, builder, names);
    for (Joint& joint : joints) {
      const bool second = &joint != &joints.front();
      InterfacePart part{&tables[k], tables[k].law, second ? name + " walls" : name, std::move(joint)};
      if (second) names.interfaces.add(part.name, tables[k].name.where(), tables[k].name.path());
      part.joint.facts.name = part.name;
      part.water = tables[k].water.has_value();
      parts.push_back(std::move(part));
    }
  }
  for (const CaseFoundation& table : read.input->foundations) {
    names.interfaces.add(table.name);
    InterfacePart part{&table, table.model, table.name.name, {}, &table, footprint_of(table, names.space)};
    part.joint = foundation_joint(table, *part.footprint, names);
    parts.push_back(std::move(part));
  }
  std::ranges::stable_partition(parts, [](const InterfacePart& part) { return part.joint.facts.role == Role::base; });
  return parts;
}

}  // namespace uplift
