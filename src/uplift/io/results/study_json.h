#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "uplift/study/study_fit.h"

namespace uplift {

/// Everything that study.json says: what the report of a study and the Python interface are made of. Nothing in it depends on the order of
/// the runs, on their times or on the machine.
struct StudyDocument {
  std::string name, case_title, case_file, plan_hash, case_hash;
  std::vector<std::pair<std::string, std::string>> inputs;  // files, SHA-256
  std::string reduced_model;                                // its size and error in sentences; empty: the whole model was computed
  StudyPlan plan;
  std::vector<StudyMotion> motions;
  std::vector<StudySample> samples;
  struct Run {
    std::string id, reason, case_file, problem_file;  // the files where they were written
    double intensity = 0, factor = 1;
    StudyOutcome outcome = StudyOutcome::completed;
    std::vector<std::optional<double>> demands;  // for each limit
    std::vector<RunOutcome> states;              // for each limit
    std::string motion;
    long sample = 0;
  };
  struct Curve {
    std::string motion;
    long sample = 0;
    bool complete = false;
    std::vector<Run> runs;
  };
  std::vector<Curve> curves;
  struct Limit {
    StudyLimit limit;
    StudyLimitFit fit;
  };
  std::vector<Limit> limits;
  std::vector<StudyFloor> floors;
};

/// "survived", "exceeded", "unknown".
std::string_view word_of(RunOutcome);

/// From the curves with their results. `name` and files are left to the caller.
StudyDocument study_document(const StudyCase& study, const std::vector<StudyCurve>& curves);

std::string study_json(const StudyDocument&);
/// Its JSON Schema.
std::string study_schema();

/// One line for each limit: median, dispersion, intervals, counts and both ends.
std::string fits_csv(const StudyDocument&);
/// One line for each run, with the numbers for every limit.
std::string study_runs_csv(const StudyDocument&);
/// One line for each curve and limit: its capacity.
std::string study_curves_csv(const StudyDocument&);

/// What is said of the fit of a limit in one sentence: "median 0.62 g (90 %: 0.51 to 0.75), beta 0.41; 320 runs: ...".
std::string study_sentence(const StudyDocument&, std::size_t limit);

}  // namespace uplift
