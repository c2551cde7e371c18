#include "uplift/case/schema/verdict_sections.h"

#include <fmt/format.h>

#include "uplift/base/text.h"
#include "uplift/base/units.h"

namespace uplift {
namespace {

Field limit_field() {
  Field field = text("limit", "limit in the quantity's unit: a number, or a text with a unit (\"3 mm\")");
  field.unit = "*";
  return field;
}

const Section& criterion_section() {
  static const Section s{
      "criterion",
      "a limit for a number of the verdict: met when the number is not larger (changes with their sign, else the magnitude), for safeties "
      "and min_compression when it is not smaller",
      {text("quantity",
            "number of the verdict: those of summary.json, for example max_uplifted_ratio, max_opening, toe_pressure_ratio, "
            "max_eccentricity, min_overturning_safety, min_sliding_safety, residual_rotation, residual_slip, residual_settlement"),
       limit_field(), text("source", "where the limit comes from: code and clause, client, judgement"),
       text("interface", "interface that it is for; absent: every base, for numbers of walls alone every wall").optional(),
       text("beam", "beam that it is for, of the quantities of beams; absent: every one with a [[output.beam_envelope]]").optional()}};
  return s;
}

CaseCriterion case_criterion(const Values& table) {
  const VerdictQuantity& quantity = quantity_asked(table);
  CaseCriterion made{
      {&table}, &quantity, limit_asked(table, quantity), table.text("source"), name_if(table, "interface"), name_if(table, "beam")};
  if (made.source.find_first_not_of(" \t\n") == std::string::npos) fail(table, "source", "where the limit comes from", "an empty text");
  if (made.beam && !quantity.of_beam()) fail(*made.beam, fmt::format("no beam: \"{}\" is no quantity of beams", quantity.name), "one");
  if (made.interface && !quantity.of_interface())
    fail(*made.interface, fmt::format("no interface: \"{}\" belongs to the whole run", quantity.name), "one");
  return made;
}

}  // namespace

const VerdictQuantity& quantity_asked(const Values& table) {
  const std::string& name = table.text("quantity");
  if (const VerdictQuantity* found = find_verdict_quantity(name)) return *found;
  std::vector<std::string> known;
  for (const VerdictQuantity& each : verdict_quantities) known.emplace_back(each.name);
  fail(table, "quantity", fmt::format("a number of the verdict: {}", fmt::join(known, ", ")), "\"" + name + "\"",
       nearest_name(name, known));
}

double limit_asked(const Values& table, const VerdictQuantity& quantity) {
  const std::string unit(quantity.unit);
  const Quantity limit = parse_quantity(table.text("limit"), unit);
  if (!limit.ok) fail(table, "limit", quantity_name(unit), limit.found, limit.nearest);
  return limit.value;
}

const Section& verdict_section() {
  static const Section s{
      "verdict",
      "what the verdict is asked; thresholds and limits are the user's, none is built in",
      {numbers("uplifted_ratio_thresholds", "1", "shares of the area: for how long the uplifted share is above").between(0, 1).optional(),
       number("window", "s",
              "forces, moments and pressures of the verdict are means over this time (or over the step where that is longer), so that the "
              "peak of an impact does not depend on the step; the default passes motions up to 10 Hz within 2 %")
           .nonnegative()
           .standard(0.01),
       text("top",
            "node that is the top, whose motion and drift are numbers of the verdict; absent: the highest node (or centre of mass of a "
            "rigid body) of what stands on the base, of equally high ones that nearest to its middle")
           .optional(),
       flag("step_check",
            "`uplift run` also runs the case with twice the step, and states by how much every number of the verdict changes: a third of "
            "the total time")
           .standard(true),
       tables("criterion", criterion_section(), "limits")}};
  return s;
}

CaseVerdict case_verdict(const Values& table) {
  CaseVerdict verdict{
      table.number("window"), name_if(table, "top"), table.numbers("uplifted_ratio_thresholds"), table.flag("step_check"), {}};
  for (const Values& criterion : table.tables("criterion")) verdict.criteria.push_back(case_criterion(criterion));
  return verdict;
}

}  // namespace uplift
