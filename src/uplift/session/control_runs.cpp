#include "uplift/session/control_runs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <random>
#include <span>
#include <utility>

#include "uplift/case/schema/case_input.h"
#include "uplift/run/lockstep.h"
#include "uplift/session/steps.h"

namespace uplift {

namespace {

/// What is drawn for a pair of runs.
struct DrawnMotion {
  RunSpec spec;
  double scale = 1;
};

/// One run for the control of another: its openings over time and its floor spectra.
struct ControlRun {
  RunResult result;
  std::vector<Vector> openings;  // of all rows, at the beginning and after every step
  std::vector<char> normal;      // whether a row is an opening, not a slip
  std::vector<FloorSpectra> floors;
};

/// The motions of a case times a factor.
void scale_motions(Model& model, double factor) {
  for (TimeLoad& load : model.time_loads)
    if (!load.constant && !load.dead) load.shape *= factor;
  for (TimeLoadTable& table : model.time_load_tables) table.pattern *= factor;
  for (PrescribedMotion& motion : model.motions) motion.shape *= factor, motion.opening *= factor;
  for (GroundAcceleration& ground : model.grounds) ground.direction *= factor;
}

/// Makes the pairs of runs.
class ControlRuns {
 public:
  ControlRuns(const LoadedCase& loaded, const ReducedModel& reduced, const Control& control)
      : loaded_(loaded), reduced_(reduced), control_(control) {}

  /// How many whole runs are best made together.
  std::size_t together() const { return reduced_.vectors.rows() >= large_model ? most_in_lockstep : 1; }

  std::vector<ControlRun> whole(std::span<const DrawnMotion> group, const std::string& label) const {
    const Watch watch = watch_of(label);
    std::deque<BuiltCase> built;
    std::vector<ControlRun> made(group.size());
    std::vector<LockstepRun> runs;
    for (std::size_t k = 0; k < group.size(); ++k) {
      const BuiltCase& each = built.emplace_back(build(group[k]));
      const bool shares = k > 0 && share_matrices(built.back().model, built.front().model);
      mark_openings(each, made[k]);
      runs.push_back({.model = &each.model,
                      .plan = &each.plan,
                      .behaviours = &each.behaviours,
                      .matrices = shares ? &built.front().model : nullptr,
                      .watch = watch,
                      .observe = keeps_openings(made[k])});
    }
    std::vector<RunResult> results;
    if (group.size() > 1)
      results = run_in_lockstep(runs);
    else
      results.push_back(run(built.front().model, built.front().plan, built.front().behaviours, watch, runs.front().observe));
    for (std::size_t k = 0; k < group.size(); ++k) {
      made[k].result = std::move(results[k]);
      made[k].floors = floor_spectra(built[k].plan, made[k].result);
    }
    return made;
  }

  /// The static stages and the projected matrices are made once for all motions.
  ControlRun reduced(const DrawnMotion& one, const std::string& label) {
    BuiltCase built = build(one);
    ControlRun made;
    mark_openings(built, made);
    const Watch watch = watch_of(label);
    const std::optional<RunState> begin = begin_reduced(reduced_, {}, built, watch, made.result, &shared_);
    if (!begin) return made;
    Keeping keeping;
    keeping.from = &*begin;
    made.result = run(built.model, built.plan, built.behaviours, watch, keeps_openings(made), &keeping);
    if (shared_) shared_->swap_matrices(built.model);
    made.floors = floor_spectra(built.plan, made.result);
    return made;
  }

 private:
  BuiltCase build(const DrawnMotion& one) const {
    BuiltCase built = build_run(loaded_, one.spec);
    built.plan.frames = 0;
    scale_motions(built.model, one.scale);
    return built;
  }

  Watch watch_of(const std::string& label) const {
    if (control_.watch) return control_.watch(label);
    return control_.stopped ? Watch([this](const Progress&) { return !control_.stopped(); }) : Watch();
  }

  static void mark_openings(const BuiltCase& built, ControlRun& made) {
    for (const Interface& interface : built.model.interfaces)
      for (int row = 0; row < interface.rows(); ++row) made.normal.push_back(row >= interface.batch.normal());
  }

  static Observe keeps_openings(ControlRun& made) {
    return [&made](const Snapshot& at) {
      if (at.stepper != nullptr) made.openings.push_back(at.state.opening);
    };
  }

