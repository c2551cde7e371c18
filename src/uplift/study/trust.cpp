#include "uplift/study/trust.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <map>
#include <mutex>
#include <numeric>
#include <thread>

#include "uplift/base/format.h"
#include "uplift/case/advice/content.h"

namespace uplift {
namespace {

constexpr double steps_per_period = 10;

/// What is kept of a repetition: numbers and spectra, not its model.
struct Repetition {
  TrustRun run;
  VerdictNumbers numbers;
  std::vector<FloorSpectra> floors;
};

/// Share of the work that is done, over all runs.
class Watcher {
 public:
  Watcher(std::size_t runs, const Watch& watch) : shares_(runs, 0.0), watch_(watch) {}
  bool tell(std::size_t run, double share, Progress progress) {
    const std::lock_guard lock(mutex_);
    shares_[run] = share;
    progress.fraction = std::accumulate(shares_.begin(), shares_.end(), 0.0) / static_cast<double>(shares_.size());
    if (going_ && watch_) going_ = watch_(progress);
    return going_;
  }
  bool stopped() {
    const std::lock_guard lock(mutex_);
    return !going_;
  }

 private:
  std::vector<double> shares_;
  const Watch& watch_;
  std::mutex mutex_;
  bool going_ = true;
};

Repetition repetition_of(const TrustChange& change, const BuiltCase& built, const RunResult& result, const RunResult* bonded) {
  Repetition made;
  made.run = {change.name,
              change.choice,
              change.label,
              result.status,
              bonded ? bonded->status : RunStatus::completed,
              result.reason,
              result.wall + (bonded ? bonded->wall : 0)};
  if (!made.run.counts()) return made;
  made.numbers = numbers_of(built, result, bonded);
  made.floors = floor_spectra(built.plan, result);
  return made;
}

/// Runs a case, and its bonded run where it has one.
Repetition compute(const Case& read, const TrustChange& change, std::size_t place, Watcher& watcher) {
  std::vector<RunSpec> specs = runs_of_case(read);
  for (RunSpec& spec : specs) spec.pictures = false;
  if (watcher.stopped()) {
    Repetition left_out;
    left_out.run.name = change.name;
    left_out.run.choice = change.choice;
    left_out.run.label = change.label;
    left_out.run.status = left_out.run.bonded_status = RunStatus::interrupted;
    left_out.run.reason = "interrupted before it began";
    return left_out;
  }
  const double each = 1.0 / static_cast<double>(specs.size());
  const auto one = [&](std::size_t k, const BuiltCase& built) {
    return run(built.model, built.plan, built.behaviours,
               [&](const Progress& now) { return watcher.tell(place, each * (static_cast<double>(k) + now.fraction), now); });
  };
  const BuiltCase built = build(read, specs.front());
  const RunResult result = one(0, built);
  std::optional<RunResult> bonded;
  if (specs.size() > 1) bonded = one(1, build(read, specs[1]));
  return repetition_of(change, built, result, bonded ? &*bonded : nullptr);
}

/// All repetitions, `threads` at a time. What one of them throws is thrown here, the first of the list first.
std::vector<Repetition> compute_all(const std::vector<Case>& cases, const std::vector<TrustChange>& changes, int threads,
                                    Watcher& watcher) {
  std::vector<Repetition> made(cases.size());
  std::vector<std::exception_ptr> errors(cases.size());
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    for (std::size_t i = next++; i < cases.size(); i = next++) try {
        made[i] = compute(cases[i], changes[i], i, watcher);
      } catch (...) {
        errors[i] = std::current_exception();
      }
  };
  {
    std::vector<std::jthread> helpers;
    for (int k = 1; k < threads && static_cast<std::size_t>(k) < cases.size(); ++k) helpers.emplace_back(work);
    work();
  }
  for (const std::exception_ptr& error : errors)
    if (error) std::rethrow_exception(error);
  return made;
}

// ---- numbers ----

/// The number of this quantity of a run, of one interface or of the run.
std::optional<double> number_in(const Repetition& outcome, const VerdictQuantity& quantity, const std::string& interface) {
  const std::vector<VerdictNumber>* numbers = interface.empty() ? &outcome.numbers.whole : nullptr;
  for (const InterfaceVerdict& each : outcome.numbers.interfaces)
    if (!interface.empty() && !quantity.of_beam && each.name == interface) numbers = &each.numbers;
  for (const BeamVerdict& each : outcome.numbers.beams)
    if (quantity.of_beam && each.name == interface) numbers = &each.numbers;
  const VerdictNumber* found = numbers && outcome.run.counts() ? find_number(*numbers, quantity.name) : nullptr;
  if (!found || !std::isfinite(found->value)) return std::nullopt;
  return found->value;
}

TrustBand band_of(const VerdictNumber& number, const std::string& interface, const std::vector<Repetition>& repetitions) {
  TrustBand band{number.quantity, interface, number.value, number.value, number.value, number.swing.value_or(0), {}, {}};
  double largest = 0;
  for (std::size_t i = 1; i < repetitions.size(); ++i) {
    const std::optional<double> value = number_in(repetitions[i], *number.quantity, interface);
    band.values.push_back(value);
    if (!value) continue;
    band.least = std::min(band.least, *value);
    band.most = std::max(band.most, *value);
    const double moved = std::abs(*value - number.value);
    if (moved > largest) {
      largest = moved;
      band.dominant = repetitions[i].run.choice;
    }
  }
  if (std::max(std::abs(band.least), std::abs(band.most)) < nothing_beside(number.quantity->unit)) band.dominant.clear();
  return band;
}

std::vector<TrustBand> bands_of(const std::vector<Repetition>& repetitions) {
  std::vector<TrustBand> bands;
  const auto take = [&](const std::vector<VerdictNumber>& numbers, const std::string& interface) {
    for (const VerdictNumber& number : numbers)
      if (std::isfinite(number.value)) bands.push_back(band_of(number, interface, repetitions));
  };
  take(repetitions.front().numbers.whole, "");
  for (const InterfaceVerdict& each : repetitions.front().numbers.interfaces) take(each.numbers, each.name);
  for (const BeamVerdict& each : repetitions.front().numbers.beams) take(each.numbers, each.name);
  return bands;
}

// ---- spectra ----

using Reach = TrustSpectrum::Reach;

/// What the model itself can carry: shear waves with ten nodes a wavelength in every group of a mesh, ten steps a period.
std::vector<Reach> resolutions(const Case& read, const RunPlan& plan) {
  std::vector<Reach> found;
  if (const MeshReach reach = lowest_reach(read); std::isfinite(reach.frequency))
    found.push_back({"size of the elements", reach.frequency});
  double step = 0;
  for (const Stage& stage : plan.stages)
    if (stage.type == Stage::Type::dynamics) step = std::max(step, stage.step);
  if (step > 0) found.push_back({"length of the step", 1 / (steps_per_period * step)});
  return found;
}

/// Up to where a repetition's spectrum keeps within the accepted share of the case's [Hz].
double reach_of(const Spectrum& raw, const Spectrum& other, double accepted) {
  double to = 0;
  for (std::size_t f = 0; f < raw.frequencies.size(); ++f) {
    if (std::abs(value_at(other, raw.frequencies[f]) - raw.values[f]) > accepted * raw.values[f]) break;
    to = raw.frequencies[f];
  }
  return to;
}

/// (T2) for every choice, and the resolutions below the last frequency.
void add_reaches(std::size_t floor, std::size_t damping, const std::vector<Repetition>& repetitions, double accepted,
                 const std::vector<Reach>& bounds, TrustSpectrum& made) {
  const Spectrum& raw = repetitions.front().floors[floor].raw[damping];
  for (std::size_t i = 1; i < repetitions.size(); ++i) {
    if (!repetitions[i].run.counts()) continue;
    const double to = reach_of(raw, repetitions[i].floors[floor].raw[damping], accepted);
    const auto same = std::ranges::find(made.reaches, repetitions[i].run.choice, &Reach::choice);
    if (same == made.reaches.end())
      made.reaches.push_back({repetitions[i].run.choice, to});
    else
      same->to = std::min(same->to, to);
  }
  for (const Reach& bound : bounds) made.reaches.push_back({bound.choice, std::min(bound.to, raw.frequencies.back())});
  std::ranges::stable_sort(made.reaches, {}, &Reach::to);
  made.speaks_to = made.reaches.empty() ? raw.frequencies.back() : made.reaches.front().to;
  if (made.speaks_to < raw.frequencies.back()) made.limited_by = made.reaches.front().choice;
}

TrustSpectrum spectrum_of(std::size_t floor, std::size_t damping, const std::vector<Repetition>& repetitions, double accepted,
                          const std::vector<Reach>& bounds) {
  const FloorSpectra& base = repetitions.front().floors[floor];
  const Spectrum& raw = base.raw[damping];
  TrustSpectrum made{base.name, raw.damping, raw.frequencies, raw.values, raw.values, raw.values, 0, {}, {}, {}, 0};
  for (std::size_t i = 1; i < repetitions.size(); ++i) {
    if (!repetitions[i].run.counts()) continue;
    for (std::size_t f = 0; f < raw.frequencies.size(); ++f) {
      const double value = value_at(repetitions[i].floors[floor].raw[damping], raw.frequencies[f]);
      made.least[f] = std::min(made.least[f], value);
      made.most[f] = std::max(made.most[f], value);
    }
  }
  add_reaches(floor, damping, repetitions, accepted, bounds, made);
  if (base.broadened.empty()) return made;
  made.above_broadened = 0;
  for (std::size_t f = 0; f < raw.frequencies.size(); ++f) {
    const double above = made.most[f] / value_at(base.broadened[damping], raw.frequencies[f]) - 1;
    if (above > *made.above_broadened) made.above_broadened = above, made.above_at = raw.frequencies[f];
  }
  return made;
}

/// The choice that is dominant for most numbers.
std::string most_frequent(const std::vector<TrustBand>& bands) {
  std::map<std::string, int> count;
  for (const TrustBand& band : bands)
    if (!band.dominant.empty()) ++count[band.dominant];
  std::string found;
  for (const auto& [choice, times] : count)
    if (found.empty() || times > count[found]) found = choice;
  return found;
}

bool changes_mesh(std::string_view path) {
  return path.starts_with("mesh") || path.ends_with(".cut.mesh_shift");
}

}  // namespace

