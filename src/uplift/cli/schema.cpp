#include "uplift/base/error.h"
#include "uplift/case/schema/sections.h"
#include "uplift/cli/commands.h"
#include "uplift/cli/console.h"
#include "uplift/io/report/motion.h"
#include "uplift/io/results/study_json.h"
#include "uplift/io/results/summary.h"
#include "uplift/io/results/trust_json.h"

namespace uplift::cli {

int schema(const std::string& document) {
  if (document == "case")
    say(to_json_schema(case_section()));
  else if (document == "results")
    say(summary_schema());
  else if (document == "trust")
    say(trust_schema());
  else if (document == "study")
    say(study_schema());
  else if (document == "motion")
    say(motion_summary_schema());
  else
    throw InputError({"uplift schema", 0}, "", "case, results, trust, study or motion", "\"" + document + "\"",
                     nearest_name(document, {"case", "results", "trust", "study", "motion"}));
  return Exit::done;
}

}  // namespace uplift::cli
