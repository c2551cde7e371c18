#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <array>
#include <cmath>
#include <numbers>

#include "simple_meshes.h"
#include "unit/case/cut_support.h"
#include "uplift/case/case.h"

// Constant and rigid jumps in cut cells: against the element-condensed discontinuity of the literature, written down here from its own
// equations, and its locking (docs/theory/element_jumps.md).
namespace uplift::element_jump_test {
namespace {

using namespace support;

constexpr double young = 2e7, poisson = 0.2, normal_stiffness = 4e7, shear_stiffness = 1e7;  // Pa, -, Pa/m
constexpr double width = 1.5, height = 1;                                                    // m
constexpr std::array<double, 2> traction{3e3, -1e4};                                         // Pa at the top

struct Line {
  Vec3 point, normal;
};

// ---- the literature: u = N d + (H - N H_d) M a with unknowns a of each cut cell, one strain B (d - H_d M a) ----

class CondensedJumps {
 public:
  /// Components of the jump: 2, constant, or 3, rigid.
  CondensedJumps(int across, int up, const Line& line, int components)
      : across_(across), up_(up), line_(line), components_(components), nodes_((across + 1) * (up + 1)) {
    const int unknowns = 2 * nodes_ + components * across * up;
    stiffness_ = Matrix::Identity(unknowns, unknowns) * 0;
    load_ = Vector::Zero(unknowns);
    for (int j = 0; j < up; ++j)
      for (int i = 0; i < across; ++i) add_cell(i, j);
    for (int i = 0; i < across; ++i)
      for (const int end : {i, i + 1})
        for (int k = 0; k < 2; ++k) load_[2 * node(end, up) + k] += traction[static_cast<std::size_t>(k)] * width / across / 2;
    for (int u = 0; u < unknowns; ++u)
      if (u < 2 * (across + 1) || stiffness_(u, u) == 0) hold(u);
  }
  /// Displacement of the upper right corner.
  Vec3 corner() const {
    const Vector d = stiffness_.ldlt().solve(load_);
    return {d[2 * node(across_, up_)], d[2 * node(across_, up_) + 1], 0};
  }

