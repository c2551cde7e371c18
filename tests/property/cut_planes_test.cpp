#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "simple_meshes.h"
#include "unit/case/cut_support.h"

// A thousand planes through a body in tension: anywhere, through nodes, along edges and diagonals, beside nodes by parts of a cell down to
// 1e-10, and beyond the body. Bonded again it moves as the whole body does; else the plane is refused in words.
namespace uplift::cut_planes_test {
namespace {

using namespace support;

constexpr double young = 2e10, traction = 1e6, stiffness = 1e8 * young;

enum class Kind { anywhere, through_a_node, along_nodes, beside_a_node, beside_a_level, beyond };
constexpr int kinds = 6;

struct Plane {
  Vec3 point, normal;
  double beside = 1;  // distance from nodes over the edges of the cells, where it is given
};

/// Of the unit square or cube with `cells` cells along each side.
Plane plane(Kind kind, int dimension, int cells, std::mt19937& random) {
  std::normal_distribution<double> any;
  std::uniform_real_distribution<double> place(0.1, 0.9), decades(-10, -2);
  const auto vector = [&](auto&& component) { return Vec3(component(), component(), dimension == 3 ? component() : 0); };
  const double h = 1.0 / cells, beside = std::pow(10, decades(random)) * h * (random() % 2 ? 1 : -1);
  Plane made{vector([&] { return place(random); }), vector([&] { return any(random); }).normalized()};
  if (kind == Kind::anywhere) return made;
  made.point = vector([&] { return h * (1 + static_cast<int>(random() % static_cast<unsigned>(cells - 1))); });
  if (kind == Kind::along_nodes || kind == Kind::beside_a_level) {
    std::array<int, 3> whole{};
    while (whole[0] == 0 && whole[1] == 0 && whole[2] == 0)
      for (int k = 0; k < dimension; ++k) whole[static_cast<std::size_t>(k)] = static_cast<int>(random() % 3) - 1;
    made.normal = Vec3(whole[0], whole[1], whole[2]).normalized();
  }
  if (kind == Kind::beside_a_node || kind == Kind::beside_a_level) {
    made.point += beside * made.normal;
    made.beside = std::abs(beside) / h;
  }
  if (kind == Kind::beyond) made.point += 3 * made.normal;
  return made;
}

TEST(Robust, CutBodiesThatAreBondedMoveAsTheWholeOrThePlaneIsRefused) {
  std::array<int, kinds> cut{}, refused{};
  constexpr std::array cells{Cell::tri3, Cell::quad4, Cell::tet4, Cell::wedge6, Cell::hex8};
  for (unsigned seed = 0; seed < 1000; ++seed) {
    std::mt19937 random(seed);
    const Cell cell = cells[seed % cells.size()];
    const auto kind = static_cast<Kind>(seed / cells.size() % kinds);
    const bool flat = info(cell).dimension == 2;
    const int count = flat ? 4 : 2;
    const auto lines = uniform_lines(0, 1, count);
    const Plane at = plane(kind, info(cell).dimension, count, random);
    const auto vector = [&](const Vec3& v) {
      return flat ? fmt::format("[{:.17g}, {:.17g}]", v[0], v[1]) : fmt::format("[{:.17g}, {:.17g}, {:.17g}]", v[0], v[1], v[2]);
    };
    const Mesh mesh = flat ? rectangle(lines, lines, cell) : box(lines, lines, lines, cell);
    const auto hold = [&](const Vec3& place, const std::string& fixed) {
      const auto node = std::ranges::find_if(mesh.nodes, [&](const Vec3& x) { return (x - place).norm() < 1e-9; }) - mesh.nodes.begin();
      return fmt::format("[[support]]\nnode = \"mesh.{}\"\nfixed = [{}]\n", node + 1, fixed);
    };
    // Without forces: a support that holds both sides of the joint would forbid the opening t/K, and where it crosses a part of thickness d
    // a force of the order of d would pass through that part instead of the joint, up to K d = 100 E.
    const std::string held = hold(Vec3::Zero(), flat ? "\"ux\", \"uy\"" : "\"ux\", \"uy\", \"uz\"") +
                             hold(Vec3::UnitY(), flat ? "\"ux\"" : "\"ux\", \"uz\"") + (flat ? "" : hold(Vec3::UnitZ(), "\"ux\""));
    const std::string text =
        "title = \"body\"\n[mesh]\nfile = \"body.msh\"\n" + solid("volume", young, 0, 2000) + solid("beyond", young, 0, 2000) + held +
        "[[load]]\ngroup = \"right\"\ntraction = " + vector(Vec3(traction, 0, 0)) +
        "\n[[load]]\ngroup = \"left\"\ntraction = " + vector(Vec3(-traction, 0, 0)) +
        "\n[[interface]]\nname = \"joint\"\ncut = { through = [\"volume\"], upper = \"beyond\", point = " + vector(at.point) +
        ", normal = " + vector(at.normal) + fmt::format(" }}\nlaw = {{ type = \"elastic\", K_n = {0}, K_t = {0} }}\n", stiffness) +
        (flat ? "[[output.history]]\nname = \"end\"\nat = [1, 1]\nquantity = \"ux\"\n"
              : "[[output.history]]\nname = \"end\"\nat = [1, 1, 1]\nquantity = \"ux\"\n") +
        "[[stage]]\ntype = \"static\"\nsteps = 1\n";
    const std::string what = fmt::format("{} seed {}", info(cell).name, seed);
    try {
      const RunResult result = run_on(text, mesh);
      const double expected = traction / young;
      // The joint gives way by E/K, and the round-off of a joint so stiff is up to some 1e-7. A part of less than 1e-14 of a cell belongs
      // to the other side: 1e-7 of an edge thick, it leaves as much of the section without springs.
      EXPECT_NEAR(history(result, "end").back(), expected, (at.beside > 2e-7 ? 3e-7 : 5e-7) * expected) << what;
      ++cut[static_cast<std::size_t>(kind)];
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find("expected"), std::string::npos) << what << error.what();
      ++refused[static_cast<std::size_t>(kind)];
    }
  }
  for (int k = 0; k < kinds; ++k) {
    const bool beyond = static_cast<Kind>(k) == Kind::beyond;
    EXPECT_GE((beyond ? refused : cut)[static_cast<std::size_t>(k)], 165) << k;
    EXPECT_EQ((beyond ? cut : refused)[static_cast<std::size_t>(k)], 0) << k;
  }
}

}  // namespace
}  // namespace uplift::cut_planes_test
