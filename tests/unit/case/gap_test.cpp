#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "simple_meshes.h"
#include "text_support.h"
#include "uplift/case/case.h"
#include "uplift/io/text/toml.h"

// Initial gaps from the geometry and from tables.
namespace uplift::gap_test {
namespace {

BuiltCase built_of(const std::string& text, const Mesh& mesh = {}) {
  static std::vector<std::unique_ptr<Case>> kept;  // a model points into its case
  kept.push_back(std::make_unique<Case>(check_case(read_toml_text(text, "case.toml"), "case.toml",
                                                   [&](const std::string&, const Where&, const std::string&) { return mesh; })));
  return build(*kept.back(), RunSpec{});
}

std::vector<double> gaps(const BuiltCase& built) {
  const Interface& interface = built.model.interfaces.front();
  const Vector normal = interface.gap.tail(interface.batch.points);
  return {normal.begin(), normal.end()};
}

/// Three nodes of a rigid body over three nodes of the ground, drawn apart by 0, 1 and 4 mm.
std::string pairs_text(const std::string& gap, const std::string& upper = "[1, \"4 mm\"]", const std::string& joint = "pairs") {
  return "title = \"gap\"\n[nodes]\na = [-1, 0]\nb = [0, \"1 mm\"]\nc = " + upper +
         "\nd = [-1, 0]\ne = [0, 0]\nf = [1, 0]\n"
         "[[rigid]]\nname = \"body\"\nnode = \"b\"\nslaves = [\"a\", \"c\"]\nmass = 1e3\ninertia = 1e3\n"
         "[[support]]\nnode = \"d\"\nfixed = [\"ux\", \"uy\", \"rz\"]\n[[support]]\nnode = \"e\"\nfixed = [\"ux\", \"uy\", \"rz\"]\n"
         "[[support]]\nnode = \"f\"\nfixed = [\"ux\", \"uy\", \"rz\"]\n"
         "[[interface]]\nname = \"foot\"\nlaw = \"unilateral\"\n" +
         (joint == "pairs" ? "pairs = { upper = [\"a\", \"b\", \"c\"], lower = [\"d\", \"e\", \"f\"], area = 1 }\n"
                           : "line = { upper = [\"a\", \"b\", \"c\"], lower = [\"d\", \"e\", \"f\"], quadrature = \"gauss\" }\n") +
         gap + "[[stage]]\ntype = \"dynamic\"\nduration = 0.01\nstep = 0.01\n";
}

TEST(InitialGap, OfPairsIsThatOfTheDrawing) {
  const std::vector<double> found = gaps(built_of(pairs_text("gap = \"geometry\"\n")));
  ASSERT_EQ(found.size(), 3);
  EXPECT_NEAR(found[0], 0, 1e-15);
  EXPECT_NEAR(found[1], 1e-3, 1e-15);
  EXPECT_NEAR(found[2], 4e-3, 1e-15);
  for (const double gap : gaps(built_of(pairs_text("")))) EXPECT_EQ(gap, 0);  // not unless it is asked for
}

TEST(InitialGap, OfALineVariesLinearlyOverItsElements) {
  // Upper side straight from 0 to 1 mm, then to 4 mm; two Gauss points on each element. The normal follows the upper side: cos(slope).
  const std::vector<double> found = gaps(built_of(pairs_text("gap = \"geometry\"\n", "[1, \"4 mm\"]", "line")));
  ASSERT_EQ(found.size(), 4);
  const double g = 0.5 / std::sqrt(3.0);
  const double exact[] = {1e-3 * (0.5 - g), 1e-3 * (0.5 + g), 1e-3 + 3e-3 * (0.5 - g), 1e-3 + 3e-3 * (0.5 + g)};
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(found[static_cast<std::size_t>(i)], exact[i], 1e-5 * exact[i]);
}

TEST(InitialGap, OfATableIsLinearBetweenThePositionsAndAddsToTheOthers) {
  // A wedge of 2 mm per metre from x = -0.5 on; with a uniform millimetre and the drawing on top.
  const std::string table = "gap_profile = { along = \"x\", positions = [-0.5, 0.5], gaps = [0, \"2 mm\"] }\n";
  const std::vector<double> alone = gaps(built_of(pairs_text(table))), drawn = gaps(built_of(pairs_text("gap = \"geometry\"\n" + table))),
                            uniform = gaps(built_of(pairs_text("gap = \"1 mm\"\n" + table)));
  const double exact[] = {0, 1e-3, 2e-3}, geometry[] = {0, 1e-3, 4e-3};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(alone[i], exact[i], 1e-15);
    EXPECT_NEAR(drawn[i], exact[i] + geometry[i], 1e-15);
    EXPECT_NEAR(uniform[i], exact[i] + 1e-3, 1e-15);
  }
}

TEST(InitialGap, OverTheDistanceFromAPoint) {
  // A cone: gap = r/100 over a footing in space.
  const std::string text =
      "title = \"cone\"\n[nodes]\nbody = [1, 2, 0.5]\n[[mass]]\nnode = \"body\"\nmass = 1e3\ninertia = 1e3\n"
      "[[interface]]\nname = \"foot\"\nfooting = { body = \"body\", width = 2, length = 3, points = 5, points_across = 4, offset = [0, 0, "
      "-0.5] "
      "}\nlaw = \"unilateral\"\ngap_profile = { along = \"distance\", centre = [1, 2, 0], positions = [0, 10], gaps = [0, 0.1] }\n"
      "[[stage]]\ntype = \"dynamic\"\nduration = 0.01\nstep = 0.01\n";
  const BuiltCase built = built_of(text);
  const Interface& interface = built.model.interfaces.front();
  const std::vector<double> found = gaps(built);
  ASSERT_EQ(found.size(), 20);
  for (std::size_t i = 0; i < found.size(); ++i)
    EXPECT_NEAR(found[i], std::hypot(interface.position[i].x() - 1, interface.position[i].y() - 2) / 100, 1e-14);
}

/// Two blocks, 0.1 m apart at x = 0 and 0.4 m at x = 3 m. `shift` moves a node of the upper one along the joint.
Mesh two_blocks(Cell cell, double shift = 0) {
  Grid lines{uniform_lines(0, 3, 3), {-1, 0, 1, 2}, {}};
  if (info(cell).dimension == 3) lines = {uniform_lines(0, 3, 3), uniform_lines(0, 2, 2), {-1, 0, 1, 2}};
  const bool space = lines.dimension() == 3;
  Mesh mesh = with_cells(grid(
                             lines, [&](int, int j, int k) { return (space ? k : j) == 1 ? -1 : (space ? k : j) / 2; }, {"soil", "block"},
                             [](int part, Direction direction, int other) -> std::string {
                               return other < 0 ? (part == 0 ? "soil_" : "block_") + std::string(name_of(direction)) : "";
                             }),
                         cell);
  const int up = space ? 2 : 1;
  for (Vec3& x : mesh.nodes)
    if (x[up] > 0.99) x[up] += x[up] < 1.01 ? 0.1 * (1 + x.x()) - 1 : 0;
  for (Vec3& x : mesh.nodes)
    if (x.x() == 1 && x[up] > 0.19 && x[up] < 0.21) x.x() += shift;
  return mesh;
}

std::string blocks_text(const std::string& surface, const std::string& quadrature = "nodal") {
  return "title = \"blocks\"\n[mesh]\nfile = \"blocks.msh\"\n[[solid]]\ngroup = \"soil\"\nE = 5e7\npoisson = 0.3\ndensity = 1900\n"
         "[[solid]]\ngroup = \"block\"\nE = 2e9\npoisson = 0.3\ndensity = 2400\n[[interface]]\nname = \"base\"\nsurface = { " +
         surface + ", quadrature = \"" + quadrature +
         "\" }\ngap = \"geometry\"\nlaw = \"unilateral\"\n"
         "[[stage]]\ntype = \"dynamic\"\nduration = 1e-3\nstep = 1e-3\n";
}

const std::string apart = "lower_group = \"soil_top\", upper_group = \"block_bottom\"";

TEST(InitialGap, OfFacesThatAreDrawnApart) {
  // Every point sees the distance at its place, with shape functions of both sides and at both rules.
  for (const Cell cell : {Cell::quad4, Cell::tri6, Cell::quad8, Cell::hex8, Cell::hex20, Cell::tet4, Cell::wedge15})
    for (const char* quadrature : {"nodal", "gauss"}) {
      const BuiltCase built = built_of(blocks_text(apart, quadrature), two_blocks(cell));
      const Interface& interface = built.model.interfaces.front();
      const std::vector<double> found = gaps(built);
      EXPECT_NEAR(interface.area.sum(), info(cell).dimension == 3 ? 6 : 3, 1e-12);
      for (std::size_t i = 0; i < found.size(); ++i) {
        EXPECT_NEAR(found[i], 0.1 * (1 + interface.position[i].x()), 1e-12) << info(cell).name << quadrature;
        EXPECT_NEAR(interface.normal[i][info(cell).dimension - 1], 1, 1e-12);
      }
      // lifting the block opens every point by as much
      Vector lifted = Vector::Zero(built.model.full_unknowns());
      for (int node = 0; node < static_cast<int>(built.model.nodes.size()); ++node)
        if (built.model.nodes[static_cast<std::size_t>(node)].position[built.model.space.up()] > 0.05)
          lifted[built.model.space.unknowns() * node + built.model.space.up()] = 1;
      const Vector opened = built.model.assembly.b * lifted;
      for (int i = 0; i < interface.batch.points; ++i) EXPECT_NEAR(opened[interface.batch.normal() + i], 1, 1e-12);
    }
}

TEST(InitialGap, OfFacesThatDoNotLieOppositeIsRefused) {
  const auto refusal = [](const std::string& surface, double shift = 0) {
    return support::refusal_of([&] { built_of(blocks_text(surface), two_blocks(Cell::quad4, shift)); });
  };
  EXPECT_EQ(refusal(apart), "accepted");
  EXPECT_NE(refusal(apart, 0.01).find("case.toml:16"), std::string::npos) << refusal(apart, 0.01);
  EXPECT_NE(refusal(apart, 0.01).find("none opposite to (1, 0, 0) m"), std::string::npos) << refusal(apart, 0.01);
  EXPECT_NE(refusal("lower_group = \"soil_top\", upper_group = \"block_left\"").find("with the same number of faces"), std::string::npos);
  EXPECT_NE(refusal("lower_group = \"soil_tops\", upper_group = \"block_bottom\"").find("\"soil_top\""), std::string::npos);
  EXPECT_NE(refusal("lower_group = \"soil_top\", lower = [\"soil\"]").find("group and lower, or lower_group and upper_group"),
            std::string::npos);
  EXPECT_NE(refusal("lower_group = \"soil\", upper_group = \"block_bottom\"").find("a group of edges on the surface of a solid"),
            std::string::npos);
}

TEST(InitialGap, ThatMakesNoSenseIsRefused) {
  const auto refusal = [](const std::string& text) { return support::refusal_of([&] { built_of(text); }); };
  const std::string footing =
      "title = \"gap\"\n[nodes]\nbody = [0, 0]\n[[mass]]\nnode = \"body\"\nmass = 1e3\ninertia = 1e3\n[[interface]]\nname = \"foot\"\n"
      "footing = { body = \"body\", width = 2, points = 5 }\nlaw = \"unilateral\"\ngap = \"geometry\"\n"
      "[[stage]]\ntype = \"dynamic\"\nduration = 0.01\nstep = 0.01\n";
  EXPECT_NE(refusal(footing).find("case.toml:12: interface[0].gap: expected a gap in m for an interface whose faces are not both drawn"),
            std::string::npos)
      << refusal(footing);
  const std::string offset = refusal(pairs_text("gap = \"geometry\"\n", "[1.1, \"4 mm\"]"));
  EXPECT_NE(offset.find("an offset of 0.1 m along the interface"), std::string::npos) << offset;
  EXPECT_NE(refusal(pairs_text("gap = \"geometrie\"\n")).find("geometry"), std::string::npos);
  EXPECT_NE(refusal(pairs_text("gap_profile = { along = \"x\", positions = [0, 1], gaps = [1] }\n")).find("as many gaps as positions (2)"),
            std::string::npos);
}

}  // namespace
}  // namespace uplift::gap_test
