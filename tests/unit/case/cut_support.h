#pragma once
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <span>
#include <string>

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

}  // namespace uplift::support