  const LoadedCase& loaded_;
  const ReducedModel& reduced_;
  const Control& control_;
  std::optional<ReducedStart> shared_;
};

/// Sizes are compared: where both signs reach nearly the same value, either may be the larger one.
void take(double& most, double full, double reduced) {
  if (full != 0) most = std::max(most, std::abs(std::abs(reduced) - std::abs(full)) / std::abs(full));
}

/// Openings over time, or slips.
void take_history(double& most, const ControlRun& full, const ControlRun& reduced, bool normal) {
  double difference = 0, size = 0;
  for (std::size_t i = 0; i < std::min(full.openings.size(), reduced.openings.size()); ++i)
    for (Index row = 0; row < full.openings[i].size(); ++row) {
      if ((full.normal[static_cast<std::size_t>(row)] != 0) != normal) continue;
      const double whole = full.openings[i][row];
      difference += std::pow(whole - reduced.openings[i][row], 2);
      size += std::pow(whole - full.openings.front()[row], 2);
    }
  if (size > 0) most = std::max(most, std::sqrt(difference / size));
}

void take_floors(const ControlRun& full, const ControlRun& reduced, double highest, ControlErrors& errors) {
  for (std::size_t k = 0; k < std::min(full.floors.size(), reduced.floors.size()); ++k) {
    const FloorSpectra &one = full.floors[k], &other = reduced.floors[k];
    const bool broadened = !one.broadened.empty();
    const std::vector<Spectrum>&spectra = broadened ? one.broadened : one.raw, &others = broadened ? other.broadened : other.raw;
    for (std::size_t d = 0; d < spectra.size(); ++d)
      for (std::size_t i = 0; i < spectra[d].values.size(); ++i)
        if (const double frequency = spectra[d].frequencies[i]; frequency <= highest)
          take(errors.floor_spectrum, spectra[d].values[i], value_at(others[d], frequency));
  }
}

void take(const ControlRun& full, const ControlRun& reduced, double highest, ControlErrors& errors) {
  ++errors.runs;
  if (full.result.status != reduced.result.status) {
    ++errors.different;
    return;
  }
  take(errors.opening, full.result.max_opening.value, reduced.result.max_opening.value);
  take(errors.moment, full.result.max_base_moment.value, reduced.result.max_base_moment.value);
  take_history(errors.history, full, reduced, true);
  take_history(errors.slip, full, reduced, false);
  take_floors(full, reduced, highest, errors);
}

std::vector<DrawnMotion> draw_motions(const LoadedCase& loaded, const ReduceOptions& options, ControlErrors& errors) {
  RunSpec own = runs_of_case(loaded.read).front();
  own.pictures = false;
  std::vector<const CaseOtherMotion*> motions{nullptr};
  if (const std::optional<CaseComparison>& compare = loaded.read.input->compare)
    for (const CaseOtherMotion& motion : compare->motions) motions.push_back(&motion);
  errors.least_scale = options.least_scale, errors.most_scale = options.most_scale;
  errors.motions = motions.size() == 1 ? "the motion of the case" : fmt::format("one of the {} motions of the case", motions.size());
  errors.motions += " with either sign";
  std::mt19937_64 random(options.seed);
  const auto share = [&] { return static_cast<double>(random() >> 11U) * 0x1p-53; };
  std::vector<DrawnMotion> drawn(static_cast<std::size_t>(options.controls), DrawnMotion{own});
  for (DrawnMotion& one : drawn) {
    one.spec.motion = motions[static_cast<std::size_t>(share() * static_cast<double>(motions.size()))];
    one.scale = (share() < 0.5 ? -1 : 1) * (options.least_scale + (options.most_scale - options.least_scale) * share());
  }
  return drawn;
}

}  // namespace

ControlErrors control_errors(const LoadedCase& loaded, const ReducedModel& reduced, const ReduceOptions& options, const Control& control) {
  ControlErrors errors;
  const std::vector<DrawnMotion> drawn = draw_motions(loaded, options, errors);
  ControlRuns runs(loaded, reduced, control);
  const std::size_t most = runs.together();
  for (std::size_t first = 0; first < drawn.size();) {
    const std::size_t count = std::min(most, drawn.size() - first);
    const std::string of = fmt::format(" of {}", drawn.size());
    const std::string label =
        count == 1 ? fmt::format("control run {}", first + 1) : fmt::format("control runs {} to {}", first + 1, first + count);
    const std::vector<ControlRun> whole = runs.whole(std::span(drawn).subspan(first, count), label + of);
    for (const ControlRun& full : whole) {
      if (control.is_stopped()) return errors;
      const ControlRun other = runs.reduced(drawn[first], fmt::format("control run {}{}, reduced", first + 1, of));
      if (control.is_stopped()) return errors;
      take(full, other, reduced.frequency, errors);
      ++first;
    }
  }
  return errors;
}

}  // namespace uplift
