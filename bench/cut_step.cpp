// What a dynamic step of a cut model costs beside that of an aligned joint: a raft on soil that rocks and lifts, in the plane and in space.
// The aligned mesh has the same rows of cells, the one with the underside as a line of nodes; so both models have as many unknowns and,
// with a level cut of quadrilaterals or hexahedra, as many points. Beside other cuts stands a second aligned joint: about as many points
// and unknowns, in a mesh with finer cells at the raft and longer ones elsewhere. In turns, in one process, least time of every piece of
// the run between two reports of progress. A step includes records, energies and checks. Usage: bench_cut_step [ROUNDS [MODEL]], models
// from 1 on.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <deque>
#include <numeric>
#include <string>
#include <vector>

#include "tests/simple_meshes.h"
#include "uplift/case/case.h"
#include "uplift/io/text/toml.h"
#include "uplift/linear/memory.h"

namespace uplift {
namespace {

/// Soil E = 50 MPa, raft E = 30 GPa; 2 m (x 2 m) x 0.6 m.
struct Raft {
  int dimension = 2;
  Cell cell = Cell::quad4;
  double soil = 10, depth = 4;  // m: width (in space also length) and depth
  int cells = 8;                // in a metre
  double slope = 0;             // of the cut
  // > 0: an aligned joint with so many cells across the raft, beside it and in the depth of the soil
  int fine = 0, beside = 0, deep = 0;
  bool friction = false;  // Coulomb's, coefficient 0.7; else bonded
  const char* label = "";
};
constexpr double raft_width = 2, raft_height = 0.6, raft_force = 2e5;  // m, m, N (in the plane N/m)

struct OnMesh {
  Mesh mesh;
  std::string text;
};

OnMesh raft_on_soil(const Raft& raft, bool aligned) {
  const int d = raft.dimension;
  const int below = static_cast<int>(std::lround(raft.depth * raft.cells)), above = static_cast<int>(std::ceil(raft_height * raft.cells));
  std::vector<double> across = uniform_lines(-raft.soil / 2, raft.soil / 2, static_cast<int>(std::lround(raft.soil * raft.cells)));
  if (raft.fine > 0) {
    across = uniform_lines(-raft.soil / 2, -raft_width / 2, raft.beside);
    for (const std::vector<double>& next :
         {uniform_lines(-raft_width / 2, raft_width / 2, raft.fine), uniform_lines(raft_width / 2, raft.soil / 2, raft.beside)})
      across.insert(across.end(), next.begin() + 1, next.end());
  }
  std::vector<double> up;  // heights; a cut goes through a row
  if (aligned) {
    up = uniform_lines(-raft.depth, 0, raft.fine > 0 ? raft.deep : below);
    for (int row = 1; row <= above; ++row) up.push_back(row * raft_height / above);
  } else {
    for (int row = 0; row < below + above; ++row) up.push_back(-raft.depth + row * (raft.depth + raft_height) / (below + above - 1));
  }
  const Grid lines{across, d == 2 ? up : across, d == 2 ? std::vector<double>{} : up};
  const auto inside = [&](int i) {
    return std::abs(across[static_cast<std::size_t>(i)] + across[static_cast<std::size_t>(i) + 1]) < raft_width;
  };
  const auto part = [&](int i, int j, int k) {
    const double middle = up[static_cast<std::size_t>(d == 2 ? j : k)];
    if (!aligned) return 0;
    if (middle < -1e-9) return 0;
    return inside(i) && (d == 2 || inside(j)) ? 1 : -1;
  };
  const auto face = [](int of, Direction direction, int other) -> std::string {
    if (of == 0 && other == 1) return "interface";
    return of == 0 && direction == Direction::bottom && other < 0 ? "bottom" : "";
  };
  OnMesh made{
      with_cells(grid(lines, part, aligned ? std::vector<std::string>{"soil", "raft"} : std::vector<std::string>{"soil"}, face), raft.cell),
      ""};
  std::vector<int> top;
  for (std::size_t node = 0; node < made.mesh.nodes.size(); ++node) {
    const Vec3& x = made.mesh.nodes[node];
    const bool over = std::abs(x.x()) < raft_width / 2 + 1e-9 && (d == 2 || std::abs(x.y()) < raft_width / 2 + 1e-9);
    if (over && std::abs(x[d - 1] - raft_height) < 1e-9) top.push_back(static_cast<int>(node) + 1);
  }
  std::string loads;
  const double each = raft_force / static_cast<double>(top.size());
  for (const int node : top) {
    loads += fmt::format("[[load]]\nname = \"weight{0}\"\nnode = \"mesh.{0}\"\nforce = [0, {1}{2}]\n", node, d == 2 ? "" : "0, ", -each);
    loads += fmt::format("[[load]]\nname = \"push{0}\"\nnode = \"mesh.{0}\"\nforce = [{1}, 0{2}]\nfunction = \"push\"\n", node, 1.4 * each,
                         d == 2 ? "" : ", 0");
  }
  const double half = raft_width / 2;
  const std::string plane = raft.slope == 0
                                ? "level = 0"
                                : fmt::format("point = [0, {}0], normal = [{}, {}1]", d == 2 ? "" : "0, ", raft.slope, d == 2 ? "" : "0, ");
  const std::string outline = fmt::format("x = [{}, {}]", -half, half) + (d == 2 ? "" : fmt::format(", y = [{}, {}]", -half, half));
  const std::string joint = aligned ? "surface = { group = \"interface\", lower = [\"soil\"] }\n"
                                    : fmt::format("cut = {{ through = [\"soil\"], {}, upper = \"raft\", {} }}\n", plane, outline);
  const std::string plain = "incompatible_modes = false\n";  // cut cells have none
  made.text = std::string("title = \"raft\"\n[mesh]\nfile = \"raft.msh\"\n") +
              "[[solid]]\ngroup = \"soil\"\nE = 5e7\npoisson = 0.2\ndensity = 1800\n" +
              (raft.cell == Cell::quad4 || raft.cell == Cell::hex8 ? plain : "") +
              "[[solid]]\ngroup = \"raft\"\nE = 3e10\npoisson = 0.2\ndensity = 2500\n" +
              (raft.cell == Cell::quad4 || raft.cell == Cell::hex8 ? plain : "") +
              fmt::format("[[support]]\ngroup = \"bottom\"\nfixed = [\"ux\", \"uy\"{}]\n", d == 2 ? "" : ", \"uz\"") +
              "[[function]]\nname = \"push\"\nshape = { type = \"harmonic\", frequency = 3 }\n" + loads +
              "[[interface]]\nname = \"base\"\n" + joint +
              fmt::format("law = {{ type = \"springs\", K_n = 1e9, K_t = 1e9, tangential = {} }}\n",
                          raft.friction ? "\"coulomb\", friction = 0.7" : "\"bonded\"") +
              "[damping]\nalpha = 1.0\nbeta = 1e-3\n"
              "[[stage]]\ntype = \"static\"\n[[stage]]\ntype = \"dynamic\"\n" +
              fmt::format("duration = {}\nstep = 2e-3\n", d == 2 ? 1.0 : 0.4);
  return made;
}

/// A model and the least times of the pieces of all of its runs [s].
struct Measured {
  BuiltCase built;
  std::vector<double> least = {};
  long steps = 0;         // of all pieces
  double iterations = 0;  // of the interface, a step
  double lifted = 0;      // largest share of the area
  double seconds_per_step() const { return std::accumulate(least.begin(), least.end(), 0.0) / static_cast<double>(steps); }
};

void take_turn(Measured& measured) {
  std::vector<double> times;
  double first = -1;  // s, of the motion
  const BuiltCase& built = measured.built;
  const RunResult result = run(built.model, built.plan, built.behaviours, [&](const Progress& progress) {
    times.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count());
    if (first < 0) first = progress.time;
    measured.steps = std::lround((progress.time - first) / progress.step);
    return true;
  });
  measured.least.resize(times.size() - 1, 1e300);
  for (std::size_t k = 0; k + 1 < times.size(); ++k) measured.least[k] = std::min(measured.least[k], times[k + 1] - times[k]);
  measured.iterations = static_cast<double>(result.counts.iterations) / static_cast<double>(result.counts.steps);
  measured.lifted = result.max_uplifted_ratio.value;
  if (!result.reason.empty()) fmt::print("{}\n", result.reason);
}

Measured prepare(const OnMesh& from) {
  const Case read = check_case(read_toml_text(from.text, "raft.toml"), "raft.toml",
                               [&](const std::string&, const Where&, const std::string&) { return from.mesh; });
  return {build(read, runs_of_case(read).front())};
}

void measure(const Raft& raft, int rounds) {
  Raft plain = raft;
  plain.fine = 0;
  std::deque<std::pair<const char*, Measured>> all;
  all.emplace_back("aligned", prepare(raft_on_soil(plain, true)));
  all.emplace_back("cut", prepare(raft_on_soil(plain, false)));
  if (raft.fine > 0) all.emplace_back("aligned, as many points", prepare(raft_on_soil(raft, true)));
  for (int round = 0; round < rounds; ++round)
    for (auto& [name, of] : all) take_turn(of);
  for (const auto& [name, of] : all) {
    const Model& model = of.built.model;
    fmt::print(
        "{}, {}: {} unknowns, {} entries of the stiffness, {} points, {} steps, {:.2f} iterations a step, {:.0f} % lifted, {:.4g} us a "
        "step\n",
        raft.label, name, model.free(), model.stiffness.nonZeros(), model.interfaces.front().batch.points, of.steps, of.iterations,
        100 * of.lifted, 1e6 * of.seconds_per_step());
  }
  const double cut = all[1].second.seconds_per_step();
  fmt::print("{}: cut over aligned {:.3f} times", raft.label, cut / all[0].second.seconds_per_step());
  if (raft.fine > 0) fmt::print(", with as many points {:.3f} times", cut / all[2].second.seconds_per_step());
  fmt::print("\n");
}

}  // namespace
}  // namespace uplift