 private:
  int node(int i, int j) const { return (across_ + 1) * j + i; }
  Vec3 place(int i, int j) const { return {width * i / across_, height * j / up_, 0}; }
  void hold(int u) {
    stiffness_.row(u).setZero(), stiffness_.col(u).setZero();
    stiffness_(u, u) = 1, load_[u] = 0;
  }
  Matrix jump_at(const Vec3& x, const Vec3& centre) const {
    Matrix jump = Matrix::Zero(2, components_);
    jump(0, 0) = jump(1, 1) = 1;
    if (components_ == 3) jump(0, 2) = -(x - centre).y(), jump(1, 2) = (x - centre).x();
    return jump;
  }
  void add_cell(int i, int j) {
    const std::array<Vec3, 4> x{place(i, j), place(i + 1, j), place(i + 1, j + 1), place(i, j + 1)};
    std::array<double, 4> distance{};
    for (std::size_t a = 0; a < 4; ++a) distance[a] = line_.normal.dot(x[a] - line_.point);
    std::vector<Vec3> ends;
    for (std::size_t a = 0; a < 4; ++a)
      if (const std::size_t b = (a + 1) % 4; distance[a] * distance[b] < 0)
        ends.push_back(x[a] + (x[b] - x[a]) * distance[a] / (distance[a] - distance[b]));
    const Vec3 centre = ends.empty() ? Vec3(Vec3::Zero()) : Vec3((ends[0] + ends[1]) / 2);
    // strains of d and of a: B and -B H_d M
    Matrix of_jump = Matrix::Zero(8, components_);
    if (!ends.empty())
      for (int a = 0; a < 4; ++a)
        if (distance[static_cast<std::size_t>(a)] > 0) of_jump.middleRows(2 * a, 2) = -jump_at(x[static_cast<std::size_t>(a)], centre);
    const double c = young / ((1 + poisson) * (1 - 2 * poisson));
    Matrix elastic = Matrix::Zero(3, 3);
    elastic(0, 0) = elastic(1, 1) = c * (1 - poisson), elastic(0, 1) = elastic(1, 0) = c * poisson,
               elastic(2, 2) = c * (1 - 2 * poisson) / 2;
    const double wide = width / across_, high = height / up_;
    Matrix cell = Matrix::Zero(8, 8);
    for (const double r : {-1 / std::sqrt(3.0), 1 / std::sqrt(3.0)})
      for (const double s : {-1 / std::sqrt(3.0), 1 / std::sqrt(3.0)}) {
        constexpr std::array<double, 4> signs_r{-1, 1, 1, -1}, signs_s{-1, -1, 1, 1};
        Matrix strain = Matrix::Zero(3, 8);
        for (int a = 0; a < 4; ++a) {
          const double sr = signs_r[static_cast<std::size_t>(a)], ss = signs_s[static_cast<std::size_t>(a)];
          const double dx = sr * (1 + ss * s) / (2 * wide), dy = ss * (1 + sr * r) / (2 * high);
          strain(0, 2 * a) = strain(2, 2 * a + 1) = dx, strain(1, 2 * a + 1) = strain(2, 2 * a) = dy;
        }
        cell += strain.transpose() * elastic * strain * wide * high / 4;
      }
    Matrix all(8, 8 + components_);
    all.leftCols(8) = Matrix::Identity(8, 8), all.rightCols(components_) = of_jump;
    Matrix augmented = all.transpose() * cell * all;
    if (ends.empty()) {
      augmented.bottomRows(components_).setZero(), augmented.rightCols(components_).setZero();
    } else {
      const Vec3 &n = line_.normal, t(n.y(), -n.x(), 0);
      Matrix law(2, 2);
      for (int k = 0; k < 2; ++k)
        for (int l = 0; l < 2; ++l) law(k, l) = normal_stiffness * n[k] * n[l] + shear_stiffness * t[k] * t[l];
      const bool level = std::abs(n.x()) < 1e-12;  // the two ends there, else Simpson's rule
      const double length = (ends[1] - ends[0]).norm();
      for (int p = 0; p < 3; ++p) {
        const double weight = length * (level ? (p == 1 ? 0 : 0.5) : (p == 1 ? 4.0 : 1.0) / 6);
        const Matrix jump = jump_at(ends[0] + (ends[1] - ends[0]) * p / 2, centre);
        augmented.bottomRightCorner(components_, components_) += weight * jump.transpose() * law * jump;
      }
    }
    std::vector<int> unknown;
    for (const int each : {node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)})
      unknown.insert(unknown.end(), {2 * each, 2 * each + 1});
    for (int k = 0; k < components_; ++k) unknown.push_back(2 * nodes_ + components_ * (across_ * j + i) + k);
    for (int a = 0; a < static_cast<int>(unknown.size()); ++a)
      for (int b = 0; b < static_cast<int>(unknown.size()); ++b)
        stiffness_(unknown[static_cast<std::size_t>(a)], unknown[static_cast<std::size_t>(b)]) += augmented(a, b);
  }

