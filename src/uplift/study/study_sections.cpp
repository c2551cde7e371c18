#include "uplift/case/build/records.h"
#include "uplift/motion/generate.h"
#include "uplift/study/study_plan.h"

namespace uplift {
namespace {

/// A number in a unit that depends on another key: bare in SI, or a text with its unit.
Field quantity(std::string_view name, std::string_view meaning) {
  Field field = text(name, meaning);
  field.unit = "*";
  return field;
}

const Section& plan_motion_section() {
  static const Section s{
      "motion",
      "a motion of the study: records that take the places of others, one for each component. Without [[motion]] and "
      "[[motions]] the study has those of [[compare.motion]] of the case, and without these its own motion alone",
      {text("name", "name"), text("label", "as shown").optional(), texts("replace", "names of records or functions that drive the case"),
       texts("by", "names of the records that take their places, in the same order; of the case or of the plan")}};
  return s;
}

const Section& motions_section() {
  static const Section s = [] {
    Section made{"motions", "many motions at once: from files, or generated for a target spectrum", {}};
    made.fields = {text("name", "beginning of their names: NAME-1, NAME-2, ..."),
                   texts("replace", "names of records or functions that drive the case, one for each component"),
                   texts("files", "files of the records; of several components the files of one motion stand side by side").optional(),
                   integer("count", "number of generated motions").between(1, 100000).optional()};
    for (const Field& field : record_section().fields) {
      if (field.name == "name" || field.name == "file" || field.name == "component") continue;
      made.fields.push_back(field);
      if (field.name == "generate") {
        made.fields.back().kind = Kind::tables;
        made.fields.back().required = false;
        made.fields.back().meaning =
            "a target and times for each component in the order of `replace`; motion i has the seed `seed` + i - 1";
      }
    }
    return made;
  }();
  return s;
}

const Section& intensity_section() {
  static const Section s{
      "intensity",
      "what the intensity of a motion is; every intensity of the plan and of the results is in its unit",
      {choice("measure", {"pga", "pgv", "sa", "factor"},
              "peak acceleration, peak velocity, pseudo-acceleration of an oscillator, or the factor on the motion as it is"),
       number("period", "s", "of the oscillator").positive().optional(),
       number("damping", "1", "of the oscillator, ratio to the critical damping").between(0, 0.99).standard(0.05),
       text("unit", "unit of all intensities, as \"g_n\"; absent: m/s2 or m/s").optional(),
       text("of", "name in `replace` whose record is measured; absent: the first one").optional()}};
  return s;
}

constexpr const char* search_equations =
    "For every motion and sample the capacity is the intensity at which a limit is exceeded first. Intensities grow from `start` by "
    "growing\n"
    "factors until it is exceeded; then the interval between the last survival and the first exceedance is halved in the logarithm until "
    "it\nis within `tolerance`; then the largest gaps are filled. A survival above an exceedance is reported (resurrection).";

Field start_field() {
  return number("start", "1", "first intensity").positive();
}
Field tolerance_field() {
  return number("tolerance", "1", "width of the interval of the capacity, of its logarithm").between(1e-6, 1).standard(0.02);
}
Field most_runs_field() {
  return integer("most_runs", "most runs of a motion for one limit").between(1, 1000).standard(12);
}
Field smallest_field() {
  return number("smallest", "1", "the search goes no lower; absent: a hundredth of start").positive().optional();
}
Field fill_field() {
  return integer("fill", "intensities of a curve in all: when the capacity is known, the largest gaps below it are filled")
      .between(0, 1000)
      .standard(0);
}

const PartInfo& ida() {
  static const PartInfo s{
      "ida",
      "incremental dynamic analysis: the capacity of every motion is searched",
      search_equations,
      "Vamvatsikos and Cornell (2002), Earthquake Engineering and Structural Dynamics 31, 491-514",
      {start_field(), number("largest", "1", "largest intensity: a motion that survives it has a capacity beyond").positive(),
       smallest_field(), tolerance_field(), fill_field(), most_runs_field()}};
  return s;
}

const PartInfo& truncated_ida() {
  static const PartInfo s{"truncated_ida",
                          "incremental dynamic analysis up to a largest intensity; capacities beyond it are censored in the fit",
                          search_equations,
                          "Baker (2015), Earthquake Spectra 31, 579-599",
                          {start_field(), number("largest", "1", "intensity at which the search ends").positive(), smallest_field(),
                           tolerance_field(), fill_field(), most_runs_field()}};
  return s;
}

const PartInfo& stripes() {
  static const PartInfo s{
      "stripes",
      "every motion at every one of some intensities; exceedances are counted",
      "The number of exceedances at an intensity is binomial with P(exceeded) = Phi(ln(im/theta)/beta); maximum likelihood.",
      "Baker (2015), Earthquake Spectra 31, 579-599",
      {numbers("levels", "1", "intensities, ascending").positive()}};
  return s;
}

const PartInfo& cloud() {
  static const PartInfo s{"cloud",
                          "motions as they are, or with a few factors; the demand is regressed on the intensity",
                          "ln D = a + b ln IM + error of standard deviation s;  theta = exp((ln d - a)/b),  beta = s/b.",
                          "Jalayer, De Risi and Manfredi (2015), Bulletin of Earthquake Engineering 13, 1183-1203",
                          {numbers("factors", "1", "factors on every motion; absent: 1").positive().optional()}};
  return s;
}

const PartInfo& lognormal() {
  static const PartInfo s{"lognormal",
                          "the logarithm is normal",
                          "ln x = ln median + beta z",
                          "",
                          {quantity("median", "median"), number("beta", "1", "standard deviation of the logarithm").positive()}};
  return s;
}

const PartInfo& normal() {
  static const PartInfo s{
      "normal", "normal", "x = mean + deviation z", "", {quantity("mean", "mean"), quantity("deviation", "standard deviation, > 0")}};
  return s;
}

const PartInfo& uniform() {
  static const PartInfo s{"uniform",
                          "all values between two are equally likely",
                          "least <= x <= most",
                          "",
                          {quantity("least", "least value"), quantity("most", "largest value")}};
  return s;
}

const Section& variable_section() {
  static const Section s{"variable",
                         "numbers of the case that are uncertain; they vary together. Samples are a Latin hypercube",
                         {text("name", "name"), texts("paths", "numbers of the case that it sets, as \"interface[0].law.K_n\""),
                          choice("meaning", {"factor", "value"}, "a factor on the case's values, or their value").standard("factor"),
                          part("distribution", study_distributions, "distribution")}};
  return s;
}

const Section& correlation_section() {
  static const Section s{
      "correlation",
      "rank correlation of two variables; others are independent",
      {texts("variables", "names of two variables"), number("value", "1", "correlation coefficient").between(-0.999, 0.999)}};
  return s;
}

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

std::span<const PartInfo* const> study_distributions() {
  static const PartInfo* const all[] = {&lognormal(), &normal(), &uniform()};
  return all;
}

std::span<const PartInfo* const> study_methods() {
  static const PartInfo* const all[] = {&ida(), &truncated_ida(), &stripes(), &cloud()};
  return all;
}

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
       flag("floor_spectra", "keep the floor spectra of every run, for percentiles").standard(false),
       table("run", run_section(), "how the runs are computed")}};
  return s;
}

}  // namespace uplift
