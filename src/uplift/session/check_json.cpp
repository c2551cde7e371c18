#include <cmath>

#include "uplift/case/mesh/mesh.h"
#include "uplift/case/schema/case_input.h"
#include "uplift/io/results/interface_points.h"
#include "uplift/io/text/json_writer.h"
#include "uplift/session/check.h"

namespace uplift {
namespace {

void write_mesh(JsonWriter& json, const Case& read, const CaseFindings& found) {
  json.key("mesh").begin_object().member("from", read.mesh->from).member("nodes", static_cast<int>(read.mesh->mesh.nodes.size()));
  json.member("pieces", found.pieces).key("solids").begin_array();
  for (const CaseFindings::Solid& solid : found.solids)
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

}  // namespace

std::string check_json(const LoadedCase& loaded, const CheckedCase& checked) {
  const BuiltCase& built = checked.built;
  const CaseFindings& found = checked.found;
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
    ResultWriter out(json);
    write_points(out, interface);
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
        .member("other_ranks_bytes", found.bulk->elsewhere_bytes)  // the largest of them; zero where there is one process
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
  if (!built.facts.empty()) json.member("weight", built.weight());
  json.key("frequencies_fixed_base")
      .numbers(found.fixed)
      .key("frequencies_bonded")
      .numbers(found.bonded)
      .key("frequencies_base_free")
      .numbers(found.base_free);
  json.member("steps", found.steps).member("suggested_step", found.suggested_step).member("seconds_per_step", found.seconds_per_step);
  json.member("interface_solver", loaded.read.input->interface_solver)
      .member("interface_systems_factored", found.systems.factored)
      .member("interface_systems_iterated", found.systems.iterated);
  json.key("step_bounds").begin_array();
  for (const StepBound& bound : found.bounds) json.begin_object().member("step", bound.step).member("reason", bound.reason).end_object();
  json.end_array();
  json.key("runs")
      .texts(checked.runs)
      .key("notes")
      .texts(built.notes)
      .key("warnings")
      .texts(found.warnings)
      .member("trial_failure", found.trial_failure)
      .end_object();
  return json.take();
}

}  // namespace uplift
