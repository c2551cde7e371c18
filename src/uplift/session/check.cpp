#include "uplift/session/check.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <numbers>

#include "uplift/base/format.h"
#include "uplift/base/text.h"
#include "uplift/case/advice/content.h"
#include "uplift/case/mesh/mesh.h"
#include "uplift/elements/element_entry.h"
#include "uplift/linear/memory.h"
#include "uplift/model/builder.h"
#include "uplift/run/floor_record.h"
#include "uplift/session/steps.h"

namespace uplift {
namespace {

constexpr int little_to_foresee = 3000, quick_modes = 30'000;  // unknowns: nothing to foresee below; only the bonded modes beyond
constexpr int most_to_try = 200'000;  // unknowns of distributed matrices: their static stages and compliance take minutes
constexpr double trial_seconds = 5;

/// Quality and resolution of the groups that have a material.
void look_at_mesh(const Case& read, CaseFindings& found) {
  if (!read.mesh) return;
  const CaseSolids materials(*read.input, *read.mesh);
  const std::vector<GroupQuality> qualities = quality_by_group(read.mesh->mesh);
  for (const CaseSolids::Solid& solid : materials.solids())
    for (const GroupQuality& quality : qualities) {
      if (quality.name != solid.group()) continue;
      const double speed = solid.section.material.density > 0 ? solid.section.material.s_wave_speed() : 0;
      found.solids.push_back({quality, speed, speed > 0 ? highest_frequency(quality, speed, nodes_per_wavelength) : 0});
    }
  for (const CaseElement& beam : read.input->elements_at(ElementPlace::lines))
    for (const GroupQuality& quality : qualities)
      if (beam.group && quality.name == beam.group->name) found.beams.push_back(quality);
  found.pieces = connected_pieces(read.mesh->mesh).count();
}

std::vector<double> frequencies(const std::vector<Mode>& found) {
  std::vector<double> values;
  for (const Mode& mode : found) values.push_back(mode.frequency);
  return values;
}

/// Modes of a model and how they are damped outside the joints.
std::vector<ResolvedMode> damped(const Model& model, const std::vector<Mode>& modes) {
  std::vector<ResolvedMode> made;
  for (const Mode& mode : modes) {
    const double omega = 2 * std::numbers::pi * mode.frequency;
    double twice = 0;  // 2 zeta
    if (omega > 0 && model.distributed == nullptr && model.damping.rows() == mode.shape.size())
      twice = mode.shape.dot(model.damping * mode.shape) / omega;
    else if (omega > 0)
      twice = model.assembly.mass_damping / omega + model.assembly.stiffness_damping * omega;
    made.push_back({mode.frequency, std::max(0.0, twice / 2)});
  }
  return made;
}

/// What the step has to resolve. In a small model all bonded modes are looked at: that in which a footing bounces on a stiff joint is far
/// from the lowest. Modes of next to no mass, as of ground under single points, do not matter.
ResolvedModes resolved_modes(const Model& model, const std::vector<Mode>& bonded, const std::vector<Mode>& base_free) {
  constexpr int small = 300, lowest_elastic = 5, most_rigid = 6;  // unknowns, modes
  constexpr double least_share = 0.05;                            // of the mass, in any direction
  const auto lowest = [](const std::vector<ResolvedMode>& modes) {
    ResolvedMode found;
    for (const ResolvedMode& mode : modes)
      if (mode.frequency > 0 && (found.frequency == 0 || mode.frequency < found.frequency)) found = mode;
    return found;
  };
  ResolvedModes made{damped(model, bonded), damped(model, base_free), {}, {}};
  made.lowest = lowest(made.bonded);
  if (model.free() > small) return made;
  const Sparse mass = assembled(model, &Local::mass);
  const std::vector<Mode> all = bonded_modes(model, model.free());
  const std::vector<ResolvedMode> all_damped = damped(model, all);
  std::array<double, 3> largest{};  // share along an axis
  std::array<ResolvedMode, 3> main;
  for (std::size_t k = 0; k < all.size(); ++k) {
    const Vector shape = model.expand(all[k].shape);
    double most = 0;
    for (int axis = 0; axis < model.space.dimension; ++axis) {
      const auto along = static_cast<std::size_t>(axis);
      const double share = mass_share(model, mass, shape, model.space.dof(axis));
      if (share > largest[along]) largest[along] = share, main[along] = all_damped[k];
      most = std::max(most, share);
    }
    if (most >= least_share) made.moving.push_back(all_damped[k]);
  }
  if (!made.moving.empty()) made.lowest = lowest(made.moving);
  for (std::size_t axis = 0; axis < main.size(); ++axis)  // what sways along one axis may have dashpots that another lacks
    if (static_cast<int>(axis) != model.space.up() && largest[axis] >= least_share)
      made.lowest.damping = std::min(made.lowest.damping, main[axis].damping);
  made.bonded.insert(made.bonded.end(), made.moving.begin(), made.moving.end());
  made.base_free = damped(model, base_free_modes(model, lowest_elastic + most_rigid));
  std::erase_if(made.base_free, [](const ResolvedMode& mode) { return !(mode.frequency > 0); });
  made.base_free.resize(std::min<std::size_t>(made.base_free.size(), lowest_elastic));
  return made;
}

/// The first steps of the run: do the static stages converge, and what does a step cost?
void try_steps(CaseFindings& found, const BuiltCase& built) {
  RunPlan plan = built.plan;
  plan.frames = 0;
  for (Stage& stage : plan.stages)
    if (stage.type == Stage::Type::dynamics) stage.duration = std::min(stage.duration, 200 * stage.step);
  const auto start = std::chrono::steady_clock::now();
  const Watch enough = [&](const Progress&) {
    return std::chrono::steady_clock::now() - start < std::chrono::duration<double>(trial_seconds);
  };
  const RunResult trial = uplift::run(built.model, plan, built.behaviours, enough);
  if (trial.status == RunStatus::failed && trial.counts.steps < 200) found.trial_failure = trial.reason;
  found.seconds_per_step = trial.step_seconds;
  found.systems = trial.counts.systems;
}

/// Pictures that a run keeps at most: at the beginning, at regular steps and at the largest uplift of each stage.
double pictures(const RunPlan& plan) {
  double count = 0;
  for (const Stage& stage : plan.stages) {
    if (plan.frames == 0) break;
    const long steps = stage.type == Stage::Type::dynamics ? std::max(1L, std::lround(stage.duration / stage.step)) : 1;
    count += 2 + static_cast<double>(steps / std::max(1L, steps / plan.frames));
  }
  return count;
}

/// What the pictures of all runs of `uplift run` take until the report is written.
double pictures_bytes(const Case& read, const BuiltCase& built) {
  const std::vector<int>& pictured = built.plan.pictured;
  double numbers = pictured.empty() ? built.model.full_unknowns() : built.model.space.unknowns() * static_cast<double>(pictured.size());
  for (const Interface& interface : built.model.interfaces) numbers += 2 * interface.rows();
  return 8 * numbers * pictures(built.plan) * static_cast<double>(runs_of_case(read).size());
}

/// `uplift run` keeps the histories of all its runs until they are written; those with twice the step have half of them.
std::string history_warning(const Case& read, const HistoryForecast& one) {
  constexpr double small = 1e8;  // bytes
  const double all =
      one.memory * (static_cast<double>(runs_of_case(read).size()) + 0.5 * static_cast<double>(companions_of_case(read).size()));
  const double available = all > small ? available_memory() : all;
  if (all <= available) return {};
  return fmt::format(
      "the histories of all runs together take {} of memory, {} are available: take a larger step or `every`, or leave runs out",
      format_bytes(all), format_bytes(available));
}

CaseFindings find(const Case& read, const RunSpec& spec, const BuiltCase& built) {
  CaseFindings found;
  look_at_mesh(read, found);
  found.fields = field_forecast(read, built);
  found.record_bytes = floor_record_bytes(built.plan);
  found.histories = forecast_histories(built.plan, built.model.interfaces.size());
  const int unknowns = built.model.free();
  if (unknowns > little_to_foresee) {
    BulkUse use;
    use.impacts = built.plan.method->constrains();
    use.propagates = use.impacts && (built.plan.impact->needs_dynamic() ||
                                     (built.plan.impact->holds_acceleration() && built.model.damping.nonZeros() > 0));
    const Stage* stage = dynamic_stage(built.plan);
    const bool balanced = stage != nullptr && stage->path_average && !use.impacts;
    if (stage != nullptr) {
      const StepWeights weights = weights_of(stage->scheme, stage->step);
      use.damping = weights.damping, use.mass = weights.mass;
    }
    use.keeps_mass = use.impacts || (balanced && (records_accelerations(built.plan) || found.fields));
    use.statics = std::ranges::any_of(built.plan.stages, [](const Stage& each) { return each.type == Stage::Type::statics; });
    use.record_bytes = found.record_bytes + pictures_bytes(read, built);
    found.bulk = predict_bulk(built.model, *built.plan.solver, use);
    if (!found.bulk->refusal.empty()) {
      found.trial_failure = found.bulk->refusal;
      return found;
    }
  }
  // modes need whole matrices and a factor on one process: of a large model whose matrices are distributed they are left out
  std::vector<Mode> bonded, base_free;
  if (built.model.distributed == nullptr || unknowns <= quick_modes) bonded = bonded_modes(built.at_rest(), 5);
  if (unknowns <= quick_modes) {
    found.fixed = frequencies(fixed_base_modes(built.at_rest(), 3));
    base_free = base_free_modes(built.at_rest(), 5);
  }
  found.bonded = frequencies(bonded), found.base_free = frequencies(base_free);
  for (const Stage& stage : built.plan.stages)
    if (stage.type == Stage::Type::dynamics) found.steps += std::lround(stage.duration / stage.step);
  const bool tries = built.model.distributed == nullptr || unknowns <= most_to_try;
  if (const Stage* stage = dynamic_stage(built.plan); stage != nullptr && tries)
    found.ratios = stiffness_ratios(built.model, *stage, *built.plan.solver);
  if (dynamic_stage(built.plan)) found.bounds = step_bounds(read, built, resolved_modes(built.at_rest(), bonded, base_free));
  if (!found.bounds.empty()) found.suggested_step = rounded_down(found.bounds.front().step);
  if (tries) try_steps(found, built);
  found.warnings = warnings(read, spec, built);
  if (std::string warning = history_warning(read, found.histories); !warning.empty()) found.warnings.push_back(std::move(warning));
  if (!tries)
    found.warnings.push_back(
        fmt::format("the first steps are not tried with more than {} unknowns on several processes: whether static stages "
                    "converge and what a step costs is not known",
                    most_to_try));
  return found;
}

}  // namespace

CheckedCase examine(const LoadedCase& loaded) {
  const std::vector<RunSpec> own = runs_of_case(loaded.read);
  CheckedCase checked{build_run(loaded, own.front()), {}, {}};
  for (const RunSpec& spec : own) checked.runs.push_back("uplift run: " + spec.label);
  if (compares(loaded.read)) {
    const Comparison comparison = comparison_of_case(loaded.read);
    for (const RunSpec& spec : comparison.runs) {
      build_run(*case_of(loaded, spec), spec);  // every variant is checked too
      checked.runs.push_back(fmt::format("uplift compare: {}{}", spec.label, spec.group.empty() ? "" : ", " + spec.group));
    }
    for (const RunSpec& spec : comparison.sweep) build_run(loaded, spec);
    if (!comparison.sweep.empty()) checked.runs.push_back(fmt::format("uplift compare: stiffness sweep, {} runs", comparison.sweep.size()));
  }
  checked.found = find(loaded.read, own.front(), checked.built);
  return checked;
}

}  // namespace uplift
