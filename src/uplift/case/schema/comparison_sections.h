#pragma once
#include "uplift/case/schema/analysis_sections.h"
#include "uplift/case/schema/record_sections.h"

// What is compared, trust bands and where values come from: declarations, used by case/schema/sections.cpp alone, and what their tables
// are read into.
namespace uplift {

const Section& variant_section();
/// Null, empty and absent: as in the case.
struct CaseVariant : CaseTable {
  NameUsed name;
  std::string label;
  std::optional<NameUsed> other_case;  // nothing else is given then
  const Values *law, *method, *impact, *scheme;
  std::string interface;
  std::optional<bool> path_average;
  std::optional<double> step;  // s
  bool may_fail;
};
CaseVariant case_variant(const Values&);

struct CaseSweep : CaseTable {
  const Values* law;
  std::string parameter;
  std::vector<double> ratios;
  bool rigid_ground;
  const Values* impact;
  std::optional<double> duration;  // s
};

inline constexpr double agreement_band = 0.02;  // difference from the median, relative

const Section& compare_section();
struct CaseComparison {
  double band = agreement_band;
  std::vector<NameUsed> agree_on;
  std::vector<CaseDamping> dampings;
  std::vector<CaseOtherMotion> motions;
  std::optional<CaseSweep> sweep;
};
CaseComparison case_comparison(const Values&);

const Section& trust_section();
struct CaseTrust {
  std::optional<double> stiffness_factor;
  int interior = 0;
  double mesh_factor, mesh_shift, spectrum_band;
};
CaseTrust case_trust(const Values&);

const Section& origin_section();
struct CaseOrigin {
  std::string label;
  std::vector<std::string> keys;
  std::string note;
};
CaseOrigin case_origin(const Values&);

const Section& figure_section();
struct CaseFigure {
  std::string chart, origin;
  std::optional<std::string> caption;
};
CaseFigure case_figure(const Values&);

}  // namespace uplift
