#include "uplift/study/schema/study_plan.h"

#include <fmt/format.h>

#include "uplift/base/file.h"
#include "uplift/case/schema/record_sections.h"
#include "uplift/case/schema/verdict_sections.h"
#include "uplift/study/schema/plan_sections.h"

namespace uplift {
namespace {

const Section& limit_section() {
  static const Section s{
      "limit",
      "a limit state: exceeded where the number lies beyond the limit; runs that overturn or separate exceed every one",
      {text("name", "name"),
       text("quantity", "number of the verdict (`uplift describe quantity`); absent: overturning and separation alone").optional(),
       text("of", "interface or beam that it is for; absent: any of them").optional(),
       quantity("limit", "limit in the quantity's unit: a number, or a text with a unit (\"30 mm\")").optional(),
       text("source", "where the limit comes from").optional()}};
  return s;
}

StudyLimit limit_of(const Values& table) {
  StudyLimit limit;
  limit.given.table = &table;
  limit.name = table.text("name");
  limit.source = text_or(table, "source", "");
  if (!table.has("quantity")) {
    for (const char* key : {"limit", "of"})
      if (table.has(key)) fail(table, key, "a quantity beside it", "none");
    return limit;
  }
  limit.quantity = &quantity_asked(table);
  const std::string_view name = limit.quantity->name;
  if (!table.has("limit")) fail(table, "", fmt::format("limit, of {}", name), "none");
  limit.limit = limit_asked(table, *limit.quantity);
  if (limit.limit < 0 && !limit.quantity->at_least && !name.starts_with("change_of"))
    fail(table, "limit", "a number >= 0: the size of the quantity counts", table.text("limit"));
  if (table.has("of")) {
    if (!limit.quantity->of_interface() && !limit.quantity->of_beam())
      fail(table, "of", fmt::format("nothing: {} belongs to the whole run", name), "\"" + table.text("of") + "\"");
    limit.of = table.text("of");
  }
  return limit;
}

const Section& design_section() {
  static const Section s{"design",
                         "the design motion of the site: the probability that each limit is exceeded there and at 1.5 times it, beside the "
                         "aims of ASCE/SEI 43 (about 1 % and 10 %)",
                         {number("intensity", "1", "its intensity").positive(), text("source", "where it comes from").optional()}};
  return s;
}

const Section& hazard_section() {
  static const Section s{"hazard",
                         "the hazard curve of the site: the annual rate with which each limit is exceeded. Straight in both logarithms "
                         "between its points and beyond them",
                         {numbers("intensities", "1", "intensities, ascending").positive(),
                          numbers("rates", "1", "mean rates per year with which they are exceeded").positive(),
                          text("source", "where it comes from").optional()}};
  return s;
}

const Section& factor_section() {
  static const Section s{"factor",
                         "a factor of safety that the runs do not vary, as the strength of an anchor or the damping of equipment: it "
                         "multiplies the capacity of every limit (separation of variables, EPRI TR-103959)",
                         {text("name", "name"), number("median", "1", "median of the factor").positive().standard(1),
                          number("beta_r", "1", "scatter from motion to motion, of the logarithm").nonnegative().standard(0),
                          number("beta_u", "1", "uncertainty of knowledge, of the logarithm").nonnegative().standard(0),
                          text("source", "where the numbers come from").optional()}};
  return s;
}

std::vector<SafetyFactor> factors_of(const Values& root) {
  std::vector<SafetyFactor> factors;
  Names names("factor");
  for (const Values& table : root.tables("factor")) {
    names.add(table, "name");
    factors.push_back(
        {table.text("name"), table.number("median"), table.number("beta_r"), table.number("beta_u"), text_or(table, "source", "")});
    const SafetyFactor& factor = factors.back();
    if (factor.median == 1 && factor.beta_r == 0 && factor.beta_u == 0)
      fail(table, "", "a median other than 1, beta_r or beta_u", "a factor that changes nothing");
  }
  return factors;
}

StudySite site_of(const Values& root) {
  StudySite site;
  site.factors = factors_of(root);
  if (const Values* design = table_if(root, "design")) {
    site.design = design->number("intensity");
    site.design_source = text_or(*design, "source", "");
  }
  if (!root.has("hazard")) return site;
  const Values& table = root.table("hazard");
  site.hazard_source = text_or(table, "source", "");
  const std::vector<double>&intensities = table.numbers("intensities"), &rates = table.numbers("rates");
  if (intensities.size() < 2) fail(table, "intensities", "two intensities at least", fmt::format("{}", intensities.size()));
  if (rates.size() != intensities.size())
    fail(table, "rates", fmt::format("a rate for each of the {} intensities", intensities.size()), fmt::format("{}", rates.size()));
  for (std::size_t i = 0; i < rates.size(); ++i) {
    if (i > 0 && !(intensities[i] > intensities[i - 1]))
      fail(table, "intensities", "ascending numbers", fmt::format("{:g} after {:g}", intensities[i], intensities[i - 1]));
    if (i > 0 && !(rates[i] < rates[i - 1]))
      fail(table, "rates", "rates that fall as the intensity grows", fmt::format("{:g} after {:g}", rates[i], rates[i - 1]));
    site.hazard.push_back({intensities[i], rates[i]});
  }
  return site;
}

const Section& run_section() {
  static const Section s{
      "run",
      "how the runs are computed; nothing here changes their results",
      {integer("workers", "processes at the same time; absent: one for every core").between(1, 4096).optional(),
       number("timeout", "s", "computing time after which a run is ended").positive().optional(),
       number("memory", "1", "MB of memory that a worker may use beyond what it shares with the others").positive().optional(),
       integer("attempts", "how often a run is tried whose worker dies").positive().standard(3)}};
  return s;
}

}  // namespace

const Section& study_section() {
  static const Section s{
      "study",
      "plan.toml of a study: one case under many motions, at many intensities, with sampled variables",
      {text("case", "case file, or folder with case.toml; relative to the plan"),
       text(
           "reduced_model",
           "file of a reduced model of the case (`uplift reduce`), relative to the plan, with which the runs are computed; absent: that of "
           "the case, else the whole model")
           .optional(),
       integer("seed", "of the samples").nonnegative().standard(1), table("intensity", intensity_section(), "measure of the motions"),
       part("method", study_methods, "which intensities are run"), tables("motion", plan_motion_section(), "motions"),
       tables("motions", motions_section(), "motions from files, or generated"),
       tables("record", record_section(), "records beside those of the case"),
       integer("samples", "number of samples of the variables").between(1, 100000).standard(1),
       choice("pairing", {"crossed", "paired"},
              "crossed: every sample with every motion; paired: sample i with motion i, and the motions again from the first one on")
           .standard("crossed"),
       tables("variable", variable_section(), "uncertain numbers of the case"),
       tables("correlation", correlation_section(), "correlations of variables"), tables("limit", limit_section(), "limit states"),
       table("design", design_section(), "design motion; absent: none").optional(),
       table("hazard", hazard_section(), "hazard curve; absent: none").optional(),
       tables("factor", factor_section(), "factors of safety that the runs do not vary"),
       integer("bootstrap",
               "draws of a parametric bootstrap of every fit, whose intervals stand beside those of the likelihood: at least 200; 0: none. "
               "Runs "
               "count as independent in it")
           .between(0, 100000)
           .standard(0),
       flag("floor_spectra", "keep the floor spectra of every run, for percentiles at the levels of stripes or of a cloud").standard(false),
       table("run", run_section(), "how the runs are computed")}};
  return s;
}

StudyPlan study_plan(const Raw& raw) {
  StudyPlan plan;
  plan.raw = raw;
  plan.values = std::make_shared<const Values>(check(raw, study_section()));
  const Values& root = *plan.values;
  plan.case_file = path_beside(root.where("case"), root.text("case")).lexically_normal().string();
  plan.seed = static_cast<std::uint64_t>(root.integer("seed"));
  plan.intensity = intensity_of(root.table("intensity"));
  plan.method = method_of(root.part("method"));
  Names variables("variable"), limits("limit");
  for (const Values& table : root.tables("variable")) {
    variables.add(table, "name");
    plan.variables.push_back(variable_of(table));
  }
  plan.correlations = correlations_of(root, variables);
  plan.samples = root.integer("samples");
  if (plan.variables.empty() && plan.samples > 1) fail(root, "samples", "[[variable]] tables, of which samples are drawn", "none");
  plan.crossed = root.text("pairing") == "crossed";
  for (const Values& table : root.tables("limit")) {
    limits.add(table, "name");
    plan.limits.push_back(limit_of(table));
  }
  if (plan.limits.empty()) plan.limits.push_back({"overturned", "", nullptr, "", 0});
  if (plan.method.type == StudyMethod::Type::cloud)
    for (const StudyLimit& limit : plan.limits) {
      if (!limit.quantity)
        fail(limit.given.table ? *limit.given.table : root, "", "limits with a quantity: a cloud is regressed on it", "none");
      if (limit.quantity->at_least)
        fail(*limit.given.table, "quantity", "a number that grows with the intensity: a cloud is regressed on it",
             fmt::format("{}, which has a smallest value", limit.quantity->name));
      if (limit.quantity->name.starts_with("change_of"))  // of either sign: it has no logarithm
        fail(*limit.given.table, "quantity", "a number whose size counts: a cloud is regressed on its logarithm",
             fmt::format("{}, a change that may be negative", limit.quantity->name));
      if (!(limit.limit > 0))
        fail(*limit.given.table, "limit", "a number > 0: a cloud is regressed on the logarithm of the demand",
             limit.given.table->text("limit"));
    }
  for (const Values& table : root.tables("motions")) plan.many_motions.push_back(many_motions_of(table));
  plan.site = site_of(root);
  plan.bootstrap = root.integer("bootstrap");
  if (plan.bootstrap > 0 && plan.bootstrap < 200)
    fail(root, "bootstrap", "0 or at least 200 draws: percentiles of fewer scatter", std::to_string(plan.bootstrap));
  plan.floor_spectra = root.flag("floor_spectra");
  if (plan.floor_spectra && plan.method.searches())
    fail(root, "floor_spectra", "stripes or cloud as the method: percentiles are those of runs at one level",
         "a method that gives every motion intensities of its own");
  const Values& run = root.table("run");
  plan.timeout = number_if(run, "timeout");
  plan.memory = number_if(run, "memory");
  if (run.has("workers")) plan.workers = run.integer("workers");
  plan.attempts = run.integer("attempts");
  return plan;
}

}  // namespace uplift
