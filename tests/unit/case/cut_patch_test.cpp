#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <random>
#include <vector>

#include "simple_meshes.h"
#include "unit/case/cut_support.h"
#include "uplift/case/mesh/mesh.h"
#include "uplift/math/dense.h"

// Matrices of cut models without a solution: motions of rigid sides, uniform stress across a joint, and the aligned joint of a plane
// through nodes. Nothing is divided by a stiffness here, so that round-off alone remains.
namespace uplift::cut_patch_test {
namespace {

using namespace support;

constexpr double young = 2e10, poisson = 0.2, density = 2000, stiffness = 1e11;
constexpr std::array cells{Cell::tri3, Cell::quad4, Cell::tet4, Cell::wedge6, Cell::hex8};

/// A plane on which a joint parts a body; "volume" lies below, "beyond" above.
struct Joined {
  Case read;
  BuiltCase built;
  Sparse stiffness, mass, rows;  // on the full unknowns: K, M, B
  std::vector<int> side;         // of each node: 0 below, 1 above

  const Model& model() const { return built.model; }
  const Interface& joint() const { return built.model.interfaces.front(); }
  int dimension() const { return built.model.space.dimension; }

  /// Full displacement from a field of place and side.
  template <class Field>
  Vector displaced(Field&& field) const {
    Vector u = Vector::Zero(model().full_unknowns());
    for (int i = 0; i < static_cast<int>(side.size()); ++i) {
      const Vec3 moved = field(model().nodes[static_cast<std::size_t>(i)].position, side[static_cast<std::size_t>(i)]);
      for (int k = 0; k < dimension(); ++k) u[model().at(i, model().space.dof(k))] = moved[k];
    }
    return u;
  }
  /// Per row of the joint from a vector at each point, in the local axes.
  template <class Field>
  Vector local(Field&& field) const {
    const Interface& at = joint();
    Vector made(at.rows());
    for (int c = 0; c < at.batch.components; ++c)
      for (int p = 0; p < at.batch.points; ++p) {
        const auto point = static_cast<std::size_t>(p);
        made[c * at.batch.points + p] =
            local_axis(at.space, at.normal[point], c).dot(field(at.position[point], at.normal[point], at.weight[p]));
      }
    return made;
  }
  /// What round-off makes of K u: a sum of the terms without their signs.
  double size(const Vector& u) const { return (stiffness.cwiseAbs() * u.cwiseAbs()).maxCoeff(); }
};

Joined joined(const Mesh& mesh, const std::string& where) {
  const std::string text = "title = \"body\"\n[mesh]\nfile = \"body.msh\"\n" + solid("volume", young, poisson, density) +
                           solid("beyond", young, poisson, density) + "[[support]]\ngroup = \"left\"\nfixed = [\"ux\", \"uy\"" +
                           (mesh.dimension == 3 ? ", \"uz\"" : "") + "]\n" + "[[interface]]\nname = \"joint\"\n" + where +
                           fmt::format("\nlaw = {{ type = \"elastic\", K_n = {0}, K_t = {0} }}\n", stiffness) + at_rest_stages;
  Joined made{read_on(text, mesh), {}, {}, {}, {}, {}};
  made.built = build(made.read, RunSpec{});
  const Model& model = made.built.model;
  made.stiffness = assembled(model, &Local::stiffness), made.mass = assembled(model, &Local::mass), made.rows = model.assembly.b;
  const Mesh& cut = made.read.mesh->mesh;
  made.side.assign(model.nodes.size(), 0);
  EXPECT_EQ(model.nodes.size(), cut.nodes.size());
  for (const int node : nodes_of(cut, cut.groups.at("beyond"))) made.side[static_cast<std::size_t>(node)] = 1;
  for (std::size_t i = 0; i < cut.nodes.size(); ++i) EXPECT_EQ((model.nodes[i].position - cut.nodes[i]).norm(), 0);
  return made;
}

std::string on_plane(const Vec3& point, const Vec3& normal, int dimension) {
  const auto vector = [&](const Vec3& v) {
    return dimension == 2 ? fmt::format("[{:.17g}, {:.17g}]", v[0], v[1]) : fmt::format("[{:.17g}, {:.17g}, {:.17g}]", v[0], v[1], v[2]);
  };
  return "cut = { through = [\"volume\"], point = " + vector(point) + ", normal = " + vector(normal) + ", upper = \"beyond\" }";
}

constexpr double shear = 0.3;  // of parallelograms

bool outside(const Vec3& x, int dimension) {
  const double first = x[0] - shear * x[1];
  const auto end = [](double value) { return value < 1e-9 || value > 1 - 1e-9; };
  return end(first) || end(x[1]) || (dimension == 3 && end(x[2]));
}

/// The unit square or cube, sheared; inner nodes of triangles and tetrahedra are moved besides.
Mesh body(Cell cell, std::mt19937& random) {
  const auto lines = uniform_lines(0, 1, info(cell).dimension == 2 ? 3 : 2);
  Mesh mesh = info(cell).dimension == 2 ? rectangle(lines, lines, cell) : box(lines, lines, lines, cell);
  std::uniform_real_distribution<double> move(-0.06, 0.06);
  for (Vec3& x : mesh.nodes) {
    x[0] += shear * x[1];
    if ((cell == Cell::tri3 || cell == Cell::tet4) && !outside(x, mesh.dimension))
      for (int k = 0; k < mesh.dimension; ++k) x[k] += move(random);
  }
  return mesh;
}

/// With a random plane.
Joined random_cut(Cell cell, std::mt19937& random) {
  std::normal_distribution<double> any;
  std::uniform_real_distribution<double> place(0.3, 0.7);
  const int dimension = info(cell).dimension;
  const Mesh mesh = body(cell, random);
  const Vec3 normal = Vec3(any(random), any(random), dimension == 3 ? any(random) : 0).normalized();
  const double y = place(random);
  return joined(mesh, on_plane({place(random) + shear * y, y, dimension == 3 ? place(random) : 0}, normal, dimension));
}

Vec3 random_vector(int dimension, std::mt19937& random) {
  std::normal_distribution<double> any;
  return {any(random), any(random), dimension == 3 ? any(random) : 0};
}

constexpr int repeats = 6;

TEST(CutPatch, RigidMotionsOfTheWholeAndOfEachSide) {
  // As a whole the body has neither stress nor jump. With an open joint the upper part moves and turns alone without stress, and the jumps
  // are those of a rigid motion.
  std::mt19937 random(3);
  for (const Cell cell : cells)
    for (int repeat = 0; repeat < repeats; ++repeat) {
      const Joined at = random_cut(cell, random);
      const int d = at.dimension();
      for (const bool turns : {false, true}) {
        const Vec3 moved = random_vector(d, random), about = !turns ? Vec3(0, 0, 0) : d == 2 ? Vec3(0, 0, 1.3) : random_vector(3, random);
        const auto rigid = [&](const Vec3& x) { return Vec3(moved + cross(about, x)); };
        const Vector whole = at.displaced([&](const Vec3& x, int) { return rigid(x); });
        EXPECT_LT((at.stiffness * whole).cwiseAbs().maxCoeff(), 1e-14 * at.size(whole)) << info(cell).name << " seed 3";
        EXPECT_LT((at.rows * whole).cwiseAbs().maxCoeff(), 1e-14 * whole.cwiseAbs().maxCoeff()) << info(cell).name << " seed 3";
        const Vector upper = at.displaced([&](const Vec3& x, int side) { return side == 1 ? rigid(x) : Vec3(0, 0, 0); });
        EXPECT_LT((at.stiffness * upper).cwiseAbs().maxCoeff(), 1e-14 * at.size(upper)) << info(cell).name << " seed 3";
        EXPECT_LT(std::abs(upper.dot(at.stiffness * upper)), 1e-14 * upper.cwiseAbs().sum() * at.size(upper));
        const Vector jump = at.local([&](const Vec3& x, const Vec3&, double) { return rigid(x); });
        EXPECT_LT((at.rows * upper - jump).cwiseAbs().maxCoeff(), 1e-14 * jump.cwiseAbs().maxCoeff()) << info(cell).name << " seed 3";
      }
    }
}

/// u = e x below, e x + c above, with the traction s n in the joint: forces are left on the surface alone. The virtual work of fields of
/// the same kind is exact.
void expect_uniform_stress(const Joined& at, std::mt19937& random, const std::string& what) {
  const double mu = young / (2 * (1 + poisson)), lambda = young * poisson / ((1 + poisson) * (1 - 2 * poisson));
  const int d = at.dimension();
  struct Strained {
    std::array<Vec3, 3> strain;  // rows, symmetric
    Vec3 jump;
    Vec3 operator()(const Vec3& x, int side) const {
      return Vec3(strain[0].dot(x), strain[1].dot(x), strain[2].dot(x)) + (side == 1 ? jump : Vec3(0, 0, 0));
    }
  };
  const auto any = [&] {
    Strained made{{random_vector(d, random), random_vector(d, random), d == 3 ? random_vector(d, random) : Vec3(0, 0, 0)},
                  random_vector(d, random)};
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < i; ++j) made.strain[static_cast<std::size_t>(i)][j] = made.strain[static_cast<std::size_t>(j)][i];
    return made;
  };
  const Strained field = any(), other = any();
  std::array<Vec3, 3> stress = field.strain;
  const double volumetric = field.strain[0][0] + field.strain[1][1] + field.strain[2][2];
  for (int i = 0; i < 3; ++i) {
    stress[static_cast<std::size_t>(i)] *= 2 * mu;
    stress[static_cast<std::size_t>(i)][i] += lambda * volumetric;
  }
  const Vector u = at.displaced(field), v = at.displaced(other);
  const Vector force = at.local(
      [&](const Vec3&, const Vec3& n, double weight) { return Vec3(weight * Vec3(stress[0].dot(n), stress[1].dot(n), stress[2].dot(n))); });
  const Vector rest = at.stiffness * u + at.rows.transpose() * force;
  for (int i = 0; i < static_cast<int>(at.side.size()); ++i)
    for (int k = 0; k < d; ++k)
      if (!outside(at.model().nodes[static_cast<std::size_t>(i)].position, d))
        EXPECT_LT(std::abs(rest[at.model().at(i, at.model().space.dof(k))]), 1e-14 * at.size(u)) << what;
  double work = 0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(d); ++i) work += stress[i].dot(other.strain[i]);
  EXPECT_NEAR(v.dot(at.stiffness * u) / work, 1, 1e-11) << what;
}

