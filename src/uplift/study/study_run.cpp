#include "uplift/study/study_run.h"

#include <cmath>

namespace uplift {
namespace {

void add(const std::vector<VerdictNumber>& numbers, const std::string& of, std::vector<StudyNumber>& all) {
  for (const VerdictNumber& number : numbers)
    if (std::isfinite(number.value)) all.push_back({std::string(number.quantity->name), of, number.value});
}

StudyOutcome outcome_of(const BuiltCase& built, const RunResult& run) {
  switch (run.status) {
    case RunStatus::completed:
      return StudyOutcome::completed;
    case RunStatus::overturned:
      return StudyOutcome::overturned;
    case RunStatus::separated:
      return StudyOutcome::separated;
    case RunStatus::interrupted:
      return StudyOutcome::timeout;
    case RunStatus::failed:
      break;
  }
  return run.energy_scale > 0 && run.energy_created > built.plan.created_limit * run.energy_scale ? StudyOutcome::energy
                                                                                                  : StudyOutcome::failed;
}

/// How far a number is beyond the limit: > 0.
double beyond(const StudyLimit& limit, double value) {
  if (limit.quantity->at_least) return limit.limit - value;
  return (limit.quantity->name.starts_with("change_of") ? value : std::abs(value)) - limit.limit;
}

}  // namespace

StudyResult result_of(const BuiltCase& built, const RunResult& run, bool spectra, const RunResult* bonded) {
  StudyResult made;
  made.outcome = outcome_of(built, run);
  made.reason = run.reason;
  if (bonded != nullptr) made.bonded = outcome_of(built, *bonded);
  const VerdictNumbers numbers = numbers_of(built, run, bonded);
  add(numbers.whole, "", made.numbers);
  for (const InterfaceVerdict& each : numbers.interfaces) add(each.numbers, each.name, made.numbers);
  for (const BeamVerdict& each : numbers.beams) add(each.numbers, each.name, made.numbers);
  if (spectra && says_something(made.outcome))
    for (const FloorSpectra& floor : floor_spectra(built.plan, run))
      for (const Spectrum& raw : floor.raw) made.spectra.push_back({floor.name, raw.damping, raw.frequencies, raw.values});
  made.end_time = run.end_time;
  made.created = run.energy_scale > 0 ? run.energy_created / run.energy_scale : 0;
  made.steps = run.counts.steps;
  made.retries = run.counts.retries;
  made.replay = !run.problem.empty();
  made.wall = run.wall + (bonded != nullptr ? bonded->wall : 0);
  return made;
}

std::optional<double> demand_of(const StudyLimit& limit, const StudyResult& run) {
  std::optional<double> worst;
  for (const StudyNumber& number : run.numbers)
    if (limit.quantity && number.quantity == limit.quantity->name && (limit.of.empty() || number.of == limit.of) &&
        (!worst || beyond(limit, number.value) > beyond(limit, *worst)))
      worst = number.value;
  return worst;
}

RunOutcome outcome_of(const StudyLimit& limit, const StudyResult& run) {
  if (run.outcome == StudyOutcome::overturned || run.outcome == StudyOutcome::separated) return RunOutcome::exceeded;
  const std::optional<double> demand = demand_of(limit, run);
  const bool exceeded = demand && beyond(limit, *demand) > 0;
  if (run.outcome == StudyOutcome::completed) return exceeded ? RunOutcome::exceeded : RunOutcome::survived;
  // what is left at the end of a run says nothing before that end
  const bool is_peak = limit.quantity && !limit.quantity->name.starts_with("residual");
  return exceeded && is_peak && run.outcome != StudyOutcome::energy ? RunOutcome::exceeded : RunOutcome::unknown;
}

}  // namespace uplift