std::optional<double> TrustBand::share() const {
  if (value == 0 || dominant.empty() || near_zero(*quantity)) return std::nullopt;
  return 0.5 * (most - least) / std::abs(value);
}

std::string TrustBand::format_value(double number) const {
  const bool moves = !is_share(*quantity) && swing >= nothing_beside(quantity->unit) && swing > 0;
  return moves ? format_quantity_within(number, swing, quantity->unit) : uplift::format_value(*quantity, number);
}

std::size_t TrustAnswer::counted() const {
  return static_cast<std::size_t>(std::ranges::count_if(runs, &TrustRun::counts));
}

TrustAnswer trust(const Raw& raw, const Case& read, const MeshReader& read_mesh, const TrustBase& base, int threads, const Watch& watch) {
  TrustPlan plan = trust_plan(read);
  std::vector<Case> cases;
  std::vector<TrustChange> changes;
  for (TrustChange& change : plan.changes) {
    const bool same_mesh = std::ranges::none_of(change.edits, [](const CaseEdit& edit) { return changes_mesh(edit.path); });
    try {
      cases.push_back(check_case_like(read, same_mesh, edited(raw, change.edits), read_mesh));
      changes.push_back(std::move(change));
    } catch (const InputError& error) {  // of the changed case: the case itself was read
      plan.left_out.push_back({change.choice + ", " + change.label, error.what()});
    }
  }
  Watcher watcher(cases.size(), watch);
  std::vector<Repetition> repetitions = compute_all(cases, changes, threads, watcher);
  repetitions.insert(repetitions.begin(), repetition_of({"base", "", "as in the case", {}}, base.built, base.run, base.bonded));

  TrustAnswer made;
  made.base = repetitions.front().run;
  for (std::size_t i = 1; i < repetitions.size(); ++i) made.runs.push_back(repetitions[i].run);
  made.left_out = plan.left_out;
  made.accepted = read.values.table("trust").number("spectrum_band");
  made.complete = !watcher.stopped();
  if (!made.base.counts() || made.counted() == 0) return made;
  made.bands = bands_of(repetitions);
  const std::vector<Reach> bounds = resolutions(read, base.built.plan);
  for (std::size_t floor = 0; floor < repetitions.front().floors.size(); ++floor)
    for (std::size_t damping = 0; damping < repetitions.front().floors[floor].raw.size(); ++damping)
      made.spectra.push_back(spectrum_of(floor, damping, repetitions, made.accepted, bounds));
  made.dominant = most_frequent(made.bands);
  return made;
}

}  // namespace uplift
