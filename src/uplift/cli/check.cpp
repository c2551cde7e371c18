#include "uplift/session/check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "uplift/base/format.h"
#include "uplift/base/text.h"
#include "uplift/case/mesh/mesh.h"
#include "uplift/case/schema/case_input.h"
#include "uplift/cli/console.h"
#include "uplift/cli/load.h"
#include "uplift/io/report/motions.h"
#include "uplift/io/results/interface_points.h"

namespace uplift::cli {
namespace {

void print_mesh(const Case& read, const CaseFindings& found) {
  const Mesh& mesh = read.mesh->mesh;
  const auto line = [](std::string_view what, const std::string& value) { say(fmt::format("  {:<28} {}", what, value)); };
  int cells = 0;
  for (const CaseFindings::Solid& solid : found.solids) cells += solid.quality.cells;
  line("mesh", fmt::format("{} cells, {} nodes, {} {} after opening, from {}", cells, mesh.nodes.size(), found.pieces,
                           found.pieces == 1 ? "piece" : "pieces", read.mesh->from));
  for (const CaseFindings::Solid& solid : found.solids) {
    const GroupQuality& quality = solid.quality;
    line("  " + quality.name, fmt::format("{} cells, edges {:.3g} to {:.3g} m, aspect up to {:.3g}, scaled Jacobian from {:.3g}",
                                          quality.cells, quality.shortest, quality.longest, quality.aspect, quality.jacobian));
    if (solid.speed > 0)
      line("", fmt::format("shear waves of {:.4g} m/s up to {:.3g} Hz (ten nodes a wavelength)", solid.speed, solid.highest_frequency));
  }
  for (const GroupQuality& beam : found.beams)
    line("  " + beam.name, fmt::format("beams along {} lines of {:.3g} to {:.3g} m", beam.cells, beam.shortest, beam.longest));
}

std::string list_hz(const std::vector<double>& values) {
  std::string text;
  for (const double value : values) text += (text.empty() ? "" : ", ") + fmt::format("{:.4g}", value);
  return text.empty() ? "none" : text + " Hz";
}

void print(const LoadedCase& loaded, const CheckedCase& checked) {
  const BuiltCase& built = checked.built;
  const CaseFindings& found = checked.found;
  const std::vector<std::string>& runs = checked.runs;
  const Model& model = built.model;
  const auto line = [](std::string_view what, const std::string& value) { say(fmt::format("  {:<28} {}", what, value)); };
  say(loaded.from.title);
  line("unknowns", fmt::format("{} free of {} ({} nodes)", model.free(), model.full_unknowns(), model.nodes.size()));
  if (loaded.read.mesh) print_mesh(loaded.read, found);
  for (std::size_t k = 0; k < model.interfaces.size(); ++k) {
    const Interface& interface = model.interfaces[k];
    line("interface " + interface.name,
         fmt::format("{}, {}, {}, area {:.4g} m2{}", to_string(built.facts[k].role),
                     interface.footprint ? "foundation" : fmt::format("{} points", interface.batch.points), interface.behaviour,
                     built.facts[k].area, interface.batch.components == 1 ? ", normal only" : ""));
    if (!interface.footprint) line("  points", points_text(interface));
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
  if (!built.facts.empty()) line("dead load on the base", format_quantity(built.weight(), "N"));
  if (!found.fixed.empty()) line("frequencies, fixed base", list_hz(found.fixed));
  line("frequencies, bonded base", found.bonded.empty() && built.model.distributed != nullptr
                                       ? std::string("not computed: they need a factor on one process")
                                       : list_hz(found.bonded));
  if (!found.base_free.empty()) line("frequencies, base free", list_hz(found.base_free));
  for (const std::string& note : built.notes) line("chosen", note);
  const Stage* stage = dynamic_stage(built.plan);
  if (stage) {
    line("time step", fmt::format("{} ({} steps)", format_quantity(stage->step, "s"), found.steps));
    if (found.suggested_step > 0)
      line("suggested step, at most", fmt::format("{} ({})", format_quantity(found.suggested_step, "s"), found.bounds.front().reason));
  }
  if (found.seconds_per_step > 0)
    line("cost", fmt::format("about {} per step, {} per run", step_time_text(found.seconds_per_step),
                             format_quantity(found.seconds_per_step * static_cast<double>(found.steps), "s")));
  if (found.systems.factored + found.systems.iterated > 0)
    line("interface solver",
         fmt::format("{}; in the first steps {} systems with a new factor, {} by conjugate residuals (one factor kept, or none)",
                     loaded.read.input->interface_solver, found.systems.factored, found.systems.iterated));
  if (found.bulk)
    line("memory", fmt::format("about {}, {} of it the factor of a step; {} are free{}", format_bytes(found.bulk->bytes),
                               format_bytes(found.bulk->step.bytes), format_bytes(found.bulk->available),
                               found.bulk->elsewhere_bytes > 0 ? fmt::format("; on each other rank up to {}, and the program",
                                                                             format_bytes(found.bulk->elsewhere_bytes))
                                                               : std::string()));
  line("histories", fmt::format("{:.0f} rows x {:.0f} columns per run: {} in memory, about {} on disk", found.histories.rows,
                                found.histories.columns, format_bytes(found.histories.memory), format_bytes(found.histories.disk)));
  if (found.record_bytes > 0)
    line("floor spectra", fmt::format("{} at every step: {} per run",
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
  if (!found.trial_failure.empty())
    say("the case is read, but does not run as it is");
  else
    say(found.warnings.empty() ? "the case is in order" : "the case can be run; mind the warnings");
}

}  // namespace

int check(const Options& options) {
  const LoadedCase loaded = load(options);
  const CheckedCase checked = examine(loaded);
  if (options.json)
    say(check_json(loaded, checked));
  else if (!options.quiet)
    print(loaded, checked);
  return Exit::done;
}

}  // namespace uplift::cli
