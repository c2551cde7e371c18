#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "uplift/base/format.h"
#include "uplift/base/text.h"
#include "uplift/case/advice/content.h"
#include "uplift/case/advice/history_forecast.h"
#include "uplift/case/advice/step_suggestion.h"
#include "uplift/case/mesh/mesh.h"
#include "uplift/cli/console.h"
#include "uplift/cli/load.h"
#include "uplift/dynamics/cost.h"
#include "uplift/io/fields/run.h"
#include "uplift/io/report/motions.h"
#include "uplift/io/results/interface_points.h"
#include "uplift/io/text/json_writer.h"
#include "uplift/linear/memory.h"
#include "uplift/mesh/quality.h"
#include "uplift/run/floor_record.h"

namespace uplift::cli {
namespace {

/// What is known of a case without running it to the end.
struct Findings {
  std::vector<double> fixed, bonded, base_free;  // Hz
  std::vector<StiffnessRatio> ratios;
  double suggested_step = 0;      // s
  std::vector<StepBound> bounds;  // of the step, the smallest first
  double seconds_per_step = 0;    // measured over the first steps
  long steps = 0;                 // of one run
  InterfaceSystems systems;       // of the first steps
  std::string trial_failure;      // why the first steps failed; empty when they did not
  std::vector<std::string> warnings;
  struct Solid {
    GroupQuality quality;
    double speed = 0;              // m/s: of shear waves; 0 without mass
    double highest_frequency = 0;  // Hz: with ten nodes per wavelength
  };
  std::vector<Solid> solids;        // of a mesh
  std::vector<GroupQuality> beams;  // groups of the mesh that are beams
  int pieces = 0;                   // of the opened mesh
  std::optional<FieldForecast> fields;
  std::optional<BulkCost> bulk;  // of a large bulk
  HistoryForecast histories;     // of one run
  double record_bytes = 0;       // floors at every step
};

constexpr int small_model = 3000, quick_modes = 30'000;  // unknowns: nothing to foresee below; only the bonded modes beyond
constexpr double trial_seconds = 5;

/// Quality and resolution of the groups that have a material.
void look_at_mesh(const Case& read, Findings& found) {
  if (!read.mesh) return;
  const CaseSolids materials(read.values, *read.mesh);
  const std::vector<GroupQuality> qualities = quality_by_group(read.mesh->mesh);
  for (const CaseSolids::Solid& solid : materials.solids())
    for (const GroupQuality& quality : qualities) {
      if (quality.name != solid.table->text("group")) continue;
      const double speed = solid.section.material.density > 0 ? solid.section.material.s_wave_speed() : 0;
      found.solids.push_back({quality, speed, speed > 0 ? highest_frequency(quality, speed, nodes_per_wavelength) : 0});
    }
  for (const Values& beam : read.values.tables("beam"))
    for (const GroupQuality& quality : qualities)
      if (beam.has("group") && quality.name == beam.text("group")) found.beams.push_back(quality);
  found.pieces = connected_pieces(read.mesh->mesh).count();
}

void print_mesh(const Case& read, const Findings& found) {
  const Mesh& mesh = read.mesh->mesh;
  const auto line = [](std::string_view what, const std::string& value) { say(fmt::format("  {:<28} {}", what, value)); };
  int cells = 0;
  for (const Findings::Solid& solid : found.solids) cells += solid.quality.cells;
  line("mesh", fmt::format("{} cells, {} nodes, {} {} after opening, from {}", cells, mesh.nodes.size(), found.pieces,
                           found.pieces == 1 ? "piece" : "pieces", read.mesh->from));
  for (const Findings::Solid& solid : found.solids) {
    const GroupQuality& quality = solid.quality;
    line("  " + quality.name, fmt::format("{} cells, edges {:.3g} to {:.3g} m, aspect up to {:.3g}, scaled Jacobian from {:.3g}",
                                          quality.cells, quality.shortest, quality.longest, quality.aspect, quality.jacobian));
    if (solid.speed > 0)
      line("", fmt::format("shear waves of {:.4g} m/s up to {:.3g} Hz (ten nodes a wavelength)", solid.speed, solid.highest_frequency));
  }
  for (const GroupQuality& beam : found.beams)
    line("  " + beam.name, fmt::format("beams along {} lines of {:.3g} to {:.3g} m", beam.cells, beam.shortest, beam.longest));
}

void write_mesh(JsonWriter& json, const Case& read, const Findings& found) {
  json.key("mesh").begin_object().member("from", read.mesh->from).member("nodes", static_cast<int>(read.mesh->mesh.nodes.size()));
  json.member("pieces", found.pieces).key("solids").begin_array();
  for (const Findings::Solid& solid : found.solids)
    json.begin_object()
        .member("group", solid.quality.name)
        .member("cells", solid.quality.cells)
        .member("shortest_edge", solid.quality.shortest)
        .member("longest_edge", solid.quality.longest)
        .member("aspect", solid.quality.aspect)
        .member("scaled_jacobian", solid.quality.jacobian)
        .member("shear_wave_speed", solid.speed)
        .member("highest_frequency", solid.highest_frequency)
        .end_object();
  json.end_array().key("beams").begin_array();
  for (const GroupQuality& beam : found.beams)
    json.begin_object()
        .member("group", beam.name)
        .member("lines", beam.cells)
        .member("shortest", beam.shortest)
        .member("longest", beam.longest)
        .end_object();
  json.end_array().end_object();
}

/// Frequencies with the nodes of every interface held: what a fixed-base model has.
std::vector<double> frequencies(const std::vector<Mode>& found) {
  std::vector<double> values;
  for (const Mode& mode : found) values.push_back(mode.frequency);
  return values;
}

/// The first steps of the run: do the static stages converge, and what does a step cost?
void try_steps(Findings& found, const BuiltCase& built) {
  RunPlan plan = built.plan;
  plan.frames = 0;
  for (Stage& stage : plan.stages)
    if (stage.type == Stage::Type::dynamics) {
      found.steps += std::lround(stage.duration / stage.step);
      stage.duration = std::min(stage.duration, 200 * stage.step);
    }
  const auto start = std::chrono::steady_clock::now();
  const Watch enough = [&](const Progress&) {
    return std::chrono::steady_clock::now() - start < std::chrono::duration<double>(trial_seconds);
  };
  const RunResult trial = uplift::run(built.model, plan, built.behaviours, enough);
  if (trial.status == RunStatus::failed && trial.counts.steps < 200) found.trial_failure = trial.reason;
  found.seconds_per_step = trial.step_seconds;
  found.systems = trial.counts.systems;
}

/// What the pictures of all runs of `uplift run` take until the report is written.
double pictures_bytes(const Case& read, const BuiltCase& built) {
  double numbers = built.model.full_unknowns();
  for (const Interface& interface : built.model.interfaces) numbers += 2 * interface.rows();
  return 8 * numbers * built.plan.frames * static_cast<double>(runs_of_case(read).size());
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

Findings find(const Case& read, const RunSpec& spec, const BuiltCase& built) {
  Findings found;
  look_at_mesh(read, found);
  found.fields = field_forecast(read, built);
  found.record_bytes = floor_record_bytes(built.plan);
  found.histories = forecast_histories(built.plan, built.model.interfaces.size());
  const int unknowns = built.model.free();
  if (unknowns > small_model) {
    BulkUse use;
    use.impacts = built.plan.method->constrains();
    use.propagates = use.impacts && built.plan.impact->needs_dynamic();
    const Stage* stage = dynamic_stage(built.plan);
    const bool balanced = stage != nullptr && stage->path_average && !use.impacts;
    use.keeps_mass = use.impacts || (balanced && (records_accelerations(built.plan) || found.fields));
    use.record_bytes = found.record_bytes + pictures_bytes(read, built);
    found.bulk = predict_bulk(built.model, *built.plan.solver, use);
    if (!found.bulk->refusal.empty()) {
      found.trial_failure = found.bulk->refusal;
      return found;
    }
  }
  found.bonded = frequencies(bonded_modes(built.at_rest(), 5));
  if (unknowns <= quick_modes) {
    found.fixed = frequencies(fixed_base_modes(built.at_rest(), 3));
    found.base_free = frequencies(uplift::modes(built.at_rest().stiffness, built.at_rest().mass, 5));
  }
  if (const Stage* stage = dynamic_stage(built.plan)) found.ratios = stiffness_ratios(built.model, *stage, *built.plan.solver);
  if (dynamic_stage(built.plan)) found.bounds = step_bounds(read, built, found.bonded);
  if (!found.bounds.empty()) found.suggested_step = rounded_down(found.bounds.front().step);
  try_steps(found, built);
  found.warnings = warnings(read, spec, built);
  if (std::string warning = history_warning(read, found.histories); !warning.empty()) found.warnings.push_back(std::move(warning));
  return found;
}

std::string list_hz(const std::vector<double>& values) {
  std::string text;
  for (const double value : values) text += (text.empty() ? "" : ", ") + fmt::format("{:.4g}", value);
  return text.empty() ? "none" : text + " Hz";
}

void print(const Loaded& loaded, const BuiltCase& built, const Findings& found, const std::vector<std::string>& runs) {
  const Model& model = built.model;
  const auto line = [](std::string_view what, const std::string& value) { say(fmt::format("  {:<28} {}", what, value)); };
  say(loaded.from.title);
  line("unknowns", fmt::format("{} free of {} ({} nodes)", model.free(), model.full_unknowns(), model.nodes.size()));
  if (loaded.read.mesh) print_mesh(loaded.read, found);
  for (std::size_t k = 0; k < model.interfaces.size(); ++k) {
    const Interface& interface = model.interfaces[k];
    line("interface " + interface.name,
         fmt::format("{}, {} points, {}, area {:.4g} m2{}", to_string(built.facts[k].role), interface.batch.points, interface.behaviour,
                     interface.area.sum(), interface.batch.components == 1 ? ", normal only" : ""));
    line("  points", points_text(interface));
    if (k < found.ratios.size() && found.ratios[k].most > 0)
      line("  k F_ii at the time step", fmt::format("{:.3g} to {:.3g}", found.ratios[k].least, found.ratios[k].most));
    if (k < found.ratios.size()) line("  compliance F_ii", fmt::format("up to {:.3g} m/N", found.ratios[k].compliance));
  }
  for (const auto& history : motions_of({{nullptr, &built, nullptr}})) {
    const Motion& motion = *history->motion();
    line("record " + motion.name,
         fmt::format("{}, {} points every {}, {}, peak {}", motion.format, motion.values.size(), format_quantity(motion.step, "s"),
                     format_quantity(motion.duration(), "s"), format_quantity(std::abs(peak_of(motion).value), unit_of(motion.kind))));
    if (!motion.file.empty())  // of generated ones a warning tells
      for (const std::string& repair : motion.repairs) line("  mended", repair);
    for (const std::string& step : motion.processing) line("  processed", step);
  }
  if (!built.facts.empty()) line("dead load on the base", format_quantity(built.weight, "N"));
  if (!found.fixed.empty()) line("frequencies, fixed base", list_hz(found.fixed));
  line("frequencies, bonded base", list_hz(found.bonded));
  if (!found.base_free.empty()) line("frequencies, base free", list_hz(found.base_free));
  for (const std::string& note : built.notes) line("chosen", note);
  const Stage* stage = dynamic_stage(built.plan);
  if (stage) {
    line("time step", fmt::format("{} ({} steps)", format_quantity(stage->step, "s"), found.steps));
    if (found.suggested_step > 0)
      line("suggested step, at most", fmt::format("{} ({})", format_quantity(found.suggested_step, "s"), found.bounds.front().reason));
  }
  if (found.seconds_per_step > 0)
    line("cost", fmt::format("about {} a step, {} a run", format_quantity(found.seconds_per_step, "s"),
                             format_quantity(found.seconds_per_step * static_cast<double>(found.steps), "s")));
  if (found.systems.factored + found.systems.iterated > 0)
    line("interface solver",
         fmt::format("{}; in the first steps {} systems with a new factor, {} by conjugate residuals (one factor kept, or none)",
                     loaded.read.values.text("interface_solver"), found.systems.factored, found.systems.iterated));
  if (found.bulk)
    line("memory", fmt::format("about {}, {} of it the factor of a step; {} are free", format_bytes(found.bulk->bytes),
                               format_bytes(found.bulk->step.bytes), format_bytes(found.bulk->available)));
  line("histories", fmt::format("{:.0f} rows x {:.0f} columns a run: {} in memory, about {} on disk", found.histories.rows,
                                found.histories.columns, format_bytes(found.histories.memory), format_bytes(found.histories.disk)));
  if (found.record_bytes > 0)
    line("floor spectra", fmt::format("{} at every step: {} a run",
                                      built.plan.floors.size() == 1 ? "one record" : fmt::format("{} records", built.plan.floors.size()),
                                      format_bytes(found.record_bytes)));
  if (found.fields) {
    const FieldForecast& fields = *found.fields;
    line("fields", fmt::format("{} frames x {} = {} a run, as {}", fields.frames, format_bytes(static_cast<double>(fields.size.per_frame)),
                               format_bytes(static_cast<double>(fields.bytes())), fields.format == FieldFormat::vtu ? "vtu" : "xdmf"));
  }
  say("what is computed");
  for (const std::string& run : runs) say("  " + run);
  for (const std::string& warning : found.warnings) say("warning: " + warning);
  if (!found.trial_failure.empty()) say("warning: the first steps fail: " + found.trial_failure);
  say(found.warnings.empty() && found.trial_failure.empty() ? "the case is in order" : "the case can be run; mind the warnings");
}

void write(const Loaded& loaded, const BuiltCase& built, const Findings& found, const std::vector<std::string>& runs) {
  JsonWriter json(0, 2);
  json.begin_object()
      .member("case", loaded.from.case_file)
      .member("title", loaded.from.title)
      .member("unknowns", built.model.free())
      .member("full_unknowns", built.model.full_unknowns());
  if (loaded.read.mesh) write_mesh(json, loaded.read, found);
  json.key("interfaces").begin_array();
  for (std::size_t k = 0; k < built.model.interfaces.size(); ++k) {
    const Interface& interface = built.model.interfaces[k];
    json.begin_object()
        .member("name", interface.name)
        .member("role", to_string(built.facts[k].role))
        .member("behaviour", interface.behaviour)
        .member("points", interface.batch.points)
        .member("area", interface.area.sum());
    write_points(json.key("positions"), interface);
    if (k < found.ratios.size())
      json.member("k_F_least", found.ratios[k].least)
          .member("k_F_most", found.ratios[k].most)
          .member("compliance", found.ratios[k].compliance);
    json.end_object();
  }
  json.end_array();
  if (found.bulk)
    json.key("memory")
        .begin_object()
        .member("bytes", found.bulk->bytes)
        .member("factor_bytes", found.bulk->step.bytes)
        .member("available_bytes", found.bulk->available)
        .end_object();
  json.key("histories")
      .begin_object()
      .member("rows", static_cast<long>(found.histories.rows))
      .member("columns", static_cast<long>(found.histories.columns))
      .member("memory_bytes", static_cast<long>(found.histories.memory))
      .member("disk_bytes", static_cast<long>(found.histories.disk))
      .end_object();
  if (found.record_bytes > 0)
    json.key("floor_spectra")
        .begin_object()
        .member("floors", static_cast<int>(built.plan.floors.size()))
        .member("bytes", static_cast<long>(found.record_bytes))
        .end_object();
  if (found.fields)
    json.key("fields")
        .begin_object()
        .member("format", found.fields->format == FieldFormat::vtu ? "vtu" : "xdmf")
        .member("frames", found.fields->frames)
        .member("bytes_per_frame", static_cast<long>(found.fields->size.per_frame))
        .member("bytes", static_cast<long>(found.fields->bytes()))
        .end_object();
  if (!built.facts.empty()) json.member("weight", built.weight);
  json.key("frequencies_fixed_base")
      .numbers(found.fixed)
      .key("frequencies_bonded")
      .numbers(found.bonded)
      .key("frequencies_base_free")
      .numbers(found.base_free);
  json.member("steps", found.steps).member("suggested_step", found.suggested_step).member("seconds_per_step", found.seconds_per_step);
  json.member("interface_solver", loaded.read.values.text("interface_solver"))
      .member("interface_systems_factored", found.systems.factored)
      .member("interface_systems_iterated", found.systems.iterated);
  json.key("step_bounds").begin_array();
  for (const StepBound& bound : found.bounds) json.begin_object().member("step", bound.step).member("reason", bound.reason).end_object();
  json.end_array();
  json.key("runs")
      .texts(runs)
      .key("notes")
      .texts(built.notes)
      .key("warnings")
      .texts(found.warnings)
      .member("trial_failure", found.trial_failure)
      .end_object();
  say(json.take());
}

}  // namespace

int check(const Options& options) {
  const Loaded loaded = load(options);
  const std::vector<RunSpec> own = runs_of_case(loaded.read);
  std::vector<std::string> runs;
  for (const RunSpec& spec : own) runs.push_back("uplift run: " + spec.label);
  const BuiltCase built = build(loaded.read, own.front());
  if (compares(loaded.read)) {
    const Comparison comparison = comparison_of_case(loaded.read);
    for (const RunSpec& spec : comparison.runs) {
      build(loaded.read, spec);  // every variant is checked too
      runs.push_back(fmt::format("uplift compare: {}{}", spec.label, spec.group.empty() ? "" : ", " + spec.group));
    }
    for (const RunSpec& spec : comparison.sweep) build(loaded.read, spec);
    if (!comparison.sweep.empty()) runs.push_back(fmt::format("uplift compare: stiffness sweep, {} runs", comparison.sweep.size()));
  }
  const Findings found = find(loaded.read, own.front(), built);
  if (options.json)
    write(loaded, built, found, runs);
  else if (!options.quiet)
    print(loaded, built, found, runs);
  return Exit::done;
}

}  // namespace uplift::cli