int main(int count, char** words) {
  using uplift::Cell;
  const int rounds = count > 1 ? std::atoi(words[1]) : 5;
  const uplift::Raft inclined{.dimension = 3,
                              .cell = Cell::hex8,
                              .soil = 5,
                              .depth = 2,
                              .cells = 4,
                              .slope = 0.007,
                              .fine = 11,
                              .beside = 4,
                              .deep = 8,
                              .label = "space, hexahedra, inclined"};
  uplift::Raft with_friction = inclined;
  with_friction.friction = true;
  with_friction.label = "space, hexahedra, inclined, friction";
  uplift::Raft tetrahedra = inclined;  // six of a cube; level: a point on every edge that the cut crosses
  tetrahedra.cell = Cell::tet4;
  tetrahedra.slope = 0;
  tetrahedra.fine = 16, tetrahedra.beside = 3, tetrahedra.deep = 5;
  tetrahedra.label = "space, tetrahedra, level";
  uplift::Raft inclined_tetrahedra = tetrahedra;
  inclined_tetrahedra.slope = inclined.slope;
  inclined_tetrahedra.label = "space, tetrahedra, inclined";
  const std::vector<uplift::Raft> rafts{
      {.label = "plane, quadrilaterals, level"},
      {.cells = 16, .label = "plane, quadrilaterals of 1/16 m, level"},
      {.slope = 0.007, .fine = 32, .beside = 25, .deep = 30, .label = "plane, quadrilaterals, inclined"},
      {.cell = Cell::tri3, .fine = 32, .beside = 25, .deep = 30, .label = "plane, triangles, level"},
      {.dimension = 3, .cell = Cell::hex8, .soil = 5, .depth = 2, .cells = 4, .label = "space, hexahedra, level"},
      inclined,
      with_friction,
      tetrahedra,
      inclined_tetrahedra};
  uplift::prepare_heap();
  for (std::size_t k = 0; k < rafts.size(); ++k)
    if (count < 3 || std::atoi(words[2]) == static_cast<int>(k) + 1) uplift::measure(rafts[k], rounds);
  return 0;
}
