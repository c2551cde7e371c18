#pragma once
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <span>
#include <string>
#include <vector>

#include "simple_meshes.h"
#include "uplift/case/case.h"
#include "uplift/io/text/toml.h"
#include "uplift/mesh/mesh.h"

// Cases on meshes of a test: what the tests of cut interfaces share.
namespace uplift::support {

inline Case read_on(const std::string& text, const Mesh& mesh) {
  return check_case(read_toml_text(text, "case.toml"), "case.toml",
                    [&](const std::string&, const Where&, const std::string&) { return mesh; });
}

inline RunResult run_on(const std::string& text, const Mesh& mesh) {
  const Case read = read_on(text, mesh);
  BuiltCase built = build(read, RunSpec{});
  RunResult result = run(built.model, built.plan, built.behaviours);
  EXPECT_EQ(to_string(result.status), "completed") << result.reason;
  return result;
}

inline std::span<const double> history(const RunResult& result, const std::string& column) {
  for (std::size_t k = 0; k < result.columns.size(); ++k)
    if (result.columns[k].name == column) return result.table[k + 1];
  ADD_FAILURE() << "no column " << column;
  return {};
}

inline double at_rest(const RunResult& result, const std::string& column) {
  return history(result, column).front();
}

inline constexpr const char* at_rest_stages = R"(
[[stage]]
type = "static"
[[stage]]
type = "dynamic"
duration = 1e-3
step = 1e-3
)";

inline std::string solid(const std::string& group, double young, double poisson, double density, const std::string& extra = {}) {
  return fmt::format("[[solid]]\ngroup = \"{}\"\nE = {}\npoisson = {}\ndensity = {}\n{}", group, young, poisson, density, extra);
}

/// Lines of cells of about 1/n m from 0 to `top`, one of them at `level` [m].
inline std::vector<double> lines_with(double level, double top, int n) {
  std::vector<double> lines = uniform_lines(0, level, static_cast<int>(std::lround(level * n)));
  const std::vector<double> above = uniform_lines(level, top, static_cast<int>(std::lround((top - level) * n)));
  lines.insert(lines.end(), above.begin() + 1, above.end());
  return lines;
}

/// A block on tensionless springs: its rotation over that at the beginning of uplift, 2 N/(k W^2); the share of its base that is open, as
/// results state it and as the share of the points.
struct BlockAtRest {
  double rotation, open, open_points;
};

/// On a base of the same material that the plane parts from it, under N and M = ratio N W/6 at the top.
inline BlockAtRest block_at_rest(double ratio, double level, int cells, const std::string& more = {}, double young = 1e15) {
  constexpr double width = 3, force = 1e6, k = 2e8;
  std::string columns;
  for (int point = 1; point <= cells + 1; ++point)
    columns += fmt::format("[[output.history]]\nname = \"point{0}\"\ninterface = \"base\"\npoint = {0}\nquantity = \"opening\"\n", point);
  const std::string text =
      "title = \"block\"\n[mesh]\nfile = \"block.msh\"\n" + solid("volume", young, 0.2, 2000) + solid("block", young, 0.2, 2000) +
      "[[support]]\ngroup = \"bottom\"\nfixed = [\"ux\", \"uy\"]\n" +
      fmt::format(
          "[[load]]\ngroup = \"top\"\ntraction = [0, {}]\n[load.profile]\nalong = \"x\"\npositions = [-1.5, 1.5]\n"
          "factors = [{}, {}]\n",
          -force / width, 1 - ratio, 1 + ratio) +
      fmt::format("[[interface]]\nname = \"base\"\ncut = {{ through = [\"volume\"], level = {}, upper = \"block\"{} }}\n", level, more) +
      fmt::format("law = {{ type = \"springs\", K_n = {}, K_t = {}, tangential = \"bonded\" }}\n", k, k) + columns + at_rest_stages;
  const RunResult result = run_on(text, rectangle(uniform_lines(-1.5, 1.5, cells), uniform_lines(0, 1, 4)));
  BlockAtRest found{std::abs(at_rest(result, "base.rotation")) / (2 * force / (k * width * width)), at_rest(result, "base.uplifted_ratio"),
                    0};
  for (int point = 0; point <= cells; ++point)
    if (at_rest(result, fmt::format("point{}", point + 1)) > 0)
      found.open_points += (point == 0 || point == cells ? 0.5 : 1) / static_cast<double>(cells);
  return found;
}

inline double block_rotation(double ratio, double level, int cells, const std::string& more = {}, double young = 1e15) {
  return block_at_rest(ratio, level, cells, more, young).rotation;
}

}  // namespace uplift::support
