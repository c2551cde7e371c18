#include "uplift/dynamics/plastic_bulk.h"

#include <algorithm>
#include <cassert>

namespace uplift {

PlasticBulk::PlasticBulk(const Model& model) : model_(model) {
  for (const auto& element : model.elements)
    if (const int size = element->num_history(); size > 0) {
      elements_.push_back(
          {element.get(), history_, static_cast<std::size_t>(size), static_cast<std::size_t>(element->unknowns()), index_.size(), parts_});
      history_ += elements_.back().size;
      parts_ += elements_.back().unknowns + 1;
      for (const int node : element->nodes())
        for (int c = 0; c < element->unknowns_per_node(); ++c) index_.push_back(model.space.unknowns() * node + c);
    }
  if (any()) spread_ = model.expansion.cwiseAbs(), reduction_ = model.reduction();
}

void PlasticBulk::of_element(const One& one, const Vector& full, Vector& result) const {
  result.resize(static_cast<Index>(one.unknowns));
  double* to = result.data();
  for (const int place : places(one)) *to++ = full[place];
}

void PlasticBulk::keep_part(const One& one, PlasticState& state) const {
  double* part = state.parts.data() + one.first_part;
  std::copy_n(scratch_.inelastic.force.data(), one.unknowns, part);
  part[one.unknowns] = scratch_.inelastic.energy;
}

void PlasticBulk::add_parts(PlasticState& state) const {
  state.full.setZero(model_.full_unknowns());
  state.energy = 0;
  const double* part = state.parts.data();
  for (const One& one : elements_) {
    for (const int place : places(one)) state.full[place] += *part++;
    state.energy += *part++;
  }
  state.force = model_.expansion * state.full;
}

PlasticState PlasticBulk::state(std::vector<double> history) const {
  PlasticState made;
  made.history = std::move(history);
  if (made.history.empty()) made.history.assign(history_, 0.0);
  assert(made.history.size() == history_);
  made.parts.assign(parts_, 0.0);
  for (const One& one : elements_) {
    const auto history_of_one = history_of(one, made.history);
    if (!one.element->has_yielded(history_of_one)) continue;
    one.element->find_inelastic(history_of_one, scratch_.element, scratch_.inelastic);
    keep_part(one, made);
  }
  add_parts(made);
  return made;
}

BulkResponse PlasticBulk::respond(const Vector& displacement, const Update& step, PlasticState& now, Vector* size) const {
  const Vector full = model_.full(displacement, 0, step.at);
  scratch_.element.duration = step.duration;
  Vector& sizes = scratch_.sizes;
  if (size) sizes.setZero(full.size());
  now.history.resize(history_);
  now.parts.resize(parts_);
  std::copy(step.old.parts.begin(), step.old.parts.end(), now.parts.begin());
  for (const One& one : elements_) {
    of_element(one, full, scratch_.displacement);
    const auto before = history_of(one, step.old.history);
    const auto history = std::span(now.history).subspan(one.first, one.size);
    BulkResponse response =
        one.element->respond(scratch_.displacement, before, history, scratch_.element, size ? &scratch_.force : nullptr, nullptr);
    if (!response.converged) return response;
    if (size) {
      const double* force = scratch_.force.data();
      for (const int place : places(one)) sizes[place] += std::abs(*force++);
    }
    if (!one.element->yields(before, history)) continue;  // its part is that of the beginning
    one.element->find_inelastic_of_response(history, scratch_.element, scratch_.inelastic);
    keep_part(one, now);
  }
  add_parts(now);
  if (size) *size = spread_ * sizes;
  return {};
}

Sparse PlasticBulk::softening(const Vector& displacement, const Update& step, const PlasticState& now, bool& whole) const {
  constexpr double round_off = 1e-7;
  whole = true;
  const Vector full = model_.full(displacement, 0, step.at);
  scratch_.element.duration = step.duration;
  std::vector<Triplet> entries;
  std::vector<double> history;
  Matrix tangent, elastic;
  for (const One& one : elements_) {
    const auto before = history_of(one, step.old.history), after = history_of(one, now.history);
    history.assign(after.begin(), after.end());  // the modes begin where `respond` has found their balance
    of_element(one, full, scratch_.displacement);
    if (one.element->yields(before, after) &&
        one.element->respond(scratch_.displacement, before, history, scratch_.element, nullptr, &tangent).converged) {
      one.element->form({&elastic, nullptr, nullptr});
      whole = whole && (tangent - tangent.transpose()).norm() <= round_off * elastic.norm();
      tangent = (0.5 * (tangent + tangent.transpose()) - elastic).eval();
    } else {
      tangent.setZero(one.element->unknowns(), one.element->unknowns());  // so that all tangents have their entries in the same places
    }
    const auto place = places(one);
    const auto unknown = [&](Index i) { return place[static_cast<std::size_t>(i)]; };
    for (Index j = 0; j < tangent.cols(); ++j)
      for (Index i = 0; i < tangent.rows(); ++i) entries.emplace_back(unknown(i), unknown(j), tangent(i, j));
  }
  Sparse assembled(full.size(), full.size());
  assembled.setFromTriplets(entries.begin(), entries.end());
  return model_.expansion * assembled * reduction_;
}

double PlasticBulk::energy(const Vector& displacement, MotionInstant at, const PlasticState& state) const {
  return model_.full(displacement, 0, at).dot(state.full) + state.energy;
}

double PlasticBulk::dissipated(const Vector& from, MotionInstant before, const PlasticState& old, const Vector& to, MotionInstant after,
                               const PlasticState& now) const {
  const Vector u0 = model_.full(from, 0, before), u1 = model_.full(to, 0, after);
  Vector from_element, to_element;
  double sum = 0;
  for (const One& one : elements_) {
    const auto was = history_of(one, old.history), is = history_of(one, now.history);
    if (!one.element->yields(was, is)) continue;
    of_element(one, u0, from_element);
    of_element(one, u1, to_element);
    sum += one.element->dissipated(from_element, was, to_element, is);
  }
  return sum;
}

double PlasticBulk::support_work(MotionInstant before, const PlasticState& old, MotionInstant after, const PlasticState& now) const {
  double work = 0;
  for (const PrescribedMotion& motion : model_.motions) {
    const auto moved = [&](const MotionInstant& at) { return at.share * motion.function->value(at.time); };
    work += 0.5 * (old.full + now.full).dot(motion.shape) * (moved(after) - moved(before));
  }
  return work;
}

}  // namespace uplift