TEST(CutPatch, UniformStressAcrossAJoint) {
  std::mt19937 random(4);
  for (const Cell cell : cells)
    for (int repeat = 0; repeat < repeats; ++repeat)
      expect_uniform_stress(random_cut(cell, random), random, fmt::format("{}, seed 4, {}", info(cell).name, repeat));
}

TEST(CutPatch, UniformStressAcrossFacesOfCells) {
  // a plane through nodes, also of cells of the second degree
  std::mt19937 random(5);
  for (const Cell cell : {Cell::tri3, Cell::quad4, Cell::tri6, Cell::quad8, Cell::quad9, Cell::tet4, Cell::wedge6, Cell::hex8, Cell::tet10,
                          Cell::wedge15, Cell::hex20, Cell::hex27}) {
    const auto lines = uniform_lines(0, 1, 2);
    const int d = info(cell).dimension;
    Mesh mesh = d == 2 ? rectangle(lines, lines, cell) : box(lines, lines, lines, cell);
    for (Vec3& x : mesh.nodes) x[0] += shear * x[1];
    expect_uniform_stress(joined(mesh, "cut = { through = [\"volume\"], level = 0.5, upper = \"beyond\" }"), random,
                          std::string(info(cell).name));
  }
}

TEST(CutPatch, APlaneThroughNodesHasTheMatricesOfTheAlignedJoint) {
  // Cells without parallel sides: the lines along the plane are moved in it, every level by another amount.
  const auto lines = uniform_lines(0, 1, 4);
  for (const Cell cell : cells) {
    const int d = info(cell).dimension;
    const Grid of{lines, lines, d == 3 ? lines : std::vector<double>{}};
    const auto moved = [&](Mesh mesh) {
      for (Vec3& x : mesh.nodes) {
        const Vec3 from = x;
        x[0] += 0.1 * from[0] * (1 - from[0]) * (1 + from[1]) * (1 + 2 * from[2]);
        if (d == 3) x[1] += 0.1 * from[1] * (1 - from[1]) * (1 + from[0] * from[2]);
      }
      return with_cells(std::move(mesh), cell);
    };
    const auto part = [&](int, int j, int k) { return (d == 2 ? j : k) < 2 ? 0 : 1; };
    const auto face = [](int from, Direction direction, int other) -> std::string {
      if (from == 0 && other == 1) return "interface";
      return other >= 0 ? "" : std::string(name_of(direction));
    };
    const Joined aligned =
        joined(moved(grid(of, part, {"volume", "beyond"}, face)), "surface = { group = \"interface\", lower = [\"volume\"] }");
    const Joined cut = joined(moved(d == 2 ? rectangle(lines, lines) : box(lines, lines, lines)),
                              "cut = { through = [\"volume\"], level = 0.5, upper = \"beyond\" }");
    ASSERT_EQ(cut.side.size(), aligned.side.size()) << info(cell).name;
    std::map<std::array<double, 4>, int> places;
    const auto key = [](const Joined& of_one, int i) {
      const Vec3& x = of_one.model().nodes[static_cast<std::size_t>(i)].position;
      return std::array{x[0], x[1], x[2], static_cast<double>(of_one.side[static_cast<std::size_t>(i)])};
    };
    const int nodes = static_cast<int>(cut.side.size());
    for (int i = 0; i < nodes; ++i) places[key(aligned, i)] = i;
    std::vector<int> same(static_cast<std::size_t>(cut.model().full_unknowns()), -1);
    for (int i = 0; i < nodes; ++i) {
      ASSERT_TRUE(places.contains(key(cut, i))) << info(cell).name;
      for (int k = 0; k < d; ++k)
        same[static_cast<std::size_t>(cut.model().at(i, cut.model().space.dof(k)))] =
            aligned.model().at(places[key(cut, i)], aligned.model().space.dof(k));
    }
    const auto spring = [](const Joined& of_one) {
      Vector weight(of_one.joint().rows());
      for (int row = 0; row < of_one.joint().rows(); ++row) weight[row] = of_one.joint().weight[row % of_one.joint().batch.points];
      const Matrix rows = of_one.rows;
      return Matrix(rows.transpose() * weight.asDiagonal() * rows);
    };
    const auto expect_same = [&](const Matrix& one, const Matrix& other, const char* what) {
      double off = 0;
      for (int i = 0; i < one.rows(); ++i)
        for (int j = 0; j < one.cols(); ++j)
          if (same[static_cast<std::size_t>(i)] >= 0 && same[static_cast<std::size_t>(j)] >= 0)  // solids have no rotations
            off = std::max(off, std::abs(one(i, j) - other(same[static_cast<std::size_t>(i)], same[static_cast<std::size_t>(j)])));
      EXPECT_LE(off, 1e-14 * other.cwiseAbs().maxCoeff()) << info(cell).name << " " << what;
    };
    expect_same(Matrix(cut.stiffness), Matrix(aligned.stiffness), "stiffness");
    expect_same(Matrix(cut.mass), Matrix(aligned.mass), "mass");
    expect_same(spring(cut), spring(aligned), "joint");
  }
}

}  // namespace
}  // namespace uplift::cut_patch_test
