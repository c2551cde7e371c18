#include "uplift/study/trust.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <map>
#include <mutex>
#include <numeric>
#include <thread>

#include "uplift/base/file.h"
#include "uplift/base/format.h"
#include "uplift/case/advice/content.h"
#include "uplift/case/schema/case_input.h"
#include "uplift/study/study_case.h"

namespace uplift {
namespace {

constexpr double steps_per_period = 10;

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

RunStatus status_of(StudyOutcome outcome) {
  switch (outcome) {
    case StudyOutcome::completed:
      return RunStatus::completed;
    case StudyOutcome::overturned:
      return RunStatus::overturned;
    case StudyOutcome::separated:
      return RunStatus::separated;
    default:
      return RunStatus::failed;
  }
}

/// Of a sample; without a result it was interrupted.
TrustRun run_of(const TrustChange& change, const std::optional<StudyResult>& result) {
  if (!result) return {change.name, change.choice, change.label, RunStatus::interrupted, RunStatus::interrupted, "interrupted", 0};
  return {
      change.name,    change.choice, change.label, status_of(result->outcome), status_of(result->bonded.value_or(StudyOutcome::completed)),
      result->reason, result->wall};
}

/// The case as it stands, with what is kept of its repetitions: those that count.
struct Repeated {
  VerdictNumbers numbers;
  std::vector<FloorSpectra> floors;
  struct Repetition {
    const TrustChange* change = nullptr;
    const StudyResult* result = nullptr;  // null: it does not count
  };
  std::vector<Repetition> repetitions;
};

// ---- numbers ----

/// The number of this quantity of a repetition, of one interface or of the run.
std::optional<double> number_in(const StudyResult* result, const VerdictQuantity& quantity, const std::string& interface) {
  if (result == nullptr) return std::nullopt;
  for (const StudyNumber& number : result->numbers)
    if (number.quantity == quantity.name && number.of == interface) return number.value;
  return std::nullopt;
}

TrustBand band_of(const VerdictNumber& number, const std::string& interface, const Repeated& all) {
  TrustBand band{number.quantity, interface, number.value, number.value, number.value, number.swing.value_or(0), {}, {}};
  double largest = 0;
  for (const auto& [change, result] : all.repetitions) {
    const std::optional<double> value = number_in(result, *number.quantity, interface);
    band.values.push_back(value);
    if (!value) continue;
    band.least = std::min(band.least, *value);
    band.most = std::max(band.most, *value);
    const double moved = std::abs(*value - number.value);
    if (moved > largest) {
      largest = moved;
      band.dominant = change->choice;
    }
  }
  if (std::max(std::abs(band.least), std::abs(band.most)) < nothing_beside(number.quantity->unit)) band.dominant.clear();
  return band;
}

std::vector<TrustBand> bands_of(const Repeated& all) {
  std::vector<TrustBand> bands;
  const auto take = [&](const std::vector<VerdictNumber>& numbers, const std::string& interface) {
    for (const VerdictNumber& number : numbers)
      if (std::isfinite(number.value)) bands.push_back(band_of(number, interface, all));
  };
  take(all.numbers.whole, "");
  for (const InterfaceVerdict& each : all.numbers.interfaces) take(each.numbers, each.name);
  for (const BeamVerdict& each : all.numbers.beams) take(each.numbers, each.name);
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

/// A raw spectrum of a repetition: results keep those of all floors, and of each floor for all dampings.
Spectrum spectrum_in(const StudyResult& result, const std::string& floor, double damping) {
  const auto found =
      std::ranges::find_if(result.spectra, [&](const StudySpectrum& each) { return each.floor == floor && each.damping == damping; });
  if (found == result.spectra.end()) return {};
  return {Spectrum::Kind::psa, damping, found->frequencies, found->values};
}

/// (T2) for every choice, and the resolutions below the last frequency.
void add_reaches(const Spectrum& raw, const std::vector<std::pair<std::string, Spectrum>>& others, double accepted,
                 const std::vector<Reach>& bounds, TrustSpectrum& made) {
  for (const auto& [choice, other] : others) {
    const double to = reach_of(raw, other, accepted);
    const auto same = std::ranges::find(made.reaches, choice, &Reach::choice);
    if (same == made.reaches.end())
      made.reaches.push_back({choice, to});
    else
      same->to = std::min(same->to, to);
  }
  for (const Reach& bound : bounds) made.reaches.push_back({bound.choice, std::min(bound.to, raw.frequencies.back())});
  std::ranges::stable_sort(made.reaches, {}, &Reach::to);
  made.speaks_to = made.reaches.empty() ? raw.frequencies.back() : made.reaches.front().to;
  if (made.speaks_to < raw.frequencies.back()) made.limited_by = made.reaches.front().choice;
}

TrustSpectrum spectrum_of(const FloorSpectra& base, std::size_t damping, const Repeated& all, double accepted,
                          const std::vector<Reach>& bounds) {
  const Spectrum& raw = base.raw[damping];
  std::vector<std::pair<std::string, Spectrum>> others;  // with their choices
  for (const auto& [change, result] : all.repetitions)
    if (result != nullptr) others.emplace_back(change->choice, spectrum_in(*result, base.name, raw.damping));
  TrustSpectrum made{base.name, raw.damping, raw.frequencies, raw.values, raw.values, raw.values, 0, {}, {}, {}, 0};
  for (const auto& [choice, other] : others)
    for (std::size_t f = 0; f < raw.frequencies.size(); ++f) {
      const double value = value_at(other, raw.frequencies[f]);
      made.least[f] = std::min(made.least[f], value);
      made.most[f] = std::max(made.most[f], value);
    }
  add_reaches(raw, others, accepted, bounds, made);
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

TrustSamples trust_samples(const Raw& raw, const Case& read, const MeshReader& read_mesh) {
  TrustPlan plan = trust_plan(read);
  TrustSamples made;
  for (TrustChange& change : plan.changes) {
    const bool same_mesh = std::ranges::none_of(change.edits, [](const CaseEdit& edit) { return changes_mesh(edit.path); });
    try {
      const Raw changed = edited(raw, change.edits);
      Case own = check_case_like(read, same_mesh, changed, read_mesh);
      const std::string id = sha256("trust " UPLIFT_VERSION "\n" + identity_of_case(changed, own));
      made.samples.push_back({std::move(change), std::move(own), id});
    } catch (const InputError& error) {  // of the changed case: the case itself was read
      plan.left_out.push_back({change.choice + ", " + change.label, error.what()});
    }
  }
  made.left_out = std::move(plan.left_out);
  return made;
}

StudyResult compute_sample(const TrustSample& sample, const Watch& watch, std::string& problem) {
  std::vector<RunSpec> specs = runs_of_case(sample.read);
  for (RunSpec& spec : specs) spec.pictures = false;
  const double each = 1.0 / static_cast<double>(specs.size());
  const auto one = [&](std::size_t k, const BuiltCase& built) {
    return run(built.model, built.plan, built.behaviours, [&](Progress now) {
      now.fraction = each * (static_cast<double>(k) + now.fraction);
      return !watch || watch(now);
    });
  };
  const BuiltCase built = build(sample.read, specs.front());
  const RunResult result = one(0, built);
  std::optional<RunResult> bonded;
  if (specs.size() > 1) bonded = one(1, build(sample.read, specs[1]));
  problem = result.problem;
  StudyResult made = result_of(built, result, true, bonded ? &*bonded : nullptr);
  made.id = sample.id;
  return made;
}

TrustResults compute_samples(const TrustSamples& samples, int threads, const Watch& watch) {
  const std::size_t count = samples.samples.size();
  Watcher watcher(count, watch);
  TrustResults made(count);
  std::vector<std::exception_ptr> errors(count);
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    for (std::size_t i = next++; i < count && !watcher.stopped(); i = next++) try {
        std::string problem;
        StudyResult result = compute_sample(
            samples.samples[i], [&](const Progress& now) { return watcher.tell(i, now.fraction, now); }, problem);
        const auto interrupted = [](std::optional<StudyOutcome> outcome) { return outcome == StudyOutcome::timeout; };
        if (!interrupted(result.outcome) && !interrupted(result.bonded)) made[i] = std::move(result);
      } catch (...) {
        errors[i] = std::current_exception();
      }
  };
  {
    std::vector<std::jthread> helpers;
    for (int k = 1; k < threads && static_cast<std::size_t>(k) < count; ++k) helpers.emplace_back(work);
    work();
  }
  for (const std::exception_ptr& error : errors)
    if (error) std::rethrow_exception(error);
  return made;
}

TrustAnswer trust_answer(const Case& read, const TrustSamples& samples, const TrustResults& results, const TrustBase& base) {
  TrustAnswer made;
  made.base = {"base",
               "",
               "as in the case",
               base.run.status,
               base.bonded ? base.bonded->status : RunStatus::completed,
               base.run.reason,
               base.run.wall + (base.bonded ? base.bonded->wall : 0)};
  Repeated all;
  for (std::size_t i = 0; i < results.size(); ++i) {
    const TrustChange& change = samples.samples[i].change;
    made.runs.push_back(run_of(change, results[i]));
    all.repetitions.push_back({&change, made.runs.back().counts() ? &*results[i] : nullptr});
    if (change.choice == joint_stiffness) made.interior = read.input->trust.interior;
  }
  made.left_out = samples.left_out;
  made.accepted = read.input->trust.spectrum_band;
  made.complete = std::ranges::all_of(results, [](const auto& each) { return each.has_value(); });
  if (!made.base.counts() || made.counted() == 0) return made;
  all.numbers = numbers_of(base.built, base.run, base.bonded);
  all.floors = floor_spectra(base.built.plan, base.run);
  made.bands = bands_of(all);
  const std::vector<Reach> bounds = resolutions(read, base.built.plan);
  for (const FloorSpectra& floor : all.floors)
    for (std::size_t damping = 0; damping < floor.raw.size(); ++damping)
      made.spectra.push_back(spectrum_of(floor, damping, all, made.accepted, bounds));
  made.dominant = most_frequent(made.bands);
  return made;
}

}  // namespace uplift
