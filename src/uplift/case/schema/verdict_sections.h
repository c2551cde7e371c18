#pragma once
#include "uplift/case/schema/case_table.h"
#include "uplift/case/schema/verdict_quantities.h"

// What the verdict is asked: declarations, used by case/schema/sections.cpp alone, and what their tables are read into. Thresholds and
// criteria come from the user, with their source; the program knows none.
namespace uplift {

/// The number of the verdict that a table names under `quantity`. Throws InputError.
const VerdictQuantity& quantity_asked(const Values& table);
/// What a table states under `limit`, in the quantity's unit. Throws InputError.
double limit_asked(const Values& table, const VerdictQuantity& quantity);

/// See Criterion.
struct CaseCriterion : CaseTable {
  const VerdictQuantity* quantity;
  double limit;
  std::string source;
  std::optional<NameUsed> interface, beam;
};

const Section& verdict_section();
struct CaseVerdict {
  double window = 0.01;         // s
  std::optional<NameUsed> top;  // node
  std::vector<double> thresholds;
  bool step_check = true;
  std::vector<CaseCriterion> criteria;
};
CaseVerdict case_verdict(const Values&);

}  // namespace uplift
