#pragma once
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "ran_support.h"
#include "text_support.h"

// What the tests of section forces share: cases from text, columns of their output, a pulse.
namespace uplift::support {

using Column = std::vector<double>;

/// A run of a case that completed, with every section in equilibrium to round-off.
inline Ran run_balanced(const std::string& text) {
  Ran ran = run_text(text);
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
