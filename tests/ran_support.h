#pragma once
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "uplift/case/case.h"
#include "uplift/io/text/toml.h"

namespace uplift::support {

/// A case that has run, with all that its results point into.
struct Ran {
  std::unique_ptr<Case> file;  // behind a pointer: the model points into it
  BuiltCase built;
  RunResult result;

  /// The rows of a column of the histories.
  const std::vector<double>& operator[](const std::string& name) const {
    for (std::size_t k = 0; k < result.columns.size(); ++k)
      if (result.columns[k].name == name) return result.table[k + 1];
    ADD_FAILURE() << "no column " << name;
    return result.table.front();
  }
  std::size_t rows() const { return result.table.front().size(); }
};

/// Runs a case: itself, or another of runs_of_case().
inline Ran run_text(const std::string& text, std::size_t which = 0) {
  Ran made{std::make_unique<Case>(check_case(read_toml_text(text, "case.toml"), "case.toml")), {}, {}};
  made.built = build(*made.file, runs_of_case(*made.file)[which]);
  made.result = run(made.built.model, made.built.plan, made.built.behaviours);
  return made;
}

}  // namespace uplift::support
