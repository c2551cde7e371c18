#include "uplift/session/steps.h"

#include "uplift/base/text.h"
#include "uplift/case/schema/case_input.h"
#include "uplift/io/fields/run.h"
#include "uplift/linear/memory.h"
#include "uplift/model/model_matrices.h"
#include "uplift/run/run_state.h"
#include "uplift/session/checkpoint.h"
#include "uplift/session/history_file.h"
#include "uplift/session/reduce.h"

namespace uplift {

namespace {

const ExternalFunction& function_of(const LoadedCase& loaded, const Values& behaviour) {
  const std::string name = external_info(behaviour).name;
  const auto found = loaded.external_laws.find(name);
  if (found == loaded.external_laws.end())
    throw InputError(behaviour.where("name"), behaviour.path("name"), "the name of a law that the calling program has connected",
                     in_quotes(name) + " (laws of type \"external\" are for users of the library)");
  return found->second;
}

void refuse_filtered(const RunPlan& plan, const Values& behaviour) {
  for (const Stage& stage : plan.stages)
    if (stage.type == Stage::Type::dynamics && stage.scheme.filtered())
      throw InputError(behaviour.where(), behaviour.path(), "another scheme than energy_decay with a law of type \"external\"",
                       "energy_decay");
}

}  // namespace

std::shared_ptr<const LoadedCase> case_of(const LoadedCase& loaded, const RunSpec& spec) {
  if (spec.other_case.empty()) return {std::shared_ptr<const LoadedCase>(), &loaded};
  auto other = std::make_shared<LoadedCase>(load_case(spec.other_case, loaded.from.command, loaded.mesh_files));
  other->external_laws = loaded.external_laws;
  return other;
}

BuiltCase build_run(const LoadedCase& loaded, const RunSpec& spec) {
  BuiltCase built = build(loaded.read, spec);
  for (std::size_t k = 0; k < built.model.interfaces.size(); ++k) {
    const Values& behaviour = *built.behaviours[k];
    if (!is_external(behaviour)) continue;
    refuse_filtered(built.plan, behaviour);
    built.model.interfaces[k].law = external_law(external_info(behaviour), function_of(loaded, behaviour));
  }
  return built;
}

void append_run(const LoadedCase& loaded, const RunSpec& spec, std::deque<BuiltCase>& to) {
  BuiltCase built = build_run(loaded, spec);
  ModelMatrices matrices;
  matrices.swap(built.model);
  to.push_back(std::move(built));
  matrices.swap(to.back().model);
  give_back_free_memory();  // what assembling a large model leaves is a part of its matrices, and their solver comes on top
}

RunResult run_built(const LoadedCase& loaded, BuiltCase& built, const std::string& label, const Control& control, bool first,
                    std::vector<std::string>* field_lists, const std::string& histories) {
  Watch watch;
  if (control.watch) watch = control.watch(label);
  if (!watch && control.stopped) watch = [&control](const Progress&) { return !control.stopped(); };
  const Observe observe = first ? control.observe : Observe();
  std::optional<HistoryFile> file;
  Keeping keeping;
  if (control.folder != nullptr && !histories.empty()) {
    file.emplace(*control.folder, histories);
    keeping.follow = [&](const RunResult& so_far) { file->follow(so_far); };
  }
  KeptRun kept(control.checkpoints, label, built.model.free());
  std::optional<RunState> begin;
  if (const ReducedModel* reduced = loaded.from.reduced.get(); reduced != nullptr) {
    const Values& root = loaded.read.values;
    RunResult resting;
    begin = begin_reduced(*reduced, root.where("reduced_model"), built, watch, resting);
    if (!begin) return resting;
    keeping.from = &*begin;
  }
  std::optional<FieldRun> fields;
  if (field_lists != nullptr && control.folder != nullptr && loaded.read.input->output.fields)
    fields.emplace(loaded.read, built, *control.folder);
  kept.attach(keeping, watch, fields ? &*fields : nullptr);
  if (!fields) return run(built.model, built.plan, built.behaviours, watch, observe, &keeping);
  const Observe both = [&](const Snapshot& snapshot) {
    fields->see(snapshot);
    if (observe) observe(snapshot);
  };
  RunResult result = run(built.model, built.plan, built.behaviours, watch, both, &keeping);
  fields->finish(result);
  field_lists->push_back(fields->list());
  return result;
}

void add_statement(const LoadedCase& loaded, std::vector<std::string>& warnings) {
  if (loaded.from.reduced != nullptr) warnings.insert(warnings.begin(), loaded.from.reduced->statement(loaded.from.reduced_file));
}

void free_matrices(BuiltCase& built) {
  built.model.distributed.reset();
  ModelMatrices().swap(built.model);  // an assignment would keep the memory
  built.plan.rest.reset();
}

}  // namespace uplift
