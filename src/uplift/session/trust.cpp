#include <thread>

#include "uplift/io/results/trust_json.h"
#include "uplift/linear/memory.h"
#include "uplift/session/steps.h"

namespace uplift {

namespace {

/// The repetitions are read from the text of the case, which does not contain the functions of the caller.
void refuse_external(const BuiltCase& built) {
  for (const Values* behaviour : built.behaviours)
    if (is_external(*behaviour))
      throw InputError(behaviour->where(), behaviour->path(), "a law of the program for a statement of reliability",
                       "a law of type \"external\"");
}

}  // namespace

Results trust_case(const LoadedCase& loaded, const Control& control) {
  return trust_case(loaded, control, [&control](const TrustSamples& samples) {
    const int threads = runs_side_by_side(static_cast<int>(std::thread::hardware_concurrency()));
    return compute_samples(samples, threads, control.watch ? control.watch("trust") : Watch());
  });
}

Results trust_case(const LoadedCase& loaded, const Control& control, const ComputeSamples& compute) {
  if (loaded.from.reduced != nullptr)
    throw InputError(loaded.read.values.where("reduced_model"), "reduced_model", "the whole model for a statement of reliability",
                     "a reduced model, which belongs to one mesh and one damping");
  Results results;
  for (const RunSpec& spec : runs_of_case(loaded.read)) {
    const bool first = results.runs.empty();
    results.specs.push_back(spec);
    append_run(loaded, spec, results.built);
    if (first) refuse_external(results.built.front());
    if (first) results.warnings = warnings(loaded.read, spec, results.built.front());
    results.runs.push_back(run_built(loaded, results.built.back(), spec.label, control, first, nullptr));
  }
  const BuiltCase& built = results.built.front();
  const RunResult* bonded = results.runs.size() > 1 ? &results.runs[1] : nullptr;
  const TrustSamples samples = trust_samples(loaded.raw, loaded.read, loaded.read_mesh);
  results.trust = trust_answer(loaded.read, samples, compute(samples), {built, results.runs.front(), bonded});
  results.floors = floor_answers(built.plan, results.runs, results.specs);
  results.verdict = judge(built, results.runs.front(), bonded, &results.floors.runs.front());
  results.verdict.step_check.reason = "the bands include a run with half the step";
  const std::string bands = trust_sentence(*results.trust);
  results.verdict.consequence += (results.verdict.consequence.empty() || bands.empty() ? "" : " ") + bands;
  return results;
}

}  // namespace uplift
