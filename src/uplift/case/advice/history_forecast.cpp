#include "uplift/case/advice/history_forecast.h"

#include <fmt/format.h>

#include <cmath>

#include "uplift/base/text.h"
#include "uplift/case/schema/case_input.h"
#include "uplift/linear/memory.h"

namespace uplift {

HistoryForecast forecast_histories(const RunPlan& plan, std::size_t interfaces) {
  constexpr double text_bytes = 13;  // of a number with ten digits at most and its comma, on average
  constexpr double tail_share = 0.1;
  HistoryForecast made;
  for (const Stage& stage : plan.stages) {
    if (stage.type == Stage::Type::dynamics)
      made.steps += std::round(stage.duration / stage.step);
    else if (statics_alone(plan))
      made.rows += stage.steps;
  }
  made.rows += std::floor(made.steps / plan.every) + 1;
  made.columns = 1 + static_cast<double>(plan.requests.size());
  const double per_step = sizeof(double) + static_cast<double>(interfaces) * (sizeof(StepRecord::Instant) + tail_share * sizeof(BasePose));
  made.memory = sizeof(double) * made.rows * made.columns + per_step * made.steps;
  made.disk = text_bytes * made.rows * made.columns;
  return made;
}

void check_history_memory(const Case& read, const BuiltCase& built) {
  constexpr double small = 1e8;  // bytes: fits anywhere
  const HistoryForecast histories = forecast_histories(built.plan, built.model.interfaces.size());
  if (histories.memory <= small) return;
  const double available = available_memory();
  if (histories.memory <= available) return;
  fail(read.input->output, "every", fmt::format("histories that fit into the {} of available memory", format_bytes(available)),
       fmt::format("{} for {:.4g} steps (a larger step, a shorter duration or a larger `every` takes less)", format_bytes(histories.memory),
                   histories.steps));
}

}  // namespace uplift
