#pragma once
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "uplift/case/case.h"
#include "uplift/io/text/toml.h"
#include "uplift/run/recorder.h"
#include "uplift/verdict/numbers.h"

// Cases from text, and runs that are made of chosen instants.
namespace uplift::support {

inline BuiltCase built_of(const std::string& text, const RunSpec& spec = {}) {
  static std::vector<std::unique_ptr<Case>> kept;  // a model points into its case
  kept.push_back(std::make_unique<Case>(check_case(read_toml_text(text, "case.toml"), "case.toml")));
  return build(*kept.back(), spec);
}

inline RunResult run_of(const BuiltCase& built) {
  return run(built.model, built.plan, built.behaviours);
}

/// A run of one interface that has these instants, the first one at rest too.
inline RunResult run_of(const std::vector<InterfaceView>& views, double step) {
  RunResult result;
  result.steps.reserve(1, views.size(), 0);
  result.steps.rest = {views.front().resultant};
  for (std::size_t i = 0; i < views.size(); ++i) result.steps.add(step * static_cast<double>(i), {views[i]}, 1e-9);
  return result;
}

inline InterfaceView view_of(const Resultant& resultant, double open_area = 0) {
  InterfaceView view;
  view.resultant = resultant;
  view.open_area = open_area;
  return view;
}

inline double number(const VerdictNumbers& numbers, QuantityName name) {
  const VerdictNumber* found = find_number(numbers.interfaces.at(0).numbers, name);
  EXPECT_NE(found, nullptr) << (*name).name;
  return found ? found->value : NAN;
}

}  // namespace uplift::support
