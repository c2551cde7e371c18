#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "uplift/cli/commands.h"
#include "uplift/ensemble/store.h"
#include "uplift/ensemble/study.h"
#include "uplift/io/files.h"
#include "uplift/io/results/study_json.h"
#include "uplift/study/study_curve.h"

namespace uplift::cli {

/// Cores that this process may use.
int cores();

/// Writes NAME.study/plan.toml.
int new_study(const std::string& name);
/// What a study would compute, from its plan and one run.
int check_study(const Options& options);

/// What the runs say, with the names and hashes of the study.
StudyDocument document_of(const Study& study, const std::vector<StudyCurve>& curves);
/// Writes study.json and fits.csv, with report.html where `with_page`; prints study.json or a sentence for each limit.
void write_results(const Study& study, const std::vector<StudyCurve>& curves, const Options& options, bool with_page);

/// What the system refuses is an output error.
template <class Write>
void writing(const Write& write) {
  try {
    write();
  } catch (const std::filesystem::filesystem_error& error) {
    throw OutputError(error.what());
  }
}

void write_in(const Study& study, const std::string& name, const std::string& text);
void tell_damage(const StudyStore& store);

}  // namespace uplift::cli
