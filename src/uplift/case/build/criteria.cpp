#include "uplift/case/build/criteria.h"

#include <fmt/format.h>

#include "uplift/base/text.h"
#include "uplift/base/units.h"
#include "uplift/case/build/names.h"

// Thresholds and criteria: they come from the user, with their source; the program knows none.
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

/// A wall has no safety against overturning, a base no share of what the walls carry.
void check_role(const Values& table, const Criterion& criterion, const BuiltCase& built) {
  const auto index = static_cast<std::size_t>(criterion.interface);
  const bool wall = index >= built.bases();
  const VerdictQuantity& asked = *criterion.quantity;
  if (wall ? asked.of_wall : asked.of_base) return;
  std::vector<std::string_view> names;
  for (const VerdictQuantity& each : verdict_quantities())
    if (each.of_interface && (wall ? each.of_wall : each.of_base)) names.push_back(each.name);
  fail(table, "quantity",
       fmt::format("a number of a {} (\"{}\" is one): {}", wall ? "wall" : "base", built.facts[index].name, fmt::join(names, ", ")),
       in_quotes(asked.name));
}

/// The quantities of beams need an envelope.
void check_beam(const Values& table, const RunPlan& plan, Criterion& criterion) {
  if (!criterion.quantity->of_beam) {
    if (table.has("beam")) fail(table, "beam", fmt::format("no beam: \"{}\" is no quantity of beams", criterion.quantity->name), "one");
    return;
  }
  if (plan.envelopes.empty()) fail(table, "quantity", "a [[output.beam_envelope]], for the section forces of beams", "none");
  if (!table.has("beam")) return;
  Names beams("beam with an envelope");
  for (const EnvelopeRequest& envelope : plan.envelopes) {
    const std::string name = envelope.beam.substr(0, envelope.beam.find(", line "));
    if (!beams.has(name)) beams.add(name, {}, {});
  }
  criterion.beam = beams[beams.find(table, "beam")];
}

Criterion criterion_of(const Values& table, const Names& interfaces, const BuiltCase& built) {
  Criterion criterion;
  const std::string& name = table.text("quantity");
  criterion.quantity = find_verdict_quantity(name);
  if (!criterion.quantity) {
    std::vector<std::string> names;
    for (const VerdictQuantity& each : verdict_quantities()) names.emplace_back(each.name);
    fail(table, "quantity", fmt::format("a number of the verdict: {}", fmt::join(names, ", ")), "\"" + name + "\"",
         nearest_name(name, names));
  }
  const std::string unit(criterion.quantity->unit);
  const Quantity limit = parse_quantity(table.text("limit"), unit);
  if (!limit.ok) fail(table, "limit", quantity_name(unit), limit.found, limit.nearest);
  criterion.limit = limit.value;
  criterion.source = table.text("source");
  if (criterion.source.find_first_not_of(" \t\n") == std::string::npos)
    fail(table, "source", "where the limit comes from", "an empty text");
  check_beam(table, built.plan, criterion);
  if (table.has("interface")) {
    if (!criterion.quantity->of_interface) fail(table, "interface", "no interface: \"" + name + "\" belongs to the whole run", "one");
    criterion.interface = interfaces.find(table, "interface");
    check_role(table, criterion, built);
  }
  return criterion;
}

}  // namespace

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
       flag("step_check",
            "`uplift run` also runs the case with twice the step, and states by how much every number of the verdict changes: a third of "
            "the "
            "total time")
           .standard(true),
       tables("criterion", criterion_section(), "limits")}};
  return s;
}

VerdictRequest verdict_request(const Values& root, const BuiltCase& built) {
  VerdictRequest request;
  request.window = 0.01;
  if (!root.has("verdict")) return request;
  const Values& verdict = root.table("verdict");
  request.window = verdict.number("window");
  request.thresholds = verdict.numbers("uplifted_ratio_thresholds");
  Names interfaces("interface");
  for (const Interface& interface : built.model.interfaces) interfaces.add(interface.name, {}, {});
  for (const Values& table : verdict.tables("criterion")) request.criteria.push_back(criterion_of(table, interfaces, built));
  return request;
}

}  // namespace uplift
