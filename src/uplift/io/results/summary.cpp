#include "uplift/io/results/summary.h"

#include "uplift/io/report/motions.h"
#include "uplift/io/results/floors.h"
#include "uplift/io/results/forces_json.h"
#include "uplift/io/results/interface_points.h"
#include "uplift/io/results/verdict_json.h"
#include "uplift/io/text/json_writer.h"

namespace uplift {
namespace {

void write_peak(JsonWriter& json, std::string_view name, double value, double time, std::string_view unit) {
  json.key(name).begin_object().member("value", value).member("time", time).member("unit", unit).end_object();
}

void write_peak(JsonWriter& json, std::string_view name, const Peak& peak) {
  write_peak(json, name, peak.value, peak.time, peak.unit);
}

void write_run(JsonWriter& json, const RunResult& run, const Agreement* agreement, const FloorRun* floors) {
  json.begin_object();
  json.member("name", run.name).member("label", run.label).member("group", run.group);
  json.member("status", to_string(run.status)).member("reason", run.reason);
  json.member("expected", run.expected_to_fail ? "may_fail" : "completes");
  json.member("steps", run.counts.steps)
      .member("load_steps", run.counts.load_steps)
      .member("retries", run.counts.retries)
      .member("iterations", run.counts.iterations);
  json.member("cycles", run.counts.cycles)
      .member("factorisations", run.counts.factorisations)
      .member("back_solves", run.counts.back_solves)
      .member("interface_systems_factored", run.counts.systems.factored)
      .member("interface_systems_iterated", run.counts.systems.iterated);
  json.member("wall_seconds", run.wall).member("step_seconds", run.step_seconds).member("end_time", run.end_time);
  write_peak(json, "max_uplifted_ratio", run.max_uplifted_ratio);
  write_peak(json, "max_opening", run.max_opening);
  write_peak(json, "max_base_moment", run.max_base_moment);
  write_peak(json, "max_base_shear", run.max_base_shear);
  write_peak(json, "max_pressure", run.max_pressure);
  write_peak(json, "max_step_pressure", run.max_step_pressure);
  json.member("first_uplift", run.first_uplift).member("time_uplifted", run.time_uplifted).member("full_loss_of_contact", run.full_loss);
  json.member("max_penetration", run.max_penetration);
  write_peak(json, "energy_created", run.energy_created, run.energy_created_time, "J");
  write_peak(json, "energy_lost", run.energy_lost, run.energy_lost_time, "J");
  json.member("energy_scale", run.energy_scale).member("energy_created_share", created_share(run));
  const Energies& end = run.final_energy;
  json.key("final_energy").begin_object().member("unit", "J");
  json.member("kinetic", end.kinetic)
      .member("strain", end.strain)
      .member("stored", end.stored)
      .member("interface_dissipated", end.interface_dissipated);
  if (end.plastic != 0) json.member("plastic", end.plastic);
  if (end.stop != 0) json.member("stop", end.stop);
  if (end.algorithmic != 0) json.member("algorithmic", end.algorithmic).member("filter", end.filter);
  json.member("damping", end.damping)
      .member("impact", end.impact)
      .member("external", end.external)
      .member("residual", end.residual)
      .end_object();
  json.key("peaks").begin_object();
  for (const Peak& peak : run.peaks) write_peak(json, peak.name, peak);
  json.end_object();
  if (floors) write_floors(json.key("floor_spectra"), *floors);
  if (agreement)
    json.key("agreement")
        .begin_object()
        .member("result", to_string(agreement->word))
        .member("deviation", agreement->deviation)
        .member("column", agreement->column)
        .end_object();
  if (!run.envelopes.empty()) write_envelopes(json.key("beam_envelopes"), run.envelopes);
  if (!run.equilibrium.instants.empty()) write_equilibrium(json.key("equilibrium"), run.equilibrium);
  json.key("notes").texts(run.notes);
  json.end_object();
}

}  // namespace

std::string summary_json(const SummaryInput& input) {
  const auto& [from, runs, verdict, motions, compared, floors, built] = input;
  JsonWriter json(0, 2);
  json.begin_object();
  json.member("format", "uplift-summary-1")
      .member("version", from.version)
      .member("built_with", from.built_with)
      .member("title", from.title)
      .member("command", from.command);
  json.member("created", from.created);
  json.key("case").begin_object().member("file", from.case_file).member("sha256", from.case_hash).end_object();
  json.key("inputs").begin_array();
  for (const auto& [file, hash] : from.inputs) json.begin_object().member("file", file).member("sha256", hash).end_object();
  json.end_array();
  write_motions(json, motions);
  json.key("interfaces").begin_array();
  for (std::size_t k = 0; built != nullptr && k < built->model.interfaces.size(); ++k) {
    const Interface& interface = built->model.interfaces[k];
    json.begin_object().member("name", interface.name).member("points", interface.batch.points);
    write_points(json.key("positions"), interface);
    json.end_object();
  }
  json.end_array();
  json.key("runs").begin_array();
  for (std::size_t i = 0; i < runs.size(); ++i)
    write_run(json, runs[i], compared ? &compared->agreement[i] : nullptr, floors && floors->any() ? &floors->runs[i] : nullptr);
  json.end_array();
  if (floors && !floors->envelopes.empty()) write_floor_envelopes(json.key("floor_envelopes"), *floors);
  json.key("verdict");
  write_verdict_numbers(json, verdict, runs, floors, built);
  if (compared) {
    json.member("band", compared->band).key("compared_columns").texts(compared->columns);
    json.key("stiffness_sweep").begin_array();
    for (const SweepRow& row : compared->sweep)
      json.begin_object()
          .member("k_F", row.ratio)
          .member("created_share_path", row.path)
          .member("status_path", row.path_status)
          .member("created_share_end", row.end)
          .member("status_end", row.end_status)
          .end_object();
    json.end_array();
    if (!compared->motions.empty()) write_over_motions(json, compared->motions);
  }
  json.end_object();
  return json.take() + "\n";
}

}  // namespace uplift
