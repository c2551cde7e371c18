#include "uplift/verdict/result_warnings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>

#include "uplift/base/format.h"
#include "uplift/verdict/step_check.h"

namespace uplift {
namespace {

std::string late_peaks(const RunResult& run, const VerdictNumbers& numbers) {
  constexpr double last_part = 0.1;
  if (run.status != RunStatus::completed || run.steps.size() < 2) return "";
  const double late = run.steps.time.back() - last_part * (run.steps.time.back() - run.steps.time.front());
  std::vector<std::string> found;
  const auto look = [&](const std::vector<VerdictNumber>& list, const std::string& of) {
    for (const QuantityName name : std::initializer_list<QuantityName>{"max_uplifted_ratio", "max_opening", "max_shear", "max_moment",
                                                                       "max_compression", "max_top_motion"})
      if (const VerdictNumber* number = find_number(list, name); number && number->time && *number->time > late)
        found.push_back(fmt::format("{}{} at {}", number->quantity->brief, of, format_quantity(*number->time, "s")));
  };
  look(numbers.whole, "");
  for (const InterfaceVerdict& said : numbers.interfaces)
    if (said.role == Role::base) look(said.numbers, " of " + said.name);
  if (found.empty()) return "";
  return fmt::format("largest values are reached in the last tenth of the run ({}): a longer run may exceed them", fmt::join(found, ", "));
}

std::string lost_energy(const RunResult& run) {
  if (run.status == RunStatus::failed || !(run.energy_lost > accepted_energy_loss * run.energy_scale)) return "";
  return fmt::format("the time scheme lost {} of the energy that was put in: the step does not resolve the motion, take a smaller one",
                     percent(run.energy_lost / run.energy_scale));
}

}  // namespace

std::vector<std::string> result_warnings(const RunResult& run, const VerdictNumbers& numbers) {
  std::vector<std::string> said;
  for (std::string text : {run.not_unique, run.equilibrium.warning(), lost_energy(run), late_peaks(run, numbers)})
    if (!text.empty()) said.push_back(std::move(text));
  return said;
}

}  // namespace uplift
