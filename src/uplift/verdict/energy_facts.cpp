#include "uplift/verdict/energy_facts.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "uplift/base/format.h"

namespace uplift {
namespace {

constexpr double round_off = 1e-9;  // of the energy put in: below, nothing was created that a ledger in double precision can tell

}  // namespace

void say_energy(const BuiltCase& built, const RunResult& run, Verdict& verdict) {
  const double scale = run.energy_scale;
  const double created = scale > 0 ? run.energy_created / scale : 0, lost = scale > 0 ? run.energy_lost / scale : 0;
  const bool too_much = created > built.plan.created_limit;
  constexpr double least_loss = 0.001;
  if (lost > least_loss && lost > created)
    verdict.facts.push_back(
        {"Energy lost by the scheme", percent(lost), "of the same: what the step does not resolve", lost > accepted_energy_loss});
  verdict.facts.push_back({"Energy created by the computation", created < round_off ? "none" : percent(created),
                           fmt::format("of {}; limit {}", format_quantity(scale, "J"), percent(built.plan.created_limit)), too_much});
  const Energies& end = run.final_energy;
  if (end.stop != 0 && scale > 0)
    verdict.facts.push_back({"Energy taken by static stages", format_quantity(end.stop, "J"),
                             fmt::format("{} of the same: they stop the structure after a dynamic stage", percent(end.stop / scale)),
                             false});
  std::string text =
      too_much ? fmt::format("The computation created {} of the energy put in ({} at {}): these results are not to be used.",
                             percent(created), format_quantity(run.energy_created, "J"), format_quantity(run.energy_created_time, "s"))
      : created < round_off
          ? "The energy balance closes: the computation created none of the energy put in."
          : fmt::format("The energy balance closes: the computation created at most {} of the energy put in.", percent(created));
  if (scale > 0) {
    if (end.stop != 0)
      text += fmt::format(" Static stages after dynamic ones stopped the structure and took {}.", percent(end.stop / scale));
    if (end.damping > 1e-6 * scale) text += fmt::format(" Damping took {}.", percent(end.damping / scale));
    if (end.interface_dissipated > 1e-6 * scale) text += fmt::format(" The interface took {}.", percent(end.interface_dissipated / scale));
    if (std::abs(end.impact) > 1e-6 * scale) text += fmt::format(" Impacts took {}.", percent(end.impact / scale));
    if (lost > least_loss && lost > created) text += fmt::format(" The time scheme dissipated {}.", percent(lost));
  }
  verdict.paragraphs.push_back(std::move(text));
}

}  // namespace uplift
