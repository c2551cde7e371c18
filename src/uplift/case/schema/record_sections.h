#pragma once
#include "uplift/case/schema/case_table.h"
#include "uplift/motion/formats/read.h"

// Recorded and generated motions: declarations, and what their tables are read into.
namespace uplift {

/// How a record is generated. Its other keys are those of generate_section(), which generate_options() reads.
struct CaseGenerated : CaseTable {
  const Values* target;
};

const Section& record_section();
/// From a file or generated.
struct CaseRecordSource : CaseTable {
  NameUsed name;
  std::optional<NameUsed> file;
  std::string location;   // of the file, that can be opened from here
  RecordOptions options;  // of the file
  std::optional<NameUsed> component;
  std::optional<CaseGenerated> generated;
  std::vector<const Values*> processes;
};
CaseRecordSource case_record(const Values&);

/// A table of [[compare.damping]] or [[compare.motion]].
struct CaseNamed : CaseTable {
  NameUsed name;
  std::string label;
};
CaseNamed case_named(const Values&);

const Section& compare_motion_section();
struct CaseOtherMotion : CaseNamed {
  std::vector<std::string> replace, by;
  /// Whether it stands for the case's own motion: every name is replaced by itself.
  bool is_own() const { return replace == by; }
  /// The function or record that is taken instead of another.
  const std::string& taken(const std::string& asked) const;
};
CaseOtherMotion case_other_motion(const Values&);

}  // namespace uplift
