#include "uplift/case/build/stages.h"

#include <fmt/format.h>

#include <algorithm>

#include "uplift/base/text.h"
#include "uplift/case/decided.h"
#include "uplift/dynamics/scheme.h"
#include "uplift/laws/tangential.h"

namespace uplift {
namespace {

/// With the place that asks for the path average: a stage, a variant or the stiffness sweep.
[[noreturn]] void fail_traction(const CaseStage& stage, const RunSpec& spec) {
  const char* wanted = "traction = \"end\" with this scheme (the path average belongs to the average acceleration)";
  if (spec.stiffness_ratio)
    throw InputError(spec.law->where(), "compare.stiffness_sweep",
                     "stages with the average acceleration: the sweep compares both tractions", in_quotes(stage.scheme->type()));
  if (spec.path_average) throw InputError(stage.where("scheme"), "variant \"" + spec.name + "\"", wanted, "traction = \"path\"");
  fail(stage, "traction", wanted, "\"path\"");
}

Stage stage_of(const CaseStage& table, const RunSpec& spec) {
  Stage stage;
  stage.type = table.statics ? Stage::Type::statics : Stage::Type::dynamics;
  stage.steps = table.steps;
  stage.halvings = table.halvings;
  stage.p_delta = table.p_delta;
  if (stage.type == Stage::Type::statics) return stage;
  if (!table.duration || !table.step) fail(table, "", fmt::format("{} of a dynamic stage", table.duration ? "step" : "duration"), "none");
  stage.duration = spec.duration.value_or(*table.duration);
  stage.step = spec.step_factor * spec.step.value_or(*table.step);
  if (stage.step > stage.duration)
    fail(table, "step", fmt::format("a step shorter than the duration of {:g} s", stage.duration), fmt::format("{:g} s", stage.step));
  constexpr double most_steps = 1e12;
  if (stage.duration / stage.step > most_steps)
    fail(table, "step", fmt::format("a step of at least {:.4g} s: a stage has at most {:g} steps", stage.duration / most_steps, most_steps),
         fmt::format("{:g} s", stage.step));
  const Values& scheme = spec.scheme ? *spec.scheme : *table.scheme;
  stage.scheme = *make_part(scheme_catalog(), scheme);
  // The path average closes the energy balance with the trapezoidal rule only: other schemes take the end of the step unless told
  // otherwise.
  const bool wanted = spec.path_average.value_or(table.path_average);
  const bool stated = spec.path_average.has_value() || table.traction_given;
  if (wanted && stated && !stage.scheme.average_acceleration()) fail_traction(table, spec);
  stage.path_average = wanted && stage.scheme.average_acceleration();
  return stage;
}

/// A static stage of second order leaves an equilibrium of second order.
void check_second_order(const std::vector<CaseStage>& tables, const std::vector<Stage>& stages) {
  bool stands = false;
  for (std::size_t k = 0; k < stages.size(); ++k) {
    if (stands && !stages[k].p_delta)
      fail(tables[k], "p_delta", "p_delta = true, as in the static stage before it, whose equilibrium is of second order", "false");
    stands = stands || (stages[k].p_delta && stages[k].type == Stage::Type::statics);
  }
}

}  // namespace

std::vector<Stage> stages_of(const Case& read, const RunSpec& spec) {
  std::vector<Stage> stages;
  for (const CaseStage& table : read.input->stages) stages.push_back(stage_of(table, spec));
  if (stages.empty()) fail(read.values, "", "at least one [[stage]]", "none");
  check_second_order(read.input->stages, stages);
  return stages;
}

void check_release(const std::vector<CaseStage>& tables, const std::vector<Stage>& stages) {
  const auto begin = std::ranges::find(stages, Stage::Type::dynamics, &Stage::type);
  const Stage* first = begin == stages.end() ? nullptr : &*begin;
  for (std::size_t k = 0; first && k < stages.size(); ++k) {
    const Stage& stage = stages[k];
    if (&stage < first) continue;
    if (stage.type == Stage::Type::statics)
      fail(tables[k], "type", "no static stage after a dynamic one, where supports hold in static stages alone", "one");
    if (stage.p_delta && !first->p_delta)
      fail(tables[k], "p_delta", "p_delta from the first dynamic stage on, where supports hold in static stages alone", "p_delta later");
  }
}

DecidedTexts decided_texts(const Case& read) {
  DecidedTexts decided;
  for (const CaseStage& stage : read.input->stages)
    if (!stage.statics && !stage.traction_given && stage_of(stage, {}).path_average != stage.path_average)
      decided[stage.path("traction")] = "end";
  const auto decide = [&](const Values* law) {
    const std::optional<std::string> kind = law != nullptr ? decided_tangential(*law) : std::nullopt;
    if (kind) decided[law->path("tangential")] = *kind;
  };
  for (const CaseInterface& interface : read.input->interfaces) decide(interface.law);
  for (const CaseVariant& variant : read.input->variants) decide(variant.law);
  return decided;
}

}  // namespace uplift
