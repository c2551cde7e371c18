#include "uplift/io/results/summary.h"

#include "uplift/io/results/floors.h"
#include "uplift/io/results/forces_json.h"
#include "uplift/io/results/interface_points.h"
#include "uplift/io/results/motions_json.h"
#include "uplift/io/results/soil.h"
#include "uplift/io/results/verdict_json.h"
#include "uplift/io/results/words.h"

namespace uplift {
namespace {

/// A run with what is known of it besides its results.
struct Entry {
  const RunResult* result = nullptr;
  const Agreement* agreement = nullptr;
  const FloorRun* floors = nullptr;
  const BuiltCase* built = nullptr;
  const RunSpec* spec = nullptr;
  bool compact = false;
};

std::vector<Entry> entries_of(const SummaryInput& input) {
  std::vector<Entry> entries;
  for (std::size_t i = 0; i < input.runs.size(); ++i)
    entries.push_back({&input.runs[i], input.compared ? &input.compared->agreement[i] : nullptr,
                       input.floors && input.floors->any() ? &input.floors->runs[i] : nullptr, input.built ? &(*input.built)[i] : nullptr,
                       input.specs ? &(*input.specs)[i] : nullptr, input.compact});
  return entries;
}

void write_counts(ResultWriter& out, const RunResult& run) {
  const Counts& counts = run.counts;
  out.count("steps", counts.steps, "time steps");
  out.count("load_steps", counts.load_steps, "load steps of the static stages");
  out.count("retries", counts.retries, "steps that were halved and repeated");
  out.count("iterations", counts.iterations, "iterations of the contact method");
  out.count("cycles", counts.cycles, "interface problems whose status repeated itself and that were restarted");
  out.count("factorisations", counts.factorisations, "factorisations of global matrices");
  out.count("back_solves", counts.back_solves, "solutions with these factors");
  out.count("interface_systems_factored", counts.systems.factored, "interface systems solved with a new factor");
  out.count("interface_systems_iterated", counts.systems.iterated, "interface systems solved iteratively");
  out.number("wall_seconds", run.wall, "s", "elapsed time");
  out.number("step_seconds", run.step_seconds, "s", "computing time per step of the last dynamic stage");
  out.number("end_time", run.end_time, "s", "time reached");
}

/// `pressure`: whether there is an interface with pressures; a whole foundation has forces alone.
void write_extremes(ResultWriter& out, const RunResult& run, bool pressure) {
  write_peak(out, "max_uplifted_ratio", run.max_uplifted_ratio, "1", "largest share of the area with a gap");
  write_peak(out, "max_opening", run.max_opening, "m", "largest gap");
  write_peak(out, "max_base_moment", run.max_base_moment, "N m", "largest base moment, mean over the window");
  write_peak(out, "max_base_shear", run.max_base_shear, "N", "largest base shear, mean over the window");
  out.when(pressure);
  write_peak(out, "max_pressure", run.max_pressure, "Pa", "largest pressure, mean over the window");
  out.when(pressure);
  write_peak(out, "max_step_pressure", run.max_step_pressure, "Pa", "largest pressure, mean over one step");
  out.number("first_uplift", run.first_uplift, "s", "time at which a gap opens first; -1: never");
  out.number("time_uplifted", run.time_uplifted, "s", "total time with a gap");
  out.number("full_loss_of_contact", run.full_loss, "s", "total time without any contact");
  out.number("max_penetration", run.max_penetration, "m", "largest compression of the joint");
}

void write_energies(ResultWriter& out, const RunResult& run) {
  write_peak(out, "energy_created", {"", "J", run.energy_created, run.energy_created_time}, "J",
             "largest residual of the energy balance: energy created by the computation");
  write_peak(out, "energy_lost", {"", "J", run.energy_lost, run.energy_lost_time}, "J", "largest energy lost by the computation");
  out.number("energy_scale", run.energy_scale, "J", "largest external work, or the initial energy without any");
  out.number("energy_created_share", created_share(run), "1", "energy created, divided by this scale");
  const Energies& end = run.final_energy;
  out.object("final_energy", "terms of the energy balance at the end", [&] {
    out.unit("J");
    out.number("kinetic", end.kinetic, "J", "kinetic energy");
    out.number("strain", end.strain, "J", "strain energy of the structure and the soil");
    out.number("stored", end.stored, "J", "stored in the interfaces");
    out.number("interface_dissipated", end.interface_dissipated, "J", "dissipated by the interfaces");
    out.when(end.plastic != 0).number("plastic", end.plastic, "J", "dissipated by yielding solids");
    out.when(end.stop != 0).number("stop", end.stop, "J", "removed by static stages that follow dynamic ones");
    out.when(end.algorithmic != 0).number("algorithmic", end.algorithmic, "J", "dissipated by the time scheme");
    out.when(end.algorithmic != 0).number("filter", end.filter, "J", "stored in the filters of the time scheme");
    out.number("damping", end.damping, "J", "dissipated by damping");
    out.number("impact", end.impact, "J", "dissipated by impacts");
    out.number("external", end.external, "J", "external work");
    out.number("residual", end.residual, "J", "residual of the balance");
  });
}

void write_agreement(ResultWriter& out, const Agreement* given) {
  const Agreement agreement = given ? *given : Agreement();
  using enum Agreement::Word;
  out.when(given != nullptr).object("agreement", "comparison with the other runs of the group", [&] {
    out.word("result", to_string(agreement.word), {to_string(agrees), to_string(differs), to_string(failed), to_string(not_counted)},
             "whether the run agrees with the others; -: it is not counted");
    out.number("deviation", agreement.deviation, "1", "largest deviation from the median");
    out.text("column", agreement.column, "column or number of the verdict with this deviation");
  });
}

void write_run(ResultWriter& out, const Entry& entry) {
  static const RunResult none;
  static const FloorRun no_floors;
  const RunResult& run = entry.result ? *entry.result : none;
  out.text("name", run.name, "name of the run: `run`, `bonded` or the variant");
  out.text("label", run.label, "label in tables and figures");
  out.text("group", run.group, "damping and motion of runs that are compared with each other; empty: one group");
  out.word("status", to_string(run.status), run_status_words(), "outcome");
  out.text("reason", run.reason, "why the run failed or stopped; empty: it completed");
  out.word("expected", run.expected_to_fail ? "may_fail" : "completes", {"completes", "may_fail"}, "outcome that the case expects");
  out.when(entry.spec != nullptr)
      .flag("bonded", entry.spec && entry.spec->bonded, "whether it is a bonded reference run, which does not open");
  write_counts(out, run);
  const std::optional<Peak> top = entry.built && entry.result ? top_motion(*entry.built, run) : std::nullopt;
  out.when(top.has_value());
  write_peak(out, "max_top_motion", top.value_or(Peak{"", "m"}), "m", "largest horizontal motion of the top, over all directions");
  const auto whole = [](const Interface& interface) { return interface.footprint.has_value(); };
  const auto* interfaces = entry.built ? &entry.built->model.interfaces : nullptr;
  write_extremes(out, run, !interfaces || interfaces->empty() || !std::ranges::all_of(*interfaces, whole));
  write_energies(out, run);
  if (!entry.compact)
    out.named(
        "peaks", "largest magnitude of each recorded column, with its sign and time", run.peaks, [](const Peak& peak) { return peak.name; },
        [&](const Peak& peak) { write_peak(out, peak, ""); });
  out.when(entry.floors != nullptr);
  write_floors(out, "floor_spectra", entry.floors ? *entry.floors : no_floors);
  write_agreement(out, entry.agreement);
  out.when(!run.envelopes.empty());
  write_envelopes(out, run.envelopes, (entry.built ? entry.built->model.space : Space()).up());
  out.when(!run.equilibrium.instants.empty() && !entry.compact);
  write_equilibrium(out, run.equilibrium);
  out.texts("notes", run.notes, "remarks on the computation: repeated steps, warnings of laws");
}

void write_provenance(ResultWriter& out, const Provenance& from) {
  out.constant("format", "uplift-summary-1", "format of this document");
  out.text("version", from.version, "version of the program");
  out.text("built_with", from.built_with, "compiler");
  out.text("title", from.title, "title of the case");
  out.text("command", from.command, "command that was run");
  out.text("created", from.created, "date and time, UTC");
  out.object("case", "the case file", [&] {
    out.text("file", from.case_file, "its name");
    out.text("sha256", from.case_hash, "its hash");
  });
  out.list("inputs", "other files that were read", from.inputs, [&](const std::pair<std::string, std::string>& input) {
    out.text("file", input.first, "name of the file");
    out.text("sha256", input.second, "its hash");
  });
}

/// The reduced model that was used, with the statement of its error.
void write_reduced(ResultWriter& out, const Provenance& from) {
  static const ReducedModel none;
  static const ControlErrors no_errors;
  const ReducedModel& reduced = from.reduced ? *from.reduced : none;
  const ControlErrors& errors = reduced.controls ? *reduced.controls : no_errors;
  out.when(from.reduced != nullptr).object("reduced_model", "the reduced model with which the dynamic stages were computed", [&] {
    out.text("file", from.reduced_file, "its file");
    out.count("coordinates", reduced.vectors.cols(), "coordinates of its basis");
    out.count("unknowns", reduced.vectors.rows(), "unknowns of the whole model");
    out.number("frequency", reduced.frequency, "Hz", "highest frequency of the motions that it was made for");
    out.number("transfer_error", reduced.transfer_error, "1", "error of the linear response to loads that it was not made of");
    out.when(reduced.controls.has_value() || !from.reduced);
    out.object("control_errors", "largest errors over the control runs, as shares of the values of the whole model", [&] {
      out.count("runs", errors.runs, "control runs");
      out.count("different", errors.different, "control runs whose outcome was another one; left out");
      out.text("motions", errors.motions, "what was drawn at random");
      out.number("least_scale", errors.least_scale, "1", "smallest factor of the motions");
      out.number("most_scale", errors.most_scale, "1", "largest factor of the motions");
      out.number("confidence", errors.confidence(), "1", "with which each of the errors bounds that of 95 % of the runs drawn like these");
      out.number("opening", errors.opening, "1", "error of the largest opening");
      out.number("moment", errors.moment, "1", "error of the largest base moment");
      out.number("history", errors.history, "1", "error of the openings over time, 2-norm");
      out.number("slip", errors.slip, "1", "error of the slips over time, 2-norm; 0: nothing slips");
      out.number("floor_spectrum", errors.floor_spectrum, "1", "error of the broadened floor spectra; 0: none were asked for");
    });
  });
}

void write_interfaces(ResultWriter& out, const BuiltCase* built) {
  struct Joint {
    const Interface* interface = nullptr;
    const FootingOnSoil* soil = nullptr;
  };
  std::vector<Joint> joints;
  if (built)
    for (std::size_t k = 0; k < built->facts.size(); ++k) joints.push_back({&built->model.interfaces[k], built->facts[k].soil.get()});
  out.list("interfaces", "the interfaces of the model", joints, [&](const Joint& joint) {
    static const Interface none;
    const Interface& interface = joint.interface ? *joint.interface : none;
    out.text("name", interface.name, "name of the interface");
    out.count("points", interface.batch.points, "number of points");
    write_points(out, interface);
    out.when(joint.soil != nullptr);
    write_soil(out, joint.soil ? *joint.soil : FootingOnSoil());
  });
}

void write_comparison(ResultWriter& out, const ComparisonSummary* given) {
  static const ComparisonSummary none;
  const ComparisonSummary& compared = given ? *given : none;
  const bool any = given != nullptr;
  out.when(any).number("band", compared.band, "1", "accepted deviation from the median in a comparison");
  out.when(any).texts("compared_columns", compared.columns, "columns whose peaks are compared; empty: all numbers of the verdict");
  out.when(any).list("stiffness_sweep", "results of `[compare.stiffness_sweep]`", compared.sweep, [&](const SweepRow& row) {
    out.number("k_F", row.ratio, "1", "stiffness of the joint times the compliance of the structure at one step");
    out.number("created_share_path", row.path, "1", "energy created with the path-averaged traction, divided by the external work");
    out.text("status_path", row.path_status, "outcome of that run");
    out.number("created_share_end", row.end, "1", "energy created with the end-of-step traction, divided by the external work");
    out.text("status_end", row.end_status, "outcome of that run");
  });
  out.when(!compared.motions.empty());
  write_over_motions(out, compared.motions);
}

void write_summary(ResultWriter& out, const SummaryInput& input) {
  const BuiltCase* first = input.built && !input.built->empty() ? &input.built->front() : nullptr;
  static const FloorAnswers none;
  write_provenance(out, input.from);
  write_reduced(out, input.from);
  write_motions(out, input.motions);
  write_interfaces(out, first);
  out.list("runs", "the runs; the first one is that of the verdict", entries_of(input), [&](const Entry& entry) { write_run(out, entry); });
  out.when(input.floors && !input.floors->envelopes.empty());
  write_floor_envelopes(out, "floor_envelopes", input.floors ? *input.floors : none);
  write_verdict_numbers(out, input.verdict, input.runs, input.floors, first, !input.compact);
  write_comparison(out, input.compared);
}

}  // namespace

std::string summary_json(const SummaryInput& input) {
  JsonWriter json(0, input.compact ? 0 : 2);
  json.begin_object();
  ResultWriter out(json);
  write_summary(out, input);
  json.end_object();
  return json.take() + "\n";
}

std::string summary_schema() {
  ResultWriter out("summary.json",
                   "Results of `uplift run`, `compare` and `trust`. Numbers are in SI units; the keyword `unit` states the unit of each. A "
                   "number that is not finite is null.");
  write_summary(out, {Provenance(), {}, Verdict(), {}});
  return out.schema();
}

}  // namespace uplift
