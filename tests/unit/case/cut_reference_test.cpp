#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "unit/case/cut_support.h"
#include "uplift/mesh/box.h"

// Cut interfaces against reference values that were computed outside of this program: a bar with a cracking joint (closed form), a rigid
// block on tensionless springs, a raft on a block of soil.
namespace uplift::cut_reference_test {
namespace {

using namespace support;

// ---- a bar in tension whose inclined crack is a strong discontinuity ----

/// The end of the bar is moved to these places, one after the other within 100 s, so slowly that forces of inertia do not count. They alone
/// hold the right half across the bar until the crack does: with less of them round-off decides.
constexpr std::size_t steps = 10;  // between two places

std::string cracking_bar(const std::vector<double>& places) {
  const double angle = 25 * std::numbers::pi / 180;
  std::string times = "0", values = "0";
  double last = 0;
  for (std::size_t i = 0; i < places.size(); ++i) {  // the end of a way is slow: a joint that softens remembers the least overshoot
    times += fmt::format(", {}, {}, {}", 100 * i + 30, 100 * i + 50, 100 * i + 100);
    values += fmt::format(", {0}, {1}, {1}", last + 0.999 * (places[i] - last), places[i]);
    last = places[i];
  }
  return "title = \"bar\"\n[mesh]\nfile = \"bar.msh\"\n" + solid("volume", 2e10, 0.2, 2000) +
         "[[support]]\ngroup = \"left\"\nfixed = [\"ux\"]\n[[support]]\nnode = \"mesh.1\"\nfixed = [\"uy\"]\n" +
         fmt::format("[[function]]\nname = \"places\"\nshape = {{ type = \"table\", times = [{}], values = [{}] }}\n", times, values) +
         "[[motion]]\ngroup = \"right\"\ndirection = \"ux\"\nfunction = \"places\"\n" +
         fmt::format("[[interface]]\nname = \"crack\"\ncut = {{ through = [\"volume\"], point = [2.03, 0.47], normal = [{}, {}] }}\n",
                     std::cos(angle), std::sin(angle)) +
         "law = { type = \"sdm\", K_n = 1e11, K_t = 1e11, F_u = 1e6, G_f = 500, F_c = -2e4 }\n"
         "[[output.history]]\nname = \"force\"\ngroup = \"right\"\nquantity = \"reaction_x\"\n"
         "[[output.history]]\nname = \"first\"\ninterface = \"crack\"\npoint = 1\nquantity = \"opening\"\n"
         "[[output.history]]\nname = \"second\"\ninterface = \"crack\"\npoint = 2\nquantity = \"opening\"\n" +
         fmt::format(
             "[method]\ntype = \"newton\"\ntolerance = 1e-8\n[[stage]]\ntype = \"dynamic\"\nduration = {}\nstep = {}\n"
             "scheme = {{ type = \"generalised_alpha\", rho = 0.1 }}\ntraction = \"end\"\n",
             100 * places.size(), 100 / steps);
}

TEST(CutReference, BarWithACrackThatSoftensClosesAndOpensAgain) {
  // u = sigma L (1 - nu^2)/E + cos a delta_n + sigma sin^2 a cos a/K_t, sigma cos^2 a = SDM(delta_n)
  const std::vector<double> places{1e-4, 2e-4, 3e-4, 6e-4, 1e-3, 4e-4, 2e-4, 1.2e-3};
  struct Row {
    std::size_t place;
    double stress, opening;
  };
  const std::array<Row, 7> rows{{{1, 4.97356357e5, 4.08525431e-6},
                                 {3, 9.62509340e5, 1.25388056e-4},
                                 {4, 3.84088668e5, 5.79972114e-4},
                                 {5, 1.42749234e5, 1.07288174e-3},
                                 {6, -1.42496902e4, 4.44395395e-4},
                                 {7, -1.92382181e4, 2.24785533e-4},
                                 {8, 8.96747580e4, 1.30489587e-3}}};
  for (const Cell cell : {Cell::tri3, Cell::quad4})
    for (const double shaken : {0.0, 0.15}) {
      if (shaken > 0 && cell == Cell::quad4) continue;  // rational functions: docs/theory/cut_elements.md
      Mesh mesh = rectangle(uniform_lines(0, 4, 9), uniform_lines(0, 1, 3), cell);
      for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {  // inner nodes alone
        Vec3& x = mesh.nodes[i];
        if (x.x() < 1e-9 || x.x() > 4 - 1e-9 || x.y() < 1e-9 || x.y() > 1 - 1e-9) continue;
        x.x() += shaken / 3 * std::sin(7.0 * static_cast<double>(i));
        x.y() += shaken / 3 * std::cos(11.0 * static_cast<double>(i));
      }
      const RunResult result = run_on(cracking_bar(places), mesh);
      const auto force = history(result, "force"), first = history(result, "first"), second = history(result, "second");
      for (const Row& row : rows) {
        EXPECT_NEAR(force[steps * row.place], row.stress, 1e-7 * 9.6e5) << info(cell).name << " at " << places[row.place - 1];
        EXPECT_NEAR(first[steps * row.place], row.opening, 1e-6 * 1.3e-3) << info(cell).name << " at " << places[row.place - 1];
        EXPECT_NEAR(second[steps * row.place], row.opening, 1e-6 * 1.3e-3) << info(cell).name << " at " << places[row.place - 1];
      }
    }
}

// ---- a rigid block on tensionless springs ----

/// The rotation of `block_rotation` for a rigid block on springs at equal distances, each with the length that the rule of the interface
/// gives it.
double block_on_springs(double ratio, int cells) {
  constexpr double width = 3, k = 2e8, force = 1e6;
  const double moment = ratio * force * width / 6, length = width / cells;
  double down = force / (k * width), turn = 2 * down / width;  // pressed by down + turn x
  for (int i = 0; i < 100; ++i) {
    double n = -force, m = -moment, nn = 0, nm = 0, mm = 0;
    for (int point = 0; point <= cells; ++point) {
      const double x = -width / 2 + point * length, pressed = down + turn * x;
      const double spring = pressed > 0 ? k * length * (point == 0 || point == cells ? 0.5 : 1) : 0;
      n += spring * pressed, m += spring * pressed * x, nn += spring, nm += spring * x, mm += spring * x * x;
    }
    const double determinant = nn * mm - nm * nm;
    down -= (mm * n - nm * m) / determinant, turn -= (nn * m - nm * n) / determinant;
  }
  return turn / (2 * force / (k * width * width));
}

TEST(CutReference, RigidBlockOnTensionlessSprings) {
  // The given figures are of a block with 1e13 Pa, whose unknown height moves them by up to 1e-4: the springs alone have 11.7/7, 45/13 and
  // 9 with six elements. The elasticity of the block counts as 1/E: two of them give the rigid one.
  const std::array<double, 3> ratios{1.5, 2, 2.5};
  const std::array<double, 3> coarse{1.671500, 3.461825, 9.000952}, fine{1.775219, 3.987326, 15.805187};
  for (std::size_t i = 0; i < ratios.size(); ++i)
    for (const int cells : {6, 48}) {
      const double rigid = block_on_springs(ratios[i], cells), given = cells == 6 ? coarse[i] : fine[i];
      const double soft = block_rotation(ratios[i], 0.37, cells, "", 1e13), hard = block_rotation(ratios[i], 0.37, cells, "", 1e14);
      EXPECT_NEAR((10 * hard - soft) / 9, rigid, 1e-6 * rigid) << ratios[i] << " " << cells;
      EXPECT_NEAR(soft, given, 1e-4 * given) << ratios[i] << " " << cells;
    }
}

TEST(CutReference, SliversDoNotMatter) {
  // The level of the plane does not enter a rigid block's rotation, however thin the parts are that it leaves.
  const double expected = block_rotation(2, 0.37, 12);
  for (const double part : {1e-2, 1e-4, 1e-6, 2e-8, -1e-4, -2e-8})
    EXPECT_NEAR(block_rotation(2, 0.25 + part * 0.25, 12), expected, 1e-6 * expected) << part;
  for (const double shift : {-0.4, 0.2, 0.45})
    EXPECT_NEAR(block_rotation(2, 0.37, 12, fmt::format(", mesh_shift = {}", shift)), expected, 1e-6 * expected) << shift;
}

// ---- a raft on a block of soil, in a mesh that ignores its underside ----

constexpr double underside = 3.87, raft_height = 0.6;

/// Its rotation, that of the line between the corners of its top, under N = 2e5 N/m and M = N e: forces on the nodes of the top, N and M x
/// times the length that belongs to a node, divided by the sums of these lengths and of length x^2. `cells` in a metre; the mesh of the
/// aligned joint has its rows of soil between the bottom and the underside.
double raft_rotation(double eccentricity, int cells, bool aligned) {
  const auto rows = [&](double length) { return static_cast<int>(std::lround(length * cells)); };
  const double bottom = aligned ? underside : 4, top = underside + raft_height;
  Grid lines{uniform_lines(-5, 5, 10 * cells), uniform_lines(0, bottom, rows(bottom)), {}};
  const int soil_rows = static_cast<int>(lines.y.size()) - 1;
  const std::vector<double> upper = uniform_lines(bottom, top, rows(top - bottom));
  lines.y.insert(lines.y.end(), upper.begin() + 1, upper.end());
  const auto above = [&](int i, int j) { return j < soil_rows ? 0 : i >= 4 * cells && i < 6 * cells ? 1 : -1; };
  const Mesh mesh = aligned ? grid(
                                  lines, [&](int i, int j, int) { return above(i, j); }, {"volume", "raft"},
                                  [](int part, Direction direction, int other) -> std::string {
                                    if (part == 0 && other == 1) return "interface";
                                    return part == 0 && direction == Direction::bottom ? "bottom" : "";
                                  })
                            : rectangle(lines.x, lines.y);
  constexpr double width = 2, force = 2e5;
  std::string loads;
  const double h = 1.0 / cells, second = width * width * width / 12 + width * h * h / 6;  // sum of length x^2
  for (std::size_t node = 0; node < mesh.nodes.size(); ++node) {
    const double x = mesh.nodes[node].x(), y = mesh.nodes[node].y();
    if (std::abs(y - top) > 1e-9 || std::abs(x) > 1 + 1e-9) continue;
    const double length = std::abs(x) > 1 - 1e-9 ? h / 2 : h;
    loads +=
        fmt::format("[[load]]\nnode = \"mesh.{}\"\nforce = [0, {}]\n", node + 1, -force * length * (1 / width + eccentricity * x / second));
  }
  const std::string plain = "incompatible_modes = false\n";
  const std::string text =
      "title = \"raft\"\n[mesh]\nfile = \"raft.msh\"\n" + solid("volume", 5e7, 0.2, 2000, plain) + solid("raft", 3e10, 0.2, 2000, plain) +
      "[[support]]\ngroup = \"bottom\"\nfixed = [\"ux\", \"uy\"]\n" + loads + "[[interface]]\nname = \"base\"\n" +
      (aligned ? "surface = { group = \"interface\", lower = [\"volume\"] }\n"
               : fmt::format("cut = {{ through = [\"volume\"], level = {}, upper = \"raft\", x = [-1, 1] }}\n", underside)) +
      "law = { type = \"springs\", K_n = 1e9, K_t = 1e9, tangential = \"bonded\" }\n" +
      fmt::format(
          "[[output.history]]\nname = \"left\"\nat = [-1, {0}]\nquantity = \"uy\"\n"
          "[[output.history]]\nname = \"right\"\nat = [1, {0}]\nquantity = \"uy\"\n",
          top) +
      at_rest_stages;
  const RunResult result = run_on(text, mesh);
  return std::abs(at_rest(result, "left") - at_rest(result, "right")) / width;
}

TEST(CutReference, RaftOnABlockOfSoil) {
  // The loads of the given figures and what they call rotation are not stated. A linear computation of its own (all closed: eccentricity
  // 0.3, cells of 1/4 m) meets the given figure of the aligned mesh to 4e-12 with those of `raft_rotation` alone. The rows of the cut
  // meshes are not known: with 35 to 38 rows of 1/8 m and the top at 4.47 to 4.6 m the rotation varies by 0.4 %.
  struct Row {
    int cells;
    std::array<double, 3> aligned, cut;
    double tolerance;  // of the cut mesh
  };
  const std::array<double, 3> eccentricities{0.3, 0.5, 0.7};
  for (const Row& row :
       {Row{4, {1.31255463952e-3, 2.18759106587e-3, 3.71841962173e-3}, {1.32479167574e-3, 2.20798612623e-3, 3.76926891692e-3}, 2e-3},
        Row{16, {1.43956210004e-3, 2.4219880313e-3, 4.34978776798e-3}, {1.44200894492e-3, 2.42647179158e-3, 4.36223614421e-3}, 2.5e-3}})
    for (std::size_t i = 0; i < eccentricities.size(); ++i) {
      const double on_cut = raft_rotation(eccentricities[i], row.cells, false),
                   on_joint = raft_rotation(eccentricities[i], row.cells, true);
      EXPECT_NEAR(on_joint, row.aligned[i], 1e-6 * row.aligned[i]) << row.cells << " cells in a metre, " << eccentricities[i];
      EXPECT_NEAR(on_cut, row.cut[i], row.tolerance * row.cut[i]) << row.cells << " cells in a metre, " << eccentricities[i];
      if (row.cells == 16) EXPECT_NEAR(on_cut, on_joint, 1e-3 * on_joint) << eccentricities[i];
    }
}

}  // namespace
}  // namespace uplift::cut_reference_test
