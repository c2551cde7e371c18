#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "uplift/case/schema/case_table.h"
#include "uplift/case/schema/verdict_quantities.h"
#include "uplift/statistics/capacity_search.h"
#include "uplift/statistics/distributions.h"
#include "uplift/statistics/nuclear.h"

// The plan of a study: one case under many motions, at many intensities, with sampled variables (docs/guide/studies.md).
namespace uplift {

/// The declaration of the file plan.toml.
const Section& study_section();
/// How intensities are chosen: the parts of `method`.
std::span<const PartInfo* const> study_methods();
/// Of the values of its variables.
std::span<const PartInfo* const> study_distributions();

/// What measures a motion. Intensities are in the unit of the plan throughout.
struct IntensityMeasure {
  enum class Kind { pga, pgv, sa, factor } kind = Kind::factor;
  double period = 0, damping = 0.05;  // s, ratio to the critical damping: of sa
  std::string unit = "1";             // "g_n", "m/s2", ...
  double in_si = 1;                   // of one unit
  std::string word;                   // for the kind
  CaseTable given;                    // [intensity]
  std::string of;                     // name in `replace` whose record is measured; empty: the first
  std::string label() const;          // "Sa(0.5 s, 5 %)"
};

struct StudyMethod {
  enum class Type { ida, truncated_ida, stripes, cloud } type = Type::ida;
  std::vector<double> levels;  // stripes: intensities, ascending; cloud: factors
  SearchPlan search;           // of the capacity of a motion
  bool searches() const { return type == Type::ida || type == Type::truncated_ida; }
};
std::string_view to_string(StudyMethod::Type);

/// A limit state: exceeded by runs whose number lies beyond the limit, and by all that overturned or separated.
struct StudyLimit {
  std::string name, source;
  const VerdictQuantity* quantity = nullptr;  // null: overturning and separation alone
  std::string of;                             // interface or beam; empty: the worst of all
  double limit = 0;                           // in the quantity's unit
  CaseTable given = {};                       // [[limit]]; null without any
};

/// One or several numbers of the case that vary together.
struct StudyVariable {
  std::string name;
  std::vector<std::string> paths;               // of the case: "interface[0].law.K_n"
  bool is_factor = true;                        // of the case's values; else it is their value
  Distribution distribution = Lognormal{1, 1};  // of SI values, see unit
  std::string unit = "1";                       // of the values
  CaseTable given = {};                         // [[variable]]
};
struct StudyCorrelation {
  std::size_t first = 0, second = 0;  // variables
  double value = 0;
  CaseTable given = {};  // [[correlation]]
};

/// Many motions at once, [[motions]]: from files, or generated.
struct StudyManyMotions {
  std::string name;  // beginning of theirs
  std::vector<std::string> replace;
  std::vector<std::string> files;   // those of one motion side by side; empty: they are generated
  std::size_t count = 0;            // of motions
  std::vector<std::int64_t> seeds;  // of the components of the first motion
};

/// What the site asks for and what the runs do not vary: they change results of the fits, not of the runs.
struct StudySite {
  std::optional<double> design;     // intensity of the design motion
  std::vector<HazardPoint> hazard;  // rates in 1/a; empty: none
  std::string design_source, hazard_source;
  std::vector<SafetyFactor> factors;  // on the capacity of every limit
};

/// A checked plan.
struct StudyPlan {
  Raw raw;                               // as read
  std::shared_ptr<const Values> values;  // of study_section(); the tables of the others are in it
  std::string case_file;
  std::uint64_t seed = 1;
  IntensityMeasure intensity;
  StudyMethod method;
  std::vector<StudyVariable> variables;
  std::vector<StudyCorrelation> correlations;
  int samples = 1;
  bool crossed = true;  // every sample with every motion; else sample i with motion i
  std::vector<StudyLimit> limits;
  std::vector<StudyManyMotions> many_motions;
  StudySite site;
  int bootstrap = 0;  // draws of a parametric bootstrap of the fits; 0: none
  bool floor_spectra = false;
  std::optional<double> timeout;  // s of one run
  std::optional<double> memory;   // MB of one worker
  int workers = 0;                // 0: one for every core
  int attempts = 3;               // of a run whose worker dies
};

/// Checks a plan on its own, without its case: distributions are read later, when the units of their values are known. Throws InputError.
StudyPlan study_plan(const Raw& raw);
/// The distribution that the table of a variable states for values of its unit. Throws InputError.
Distribution distribution_of(const StudyVariable& variable);

}  // namespace uplift
