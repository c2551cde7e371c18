#pragma once
#include <string>
#include <vector>

#include "uplift/case/case.h"
#include "uplift/motion/intensity.h"
#include "uplift/study/case_edit.h"
#include "uplift/study/schema/study_plan.h"

namespace uplift {

/// One motion of a study.
struct StudyMotion {
  std::string name, label;
  const CaseOtherMotion* given = nullptr;  // [[compare.motion]] of the case; null: the case's own
  std::string hash;                        // SHA-256 of what is put in place of what
  double intensity = 1;                    // at the factor 1, in the plan's unit
  std::string record;                      // whose intensity it is; empty: not a record
  double step = 0, duration = 0;           // s, of that record
  Intensity measures;                      // of that record
};

/// One sample of the variables.
struct StudySample {
  std::vector<double> values;   // of the variables, as in the plan
  std::vector<CaseEdit> edits;  // of the case
  std::string hash;  // SHA-256 of the resolved case with these edits, without its title and description, and of the files that it reads
};

/// The case of a study, with its motions and samples.
struct StudyCase {
  StudyPlan plan;
  Raw raw;  // of the case, with the records and motions of the plan
  MeshReader read_mesh;
  Case read;  // without edits
  std::vector<StudyMotion> motions;
  std::vector<StudySample> samples;
  bool edits_mesh = false;
};

/// Joins a plan and its case. `raw`: the case as read; `motions`: folder where generated records are kept, empty: nowhere. Throws
/// InputError.
StudyCase study_case(const StudyPlan& plan, const Raw& raw, const MeshReader& read_mesh, const std::string& motions = {});

/// The case of a sample, checked. The mesh and the records are shared where no variable changes them. Throws InputError.
Case case_of_sample(const StudyCase& study, std::size_t sample);

/// What a run of the study is.
RunSpec run_of_study(const StudyCase& study, const Case& sample, std::size_t motion, double factor);

/// The case of a sample with one motion and factor, as a text that `uplift run` takes; paths of files in it are absolute.
std::string resolved_run(const StudyCase& study, std::size_t sample, std::size_t motion, double factor);

/// What a run of this case computes, as a text: its values without title, description and [trust], and the SHA-256 of the files that it
/// reads. `raw`: the file of the case.
std::string identity_of_case(const Raw& raw, const Case& read);

/// SHA-256 that names a run: of sample, motion, every bit of the factor, and the version of the program.
std::string run_identity(const StudyCase& study, std::size_t sample, std::size_t motion, double factor);

}  // namespace uplift
