#include <fmt/format.h>

#include "uplift/base/format.h"
#include "uplift/base/units.h"
#include "uplift/study/schema/plan_sections.h"

namespace uplift {
namespace {

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

}  // namespace

std::span<const PartInfo* const> study_methods() {
  static const PartInfo* const all[] = {&ida(), &truncated_ida(), &stripes(), &cloud()};
  return all;
}

StudyMethod method_of(const Values& part) {
  using enum StudyMethod::Type;
  StudyMethod method;
  const std::string& word = part.type();
  method.type = word == "ida" ? ida : word == "truncated_ida" ? truncated_ida : word == "stripes" ? stripes : cloud;
  if (method.searches()) {
    SearchPlan& search = method.search;
    search.start = part.number("start");
    search.largest = part.number("largest");
    search.smallest = number_if(part, "smallest").value_or(search.start / 100);
    search.tolerance = part.number("tolerance");
    search.fill = part.integer("fill");
    search.most = part.integer("most_runs");
    if (!(search.largest > search.start))
      fail(part, "largest", fmt::format("an intensity above start ({:g})", search.start), fmt::format("{:g}", search.largest));
    if (!(search.smallest <= search.start))
      fail(part, "smallest", fmt::format("an intensity of at most start ({:g})", search.start), fmt::format("{:g}", search.smallest));
    return method;
  }
  const char* key = method.type == stripes ? "levels" : "factors";
  method.levels = part.numbers(key);
  if (method.levels.empty() && method.type == stripes) fail(part, key, "one intensity at least", "none");
  if (method.levels.empty()) method.levels = {1};
  for (std::size_t i = 1; i < method.levels.size(); ++i)
    if (!(method.levels[i] > method.levels[i - 1]))
      fail(part, key, "ascending numbers", fmt::format("{:g} after {:g}", method.levels[i], method.levels[i - 1]));
  return method;
}

std::string_view to_string(StudyMethod::Type type) {
  constexpr std::string_view words[] = {"ida", "truncated_ida", "stripes", "cloud"};
  return words[static_cast<std::size_t>(type)];
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

IntensityMeasure intensity_of(const Values& table) {
  using enum IntensityMeasure::Kind;
  IntensityMeasure measure;
  measure.word = table.text("measure");
  measure.given.table = &table;
  const std::string& word = measure.word;
  measure.kind = word == "pga" ? pga : word == "pgv" ? pgv : word == "sa" ? sa : factor;
  if (measure.kind == sa && !table.has("period")) fail(table, "", "period, of the oscillator of sa", "none");
  if (measure.kind != sa && table.has("period")) fail(table, "period", fmt::format("no period with {}", word), "one");
  measure.period = number_if(table, "period").value_or(0);
  measure.damping = table.number("damping");
  measure.of = text_or(table, "of", "");
  const std::string si = measure.kind == factor ? "1" : measure.kind == pgv ? "m/s" : "m/s2";
  measure.unit = text_or(table, "unit", si);
  if (measure.unit.find_first_not_of(' ') == std::string::npos) fail(table, "unit", "a unit of " + quantity_name(si), "none");
  const Quantity one = measure.unit == "1" ? Quantity{1, si == "1", "a plain number", ""} : parse_quantity("1 " + measure.unit, si);
  if (!one.ok) fail(table, "unit", "a unit of " + quantity_name(si), one.found, one.nearest);
  measure.in_si = one.value;
  return measure;
}

std::string IntensityMeasure::label() const {
  switch (kind) {
    case Kind::pga:
      return "PGA";
    case Kind::pgv:
      return "PGV";
    case Kind::sa:
      return fmt::format("Sa({:g} s, {})", period, percent(damping));
    case Kind::factor:
      break;
  }
  return "factor on the motion";
}

}  // namespace uplift
