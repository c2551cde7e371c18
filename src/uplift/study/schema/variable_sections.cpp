#include <fmt/format.h>

#include <algorithm>

#include "uplift/base/units.h"
#include "uplift/study/schema/plan_sections.h"

namespace uplift {
namespace {

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

}  // namespace

std::span<const PartInfo* const> study_distributions() {
  static const PartInfo* const all[] = {&lognormal(), &normal(), &uniform()};
  return all;
}

Distribution distribution_of(const StudyVariable& variable) {
  const Values& part = variable.given.table->part("distribution");
  const auto number = [&](const char* key) {
    const Quantity value = parse_quantity(part.text(key), variable.unit);
    if (!value.ok) fail(part, key, quantity_name(variable.unit), value.found, value.nearest);
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

const Section& variable_section() {
  static const Section s{"variable",
                         "numbers of the case that are uncertain; they vary together. Samples are a Latin hypercube",
                         {text("name", "name"), texts("paths", "numbers of the case that it sets, as \"interface[0].law.K_n\""),
                          choice("meaning", {"factor", "value"}, "a factor on the case's values, or their value").standard("factor"),
                          part("distribution", study_distributions, "distribution")}};
  return s;
}

StudyVariable variable_of(const Values& table) {
  StudyVariable variable;
  variable.given.table = &table;
  variable.name = table.text("name");
  variable.paths = table.texts("paths");
  if (variable.paths.empty()) fail(table, "paths", "one number of the case at least", "none");
  variable.is_factor = table.text("meaning") == "factor";
  return variable;
}

const Section& correlation_section() {
  static const Section s{
      "correlation",
      "rank correlation of two variables; others are independent",
      {texts("variables", "names of two variables"), number("value", "1", "correlation coefficient").between(-0.999, 0.999)}};
  return s;
}

std::vector<StudyCorrelation> correlations_of(const Values& root, const Names& variables) {
  std::vector<StudyCorrelation> made;
  for (const Values& table : root.tables("correlation")) {
    const std::vector<std::string>& names = table.texts("variables");
    if (names.size() != 2 || names[0] == names[1]) fail(table, "variables", "two variables", fmt::format("{}", fmt::join(names, ", ")));
    const auto find = [&](const std::string& name) {
      return static_cast<std::size_t>(variables.find(name, table.where("variables"), table.path("variables")));
    };
    made.push_back({find(names[0]), find(names[1]), table.number("value"), {&table}});
    const auto same = [&](const StudyCorrelation& each) {
      return std::minmax(each.first, each.second) == std::minmax(made.back().first, made.back().second);
    };
    if (std::ranges::count_if(made, same) > 1) fail(table, "variables", "two variables whose correlation is given once", "both again");
  }
  return made;
}

Field quantity(std::string_view name, std::string_view meaning) {
  Field field = text(name, meaning);
  field.unit = "*";
  return field;
}

}  // namespace uplift
