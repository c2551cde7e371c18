#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "simple_meshes.h"
#include "text_support.h"
#include "unit/case/cut_support.h"
#include "uplift/case/case.h"
#include "uplift/case/mesh/mesh.h"

// Interfaces on planes that the mesh ignores: against closed forms, and against the aligned joint.
namespace uplift::cut_test {
namespace {

using namespace support;

// ---- the patch test: a bar in tension, cut at 25 degrees, with an elastic joint ----

constexpr double young = 2e10, poisson = 0.2, traction = 1e6, joint_stiffness = 1e11;

std::string bar(const std::string& normal, int dimension) {
  const std::string zeros = dimension == 2 ? "0" : "0, 0";
  return "title = \"bar\"\n[mesh]\nfile = \"bar.msh\"\n" + solid("volume", young, poisson, 2000) + solid("beyond", young, poisson, 2000) +
         "[[support]]\ngroup = \"left\"\nfixed = [\"ux\"]\n" +
         (dimension == 2 ? "[[support]]\nnode = \"mesh.1\"\nfixed = [\"uy\"]\n"
                         : "[[support]]\ngroup = \"front\"\nfixed = [\"uy\"]\n[[support]]\ngroup = \"bottom\"\nfixed = [\"uz\"]\n") +
         fmt::format("[[load]]\nname = \"pull\"\ngroup = \"right\"\ntraction = [{}, {}]\n", traction, zeros) +
         fmt::format(
             "[[interface]]\nname = \"crack\"\ncut = {{ through = [\"volume\"], point = [2.03, 0.47{}], normal = {}, upper = "
             "\"beyond\" }}\nlaw = {{ type = \"elastic\", K_n = {}, K_t = {} }}\n",
             dimension == 2 ? "" : ", 0.5", normal, joint_stiffness, joint_stiffness) +
         fmt::format("[[output.history]]\nname = \"end\"\nat = [4, 1{}]\nquantity = \"ux\"\n", dimension == 2 ? "" : ", 1") +
         at_rest_stages;
}

TEST(CutCase, BarWithAnInclinedCrackHasUniformStress) {
  // sigma L (1 - nu^2)/E + cos a delta_n + sigma sin^2 a cos a/K_t with K_n delta_n = sigma cos^2 a; in space uniaxial stress
  const double a = 25 * std::numbers::pi / 180, c = std::cos(a), s = std::sin(a);
  const double jump = traction * c * c / joint_stiffness * c + traction * s * s * c / joint_stiffness;
  const auto x = uniform_lines(0, 4, 9), y = uniform_lines(0, 1, 3);
  for (const Cell cell : {Cell::tri3, Cell::quad4}) {
    const RunResult result = run_on(bar(fmt::format("[{}, {}]", c, s), 2), rectangle(x, y, cell));
    const double expected = traction * 4 * (1 - poisson * poisson) / young + jump;
    EXPECT_NEAR(at_rest(result, "end"), expected, 1e-12 * expected) << info(cell).name;
  }
  for (const Cell cell : {Cell::tet4, Cell::wedge6, Cell::hex8}) {
    const std::string upright = fmt::format("[{}, 0, {}]", c, s);
    std::string text = bar(upright, 3);
    const std::string held = "[[support]]\ngroup = \"bottom\"\nfixed = [\"uz\"]\n";
    text.replace(text.find(held), held.size(), "[[support]]\nnode = \"mesh.1\"\nfixed = [\"uz\"]\n");
    const RunResult result = run_on(text, box(x, y, y, cell));
    const double expected = traction * 4 / young + jump;
    EXPECT_NEAR(at_rest(result, "end"), expected, 1e-12 * expected) << info(cell).name;
  }
}

// ---- corners of cells just below the plane ----

TEST(CutCase, CornersNextToThePlaneCarryTheWeight) {
  // The plane passes a node on a side of the block, 1e-5 to 3e-8 of a cell beside it, and rises towards the side or away from it. Some
  // doubles then belong to the tip of one cell, of 1e-10 to 1e-24 of its volume.
  constexpr double density = 2000, gravity = 9.81, slope = 0.14;
  const Vec3 normal = Vec3(-slope, 0, 1).normalized();
  for (const Cell cell : {Cell::tri3, Cell::quad4, Cell::tet4, Cell::wedge6, Cell::hex8})
    for (const double share : {1e-5, 3e-7, 3e-8, -3e-8})
      for (const double side : {0.0, 1.0}) {
        const bool plane = info(cell).dimension == 2;
        const auto lines = uniform_lines(0, 1, 4);
        const double height = 0.5 + 0.25 * share;  // of the plane at the side
        const auto vector = [&](double x, double up) { return plane ? fmt::format("[{}, {}]", x, up) : fmt::format("[{}, 0, {}]", x, up); };
        const std::string text = "title = \"block\"\n[mesh]\nfile = \"block.msh\"\n" + solid("volume", young, poisson, density) +
                                 solid("block", young, poisson, density) +
                                 fmt::format("[[support]]\ngroup = \"bottom\"\nfixed = [\"ux\", \"uy\"{}]\n", plane ? "" : ", \"uz\"") +
                                 fmt::format("[gravity]\nacceleration = {}\n[[interface]]\nname = \"base\"\n", vector(0, -gravity)) +
                                 fmt::format("cut = {{ through = [\"volume\"], point = {}, normal = {}, upper = \"block\" }}\n",
                                             vector(side, height), vector(normal.x(), normal.z())) +
                                 fmt::format("law = {{ type = \"elastic\", K_n = {0}, K_t = {0} }}\n", 0.01 * joint_stiffness) +
                                 at_rest_stages;
        const RunResult result = run_on(text, plane ? rectangle(lines, lines, cell) : box(lines, lines, lines, cell));
        const double above = 1 - height - slope * (0.5 - side), weight = above * density * gravity;
        EXPECT_NEAR(at_rest(result, "base.axial"), -weight * normal.z(), 1e-12 * weight) << info(cell).name << " " << share;
        EXPECT_NEAR(std::abs(at_rest(result, "base.shear")), weight * slope * normal.z(), 1e-12 * weight)
            << info(cell).name << " " << share;
      }
}

// ---- a column of soil and block that is one group in the mesh ----

constexpr double depth = 5.63, height = 4.37, soil_young = 5e7, block_young = 2e9, soil_density = 1900, block_density = 700, gravity = 10;

std::string column(double level, const std::string& law, bool block = true) {
  return "title = \"column\"\n[mesh]\nfile = \"column.msh\"\n" + solid("volume", soil_young, 0.3, soil_density) +
         (block ? solid("block", block_young, 0.3, block_density) : "") +
         "[[support]]\ngroup = \"bottom\"\nfixed = [\"ux\", \"uy\"]\n[[support]]\ngroup = \"left\"\nfixed = [\"ux\"]\n"
         "[[support]]\ngroup = \"right\"\nfixed = [\"ux\"]\n"
         "[gravity]\nacceleration = [0, -10]\n" +
         fmt::format("[[interface]]\nname = \"base\"\ncut = {{ through = [\"volume\"], level = {}, upper = \"block\" }}\nlaw = {}\n", level,
                     law) +
         "[[output.history]]\nname = \"top\"\nat = [0, 10]\nquantity = \"uy\"\n" + at_rest_stages;
}

TEST(CutCase, ColumnOfTwoMaterialsSettlesByTheClosedForm) {
  // One-dimensional strain: the elements are exact at their nodes, cut ones too.
  const auto constrained = [](double e) { return e * 0.7 / (1.3 * 0.4); };
  const double pressure = block_density * gravity * height, joint = 3e7;
  const double soil = soil_density * gravity * depth * depth / (2 * constrained(soil_young)) + pressure * depth / constrained(soil_young);
  const double block = block_density * gravity * height * height / (2 * constrained(block_young));
  const RunResult result = run_on(column(depth, fmt::format("{{ type = \"elastic\", K_n = {}, tangential = \"bonded\" }}", joint)),
                                  rectangle(uniform_lines(-1, 1, 2), uniform_lines(0, 10, 10)));
  const double expected = -(soil + pressure / joint + block);
  EXPECT_NEAR(at_rest(result, "top"), expected, 1e-12 * std::abs(expected));
  EXPECT_NEAR(at_rest(result, "base.axial"), -pressure * 2, 1e-12 * pressure);
}

TEST(CutCase, TiedSidesPartAtTheInterface) {
  // One-dimensional strain by ties instead of supports; also where nodes of both sides of an aligned joint stand at one place.
  const std::string held = "[[support]]\ngroup = \"left\"\nfixed = [\"ux\"]\n[[support]]\ngroup = \"right\"\nfixed = [\"ux\"]\n";
  const std::string tied = "[[tie]]\ngroup = \"left\"\nto = \"right\"\nunknowns = [\"ux\", \"uy\"]\n";
  const std::string law = "{ type = \"springs\", K_n = 3e7, K_t = 3e7 }";
  for (const Cell cell : {Cell::quad4, Cell::tri3})
    for (const double level : {5.63, 6.0, 9.5}) {
      const Mesh mesh = rectangle(uniform_lines(-1, 1, 4), uniform_lines(0, 10, 10), cell);
      const std::string text = column(level, law);
      std::string other = text;
      other.replace(other.find(held), held.size(), tied);
      const RunResult a = run_on(text, mesh), b = run_on(other, mesh);
      const double weight = block_density * gravity * (10 - level) * 2, top = at_rest(a, "top");
      EXPECT_NEAR(at_rest(b, "base.axial"), -weight, 1e-11 * weight) << level;
      EXPECT_NEAR(at_rest(b, "top"), top, (cell == Cell::quad4 ? 1e-9 : 1e-4) * std::abs(top))
          << level;  // triangles move sideways a little
    }
}

TEST(CutCase, ThroughNodesItIsTheAlignedJoint) {
  const Grid lines{uniform_lines(-1, 1, 4), uniform_lines(0, 10, 10), {}};
  const Mesh parted = grid(
      lines, [](int, int j, int) { return j < 6 ? 0 : 1; }, {"volume", "block"},
      [](int part, Direction direction, int other) -> std::string {
        if (part == 0 && other == 1) return "interface";
        return other >= 0 ? "" : std::string(name_of(direction));
      });
  const std::string law = "{ type = \"springs\", K_n = 1e10, K_t = 1e10 }";
  std::string text = column(6, law);
  const std::string push =
      "[[function]]\nname = \"push\"\nshape = { type = \"harmonic\", frequency = 2, amplitude = 12e3 }\n"
      "[[load]]\ngroup = \"top\"\ntraction = [1, 0]\nfunction = \"push\"\n";
  const std::string sides = "[[support]]\ngroup = \"left\"\nfixed = [\"ux\"]\n[[support]]\ngroup = \"right\"\nfixed = [\"ux\"]\n";
  text.replace(text.find(sides), sides.size(), push);
  text.replace(text.find("duration = 1e-3"), 15, "duration = 0.3 ");
  std::string aligned = text;
  const std::string cut = "cut = { through = [\"volume\"], level = 6, upper = \"block\" }";
  aligned.replace(aligned.find(cut), cut.size(), "surface = { group = \"interface\", lower = [\"volume\"] }");
  Mesh one = rectangle(lines.x, lines.y);
  const RunResult a = run_on(text, one), b = run_on(aligned, parted);
  double open = 0;
  for (const char* name : {"base.moment", "base.axial", "top"}) {
    const auto x = history(a, name), y = history(b, name);
    ASSERT_EQ(x.size(), y.size());
    double most = 0, off = 0;
    for (std::size_t i = 0; i < x.size(); ++i) most = std::max(most, std::abs(y[i])), off = std::max(off, std::abs(x[i] - y[i]));
    EXPECT_LT(off, 1e-9 * most) << name;
  }
  for (const double ratio : history(a, "base.uplifted_ratio")) open = std::max(open, ratio);
  EXPECT_GT(open, 0.1);
}

// ---- a rigid block on tensionless springs; published values of a cut mesh (not of this program) ----

TEST(CutCase, RockingBlockOnTensionlessSprings) {
  // W = 3 m, plane at 0.37 m in rows of 0.25 m, k = 2e8 Pa/m, N = 1 MN/m: theta/theta_u at M/M_u = 1.5, 2, 2.5 with six elements
  const std::array<double, 3> moments{1.5, 2, 2.5}, expected{1.671500, 3.461825, 9.000952};
  constexpr double width = 3, force = 1e6, k = 2e8, top = 1.0;
  const double lift_off = force / (k * width) / (width / 2);  // theta_u = 2 N/(k W^2)
  for (std::size_t i = 0; i < moments.size(); ++i) {
    const double moment = moments[i] * force * width / 6, shear = moment / (top - 0.37);
    std::string text = "title = \"block\"\n[mesh]\nfile = \"block.msh\"\n" + solid("volume", 1e13, 0.2, 2000) +
                       solid("block", 1e13, 0.2, 2000) + "[[support]]\ngroup = \"bottom\"\nfixed = [\"ux\", \"uy\"]\n" +
                       fmt::format("[[load]]\nname = \"weight\"\ngroup = \"top\"\ntraction = [{}, {}]\n", shear / width, -force / width) +
                       fmt::format(
                           "[[interface]]\nname = \"base\"\ncut = {{ through = [\"volume\"], level = 0.37, upper = \"block\" }}\n"
                           "law = {{ type = \"springs\", K_n = {}, K_t = {}, tangential = \"bonded\" }}\n",
                           k, 100 * k) +
                       at_rest_stages;
    const RunResult result = run_on(text, rectangle(uniform_lines(-1.5, 1.5, 6), uniform_lines(0, 1, 4)));
    EXPECT_NEAR(std::abs(at_rest(result, "base.rotation")) / lift_off, expected[i], 2e-4 * expected[i]) << moments[i];
  }
}

TEST(CutCase, WarnsOfAnOutlineInsideCoarseCells) {
  const auto said = [](const std::string& outline, int cells) {
    std::string text = column(depth, "{ type = \"springs\", K_n = 1e9, K_t = 1e9 }");
    text.replace(text.find("upper = "), 0, outline);
    const Case read = read_on(text, rectangle(uniform_lines(-1, 1, cells), uniform_lines(0, 10, 10)));
    const BuiltCase built = build(read, RunSpec{});
    return std::ranges::any_of(warnings(read, RunSpec{}, built),
                               [](const std::string& each) { return each.find("ends inside") != each.npos; });
  };
  EXPECT_TRUE(said("x = [-0.7, 0.7], ", 2));
  EXPECT_FALSE(said("x = [-0.5, 0.5], ", 4));     // the edges are sides of cells
  EXPECT_FALSE(said("x = [-0.7, 0.7], ", 1000));  // fine enough
  EXPECT_FALSE(said("", 2));
}

TEST(CutCase, WarnsOfAnOutlineBeyondTheMesh) {
  const auto said = [](const std::string& outline) {
    std::string text = column(depth, "{ type = \"springs\", K_n = 1e9, K_t = 1e9 }");
    text.replace(text.find("upper = "), 0, outline);
    const Case read = read_on(text, rectangle(uniform_lines(-1, 1, 4), uniform_lines(0, 10, 10)));
    std::string all;
    for (const std::string& each : warnings(read, RunSpec{}, build(read, RunSpec{}))) all += each + "\n";
    return all;
  };
  EXPECT_NE(said("x = [-0.5, 4], ").find("goes from -0.5 to 4 m in x, the cells that it cuts from -0.5 to 1 m"), std::string::npos);
  EXPECT_EQ(said("x = [-0.5, 1], ").find("goes from"), std::string::npos);
}

// Joints that are much stiffer than their cells: on level planes through rectangles alone the pressures are smooth.
TEST(CutCase, WarnsOfStiffJointsInCellsCutAtAnAngle) {
  const auto said = [](const std::string& normal, Cell cell, double y) {
    std::string text = bar(normal, 2);
    const std::string place = "2.03, 0.47", stiffness = fmt::format("{}", joint_stiffness);
    text.replace(text.find(place), place.size(), fmt::format("{}, 0.47", y));
    for (std::size_t at = text.find(stiffness); at != text.npos; at = text.find(stiffness, at + 1))
      text.replace(at, stiffness.size(), fmt::format("{}", 1e3 * young));
    const Case read = read_on(text, rectangle(uniform_lines(0, 4, 9), uniform_lines(0, 1, 3), cell));
    std::string all;
    for (const std::string& each : warnings(read, RunSpec{}, build(read, RunSpec{}))) all += each + "\n";
    return all;
  };
  EXPECT_NE(said("[0.9, 0.4]", Cell::quad4, 2.03).find("\"crack\" cuts its cells at an angle"), std::string::npos);
  EXPECT_NE(said("[0.9, 0.4]", Cell::tri3, 2.03).find("\"crack\" cuts triangles"), std::string::npos);
  EXPECT_NE(said("[1, 0]", Cell::tri3, 2.03).find("\"crack\" cuts triangles"), std::string::npos);
  EXPECT_EQ(said("[1, 0]", Cell::quad4, 2.03).find("cuts"), std::string::npos);
  EXPECT_EQ(said("[1, 0]", Cell::tri3, 16.0 / 9).find("cuts"), std::string::npos);  // along their sides
}

// ---- a raft on free ground: names of nodes, places, lines of beams ----

const Mesh& ground_of_8_by_4() {
  static const Mesh mesh = rectangle(uniform_lines(-4, 4, 8), uniform_lines(0, 4, 4));
  return mesh;
}
std::string raft(const std::string& more) {
  return "title = \"raft\"\n[mesh]\nfile = \"raft.msh\"\n" + solid("volume", 5e7, 0.3, 1900) + solid("raft", 2e10, 0.2, 2500) +
         "[[support]]\ngroup = \"bottom\"\nfixed = [\"ux\", \"uy\"]\n[gravity]\nacceleration = [0, -10]\n"
         "[[interface]]\nname = \"base\"\ncut = { through = [\"volume\"], level = 2.4, upper = \"raft\", x = [-2, 2] }\n"
         "law = { type = \"elastic\", K_n = 1e9, K_t = 1e9 }\n" +
         more + at_rest_stages;
}

TEST(CutCase, NodesKeepTheirNumbers) {
  // node 41 of the mesh stands at (0, 4), node 45 at (4, 4), where the ground beside the raft is removed
  const auto loaded = [](int node) { return raft(fmt::format("[[load]]\nnode = \"mesh.{}\"\nforce = [0, -1e5]\n", node)); };
  ASSERT_EQ(ground_of_8_by_4().nodes[40], Vec3(0, 4, 0));
  const RunResult result = run_on(loaded(41), ground_of_8_by_4());
  const double weight = 2500 * 10 * 4 * 1.6 + 1e5;
  EXPECT_NEAR(at_rest(result, "base.axial"), -weight, 1e-12 * weight);
  EXPECT_NEAR(at_rest(result, "base.moment"), 0, 1e-12 * weight);
  EXPECT_NE(support::refusal_of([&] { build(read_on(loaded(45), ground_of_8_by_4()), RunSpec{}); }).find("\"mesh.45\""), std::string::npos);
}

TEST(CutCase, PlacesAreThoseOfTheGround) {
  // the doubles of the ground beside the raft reach up to y = 3, the ground ends at 2.4
  const Case read = read_on(raft("[[output.history]]\nname = \"beside\"\nat = [-3, 3]\nquantity = \"uy\"\n"), ground_of_8_by_4());
  const BuiltCase built = build(read, RunSpec{});
  EXPECT_TRUE(std::ranges::any_of(built.notes, [](const std::string& note) { return note.find("0.6 m away") != note.npos; }))
      << fmt::format("{}", fmt::join(built.notes, "; "));
}

TEST(CutCase, ALineOfBeamsJoinsBothSides) {
  // three beams on edges of cells, from y = 1 to y = 4, through the plane at 2.4
  Mesh mesh = ground_of_8_by_4();
  Group& pile = mesh.groups["pile"];
  pile.dimension = 1;
  CellBlock& lines = mesh.block(Cell::line2);
  for (int j = 1; j < 4; ++j) {
    pile.cells.push_back({mesh.find_block(Cell::line2), lines.count()});
    lines.nodes.insert(lines.nodes.end(), {j * 9 + 4, (j + 1) * 9 + 4});
  }
  const double beam = 2500 * 10 * 0.5 * 3, ground = 1900 * 10 * 8 * 2.4, above = 2500 * 10 * 4 * 1.6;
  const std::string text = raft(
      "[[beam]]\nname = \"pile\"\ngroup = \"pile\"\nE = 2e10\nA = 0.5\nI = 0.02\nmass = \"consistent\"\ndensity = 2500\n"
      "[[output.history]]\nname = \"below\"\ngroup = \"bottom\"\nquantity = \"reaction_y\"\n");
  const RunResult result = run_on(text, mesh);
  EXPECT_NEAR(at_rest(result, "below"), beam + ground + above, 1e-12 * ground);
  EXPECT_GT(at_rest(result, "base.axial"), -0.9 * above);  // the pile carries a part of it
}

TEST(CutCase, RefusesWhatWouldStayBondedOrHang) {
  // a second group from y = 3 up, within |x| < 2
  const Grid lines{uniform_lines(-4, 4, 8), uniform_lines(0, 4, 4), {}};
  const Mesh mesh = grid(
      lines, [](int i, int j, int) { return j == 3 && i >= 2 && i < 6 ? 1 : 0; }, {"volume", "block"},
      [](int, Direction direction, int other) -> std::string { return other >= 0 ? "" : std::string(name_of(direction)); });
  const auto refusal = [&](const std::string& cut, const std::string& new_cut) {
    std::string text = raft(solid("block", 2e10, 0.2, 2500));
    text.replace(text.find(cut), cut.size(), new_cut);
    return support::refusal_of([&] { build(read_on(text, mesh), RunSpec{}); });
  };
  EXPECT_NE(refusal("level = 2.4, upper = \"raft\", x = [-2, 2]", "level = 3, upper = \"raft\"").find("in `through`"), std::string::npos);
  EXPECT_NE(refusal("x = [-2, 2]", "x = [-2, 2], height = 0.4").find("holds what stands above"), std::string::npos);
  EXPECT_NE(refusal("upper = \"raft\"", "upper = \"volume\"").find("another group than those of `through`"), std::string::npos);
}

TEST(CutCase, RefusesWithFileAndKey) {
  const Mesh mesh = rectangle(uniform_lines(-1, 1, 2), uniform_lines(0, 10, 10));
  const std::string law = "{ type = \"elastic\", K_n = 1e9 }";
  const auto refusal = [&](const std::string& from, const std::string& to) {
    std::string text = column(depth, law);
    const std::size_t place = text.find(from);
    EXPECT_NE(place, std::string::npos);
    text.replace(place, from.size(), to);
    return support::refusal_of([&] { build(read_on(text, mesh), RunSpec{}); });
  };
  EXPECT_NE(refusal("level = 5.63", "level = 12").find("above it"), std::string::npos);
  EXPECT_NE(refusal("level = 5.63, ", "").find("level, or point and normal"), std::string::npos);
  EXPECT_NE(refusal("level = 5.63", "level = 5.63, x = [1, -1]").find("least and the largest"), std::string::npos);
  EXPECT_NE(refusal("[\"volume\"]", "[\"volumes\"]").find("\"volume\""), std::string::npos);
  EXPECT_NE(refusal("level = 5.63, upper = \"block\" }\nlaw = " + law,
                    "point = [0, 5.63], normal = [0.3, 1], upper = \"block\" }\nlaw = \"unilateral\"")
                .find("angle"),
            std::string::npos);
}

TEST(CutCase, ConstraintsNeedLevelPlanesThroughQuadrilateralsOrHexahedra) {
  // Triangles have a point at every crossing: T + 1 in a row of T with T + 2 nodes. Their tractions change sign under a closed base.
  const auto refusal = [](const std::string& text, const Mesh& mesh) {
    return support::refusal_of([&] { build(read_on(text, mesh), RunSpec{}); });
  };
  const auto x = uniform_lines(-1, 1, 2), y = uniform_lines(0, 10, 10);
  const std::string inside = column(5.63, "\"unilateral\""), through_nodes = column(6, "\"unilateral\"");
  EXPECT_NE(refusal(inside, rectangle(x, y, Cell::tri3)).find("through triangles"), std::string::npos);
  EXPECT_NO_THROW(build(read_on(through_nodes, rectangle(x, y, Cell::tri3)), RunSpec{}));
  EXPECT_NO_THROW(build(read_on(inside, rectangle(x, y)), RunSpec{}));
  std::string text = bar("[0, 0, 1]", 3);
  text.replace(text.find("law = {"), text.find("[[output.history]]") - text.find("law = {"), "law = \"unilateral\"\n");
  const auto lines = uniform_lines(0, 1, 3);
  EXPECT_NE(refusal(text, box(uniform_lines(0, 4, 4), lines, lines, Cell::tet4)).find("through tetrahedra"), std::string::npos);
}

}  // namespace
}  // namespace uplift::cut_test
