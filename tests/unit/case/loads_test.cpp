#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "simple_meshes.h"
#include "text_support.h"
#include "uplift/case/case.h"
#include "uplift/io/text/toml.h"

// Pressures and tractions on surfaces of the mesh against integrals and closed forms.
namespace uplift::loads_test {
namespace {

const std::string solid =
    "title = \"loads\"\n[mesh]\nfile = \"mesh.msh\"\n[[solid]]\ngroup = \"volume\"\nE = 3e7\npoisson = 0.3\ndensity = 2000\n";
const std::string statics = "[[stage]]\ntype = \"static\"\nsteps = 1\n";

BuiltCase built_of(const std::string& text, const Mesh& mesh) {
  static std::vector<std::unique_ptr<Case>> kept;  // a model points into its case
  kept.push_back(std::make_unique<Case>(check_case(read_toml_text(text, "case.toml"), "case.toml",
                                                   [&](const std::string&, const Where&, const std::string&) { return mesh; })));
  return build(*kept.back(), RunSpec{});
}

std::string held(const std::string& group) {
  return "[[support]]\ngroup = \"" + group + "\"\nfixed = [\"ux\", \"uy\"]\n";
}

/// Resultant and moment about the origin of the first load of a model.
struct Sums {
  Vec3 force = Vec3::Zero(), moment = Vec3::Zero();
};
Sums sums_of_load(const BuiltCase& built) {
  const Model& model = built.model;
  Sums sums;
  for (int node = 0; node < static_cast<int>(model.nodes.size()); ++node) {
    Vec3 force = Vec3::Zero();
    for (int k = 0; k < model.space.dimension; ++k) force[k] = model.assembly.loads.front().coeff(model.space.unknowns() * node + k);
    sums.force += force;
    sums.moment += cross(model.nodes[static_cast<std::size_t>(node)].position, force);
  }
  return sums;
}

TEST(CaseLoads, WaterOnTheFaceOfADam) {
  // Depth h, unit weight g: the resultant is g h^2/2 per metre, at h/3 above the foot. The face is the left one: the water pushes to +x.
  constexpr double depth = 12, unit_weight = 9810;
  for (const Cell cell : {Cell::quad4, Cell::tri3, Cell::quad8, Cell::quad9, Cell::tri6}) {
    const Mesh mesh = rectangle(uniform_lines(0, 8, 3), {0, 2, 5, depth, 15}, cell);
    const std::string load = fmt::format(
        "[[load]]\ngroup = \"left\"\npressure = {}\nprofile = {{ along = \"y\", positions = [0, \"{} m\"], factors = [1, 0] }}\n",
        unit_weight * depth, depth);
    const Sums sums = sums_of_load(built_of(solid + held("bottom") + load + statics, mesh));
    const double thrust = unit_weight * depth * depth / 2;
    EXPECT_NEAR(sums.force.x(), thrust, 1e-12 * thrust) << info(cell).name;
    EXPECT_NEAR(sums.force.y(), 0, 1e-12 * thrust) << info(cell).name;
    EXPECT_NEAR(sums.moment.z(), -thrust * depth / 3, 1e-12 * thrust * depth) << info(cell).name;
  }
}

TEST(CaseLoads, WaterLevelInsideAFace) {
  // The level lies inside a face, where the slope of the pressure changes.
  constexpr double depth = 7.3, unit_weight = 9810, thrust = unit_weight * depth * depth / 2;
  const auto load = [&](const char* along) {
    return fmt::format("[[load]]\ngroup = \"left\"\npressure = {}\nprofile = {{ along = \"{}\", positions = [0, {}], factors = [1, 0] }}\n",
                       unit_weight * depth, along, depth);
  };
  for (const Cell cell : {Cell::quad4, Cell::quad8}) {
    const Mesh mesh = rectangle({0, 8}, {0, 5, 10}, cell);
    const Sums sums = sums_of_load(built_of(solid + held("bottom") + load("y") + statics, mesh));
    EXPECT_NEAR(sums.force.x(), thrust, 2e-5 * thrust);
    EXPECT_NEAR(sums.moment.z(), -thrust * depth / 3, 2e-5 * thrust * depth);
  }
  for (const Cell cell : {Cell::hex8, Cell::hex20, Cell::tet4, Cell::tet10}) {
    const Mesh mesh = box({0, 8}, {0, 3}, {0, 5, 10}, cell);
    const Sums sums =
        sums_of_load(built_of(solid + "[[support]]\ngroup = \"bottom\"\nfixed = [\"ux\", \"uy\", \"uz\"]\n" + load("z") + statics, mesh));
    EXPECT_NEAR(sums.force.x(), 3 * thrust, 2e-4 * 3 * thrust) << info(cell).name;
    EXPECT_NEAR(sums.moment.y(), thrust * depth, 2e-4 * 3 * thrust * depth) << info(cell).name;
    EXPECT_NEAR(sums.moment.z(), -3 * thrust * 1.5, 2e-4 * 3 * thrust * depth) << info(cell).name;
  }
}

/// A sector of a ring, 1 m < r < 2 m, 0 < angle < 90 degrees: with nodes in the middles of edges its edges are parabolas.
Mesh sector(Cell cell, bool in_space = false) {
  Mesh mesh = in_space ? box(uniform_lines(1, 2, 2), uniform_lines(0, 1, 3), uniform_lines(0, 1, 2), cell)
                       : rectangle(uniform_lines(1, 2, 2), uniform_lines(0, 1, 3), cell);
  if (cell == Cell::tet10) return mesh;  // its stiffness is integrated exactly with straight edges only
  for (Vec3& x : mesh.nodes) x = {x.x() * std::cos(x.y() * std::numbers::pi / 2), x.x() * std::sin(x.y() * std::numbers::pi / 2), x.z()};
  return mesh;
}

TEST(CaseLoads, LinearPressureOnCurvedEdges) {
  // The outer edge consists of parabolas through three nodes each: -p(y) n ds with n ds = (dy, -dx) along it, summed up in fine steps.
  const Mesh mesh = sector(Cell::quad8);
  const auto pressure = [](double y) { return 1000 * (0.5 + 1.5 * y); };
  for (const bool normal : {true, false}) {
    const std::string load = std::string("[[load]]\ngroup = \"right\"\n") + (normal ? "pressure = 1000" : "traction = [400, -300]") +
                             "\nprofile = { along = \"y\", positions = [0, 10], factors = [0.5, 15.5] }\n";
    const Sums sums = sums_of_load(built_of(solid + held("bottom") + load + statics, mesh));
    Sums exact;
    for (int edge = 0; edge < 3; ++edge) {
      const auto node = [&](int half) {
        const double angle = (edge + half / 2.0) / 3 * std::numbers::pi / 2;
        return Vec3(2 * std::cos(angle), 2 * std::sin(angle), 0);
      };
      const auto at = [&](double s) -> Vec3 {  // 0 to 1
        return (1 - s) * (1 - 2 * s) * node(0) + 4 * s * (1 - s) * node(1) + s * (2 * s - 1) * node(2);
      };
      constexpr int steps = 100000;
      for (int k = 0; k < steps; ++k) {
        const Vec3 along = at((k + 1.0) / steps) - at(static_cast<double>(k) / steps), x = at((k + 0.5) / steps);
        const Vec3 force = normal ? Vec3(-pressure(x.y()) * Vec3(along.y(), -along.x(), 0))
                                  : Vec3(pressure(x.y()) / 1000 * along.norm() * Vec3(400, -300, 0));
        exact.force += force, exact.moment += cross(x, force);
      }
    }
    // p n dA is a polynomial, dA alone is not
    const double size = exact.force.norm(), tolerance = normal ? 1e-8 : 1e-7;
    EXPECT_LT((sums.force - exact.force).norm(), tolerance * size) << normal;
    EXPECT_NEAR(sums.moment.z(), exact.moment.z(), tolerance * size) << normal;
  }
}

TEST(CaseLoads, PressureAllRoundGivesUniformStress) {
  // -p on the whole surface: sigma = -p I, u = -(x - x0) p (1 - 2 nu)/E in space; (1 + nu)(1 - 2 nu)/E in plane strain. Exact in every
  // isoparametric mesh, curved edges included.
  constexpr double pressure = 1e5, young = 3e7, nu = 0.3;
  for (const Cell cell :
       {Cell::quad4, Cell::tri3, Cell::quad8, Cell::quad9, Cell::tri6, Cell::hex8, Cell::hex20, Cell::hex27, Cell::tet10}) {
    const bool space = info(cell).dimension == 3;
    const Mesh mesh = sector(cell, space);
    std::string text = solid;
    for (const char* side : {"left", "right", "bottom", "top", "front", "back"})
      if (mesh.groups.contains(side)) text += fmt::format("[[load]]\ngroup = \"{}\"\npressure = \"100 kPa\"\n", side);
    const auto node_at = [&](const Vec3& x) {
      int found = 0;
      for (std::size_t i = 0; i < mesh.nodes.size(); ++i)
        if ((mesh.nodes[i] - x).norm() < (mesh.nodes[static_cast<std::size_t>(found)] - x).norm()) found = static_cast<int>(i);
      return found;
    };
    const int corner = node_at({1, 0, 0});
    const auto hold = [&](int node, const char* unknowns) {
      text += fmt::format("[[support]]\nnode = \"mesh.{}\"\nfixed = [{}]\n", node + 1, unknowns);
    };
    hold(corner, space ? "\"ux\", \"uy\", \"uz\"" : "\"ux\", \"uy\"");
    hold(node_at({2, 0, 0}), space ? "\"uy\", \"uz\"" : "\"uy\"");
    if (space) hold(node_at({0, 1, 0}), "\"uz\"");
    const BuiltCase built = built_of(text + statics, mesh);
    Vector full;
    const RunResult result = run(built.model, built.plan, built.behaviours, {},
                                 [&](const Snapshot& snapshot) { full = built.model.full(snapshot.state.displacement, 0, 0); });
    ASSERT_EQ(result.status, RunStatus::completed) << result.reason;
    const double strain = -pressure / young * (1 - 2 * nu) * (space ? 1 : 1 + nu);
    double worst = 0;
    for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
      const Vec3 exact = strain * (mesh.nodes[i] - mesh.nodes[static_cast<std::size_t>(corner)]);
      for (int k = 0; k < built.model.space.dimension; ++k)
        worst = std::max(worst, std::abs(full[built.model.space.unknowns() * static_cast<Index>(i) + k] - exact[k]));
    }
    EXPECT_LT(worst, 1e-9 * std::abs(strain)) << info(cell).name;
  }
}

TEST(CaseLoads, PressureWithAFunctionIsNoDeadLoad) {
  const Mesh mesh = rectangle({0, 1}, {0, 1});
  const std::string rest = solid + held("bottom") + "[[load]]\ngroup = \"top\"\npressure = 500\n";
  const std::string pulse = "function = \"pulse\"\n[[function]]\nname = \"pulse\"\nshape = { type = \"harmonic\", frequency = 2 }\n";
  const std::string dynamics = "[[stage]]\ntype = \"dynamic\"\nduration = 0.1\nstep = 0.1\n";
  const BuiltCase steady = built_of(rest + dynamics, mesh), moving = built_of(rest + pulse + dynamics, mesh);
  EXPECT_TRUE(steady.model.time_loads.front().dead);
  EXPECT_FALSE(moving.model.time_loads.front().dead);
  EXPECT_NEAR(sums_of_load(moving).force.y(), -500, 1e-10);
  EXPECT_NEAR(moving.model.time_loads.front().factor(0.125), 1, 1e-12);
}

TEST(CaseLoads, PressureThatMakesNoSenseIsRefused) {
  Grid lines{uniform_lines(0, 2, 2), uniform_lines(0, 2, 2), {}};
  const Mesh mesh = grid(
      lines, [](int, int j, int) { return j; }, {"volume", "upper"},
      [](int part, Direction direction, int other) -> std::string {
        if (part == 0 && other == 1) return "between";
        return other < 0 ? std::string(name_of(direction)) : "";
      });
  const std::string both = solid + "[[solid]]\ngroup = \"upper\"\nE = 3e7\npoisson = 0.3\ndensity = 2000\n" + held("bottom");
  const auto refusal = [&](const std::string& load) {
    return support::refusal_of([&] { built_of(both + "[[load]]\n" + load + statics, mesh); });
  };
  const std::string profile = "group = \"left\"\npressure = 1\nprofile = ";
  EXPECT_EQ(refusal("group = \"left\"\npressure = 1\n"), "accepted");
  EXPECT_NE(refusal("group = \"between\"\npressure = 1\n").find("case.toml:18: load[0].group: expected edges on the surface of a solid"),
            std::string::npos)
      << refusal("group = \"between\"\npressure = 1\n");
  EXPECT_NE(refusal("group = \"left\"\npressure = 1\ntraction = [1, 0]\n").find("only one of pressure, traction, force"),
            std::string::npos);
  EXPECT_NE(refusal("node = \"mesh.1\"\npressure = 1\n").find("expected force or moment on a node"), std::string::npos);
  EXPECT_NE(refusal("group = \"left\"\nforce = [1, 0]\nprofile = { along = \"y\", positions = [0, 1], factors = [1, 0] }\n")
                .find("profile with pressure or traction"),
            std::string::npos);
  EXPECT_NE(refusal(profile + "{ along = \"y\", positions = [0, 1, 2], factors = [1, 0] }\n").find("as many factors as positions (3)"),
            std::string::npos);
  EXPECT_EQ(refusal(profile + "{ along = \"y\", positions = [2, 5], factors = [1, 0] }\n"), "accepted");
  EXPECT_NE(refusal(profile + "{ along = \"y\", positions = [3, 5], factors = [1, 0] }\n")
                .find("load[0].profile.positions: expected positions that reach the surface, which lies from y = 0 to 2 m, found 3 to 5 m"),
            std::string::npos)
      << refusal(profile + "{ along = \"y\", positions = [3, 5], factors = [1, 0] }\n");
  EXPECT_NE(refusal(profile + "{ along = \"y\", positions = [0, 0], factors = [1, 0] }\n").find("positions in ascending order"),
            std::string::npos);
  EXPECT_NE(refusal(profile + "{ along = \"z\", positions = [0, 1], factors = [1, 0] }\n").find("x, y or distance in a plane model"),
            std::string::npos);
  EXPECT_NE(refusal(profile + "{ along = \"distance\", positions = [0, 1], factors = [1, 0] }\n").find("centre"), std::string::npos);
}

}  // namespace
}  // namespace uplift::loads_test
