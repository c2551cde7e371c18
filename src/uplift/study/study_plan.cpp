#include "uplift/study/study_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "uplift/base/file.h"
#include "uplift/base/format.h"
#include "uplift/base/units.h"
#include "uplift/case/build/names.h"

namespace uplift {
namespace {

IntensityMeasure intensity_of(const Values& table) {
  using enum IntensityMeasure::Kind;
  IntensityMeasure measure;
  const std::string& word = table.text("measure");
  measure.kind = word == "pga" ? pga : word == "pgv" ? pgv : word == "sa" ? sa : factor;
  if (measure.kind == sa && !table.has("period")) fail(table, "", "period, of the oscillator of sa", "none");
  if (measure.kind != sa && table.has("period")) fail(table, "period", fmt::format("no period with {}", word), "one");
  if (table.has("period")) measure.period = table.number("period");
  measure.damping = table.number("damping");
  if (table.has("of")) measure.of = table.text("of");
  const std::string si = measure.kind == factor ? "1" : measure.kind == pgv ? "m/s" : "m/s2";
  measure.unit = table.has("unit") ? table.text("unit") : si;
  if (measure.unit.find_first_not_of(' ') == std::string::npos) fail(table, "unit", "a unit of " + quantity_name(si), "none");
  const Quantity one = measure.unit == "1" ? Quantity{1, si == "1", "a plain number", ""} : parse_quantity("1 " + measure.unit, si);
  if (!one.ok) fail(table, "unit", "a unit of " + quantity_name(si), one.found, one.nearest);
  measure.in_si = one.value;
  return measure;
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
    search.smallest = part.has("smallest") ? part.number("smallest") : search.start / 100;
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

StudyLimit limit_of(const Values& table) {
  StudyLimit limit;
  limit.name = table.text("name");
  if (table.has("source")) limit.source = table.text("source");
  if (!table.has("quantity")) {
    for (const char* key : {"limit", "of"})
      if (table.has(key)) fail(table, key, "a quantity beside it", "none");
    return limit;
  }
  const std::string& name = table.text("quantity");
  limit.quantity = find_verdict_quantity(name);
  std::vector<std::string> known;
  for (const VerdictQuantity& each : verdict_quantities()) known.emplace_back(each.name);
  if (!limit.quantity)
    fail(table, "quantity", fmt::format("a number of the verdict: {}", fmt::join(known, ", ")), "\"" + name + "\"",
         nearest_name(name, known));
  if (!table.has("limit")) fail(table, "", fmt::format("limit, of {}", name), "none");
  const std::string unit(limit.quantity->unit);
  const Quantity value = parse_quantity(table.text("limit"), unit);
  if (!value.ok) fail(table, "limit", quantity_name(unit), value.found, value.nearest);
  limit.limit = value.value;
  if (table.has("of")) {
    if (!limit.quantity->of_interface && !limit.quantity->of_beam)
      fail(table, "of", fmt::format("nothing: {} belongs to the whole run", name), "\"" + table.text("of") + "\"");
    limit.of = table.text("of");
  }
  return limit;
}

StudyVariable variable_of(const Values& table) {
  StudyVariable variable;
  variable.name = table.text("name");
  variable.paths = table.texts("paths");
  if (variable.paths.empty()) fail(table, "paths", "one number of the case at least", "none");
  variable.is_factor = table.text("meaning") == "factor";
  return variable;
}

StudySite site_of(const Values& root) {
  StudySite site;
  if (root.has("design")) {
    const Values& table = root.table("design");
    site.design = table.number("intensity");
    if (table.has("source")) site.design_source = table.text("source");
  }
  if (!root.has("hazard")) return site;
  const Values& table = root.table("hazard");
  if (table.has("source")) site.hazard_source = table.text("source");
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

std::vector<StudyCorrelation> correlations_of(const Values& root, const Names& variables) {
  std::vector<StudyCorrelation> made;
  for (const Values& table : root.tables("correlation")) {
    const std::vector<std::string>& names = table.texts("variables");
    if (names.size() != 2 || names[0] == names[1]) fail(table, "variables", "two variables", fmt::format("{}", fmt::join(names, ", ")));
    const auto find = [&](const std::string& name) {
      return static_cast<std::size_t>(variables.find(name, table.where("variables"), table.path("variables")));
    };
    made.push_back({find(names[0]), find(names[1]), table.number("value")});
    const auto same = [&](const StudyCorrelation& each) {
      return std::minmax(each.first, each.second) == std::minmax(made.back().first, made.back().second);
    };
    if (std::ranges::count_if(made, same) > 1) fail(table, "variables", "two variables whose correlation is given once", "both again");
  }
  return made;
}

}  // namespace

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

std::string_view to_string(StudyMethod::Type type) {
  constexpr std::string_view words[] = {"ida", "truncated_ida", "stripes", "cloud"};
  return words[static_cast<std::size_t>(type)];
}

Distribution distribution_of(const Values& variable, const std::string& unit) {
  const Values& part = variable.part("distribution");
  const auto number = [&](const char* key) {
    const Quantity value = parse_quantity(part.text(key), unit);
    if (!value.ok) fail(part, key, quantity_name(unit), value.found, value.nearest);
    return value.value;
  };
  const auto positive = [&](const char* key) {
    const double value = number(key);
    if (!(value > 0)) fail(part, key, "a number > 0", part.text(key));
    return value;
  };
  if (part.type() == "lognormal") return Lognormal{positive("median"), part.number("beta")};
  if (part.type() == "normal") return Normal{number("mean"), positive("deviation")};
  const Uniform made{number("least"), number("most")};
  if (!(made.low < made.high)) fail(part, "most", "a number above least", part.text("most"));
  return made;
}

StudyPlan study_plan(const Raw& raw) {
  StudyPlan plan;
  plan.raw = raw;
  plan.values = check(raw, study_section());
  const Values& root = plan.values;
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
    for (std::size_t k = 0; k < plan.limits.size(); ++k)
      if (!plan.limits[k].quantity)
        fail(root.tables("limit").empty() ? root : root.tables("limit")[k], "", "limits with a quantity: a cloud is regressed on it",
             "none");
  plan.site = site_of(root);
  plan.floor_spectra = root.flag("floor_spectra");
  const Values& run = root.table("run");
  if (run.has("timeout")) plan.timeout = run.number("timeout");
  if (run.has("memory")) plan.memory = run.number("memory");
  if (run.has("workers")) plan.workers = run.integer("workers");
  plan.attempts = run.integer("attempts");
  return plan;
}

}  // namespace uplift