  int across_, up_;
  Line line_;
  int components_, nodes_;
  Matrix stiffness_;
  Vector load_;
};

// ---- the program ----

std::string block(const Line& line, const std::string& jump) {
  return "title = \"block\"\n[mesh]\nfile = \"block.msh\"\n" + solid("volume", young, poisson, 2000, "incompatible_modes = false\n") +
         "[[support]]\ngroup = \"bottom\"\nfixed = [\"ux\", \"uy\"]\n" +
         fmt::format("[[load]]\ngroup = \"top\"\ntraction = [{}, {}]\n", traction[0], traction[1]) +
         fmt::format(
             "[[interface]]\nname = \"joint\"\ncut = {{ through = [\"volume\"], point = [{}, {}], normal = [{}, {}], jump = \"{}\" }}\n",
             line.point.x(), line.point.y(), line.normal.x(), line.normal.y(), jump) +
         fmt::format("law = {{ type = \"elastic\", K_n = {}, K_t = {} }}\n", normal_stiffness, shear_stiffness) +
         fmt::format(
             "[[output.history]]\nname = \"ux\"\nat = [{0}, {1}]\nquantity = \"ux\"\n[[output.history]]\nname = \"uy\"\nat = [{0}, "
             "{1}]\nquantity = \"uy\"\n",
             width, height) +
         at_rest_stages;
}

Mesh mesh_of(int across, int up, Cell cell = Cell::quad4) {
  return rectangle(uniform_lines(0, width, across), uniform_lines(0, height, up), cell);
}

const Line level{{0, 0.43, 0}, {0, 1, 0}};
Line inclined() {
  const double angle = 20 * std::numbers::pi / 180;
  return {{0.7, 0.52, 0}, {-std::sin(angle), std::cos(angle), 0}};
}

TEST(ElementJump, IsTheElementCondensedDiscontinuity) {
  for (const int components : {2, 3})
    for (const Line& line : {level, inclined()})
      for (const auto& [across, up] : {std::pair{1, 1}, {3, 2}, {4, 5}}) {
        const RunResult result = run_on(block(line, components == 2 ? "constant" : "rigid"), mesh_of(across, up));
        const Vec3 expected = CondensedJumps(across, up, line, components).corner();
        const double peak = expected.norm();
        EXPECT_NEAR(at_rest(result, "ux"), expected.x(), 1e-9 * peak) << components << " " << across << " " << line.normal.x();
        EXPECT_NEAR(at_rest(result, "uy"), expected.y(), 1e-9 * peak) << components << " " << across << " " << line.normal.x();
      }
}

/// Error of the displacement of a bar in tension, cut by an elastic joint at an angle, as a share of that displacement.
double patch_error(double degrees, const std::string& jump) {
  const double a = degrees * std::numbers::pi / 180, c = std::cos(a), s = std::sin(a), pull = 1e6, stiffness = 4e10,
               bulk = 2e10;  // Pa, Pa/m
  const std::string text = "title = \"bar\"\n[mesh]\nfile = \"bar.msh\"\n" + solid("volume", bulk, poisson, 2000) +
                           "[[support]]\ngroup = \"left\"\nfixed = [\"ux\"]\n[[support]]\nnode = \"mesh.1\"\nfixed = [\"uy\"]\n" +
                           fmt::format("[[load]]\ngroup = \"right\"\ntraction = [{}, 0]\n", pull) +
                           fmt::format(
                               "[[interface]]\nname = \"crack\"\ncut = {{ through = [\"volume\"], point = [2.03, 0.47], normal = [{}, "
                               "{}], jump = \"{}\" }}\nlaw = {{ type = \"elastic\", K_n = {}, K_t = {} }}\n",
                               c, s, jump, stiffness, stiffness) +
                           "[[output.history]]\nname = \"end\"\nat = [4, 1]\nquantity = \"ux\"\n" + at_rest_stages;
  const double expected = pull * 4 * (1 - poisson * poisson) / bulk + pull * c / stiffness;
  return at_rest(run_on(text, rectangle(uniform_lines(0, 4, 9), uniform_lines(0, 1, 3))), "end") / expected - 1;
}

TEST(ElementJump, PassesThePatchTestOnLevelCutsAlone) {
  for (const char* jump : {"linear", "constant", "rigid"}) EXPECT_NEAR(patch_error(0, jump), 0, 1e-9) << jump;
  EXPECT_NEAR(patch_error(25, "linear"), 0, 1e-9);
  EXPECT_LT(patch_error(25, "constant"), -0.01);
  EXPECT_LT(patch_error(25, "rigid"), -0.01);
}

TEST(ElementJump, AConstantOneLocksWhereABaseTurns) {
  const auto rotation = [](int cells, const char* jump) {
    return block_rotation(2, 0.37, cells, fmt::format(", jump = \"{}\"", jump), 1e13);
  };
  EXPECT_NEAR(rotation(48, "linear"), 3.98733, 1e-4);
  EXPECT_NEAR(rotation(48, "rigid"), 3.98744, 1e-4);
  EXPECT_NEAR(rotation(48, "constant"), 0.003, 5e-4);
}

/// Displacement of the corner [m] of a block that a moment turns on its ground; the rows of cells meet at the base (aligned), or not.
double corner_on_ground(const std::string& jump, bool aligned, int across, double ratio) {
  std::vector<double> rows = uniform_lines(0, 1, across * 3 / 2);
  if (aligned) {
    rows = uniform_lines(0, 0.37, across * 9 / 16);
    const std::vector<double> above = uniform_lines(0.37, 1, across * 15 / 16);
    rows.insert(rows.end(), above.begin() + 1, above.end());
  }
  const std::string plain = "incompatible_modes = false\n";
  const std::string text =
      "title = \"block\"\n[mesh]\nfile = \"block.msh\"\n" + solid("volume", 5e7, poisson, 2000, plain) +
      solid("block", ratio * 5e7, poisson, 2000, plain) + "[[support]]\ngroup = \"bottom\"\nfixed = [\"ux\", \"uy\"]\n" +
      "[[load]]\ngroup = \"top\"\ntraction = [0, -1e5]\n[load.profile]\nalong = \"x\"\npositions = [-0.5, 0.5]\nfactors = [-1, 1]\n" +
      fmt::format("[[interface]]\nname = \"base\"\ncut = {{ through = [\"volume\"], level = 0.37, upper = \"block\", jump = \"{}\" }}\n",
                  jump) +
      "law = { type = \"elastic\", K_n = 1e9, K_t = 1e9 }\n"
      "[[output.history]]\nname = \"top\"\nat = [0.5, 1]\nquantity = \"uy\"\n" +
      at_rest_stages;
  return at_rest(run_on(text, rectangle(uniform_lines(-0.5, 0.5, across), rows)), "top");
}

TEST(ElementJump, HasOneStrainForTwoMaterials) {
  const auto error = [](const char* jump, double ratio) {
    return corner_on_ground(jump, false, 16, ratio) / corner_on_ground("linear", true, 16, ratio) - 1;
  };
  for (const char* jump : {"linear", "constant", "rigid"}) EXPECT_NEAR(error(jump, 1), 0, 3e-4) << jump;
  EXPECT_NEAR(error("linear", 200), 0, 3e-5);
  EXPECT_LT(error("constant", 200), -0.05);  // one strain is too stiff where one side is hard
  EXPECT_LT(error("rigid", 200), -0.05);
}

TEST(ElementJump, FrozenFiguresOfTheTheoryPage) {
  // The program's own output, so that docs/theory/element_jumps.md stays true. That it is right is shown by the other tests.
  EXPECT_NEAR(patch_error(25, "constant"), -0.031, 5e-4);
  EXPECT_NEAR(patch_error(25, "rigid"), -0.099, 5e-4);
  EXPECT_NEAR(block_rotation(2, 0.37, 6, ", jump = \"constant\"", 1e13), 0.0003, 5e-5);
  const std::array<int, 3> across{8, 16, 32};
  const std::array<double, 3> linear{1.3e-3, 1e-5, 4e-6}, constant{-0.15, -0.098, -0.051}, rigid{-0.088, -0.084, -0.037};
  for (std::size_t i = 0; i < across.size(); ++i) {
    const double aligned = corner_on_ground("linear", true, across[i], 200);
    EXPECT_NEAR(corner_on_ground("linear", false, across[i], 200) / aligned - 1, linear[i], 0.1 * linear[i]);
    EXPECT_NEAR(corner_on_ground("constant", false, across[i], 200) / aligned - 1, constant[i], 1e-3);
    EXPECT_NEAR(corner_on_ground("rigid", false, across[i], 200) / aligned - 1, rigid[i], 1e-3);
  }
}

TEST(ElementJump, IsRefusedWhereItMeansNothing) {
  const auto expect_refused = [](const std::string& text, const Mesh& mesh, const std::string& said) {
    try {
      const Case read = read_on(text, mesh);
      build(read, RunSpec{});
      FAIL() << "not refused: " << said;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(said), std::string::npos) << error.what();
    }
  };
  expect_refused(block(inclined(), "rigid"), mesh_of(3, 2, Cell::tri3), "constant or linear in triangles");
  expect_refused(block(Line{{0, 0.5, 0}, {0, 1, 0}}, "constant"), mesh_of(2, 2), "a plane that meets no node");
  std::string text = block(level, "constant");
  text.replace(text.find(", jump"), 0, ", x = [0.2, 0.8]");
  expect_refused(text, mesh_of(5, 3), "free surface beside the outline");
  text = block(level, "constant");
  text.replace(text.find("law = {"), std::string::npos, "law = { type = \"unilateral\" }\n" + std::string(at_rest_stages));
  expect_refused(text, mesh_of(5, 3), "a plane with constant or rigid jumps");
}

}  // namespace
}  // namespace uplift::element_jump_test
