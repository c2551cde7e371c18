#include "uplift/run/force_record.h"

#include <algorithm>

namespace uplift {

bool asks_for_forces(const RunPlan& plan) {
  return !plan.envelopes.empty() ||
         std::ranges::any_of(plan.requests, [](const Request& request) { return request.kind == Request::Kind::force; });
}

ForceRecorder::ForceRecorder(const ForceStage& stage, const RunPlan& plan, const Stepper* stepper, const State& state, Recorded& result)
    : plan_(plan), stepper_(stepper), state_(state), result_(result), start_(Vector::Zero(stage.model.free())) {
  for (const Request& request : plan.requests)
    if (request.kind == Request::Kind::force) quantities_.push_back(request.force.get());
  first_of_envelopes_ = quantities_.size();
  const bool fresh = result.envelopes.empty();  // a later dynamic stage continues
  for (const EnvelopeRequest& envelope : plan.envelopes) {
    for (const auto& force : envelope.forces) quantities_.push_back(force.get());
    if (fresh)
      result.envelopes.push_back({envelope.beam, envelope.components, envelope.sections, std::vector<ForceRange>(envelope.forces.size())});
  }
  meter_ = std::make_unique<const ForceMeter>(ForceModel(stage), quantities_);
  values_.resize(quantities_.size());
  if (fresh && stepper_ != nullptr) stepper_->acceleration(start_);
}

const double* ForceRecorder::value(const Request& request) const {
  return values_.data() + (std::ranges::find(quantities_, request.force.get()) - quantities_.begin());
}

void ForceRecorder::record() {
  const StepBalance balance = stepper_ != nullptr ? stepper_->balance(start_) : StepBalance::at_rest(state_, start_);
  meter_->measure(balance, values_);
  std::size_t next = first_of_envelopes_;
  for (BeamEnvelope& envelope : result_.envelopes)
    for (ForceRange& range : envelope.ranges) range.add(values_[next++], balance.time());
}

}  // namespace uplift
