#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "text_support.h"
#include "unit/case/cut_support.h"

// Several rafts on one ground, each on a plane that the mesh ignores.
namespace uplift::cut_rafts_test {
namespace {

using namespace support;

constexpr double soil_young = 5e7, block_young = 2e9, soil_density = 1900, block_density = 700;

/// Rafts on the ground from -10 to 10 m, 6 m deep, pushed sideways by a tenth of gravity.
std::string two_rafts(const std::string& interfaces) {
  std::string text = "title = \"rafts\"\n[mesh]\nfile = \"rafts.msh\"\n" + solid("volume", soil_young, 0.3, soil_density) +
                     solid("one", block_young, 0.3, block_density) + solid("two", block_young, 0.3, 2 * block_density) +
                     "[[support]]\ngroup = \"bottom\"\nfixed = [\"ux\", \"uy\"]\n[gravity]\nacceleration = [1, -10]\n";
  return text + interfaces + at_rest_stages;
}
constexpr const char* raft_law = "law = { type = \"springs\", K_n = 1e9, K_t = 1e9, tangential = \"bonded\" }\n";

std::string raft_on(double level, double from, double to, const std::string& name, const std::string& more = {}) {
  return fmt::format(
      "[[interface]]\nname = \"{0}\"\n{1}cut = {{ through = [\"volume\"], level = {2}, upper = \"{0}\", x = [{3}, {4}]{5} }}\n", name,
      raft_law, level, from, to, more);
}

TEST(CutCase, TwoRaftsOnOneGround) {
  const Mesh whole = rectangle(uniform_lines(-10, 10, 40), uniform_lines(0, 8, 16));
  const RunResult cut = run_on(two_rafts(raft_on(6.13, -6.2, -2.7, "one") + raft_on(6.13, 1.3, 5.9, "two", ", height = 1.2")), whole);
  const double first = 3.5 * 1.87 * block_density * 10, second = 4.6 * 1.2 * 2 * block_density * 10;
  EXPECT_NEAR(at_rest(cut, "one.axial"), -first, 1e-11 * first);
  EXPECT_NEAR(at_rest(cut, "two.axial"), -second, 1e-11 * second);
  EXPECT_NEAR(std::abs(at_rest(cut, "one.shear")), first / 10, 1e-11 * first);
  EXPECT_NEAR(std::abs(at_rest(cut, "two.shear")), second / 10, 1e-11 * second);
}

TEST(CutCase, TwoRaftsThroughNodesAreTwoAlignedJoints) {
  const Grid lines{uniform_lines(-10, 10, 40), uniform_lines(0, 8, 16), {}};
  const auto part = [](int i, int j, int) { return j < 12 ? 0 : i >= 8 && i < 15 ? 1 : i >= 22 && i < 32 ? 2 : -1; };
  const Mesh parted = grid(lines, part, {"volume", "one", "two"}, [](int of, Direction direction, int other) -> std::string {
    if (of == 0 && other > 0) return other == 1 ? "under_one" : "under_two";
    return of == 0 && direction == Direction::bottom ? "bottom" : "";
  });
  std::string joints;
  for (const std::string name : {"one", "two"})
    joints +=
        fmt::format("[[interface]]\nname = \"{0}\"\n{1}surface = {{ group = \"under_{0}\", lower = [\"volume\"] }}\n", name, raft_law);
  const RunResult aligned = run_on(two_rafts(joints), parted);
  const RunResult cut = run_on(two_rafts(raft_on(6, -6, -2.5, "one") + raft_on(6, 1, 6, "two")), rectangle(lines.x, lines.y));
  for (const char* column : {"one.axial", "two.axial", "one.moment", "two.moment", "one.rotation", "two.rotation"}) {
    const double expected = at_rest(aligned, column);
    EXPECT_NEAR(at_rest(cut, column), expected, 1e-8 * std::abs(expected)) << column;
  }
}

TEST(CutCase, RaftsAtTwoLevelsOfOneGround) {
  // the ground is 6.13 m deep up to x = 0 and 4.2 m beyond; the second raft ends within a cell of the wall. The order does not matter
  const Mesh whole = rectangle(uniform_lines(-10, 10, 40), uniform_lines(0, 8, 16));
  const std::string high = raft_on(6.13, -6.2, -2.7, "one", ", ground_x = [-10, 0]"),
                    low = raft_on(4.2, 0.3, 5.9, "two", ", height = 1.2, ground_x = [0, 10]");
  const double first = 3.5 * 1.87 * block_density * 10, second = 5.6 * 1.2 * 2 * block_density * 10;
  for (const std::string& both : {high + low, low + high}) {
    const RunResult cut = run_on(two_rafts(both), whole);
    EXPECT_NEAR(at_rest(cut, "one.axial"), -first, 1e-11 * first);
    EXPECT_NEAR(at_rest(cut, "two.axial"), -second, 1e-11 * second);
    EXPECT_NEAR(std::abs(at_rest(cut, "one.shear")), first / 10, 1e-11 * first);
    EXPECT_NEAR(std::abs(at_rest(cut, "two.shear")), second / 10, 1e-11 * second);
  }
  const std::string refused = support::refusal_of(
      [&] { read_on(two_rafts(raft_on(6.13, -6.2, -2.7, "one") + raft_on(4.2, 0.3, 5.9, "two", ", height = 1.2")), whole); });
  EXPECT_NE(refused.find("ground_x"), std::string::npos) << refused;
}

TEST(CutCase, TwoLevelsThroughNodesAreTwoAlignedJoints) {
  const auto in_space = [](std::string text) {
    for (const auto& [plane, space] : {std::pair{"[1, -10]", "[1, 0, -10]"}, std::pair{"\"uy\"]", "\"uy\", \"uz\"]"}})
      text.replace(text.find(plane), std::string(plane).size(), space);
    return text;
  };
  for (const int dimension : {2, 3}) {
    Grid lines{uniform_lines(-10, 10, 20), uniform_lines(0, 8, 8), {}};
    if (dimension == 3) lines = {lines.x, uniform_lines(0, 1, 1), lines.y};
    const auto part = [&](int i, int j, int k) {
      const int row = dimension == 2 ? j : k, level = i < 10 ? 6 : 4;
      return row < level ? 0 : i >= 4 && i < 8 ? 1 : i >= 11 && i < 16 ? 2 : -1;
    };
    const Mesh parted = grid(lines, part, {"volume", "one", "two"}, [](int of, Direction direction, int other) -> std::string {
      if (of == 0 && other > 0) return other == 1 ? "under_one" : "under_two";
      return of == 0 && direction == Direction::bottom ? "bottom" : "";
    });
    const Mesh whole = dimension == 2 ? rectangle(lines.x, lines.y) : box(lines.x, lines.y, lines.z);
    std::string joints;
    for (const std::string name : {"one", "two"})
      joints +=
          fmt::format("[[interface]]\nname = \"{0}\"\n{1}surface = {{ group = \"under_{0}\", lower = [\"volume\"] }}\n", name, raft_law);
    const std::string cuts = raft_on(6, -6, -2, "one", ", ground_x = [-10, 0]") + raft_on(4, 1, 6, "two", ", ground_x = [0, 10]");
    const auto result = [&](const std::string& interfaces, const Mesh& mesh) {
      return run_on(dimension == 2 ? two_rafts(interfaces) : in_space(two_rafts(interfaces)), mesh);
    };
    const RunResult aligned = result(joints, parted), cut = result(cuts, whole);
    const std::string tilt = dimension == 2 ? "rotation" : "rotation_2";
    for (const std::string& column : std::vector<std::string>{"one.axial", "two.axial", "one." + tilt, "two." + tilt}) {
      const double expected = at_rest(aligned, column);
      EXPECT_NE(expected, 0);
      EXPECT_NEAR(at_rest(cut, column), expected, 1e-8 * std::abs(expected)) << column << " " << dimension;
    }
  }
}

TEST(CutCase, OutlinesOnOnePlaneAreSaidToBeWrongAtTheirLine) {
  const Mesh whole = rectangle(uniform_lines(-10, 10, 40), uniform_lines(0, 8, 16));
  const auto refusal = [&](const std::string& second) {
    return support::refusal_of([&] { read_on(two_rafts(raft_on(6.13, -6.2, -2.7, "one") + second), whole); });
  };
  EXPECT_NE(refusal(raft_on(6.13, 20, 25, "two")).find("interface[1].cut"), std::string::npos) << refusal(raft_on(6.13, 20, 25, "two"));
  EXPECT_NE(refusal(raft_on(6.13, -2.6, 2, "two")).find("a cell apart"), std::string::npos);
  EXPECT_NE(refusal(raft_on(6.13, 1, 2, "two", ", mesh_shift = 0.2")).find("as of the other outline"), std::string::npos);
}

TEST(CutCase, NothingIsFastenedWhereNothingStands) {
  // node 16 * 41 + 1 is the corner of the rectangle above the ground beside the raft
  const Mesh whole = rectangle(uniform_lines(-10, 10, 40), uniform_lines(0, 7, 7));
  const std::string text = two_rafts(raft_on(6.13, -6.2, -2.7, "one") + raft_on(6.13, 1.3, 5.9, "two"));
  const std::string load = "[[load]]\nnode = \"mesh.288\"\nforce = [0, -1]\n";
  const auto refusal = [&] {
    const Case read = read_on(text + load, whole);
    build(read, RunSpec{});
  };
  EXPECT_NE(support::refusal_of(refusal).find("leave nothing"), std::string::npos) << support::refusal_of(refusal);
}

}  // namespace
}  // namespace uplift::cut_rafts_test
