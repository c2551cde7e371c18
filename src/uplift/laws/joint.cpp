#include "uplift/laws/joint.h"

#include <algorithm>
#include <utility>

#include "uplift/base/text.h"
#include "uplift/laws/filter.h"
#include "uplift/laws/tangential.h"

namespace uplift {
namespace {

class JointLaw final : public InterfaceLaw {
 public:
  JointLaw(std::unique_ptr<const NormalLaw> normal, std::unique_ptr<const TangentialPart> tangential)
      : normal_(std::move(normal)), tangential_(std::move(tangential)) {}

  int num_history(int components) const override {
    return normal_->num_history() + (components > 1 ? tangential_->num_history(components - 1) : 0);
  }

  void respond(const Batch& batch, const double* from, const double* to, const double* old, const LawResponse& response) const override {
    if (batch.components == 1) return normal_->respond(batch, from, to, old, response);
    const int normal = batch.normal();
    normal_->respond(one_component(batch), from + normal, to + normal, old, normal_response(batch, response));
    tangential_->respond(call(batch, from, to, old, response));
  }

  void mean(const Batch& batch, const double* from, const double* to, const double* old, const LawResponse& response) const override {
    const int normal = batch.normal();
    const LawResponse part = batch.components == 1 ? response : normal_response(batch, response);
    normal_->mean(one_component(batch), from + normal, to + normal, old, part);
    if (batch.coefficient != nullptr) filter(batch, from + normal, to + normal, part);
    if (batch.components == 1) return;
    tangential_->mean(call(batch, from, to, old, response));
    if (response.next != nullptr) std::copy_n(response.slope, others(batch), response.next);
  }

  bool fused(const FusedEvaluation& evaluation) const override { return normal_->fused(evaluation); }

  void energy(const Batch& batch, const double* opening, const double* history, double* stored, double* dissipated) const override {
    normal_->energy(one_component(batch), opening + batch.normal(), history, stored, dissipated);
    if (batch.components > 1)
      tangential_->add_energy(batch, *normal_, opening, history, history + normal_->num_history() * batch.points, stored, dissipated);
  }

  void closed_stiffness(int components, double* stiffness) const override {
    std::fill_n(stiffness, components - 1, tangential_->stiffness());
    stiffness[components - 1] = normal_->stiffness();
  }

  LawScales scales() const override { return normal_->scales(); }
  std::optional<EquivalentLaw> equivalent() const override { return normal_->equivalent(); }

 private:
  static Batch one_component(const Batch& batch) { return {batch.points, 1, batch.step}; }

  /// The normal part of the joint filter, on the response of the normal law.
  void filter(const Batch& batch, const double* from, const double* to, const LawResponse& part) const {
    const double *coefficient = batch.coefficient + batch.normal(), *lag = batch.lag + batch.normal();
    const bool tension = normal_->carries_tension();
    const double per_step = batch.step > 0 ? normal_->dashpot() / batch.step : 0;  // c/step [Pa/m]
    for (int i = 0; i < batch.points; ++i) {
      double value = part.traction[i], slope = part.slope != nullptr ? part.slope[i] : 0;
      part.plain[i] = value;
      double end = part.end[i], end_slope = 2 * part.next[i];
      // a dashpot brakes from the contact on: its mean over the step is c/step to, its force at the end c/step (to - from)
      if (from[i] > 0 && to[i] < 0) end += per_step * from[i], end_slope -= per_step;
      filter_normal(value, slope, end, end_slope, to[i] - from[i], coefficient[i], lag[i], tension, false);
      part.traction[i] = value;
      if (part.slope != nullptr) part.slope[i] = slope;
    }
  }

  /// The normal part of the response; the rest of the slope becomes zero.
  static LawResponse normal_response(const Batch& batch, const LawResponse& response) {
    LawResponse part = response;
    part.traction += batch.normal();
    if (response.end != nullptr) part.end += batch.normal();
    if (response.slope != nullptr) {
      std::fill_n(response.slope, others(batch), 0.0);
      part.slope += others(batch);
    }
    if (response.next != nullptr) part.next += others(batch);
    if (response.plain != nullptr) part.plain += batch.normal();
    return part;
  }

  /// Entries of the slope before those of the normal part.
  static int others(const Batch& batch) { return (batch.components * batch.components - 1) * batch.points; }

  TangentialCall call(const Batch& batch, const double* from, const double* to, const double* old, const LawResponse& response) const {
    const int first = normal_->num_history() * batch.points;
    return {batch, *normal_, from, to, old, old + first, response, response.now != nullptr ? response.now + first : nullptr};
  }

  std::unique_ptr<const NormalLaw> normal_;
  std::unique_ptr<const TangentialPart> tangential_;
};

/// "soil" is a word for the case, which knows the soil.
void refuse_words(const Values& values) {
  for (const char* key : {"K_n", "K_t", "c"})
    if (values.items().contains(key) && values.is_word(key)) fail(values, key, "a number", in_quotes(values.text(key)));
}

}  // namespace

Entry<InterfaceLaw> joint_entry(PartInfo info, const char* tangential, std::unique_ptr<const NormalLaw> (*make)(const Values&)) {
  for (Field& field : tangential_fields(tangential)) info.params.push_back(std::move(field));
  return {std::move(info), [make](const Values& values) -> std::unique_ptr<const InterfaceLaw> {
            refuse_words(values);
            auto normal = make(values);
            const double stiffness = normal->stiffness();
            return std::make_unique<JointLaw>(std::move(normal), make_tangential(values, stiffness));
          }};
}

}  // namespace uplift
