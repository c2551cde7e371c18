#include <fmt/format.h>

#include "uplift/case/build/model.h"
#include "uplift/case/build/output.h"
#include "uplift/motion/spectrum.h"

namespace uplift {
namespace {

std::vector<double> frequencies_of(const Values& floor) {
  const Values* range = table_if(floor, "range");
  if (floor.given("frequencies") && range) fail(floor, "range", "frequencies or range", "both");
  if (range) {
    const double from = range->number("from"), to = range->number("to");
    if (!(to > from)) fail(*range, "to", fmt::format("a frequency above {:g} Hz", from), fmt::format("{:g} Hz", to));
    return log_spaced(from, to, range->integer("count"));
  }
  if (!floor.given("frequencies")) return rg_1_122_frequencies();
  return ascending(floor, "frequencies");
}

std::vector<double> dampings_of(const Values& floor) {
  if (!floor.given("damping")) return {0.02, 0.05};
  const std::vector<double>& dampings = floor.numbers("damping");
  if (dampings.empty()) fail(floor, "damping", "at least one damping ratio", "none");
  for (const double damping : dampings)
    if (!(damping >= 0 && damping < 1)) fail(floor, "damping", "damping ratios from 0, below 1", fmt::format("{:g}", damping));
  return dampings;
}

/// The record must have equal steps.
void check_steps(const Values& floor, const RunPlan& plan) {
  const Stage* first = dynamic_stage(plan);
  if (first == nullptr) fail(floor, "", "a dynamic stage, for floor spectra", "none");
  for (const Stage& stage : plan.stages)
    if (stage.type == Stage::Type::dynamics && stage.step != first->step)
      fail(floor, "", "the same step in all dynamic stages, for floor spectra", fmt::format("{:g} s and {:g} s", first->step, stage.step));
}

}  // namespace

std::vector<double> ascending(const Values& table, std::string_view key) {
  const std::vector<double>& values = table.numbers(key);
  if (values.empty()) fail(table, key, "at least one frequency", "none");
  double before = 0;
  for (const double value : values) {
    if (!(value > before)) fail(table, key, "frequencies > 0 Hz in ascending order", fmt::format("{:g} Hz after {:g} Hz", value, before));
    before = value;
  }
  return values;
}

void add_floors(const Case& read, BuiltCase& built) {
  const Values& output = read.values.table("output");
  RunPlan& plan = built.plan;
  plan.floor_bands = output.given("floor_bands") ? ascending(output, "floor_bands") : std::vector<double>{2, 5, 10, 20};
  if (output.tables("floor_spectrum").empty()) return;
  Names nodes("node"), floors("floor");
  for (const Node& node : built.model.nodes) nodes.add(node.name, {}, {});
  for (const Values& table : output.tables("floor_spectrum")) {
    FloorRequest floor;
    floors.add(table, "name");
    floor.name = table.text("name");
    floor.node = asked_node(table, "floor " + floor.name, nodes, built);
    floor.direction = vector_of(table, "direction", built.model.space);
    const double length = floor.direction.norm();
    if (!(length > 0)) fail(table, "direction", "a direction", "zero");
    floor.direction /= length;
    floor.dampings = dampings_of(table);
    floor.frequencies = frequencies_of(table);
    floor.broadening = table.number("broadening");
    check_steps(table, plan);
    plan.floors.push_back(std::move(floor));
  }
}

}  // namespace uplift
