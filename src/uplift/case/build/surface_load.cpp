#include "uplift/case/build/surface_load.h"

#include "uplift/mesh/cell_quadrature.h"
#include "uplift/mesh/cell_shapes.h"

namespace uplift {
namespace {

/// The reference triangle or square in n x n parts, the reference line in n parts: the rule on each of them.
CellRule divided_rule(Cell cell, const CellRule& rule, int n) {
  const Cell shape = info(cell).linear;
  CellRule made;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < (shape == Cell::line2 ? 1 : n); ++j)
      for (std::size_t k = 0; k < rule.point.size(); ++k) {
        const Vec3& at = rule.point[k];
        const double weight = rule.weight[k] / (shape == Cell::line2 ? n : n * n);
        const auto add = [&](double r, double s) {
          made.point.emplace_back(r, s, 0);
          made.weight.push_back(weight);
        };
        if (shape != Cell::tri3) {
          add((2 * i + 1 + at.x()) / n - 1, shape == Cell::line2 ? 0 : (2 * j + 1 + at.y()) / n - 1);
          continue;
        }
        if (i + j < n) add((i + at.x()) / n, (j + at.y()) / n);
        if (i + j < n - 1) add((i + 1 - at.x()) / n, (j + 1 - at.y()) / n);
      }
  return made;
}

}  // namespace

std::vector<SurfaceShare> surface_shares(const CaseSolids& solids, const std::vector<CellId>& faces, const Profile* profile) {
  constexpr int degree = 7;  // quad9: shape function 2, vector of area 3, profile 2 in each direction
  const Mesh& mesh = solids.mesh();
  std::vector<SurfaceShare> shares;
  std::vector<Vec3> positions;
  for (const CellId face : faces) {
    const Cell cell = mesh.type(face);
    const std::vector<int> outward = solids.outward_nodes(face);
    const std::span<const int> nodes = outward.empty() ? mesh.cell(face) : std::span<const int>(outward);
    const double thickness = mesh.dimension == 2 ? solids.beside(face)->section.thickness : 1;
    positions.clear();
    for (const int node : nodes) positions.push_back(mesh.nodes[static_cast<std::size_t>(node)]);
    CellRule rule = rule_on_face(mesh, face, nodes, degree);
    if (profile != nullptr && profile->bends_within(positions)) rule = divided_rule(cell, rule, mesh.dimension == 2 ? 64 : 32);
    const std::size_t first = shares.size();
    for (const int node : nodes) shares.push_back({.node = node});
    for (std::size_t i = 0; i < rule.point.size(); ++i) {
      const CellShape shape = cell_shape(cell, rule.point[i]);
      const double factor = profile != nullptr ? profile->at(cell_position(shape, positions)) : 1;
      const Vec3 area = thickness * factor * rule.weight[i] * cell_area_vector(shape, positions, cell);
      const double size = factor < 0 ? -area.norm() : area.norm();
      for (std::size_t a = 0; a < nodes.size(); ++a) {
        shares[first + a].area += shape.value[a] * size;
        if (!outward.empty()) shares[first + a].outward += shape.value[a] * area;
      }
    }
  }
  return shares;
}

/// The faces are convex: lines, or fans of triangles.
std::vector<SurfaceShare> surface_shares(const CaseSolids& solids, const std::vector<FreeFace>& faces, const Profile* profile) {
  constexpr int degree = 7;  // hex8: shape function 3 on an inclined face, profile 1; more in cells without parallel sides
  const Mesh& mesh = solids.mesh();
  const Cell piece = mesh.dimension == 2 ? Cell::line2 : Cell::tri3;
  std::vector<SurfaceShare> shares;
  for (const FreeFace& face : faces) {
    const std::span<const int> nodes = mesh.cell(face.cell);
    std::vector<Vec3> corners;
    for (const int node : nodes) corners.push_back(mesh.nodes[static_cast<std::size_t>(node)]);
    const Cell cell = mesh.type(face.cell);
    const PlacedCell placed(info(cell).linear, std::span<const Vec3>(corners).first(static_cast<std::size_t>(info(cell).corners)));
    const double thickness = mesh.dimension == 2 ? solids.of(face.cell).section.thickness : 1;
    const std::size_t first = shares.size();
    for (const int node : nodes) shares.push_back({.node = node});
    for (std::size_t k = mesh.dimension == 2 ? 1 : 2; k < face.corners.size(); ++k) {
      std::vector<Vec3> positions{face.corners[0], face.corners[k]};
      if (mesh.dimension == 3) positions.insert(positions.begin() + 1, face.corners[k - 1]);
      CellRule rule = cell_rule(piece, degree);
      if (profile != nullptr && profile->bends_within(positions)) rule = divided_rule(piece, rule, mesh.dimension == 2 ? 64 : 32);
      for (std::size_t i = 0; i < rule.point.size(); ++i) {
        const CellShape on_face = cell_shape(piece, rule.point[i]);
        const Vec3 place = cell_position(on_face, positions);
        const double factor = profile != nullptr ? profile->at(place) : 1;
        const double area = thickness * factor * rule.weight[i] * cell_area_vector(on_face, positions, piece).norm();
        const CellShape shape = cell_shape(cell, placed.local(place));
        for (std::size_t a = 0; a < nodes.size(); ++a) {
          shares[first + a].area += shape.value[a] * area;
          shares[first + a].outward += shape.value[a] * area * face.normal;
        }
      }
    }
  }
  return shares;
}

}  // namespace uplift
