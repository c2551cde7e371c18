#include "uplift/verdict/result_warnings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

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
    for (const std::string_view name :
         {"max_uplifted_ratio", "max_opening", "max_shear", "max_moment", "max_compression", "max_top_motion"})
      if (const VerdictNumber* number = find_number(list, name); number && number->time && *number->time > late)
        found.push_back(fmt::format("{}{} at {}", number->quantity->brief, of, format_quantity(*number->time, "s")));
  };
  look(numbers.whole, "");
  for (const InterfaceVerdict& said : numbers.interfaces)
    if (said.role == Role::base) look(said.numbers, " of " + said.name);
  if (found.empty()) return "";
  return fmt::format("largest values are reached in the last tenth of the run ({}): a longer run may exceed them", fmt::join(found, ", "));
}

/// Drifts and lengths of vectors are made of rows of the table, which with `output.every` are fewer than the steps: by how much the peaks
/// of single columns, which are those of all steps, exceed their rows tells what rows miss.
std::string missed_peaks(const RunResult& run, const VerdictNumbers& numbers) {
  constexpr double tolerated = 0.01, of_largest = 0.05;
  if (find_number(numbers.whole, "max_drift") == nullptr || run.table.size() != run.peaks.size() + 1) return "";
  const auto moves = [&](std::size_t k) { return run.columns[k].kind == Request::Kind::displacement; };
  std::map<std::string, double> largest;  // by unit
  for (std::size_t k = 0; k < run.peaks.size(); ++k)
    if (moves(k)) largest[run.peaks[k].unit] = std::max(largest[run.peaks[k].unit], std::abs(run.peaks[k].value));
  double missed = 0;
  for (std::size_t k = 0; k < run.peaks.size(); ++k) {
    const double peak = std::abs(run.peaks[k].value);
    if (!moves(k) || !(peak > of_largest * largest[run.peaks[k].unit])) continue;
    double recorded = 0;
    for (const double value : run.table[k + 1]) recorded = std::max(recorded, std::abs(value));
    missed = std::max(missed, 1 - recorded / peak);
  }
  if (!(missed > tolerated)) return "";
  return fmt::format(
      "the recorded rows miss up to {} of the peaks of single motions, which lie between them: the drifts of the verdict and, in space, "
      "the motion of the top are made of rows and may be too small by more than that; take a smaller `every` in [output]",
      percent(missed));
}

std::string lost_energy(const RunResult& run) {
  if (run.status == RunStatus::failed || !(run.energy_lost > accepted_energy_loss * run.energy_scale)) return "";
  return fmt::format("the time scheme lost {} of the energy that was put in: the step does not resolve the motion, take a smaller one",
                     percent(run.energy_lost / run.energy_scale));
}

}  // namespace

std::vector<std::string> result_warnings(const RunResult& run, const VerdictNumbers& numbers) {
  std::vector<std::string> said;
  for (std::string text :
       {run.not_unique, run.equilibrium.warning(), lost_energy(run), late_peaks(run, numbers), missed_peaks(run, numbers)})
    if (!text.empty()) said.push_back(std::move(text));
  return said;
}

}  // namespace uplift
