#include "uplift/mesh/facing.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>

#include "uplift/base/text.h"
#include "uplift/mesh/absent_group.h"
#include "uplift/mesh/cell_shapes.h"
#include "uplift/mesh/index.h"
#include "uplift/mesh/sides.h"

namespace uplift {
namespace {

/// A face of a group with its nodes numbered with the normal out of its cell.
struct OuterFace {
  CellId cell;
  std::vector<int> nodes;
};

std::vector<OuterFace> outer_faces(const Mesh& mesh, const Sides& sides, const std::string& name, const Where& where) {
  const std::string wanted = mesh.dimension == 2 ? "edges on the surface of a solid" : "faces on the surface of a solid";
  const auto found = mesh.groups.find(name);
  if (found == mesh.groups.end()) throw absent_group(mesh, name, where, "", wanted);
  if (found->second.dimension != mesh.dimension - 1 || found->second.cells.empty())
    throw InputError(where, "", "a group of " + wanted, in_quotes(name));
  std::vector<OuterFace> faces;
  for (const CellId cell : found->second.cells) {
    const int side = sides.find(mesh.type(cell), mesh.cell(cell));
    if (side < 0 || sides.twin(side) >= 0)
      throw InputError(where, "", wanted, describe_cell(mesh, cell) + (side < 0 ? " beside no cell" : " between two cells"));
    faces.push_back({cell, {}});
    sides.nodes_of(mesh, side, faces.back().nodes);
  }
  return faces;
}

std::vector<int> nodes_of(const std::vector<OuterFace>& faces) {
  std::vector<int> nodes;
  for (const OuterFace& face : faces) nodes.insert(nodes.end(), face.nodes.begin(), face.nodes.end());
  std::ranges::sort(nodes);
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

/// Mean of the outward normals, weighted with the areas.
Vec3 mean_normal(const Mesh& mesh, const std::vector<OuterFace>& faces, const std::string& name, const Where& where) {
  Vec3 sum = Vec3::Zero();
  double area = 0;
  std::vector<Vec3> positions;
  for (const OuterFace& face : faces) {
    const Cell cell = mesh.type(face.cell);
    positions.clear();
    for (const int node : face.nodes) positions.push_back(mesh.nodes[at(node)]);
    const Vec3 vector = cell_area_vector(cell_shape(cell, cell_centre(cell)), positions, cell);
    sum += vector, area += vector.norm();
  }
  if (!(sum.norm() > 0.5 * area))
    throw InputError(where, "", "a group of faces that look in about the same direction",
                     in_quotes(name) + ", whose normals point all round");
  return sum.normalized();
}

double shortest_edge(const Mesh& mesh, const std::vector<OuterFace>& faces) {
  double least = std::numeric_limits<double>::infinity();
  for (const OuterFace& face : faces) {
    const auto corners = at(info(mesh.type(face.cell)).corners);
    for (std::size_t i = 0; i < corners; ++i)
      least = std::min(least, (mesh.nodes[at(face.nodes[i])] - mesh.nodes[at(face.nodes[(i + 1) % corners])]).norm());
  }
  return least;
}

/// The node of the upper side opposite to each node of the lower side.
std::map<int, int> opposite_nodes(const Mesh& mesh, const std::vector<int>& lower, const std::vector<int>& upper, const Vec3& normal,
                                  double tolerance, const Where& where) {
  const auto flat = [&](int node) -> Vec3 { return mesh.nodes[at(node)] - mesh.nodes[at(node)].dot(normal) * normal; };
  Vec3 along = std::abs(normal.x()) < 0.9 ? Vec3::UnitX() : Vec3::UnitY();
  along = (along - along.dot(normal) * normal).normalized();
  std::multimap<double, int> row;  // upper nodes along a direction
  for (const int node : upper) row.emplace(mesh.nodes[at(node)].dot(along), node);
  std::map<int, int> partner;
  for (const int node : lower) {
    const double place = mesh.nodes[at(node)].dot(along);
    int found = -1;
    for (auto next = row.lower_bound(place - tolerance); next != row.end() && next->first <= place + tolerance; ++next)
      if (next->second != node && (flat(next->second) - flat(node)).norm() <= tolerance) found = next->second;
    const Vec3& x = mesh.nodes[at(node)];
    if (found < 0)
      throw InputError(where, "",
                       fmt::format("opposite to every node of the lower group one of the upper group, within {:.3g} m", tolerance),
                       fmt::format("none opposite to ({:.6g}, {:.6g}, {:.6g}) m", x.x(), x.y(), x.z()));
    partner.emplace(node, found);
  }
  return partner;
}

std::vector<int> sorted(std::vector<int> nodes) {
  std::ranges::sort(nodes);
  return nodes;
}

void renumber(Mesh& mesh, CellId cell, const std::vector<int>& nodes) {
  std::vector<int>& all = mesh.blocks[at(cell.block)].nodes;
  std::ranges::copy(nodes, all.begin() + static_cast<std::ptrdiff_t>(at(cell.index) * nodes.size()));
}

}  // namespace

std::vector<FacePair> facing_pairs(Mesh& mesh, const std::string& lower, const std::string& upper, const Where& where) {
  const Sides sides(mesh, full_cells(mesh));
  const std::vector<OuterFace> below = outer_faces(mesh, sides, lower, where), above = outer_faces(mesh, sides, upper, where);
  if (below.size() != above.size())
    throw InputError(where, "", fmt::format("two groups with the same number of faces: {} has {}", in_quotes(lower), below.size()),
                     fmt::format("{} in {}", above.size(), in_quotes(upper)));
  const std::map<int, int> partner = opposite_nodes(mesh, nodes_of(below), nodes_of(above), mean_normal(mesh, below, lower, where),
                                                    1e-3 * shortest_edge(mesh, below), where);
  std::map<std::vector<int>, CellId> face_above;
  for (const OuterFace& face : above) face_above.emplace(sorted(face.nodes), face.cell);
  std::vector<FacePair> pairs;
  std::vector<std::vector<int>> upper_nodes;
  for (const OuterFace& face : below) {
    std::vector<int> nodes;
    for (const int node : face.nodes) nodes.push_back(partner.at(node));
    const auto found = face_above.find(sorted(nodes));
    if (found == face_above.end())
      throw InputError(where, "", "opposite to every face of the lower group one of the upper group with the same nodes",
                       "none opposite to " + describe_cell(mesh, face.cell));
    pairs.push_back({face.cell, found->second});
    upper_nodes.push_back(std::move(nodes));
  }
  for (std::size_t i = 0; i < pairs.size(); ++i)
    renumber(mesh, pairs[i].lower, below[i].nodes), renumber(mesh, pairs[i].upper, upper_nodes[i]);
  return pairs;
}

}  // namespace uplift
