#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <set>
#include <tuple>

#include "unit/mesh/split_support.h"
#include "uplift/interface/face_joint.h"
#include "uplift/math/fixed.h"
#include "uplift/math/quadrature.h"
#include "uplift/mesh/cell_shapes.h"
#include "uplift/mesh/soil_box.h"

// Joint points on opened surfaces of plane and space meshes of every cell type.
namespace uplift::face_joint_space_test {
namespace {

using support::mesh_file;

constexpr double thickness = 0.7;
constexpr std::array<FaceQuadrature, 2> both_rules{FaceQuadrature::nodal, FaceQuadrature::gauss};

struct Opened {
  Mesh mesh;
  std::vector<FacePair> faces;
  double depth() const { return mesh.dimension == 2 ? thickness : 1; }
  std::vector<JointPoint> points(FaceQuadrature rule) const { return face_points(mesh, faces, rule, thickness, 0.01); }
};

Opened open(Mesh mesh, const std::string& surface, const std::string& lower) {
  Opened opened{std::move(mesh), {}};
  opened.faces = split(opened.mesh, {surface}, {lower}, mesh_file)[0].faces;
  return opened;
}

class FaceJoint : public testing::TestWithParam<Cell> {
 protected:
  int dimension() const { return info(GetParam()).dimension; }
  Vec3 vector(double size) {
    Vec3 v(uniform_(random_), uniform_(random_), uniform_(random_));
    if (dimension() == 2) v.z() = 0;
    return size * v;
  }
  Mat3 gradient() {
    Mat3 g;
    for (int column = 0; column < 3; ++column) g.col(column) = vector(1);
    return g;
  }
  /// Upwards: y in plane meshes, z in space.
  Index up() const { return dimension() - 1; }

  /// Two storeys of unit cells, 3 wide (and 2 deep), that part at the height 1.
  Mesh slab() const {
    const std::array<int, 3> cells = dimension() == 2 ? std::array<int, 3>{3, 2, 0} : std::array<int, 3>{3, 2, 2};
    return support::parted(
        cells, [&](int, int j, int k) { return (dimension() == 2 ? j : k) == 0; }, GetParam());
  }
  static constexpr double slab_area(int dimension) { return dimension == 2 ? 3 * thickness : 3 * 2; }

  /// A raft of 4 x 3 m, sunk 2 m into the soil.
  Mesh raft() const {
    SoilBox box;
    box.dimension = dimension();
    box.soil.width = {8, 7};
    box.soil.layers = {{4, 1}};
    box.soil.size = 2;
    box.raft.width = {4, 3};
    box.raft.height = 3;
    box.embedment = 2;
    box.growth = 2;
    box.cell = GetParam();
    return soil_box(box, mesh_file);
  }
  static constexpr double raft_plan(int dimension) { return dimension == 2 ? 4 * thickness : 4 * 3; }

