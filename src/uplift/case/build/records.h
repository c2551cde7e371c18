#pragma once
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "uplift/case/schema/record_sections.h"
#include "uplift/motion/motion_function.h"
#include "uplift/run/plan.h"

// Recorded and generated motions of a case: `[[record]]` tables.
namespace uplift {

struct Case;

/// A record of the case, read and processed.
struct CaseRecord {
  std::string name;
  std::shared_ptr<const MotionHistory> history;
  const Motion& motion() const { return *history->motion(); }
};

/// Reads and processes all records of a checked case file. Throws InputError.
std::vector<CaseRecord> read_records(const std::vector<CaseRecordSource>& sources);

/// Refuses a [[compare.motion]] whose names do not pair, drive nothing or do not exist.
void check_motion(const Case&, const CaseOtherMotion& motion);
/// A history that gives a quantity: this one, or when it would have to be differentiated, that of its spline (see converted).
std::shared_ptr<const MotionHistory> giving(const std::shared_ptr<const MotionHistory>& history, MotionKind kind);

/// A history whose given values are multiplied, as the process "scale" does; the same one for the factor 1.
std::shared_ptr<const MotionHistory> scaled(const std::shared_ptr<const MotionHistory>& history, double factor);

/// The function or record that is taken instead of another: `instead` is a [[compare.motion]], or null.
const std::string& name_taken(const CaseOtherMotion* instead, const std::string& name);

/// A place of the case file where a function, or a record, drives the model.
struct DrivenBy {
  NameUsed function;     // or record
  MotionKind kind;       // the quantity that it takes of a record
  std::string_view key;  // of what multiplies the function, in the same table
  double factor;         // and what it is there
  bool rotates = false;  // a rotation: of no record
};
std::vector<DrivenBy> motions_wanted(const Case&);

/// A record that a run uses, once for every quantity.
struct MotionUse {
  std::shared_ptr<const MotionHistory> history;
  MotionKind kind;
};
std::vector<MotionUse> motions_used(const Case&, const CaseOtherMotion* instead, double factor = 1);

/// What the displacement of a record gets on top, see MotionFunction [s2]: zero when the dynamic stages differ or damp numerically.
double newmark_share(const std::vector<Stage>& stages);

/// What an engineer should know of the motions of a run: steps that do not fit, a record cut short, a base that drifts away.
void warn_motions(const std::vector<MotionUse>& used, const std::vector<Stage>& stages, std::vector<std::string>& said);

}  // namespace uplift
