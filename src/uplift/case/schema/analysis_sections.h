#pragma once
#include "uplift/case/schema/record_sections.h"
#include "uplift/model/builder.h"

// Damping, stages and limits: declarations, used by case/schema/sections.cpp alone, and what their tables are read into.
namespace uplift {

const Section& damping_section();
/// [[compare.damping]]: the same with a name.
const Section& damping_case_section();
struct CaseDamping : CaseNamed {  // [damping] has no name
  /// A ratio to the critical damping where it stands.
  struct Ratio : CaseTable {
    std::string_view key;
    double value;
  };
  std::vector<Ratio> ratios;
  BulkDamping made;
};
CaseDamping case_damping(const Values&);

const Section& stage_section();
struct CaseStage : CaseTable {
  bool statics;  // else dynamics
  int steps;
  std::optional<double> duration, step;  // s
  const Values* scheme;
  bool path_average, traction_given;
  bool p_delta;
  int halvings;
};
CaseStage case_stage(const Values&);

const Section& energy_section();
struct CaseEnergy {
  double created_limit;
  bool stop_at_limit = false;
};
CaseEnergy case_energy(const Values&);

const Section& limits_section();
struct CaseLimits {
  double rotation;                                  // rad
  std::optional<double> separation, gap_tolerance;  // m
};
CaseLimits case_limits(const Values&);

}  // namespace uplift