  std::mt19937 random_{static_cast<unsigned>(GetParam())};
  std::uniform_real_distribution<double> uniform_{-1, 1};
};
INSTANTIATE_TEST_SUITE_P(Cells, FaceJoint,
                         testing::Values(Cell::tri3, Cell::tri6, Cell::quad4, Cell::quad8, Cell::quad9, Cell::tet4, Cell::tet10,
                                         Cell::wedge6, Cell::wedge15, Cell::hex8, Cell::hex20, Cell::hex27),
                         [](const auto& test) { return std::string(uplift::info(test.param).name); });

/// Integral over the opened faces, by Gauss rules of many points (on the square collapsed to a triangle): f(face, shape functions,
/// position, vector of area).
template <class F>
void integrate(const Opened& opened, F&& f) {
  const Quadrature gauss = gauss_legendre(9);
  for (const FacePair& pair : opened.faces) {
    const Cell cell = opened.mesh.type(pair.lower);
    const bool line = info(cell).dimension == 1, triangle = info(cell).corners == 3;
    std::vector<Vec3> x;
    for (const int node : opened.mesh.cell(pair.lower)) x.push_back(opened.mesh.nodes[node]);
    for (Index i = 0; i < gauss.point.size(); ++i)
      for (Index j = 0; j < (line ? 1 : gauss.point.size()); ++j) {
        double r = gauss.point[i], s = gauss.point[j], weight = gauss.weight[i] * (line ? thickness : gauss.weight[j]);
        if (triangle) {
          r = (1 + r) / 2;
          s = (1 + s) / 2 * (1 - r);
          weight *= (1 - r) / 4;
        }
        const CellShape shape = cell_shape(cell, {r, s, 0});
        const Vec3 along = cell_tangent(shape, x, 0), other = line ? Vec3(Vec3::UnitZ()) : cell_tangent(shape, x, 1);
        f(pair, shape, cell_position(shape, x), Vec3(weight * cross(along, other)));
      }
  }
}

/// Forces of a unit pressure on the nodes of the upper side.
using Forces = std::map<int, Vec3>;

Forces forces(const std::vector<JointPoint>& points, std::vector<std::pair<int, double>> JointPoint::*side) {
  Forces sum;
  for (const JointPoint& p : points)
    for (const auto& [node, share] : p.*side) sum.try_emplace(node, Vec3::Zero()).first->second += p.area * share * p.normal;
  return sum;
}

Forces exact_forces(const Opened& opened) {
  Forces sum;
  integrate(opened, [&](const FacePair& pair, const CellShape& shape, const Vec3&, const Vec3& area) {
    const auto nodes = opened.mesh.cell(pair.upper);
    for (std::size_t a = 0; a < nodes.size(); ++a) sum.try_emplace(nodes[a], Vec3::Zero()).first->second += shape.value[a] * area;
  });
  return sum;
}

void expect_equal(const Forces& found, const Forces& wanted) {
  for (const auto& [node, force] : wanted) {
    const Vec3 other = found.contains(node) ? found.at(node) : Vec3(Vec3::Zero());  // tri6: nothing at a corner
    EXPECT_LE((other - force).norm(), 1e-13) << node;
  }
  for (const auto& [node, force] : found) EXPECT_TRUE(wanted.contains(node));
}

double total_area(const std::vector<JointPoint>& points) {
  double sum = 0;
  for (const JointPoint& p : points) sum += p.area;
  return sum;
}

Vec3 vector_area(const std::vector<JointPoint>& points) {
  Vec3 sum = Vec3::Zero();
  for (const JointPoint& p : points) sum += p.area * p.normal;
  return sum;
}

/// Area and its first moments.
std::pair<double, Vec3> moments(const std::vector<JointPoint>& points) {
  Vec3 sum = Vec3::Zero();
  for (const JointPoint& p : points) sum += p.area * p.position;
  return {total_area(points), sum};
}

// ---- areas and normals ----

TEST_P(FaceJoint, PointsOfADistortedPlaneSurface) {
  Mesh mesh = slab();
  for (const int node : nodes_of(mesh, mesh.groups.at("joint"))) {
    Vec3& x = mesh.nodes[node];
    const bool rim = x.x() == 0 || x.x() == 3 || (dimension() == 3 && (x.y() == 0 || x.y() == 2));
    Vec3 move = vector(0.05);
    move[up()] = 0;
    if (!rim) x += move;  // edges become curved in the plane
  }
  const Opened opened = open(std::move(mesh), "joint", "soil");
  for (const FaceQuadrature rule : both_rules) {
    const auto points = opened.points(rule);
    for (const JointPoint& p : points) {
      EXPECT_LE((p.normal - Vec3::Unit(up())).norm(), 1e-14);
      EXPECT_GT(p.area, 0);
      EXPECT_EQ(p.gap, 0.01);
      EXPECT_NEAR(p.position[up()], 1, 1e-14);
    }
    EXPECT_NEAR(total_area(points), slab_area(dimension()), 1e-13);
    if (rule == FaceQuadrature::gauss) {
      const Vec3 middle = dimension() == 2 ? Vec3(1.5, 1, 0) : Vec3(1.5, 1, 1);
      EXPECT_LE((moments(points).second - slab_area(dimension()) * middle).norm(), 1e-12);
    }
  }
}

TEST_P(FaceJoint, RaftsAreClosedSurfaces) {
  // The bottom and the walls, bent and with all nodes moved but those at the rim: what flows in through the opening flows out through the
  // surface.
  Mesh mesh = raft();
  const std::vector<int> top = nodes_of(mesh, mesh.groups.at("soil_top"));
  for (const int node : nodes_of(mesh, mesh.groups.at("interface")))
    if (!std::binary_search(top.begin(), top.end(), node)) mesh.nodes[node] += vector(0.1);
  const Opened opened = open(std::move(mesh), "interface", "soil_1");
  for (const FaceQuadrature rule : both_rules) {
    const auto points = opened.points(rule);
    EXPECT_LE((vector_area(points) - raft_plan(dimension()) * Vec3::Unit(up())).norm(), 1e-12);
    for (const JointPoint& p : points) EXPECT_NEAR(p.normal.norm(), 1, 1e-14);
  }
}

TEST_P(FaceJoint, NormalsOfARaftPointIntoIt) {
  const Opened opened = open(raft(), "interface", "soil_1");
  const Vec3 middle = -1 * Vec3::Unit(up());  // of the part of the raft in the soil
  const std::size_t sides = dimension() == 2 ? 3 : 5;
  const double walls = dimension() == 2 ? 2 * 2 * thickness : 2 * 2 * (4 + 3);
  for (const FaceQuadrature rule : both_rules) {
    const auto points = opened.points(rule);
    std::set<std::pair<int, bool>> directions;
    std::set<std::tuple<int, int, bool>> at_pairs;
    for (const JointPoint& p : points) {
      EXPECT_GT(p.normal.dot(middle - p.position), 0);
      int axis = 0;
      p.normal.cwiseAbs().maxCoeff(&axis);
      EXPECT_NEAR(std::abs(p.normal[axis]), 1, 1e-14);
      directions.insert({axis, p.normal[axis] > 0});
      if (p.lower.size() == 1) EXPECT_TRUE(at_pairs.insert({p.lower[0].first, axis, p.normal[axis] > 0}).second) << "twice the same point";
    }
    EXPECT_EQ(directions.size(), sides);
    EXPECT_NEAR(total_area(points), raft_plan(dimension()) + walls, 1e-12);
  }
}

TEST(FaceJointSpace, EdgesAndCornersOfARaftHaveAPointForEachNormal) {
  SoilBox box;
  box.dimension = 3;
  box.soil.layers = {{4, 1}};
  box.soil.width = {8, 7};
  box.raft.width = {4, 3};
  box.raft.height = 3;
  box.embedment = 2;
  box.cell = Cell::hex8;
  const Opened opened = open(soil_box(box, mesh_file), "interface", "soil_1");
  const auto points = opened.points(FaceQuadrature::nodal);
  // unit cells: 5 x 4 points below, 5 x 3 and 4 x 3 on the walls
  ASSERT_EQ(points.size(), 5 * 4 + 2 * 5 * 3 + 2 * 4 * 3u);
  std::map<int, int> normals;
  for (const JointPoint& p : points) {
    ASSERT_EQ(p.lower.size(), 1u);
    ++normals[p.lower[0].first];
    if (p.normal.z() < 0.5) continue;
    const bool at_x = std::abs(std::abs(p.position.x()) - 2) < 1e-9, at_y = std::abs(std::abs(p.position.y()) - 1.5) < 1e-9;
    EXPECT_NEAR(p.area, (at_x ? 0.5 : 1) * (at_y ? 0.5 : 1), 1e-12);  // shares of the faces around
  }
  std::array<int, 4> with{};
  for (const auto& [node, count] : normals) ++with[count];
  EXPECT_EQ(with[3], 4);                    // corners of the bottom
  EXPECT_EQ(with[2], 2 * (3 + 2) + 4 * 2);  // its edges and those of the walls
  EXPECT_EQ(with[1], 3 * 2 + 2 * (3 + 2) * 2);
}

// ---- forces ----

TEST_P(FaceJoint, PressureOnDistortedFacesIsConsistent) {
  Mesh mesh = raft();
  for (const int node : nodes_of(mesh, mesh.groups.at("interface"))) mesh.nodes[node] += vector(0.1);
  const Opened opened = open(std::move(mesh), "interface", "soil_1");
  const auto points = opened.points(FaceQuadrature::gauss);
  expect_equal(forces(points, &JointPoint::upper), exact_forces(opened));
  // the lower side gets the same at the partners
  const Forces below = forces(points, &JointPoint::lower), above = forces(points, &JointPoint::upper);
  for (const NodePair& pair : pairs_of(opened.mesh, opened.faces))
    if (above.contains(pair.upper)) EXPECT_LE((below.at(pair.lower) - above.at(pair.upper)).norm(), 1e-15);
}

TEST_P(FaceJoint, PressureOnParallelSidedFacesIsConsistentWithBothRules) {
  Mesh mesh = raft();
  const Mat3 shear = Mat3::Identity() + 0.3 * gradient();
  for (Vec3& x : mesh.nodes) x = shear * x;
  const Opened opened = open(std::move(mesh), "interface", "soil_1");
  for (const FaceQuadrature rule : both_rules) expect_equal(forces(opened.points(rule), &JointPoint::upper), exact_forces(opened));
}

TEST_P(FaceJoint, ProductsOfShapeFunctionsAreExactWithTheGaussRule) {
  Mesh mesh = slab();
  const Mat3 shear = Mat3::Identity() + 0.3 * gradient();
  for (Vec3& x : mesh.nodes) x = shear * x;
  const Opened opened = open(std::move(mesh), "joint", "soil");
  std::map<std::pair<int, int>, double> found, wanted;
  for (const JointPoint& p : opened.points(FaceQuadrature::gauss))
    for (const auto& [a, na] : p.upper)
      for (const auto& [b, nb] : p.lower) found[{a, b}] += p.area * na * nb;
  Vec3 moment = Vec3::Zero();
  integrate(opened, [&](const FacePair& pair, const CellShape& shape, const Vec3& position, const Vec3& area) {
    const auto lower = opened.mesh.cell(pair.lower), upper = opened.mesh.cell(pair.upper);
    for (std::size_t a = 0; a < lower.size(); ++a)
      for (std::size_t b = 0; b < lower.size(); ++b) wanted[{upper[a], lower[b]}] += area.norm() * shape.value[a] * shape.value[b];
    moment += area.norm() * position;
  });
  EXPECT_EQ(found.size(), wanted.size());
  for (const auto& [nodes, value] : wanted) EXPECT_NEAR(found[nodes], value, 1e-14);
  for (const FaceQuadrature rule : both_rules) EXPECT_LE((moments(opened.points(rule)).second - moment).norm(), 1e-12);
}

// ---- openings ----

TEST_P(FaceJoint, LinearOpeningsAreMetAtEveryPoint) {
  Mesh mesh = raft();
  for (const int node : nodes_of(mesh, mesh.groups.at("interface"))) mesh.nodes[node] += vector(0.1);
  const Opened opened = open(std::move(mesh), "interface", "soil_1");
  const Mat3 above = gradient(), below = gradient();
  const Vec3 lift = vector(1);
  for (const FaceQuadrature rule : both_rules)
    for (const JointPoint& p : opened.points(rule)) {
      Vec3 opening = Vec3::Zero();
      for (const auto& [node, share] : p.upper) opening += share * (above * opened.mesh.nodes[node] + lift);
      for (const auto& [node, share] : p.lower) opening -= share * (below * opened.mesh.nodes[node]);
      EXPECT_LE((opening - (above - below) * p.position - lift).norm(), 1e-13);
    }
}

TEST_P(FaceJoint, AreasOfACylinderConverge) {
  const double radius = 4;
  for (const FaceQuadrature rule : both_rules) {
    double last = 0;
    for (const int n : {2, 4, 8}) {
      const std::array<int, 3> cells = dimension() == 2 ? std::array<int, 3>{n, 2, 0} : std::array<int, 3>{n, 1, 2};
      Mesh mesh = support::parted(
          cells, [&](int, int j, int k) { return (dimension() == 2 ? j : k) == 0; }, GetParam());
      for (Vec3& x : mesh.nodes) {
        const double angle = 1.5 * x.x() / n, r = radius + (x[up()] - 1) * 0.5;  // the surface, at the height 1, becomes the arc
        x.x() = r * std::sin(angle);
        x[up()] = r * std::cos(angle);
      }
      const Opened opened = open(std::move(mesh), "joint", "soil");
      const auto points = opened.points(rule);
      const double error = std::abs(total_area(points) / (1.5 * radius * opened.depth()) - 1);
      const bool second_degree = info(GetParam()).linear != GetParam();
      if (n > 2) EXPECT_GT(std::log2(last / error), second_degree ? 3.5 : 1.9);
      last = error;
      for (const JointPoint& p : points) {
        Vec3 outwards = p.position;
        if (dimension() == 3) outwards.y() = 0;
        EXPECT_GT(p.normal.dot(outwards.normalized()), std::cos(0.51 * 1.5 / n));  // a chord's normal is off by half its angle
      }
    }
  }
}

// ---- where the surface ends ----

TEST(FaceJointSpace, SurfacesThatEndInsideHaveNoPointsAtTheirRim) {
  // 2 x 2 faces and an arm of one face: its four nodes all lie on the rim
  const auto on = [](int i, int j, int) { return (i >= 1 && i <= 2 && j >= 1 && j <= 2) || (i == 3 && j == 1); };
  const Opened opened = open(support::parted(
                                 {5, 4, 2}, [](int, int, int k) { return k == 0; }, Cell::hex8, on),
                             "joint", "soil");
  ASSERT_EQ(opened.faces.size(), 5u);
  const auto nodal = opened.points(FaceQuadrature::nodal), gauss = opened.points(FaceQuadrature::gauss);
  ASSERT_EQ(nodal.size(), 1u);
  EXPECT_EQ(nodal[0].position, Vec3(2, 2, 1));
  EXPECT_NEAR(nodal[0].area, 1, 1e-15);
  EXPECT_EQ(gauss.size(), 16u);
  EXPECT_NEAR(total_area(gauss), 4, 1e-14);
}

}  // namespace
}  // namespace uplift::face_joint_space_test
