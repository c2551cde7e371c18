#pragma once
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "text_support.h"
#include "uplift/case/case.h"
#include "uplift/io/text/toml.h"

// What the tests of section forces share: cases from text, columns of their output, a pulse.
namespace uplift::support {

using Column = std::vector<double>;

/// A case that was run, and its columns by name.
struct Ran {
  BuiltCase built;
  RunResult result;
  const Column& operator[](const std::string& name) const {
    for (std::size_t k = 0; k < result.columns.size(); ++k)
      if (result.columns[k].name == name) return result.table[k + 1];
    ADD_FAILURE() << "no column " << name;
    return result.table[0];
  }
  std::size_t rows() const { return result.table[0].size(); }
};

inline Ran run_text(const std::string& text) {
  static std::vector<std::unique_ptr<Case>> kept;  // a model points into its case
  kept.push_back(std::make_unique<Case>(check_case(read_toml_text(text, "case.toml"), "case.toml")));
  Ran ran{build(*kept.back(), runs_of_case(*kept.back()).front()), {}};
  ran.result = run(ran.built.model, ran.built.plan, ran.built.behaviours);
  EXPECT_EQ(ran.result.status, RunStatus::completed) << ran.result.reason;
  EXPECT_LT(ran.result.equilibrium.residual, 1e-9);
  EXPECT_FALSE(ran.result.equilibrium.instants.empty());
  return ran;
}

inline std::string history(const std::string& keys) {
  return "[[output.history]]\n" + keys + "\n";
}
inline std::string node_histories(const std::vector<std::string>& nodes, const std::vector<std::string>& quantities) {
  std::string text;
  for (const std::string& node : nodes)
    for (const std::string& quantity : quantities) text += history(fmt::format("node = \"{}\"\nquantity = \"{}\"", node, quantity));
  return text;
}

/// Every step after the first row: |column - expected(step)| <= 1e-9 of the peak. The expected value is of the step from row i - 1 to i.
inline void expect_column(const Ran& ran, const Column& column, const std::function<double(std::size_t)>& expected, const std::string& what,
                          double floor = 0) {
  double peak = floor, error = 0;
  for (std::size_t i = 1; i < ran.rows(); ++i) {
    peak = std::max(peak, std::abs(column[i]));
    error = std::max(error, std::abs(column[i] - expected(i)));
  }
  EXPECT_GT(peak, 0) << what;
  EXPECT_LT(error, 1e-9 * peak) << what << ", peak " << peak;
}

inline constexpr double dt = 2e-3;
/// Derivative over the step and mean of both ends.
inline double rate(const Column& column, std::size_t i) {
  return (column[i] - column[i - 1]) / dt;
}
inline double mean(const Column& column, std::size_t i) {
  return (column[i] + column[i - 1]) / 2;
}

inline constexpr const char* shaking = R"(
[[function]]
name = "shake"
shape = { type = "ricker", frequency = "2 Hz", delay = "0.4 s" }
[[stage]]
type = "dynamic"
duration = 1
step = 2e-3
)";
inline double shake(double t) {  // of functions.cpp, written down again
  const double a = std::pow(M_PI * 2 * (t - 0.4), 2);
  return (1 - 2 * a) * std::exp(-a);
}

}  // namespace uplift::support
