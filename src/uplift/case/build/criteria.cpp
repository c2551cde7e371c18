#include "uplift/case/build/criteria.h"

#include <fmt/format.h>

#include "uplift/base/text.h"
#include "uplift/case/build/names.h"

// Thresholds and criteria: they come from the user, with their source; the program knows none.
namespace uplift {
namespace {

/// A wall has no safety against overturning, a base no share of what the walls carry.
void check_role(const CaseCriterion& table, const Criterion& criterion, const BuiltCase& built) {
  const auto index = static_cast<std::size_t>(criterion.interface);
  const bool wall = index >= built.bases();
  const VerdictQuantity& asked = *criterion.quantity;
  if (wall ? asked.of_wall() : asked.of_base()) return;
  std::vector<std::string_view> names;
  for (const VerdictQuantity& each : verdict_quantities)
    if (each.of_interface() && (wall ? each.of_wall() : each.of_base())) names.push_back(each.name);
  fail(table, "quantity",
       fmt::format("a number of a {} (\"{}\" is one): {}", wall ? "wall" : "base", built.facts[index].name, fmt::join(names, ", ")),
       in_quotes(asked.name));
}

/// The quantities of beams need an envelope.
std::string beam_of(const CaseCriterion& table, const RunPlan& plan) {
  if (!table.quantity->of_beam()) return {};
  if (plan.envelopes.empty()) fail(table, "quantity", "a [[output.beam_envelope]], for the section forces of beams", "none");
  if (!table.beam) return {};
  Names beams("beam with an envelope");
  for (const EnvelopeRequest& envelope : plan.envelopes) {
    const std::string name = envelope.beam.substr(0, envelope.beam.find(", line "));
    if (!beams.has(name)) beams.add(name, {}, {});
  }
  return beams[beams.find(*table.beam)];
}

Criterion criterion_of(const CaseCriterion& table, const Names& interfaces, const BuiltCase& built) {
  if (table.quantity->is("max_drift_without_rotation") && built.bases() > 1)
    fail(table, "quantity", "a structure on one base for this number: each of several bases rotates by itself",
         std::to_string(built.bases()) + " bases");
  Criterion criterion{table.quantity, table.limit, table.source, -1, beam_of(table, built.plan)};
  if (table.interface) {
    criterion.interface = interfaces.find(*table.interface);
    check_role(table, criterion, built);
  }
  return criterion;
}

}  // namespace

VerdictRequest verdict_request(const CaseVerdict& verdict, const BuiltCase& built) {
  VerdictRequest request{verdict.window, verdict.thresholds, {}};
  Names interfaces("interface");
  for (const Interface& interface : built.model.interfaces) interfaces.add(interface.name, {}, {});
  for (const CaseCriterion& table : verdict.criteria) request.criteria.push_back(criterion_of(table, interfaces, built));
  return request;
}

}  // namespace uplift
