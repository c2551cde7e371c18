#pragma once
#include <memory>
#include <string>
#include <vector>

#include "uplift/reduction/reduced_model.h"
#include "uplift/study/study_case.h"

namespace uplift {

/// A study: a folder with plan.toml.
struct Study {
  std::string folder, name;
  StudyCase of;
  std::string case_file;                                    // as it is opened from here
  std::string plan_hash, case_hash;                         // SHA-256 of the two texts
  std::vector<std::pair<std::string, std::string>> inputs;  // other files that the case reads, with their SHA-256
  std::shared_ptr<const ReducedModel> reduced;              // that the case names; null: the whole model is computed
  /// Size and error of the reduced model in sentences; empty without one.
  std::string reduced_statement() const;
};

/// Opens a study by its folder, its plan.toml, or its name (NAME for NAME.study). Throws InputError.
Study open_study(const std::string& given);

}  // namespace uplift
