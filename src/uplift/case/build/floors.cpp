#include <fmt/format.h>

#include "uplift/case/build/model.h"
#include "uplift/case/build/output.h"

namespace uplift {
namespace {

/// The record must have equal steps.
void check_steps(const CaseFloor& floor, const RunPlan& plan) {
  const Stage* first = dynamic_stage(plan);
  if (first == nullptr) fail(floor, "", "a dynamic stage, for floor spectra", "none");
  for (const Stage& stage : plan.stages)
    if (stage.type == Stage::Type::dynamics && stage.step != first->step)
      fail(floor, "", "the same step in all dynamic stages, for floor spectra", fmt::format("{:g} s and {:g} s", first->step, stage.step));
}

}  // namespace

void add_floors(const Case& read, BuiltCase& built) {
  const CaseOutput& output = read.input->output;
  RunPlan& plan = built.plan;
  plan.floor_bands = output.floor_bands;
  if (output.floors.empty()) return;
  Names floors("floor");
  for (const CaseFloor& asked : output.floors) {
    floors.add(asked.name);
    FloorRequest floor;
    floor.name = asked.name.name;
    floor.node = asked_node(asked, "floor " + floor.name, built);
    floor.direction = asked.direction;
    floor.dampings = asked.dampings;
    floor.frequencies = asked.frequencies;
    floor.broadening = asked.broadening;
    check_steps(asked, plan);
    plan.floors.push_back(std::move(floor));
  }
}

}  // namespace uplift
