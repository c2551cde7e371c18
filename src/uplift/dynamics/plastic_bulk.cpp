#include "uplift/dynamics/plastic_bulk.h"

#include <cassert>

namespace uplift {

PlasticBulk::PlasticBulk(const Model& model) : model_(model) {
  for (const auto& element : model.elements)
    if (const int size = element->num_history(); size > 0) {
      elements_.push_back({element.get(), history_});
      history_ += static_cast<std::size_t>(size);
    }
  if (any()) spread_ = model.expansion.cwiseAbs();
}

void PlasticBulk::of_element(const Element& element, const Vector& full, Vector& result) const {
  result.resize(element.unknowns());
  const int each = element.unknowns_per_node();
  Index i = 0;
  for (const int node : element.nodes())
    for (int c = 0; c < each; ++c) result[i++] = full[model_.space.unknowns() * node + c];
}

std::span<const double> PlasticBulk::history_of(const One& one, const std::vector<double>& all) const {
  return std::span(all).subspan(one.first, static_cast<std::size_t>(one.element->num_history()));
}

void PlasticBulk::clear(PlasticState& state) const {
  state.full.setZero(model_.full_unknowns());
  state.energy = 0;
}

void PlasticBulk::add_inelastic(const Element& element, PlasticState& state) const {
  const int each = element.unknowns_per_node();
  Index i = 0;
  for (const int node : element.nodes())
    for (int c = 0; c < each; ++c) state.full[model_.space.unknowns() * node + c] += scratch_.inelastic.force[i++];
  state.energy += scratch_.inelastic.energy;
}

PlasticState PlasticBulk::state(std::vector<double> history) const {
  PlasticState made;
  made.history = std::move(history);
  if (made.history.empty()) made.history.assign(history_, 0.0);
  assert(made.history.size() == history_);
  clear(made);
  for (const One& one : elements_) {
    const auto history_of_one = history_of(one, made.history);
    if (!one.element->has_yielded(history_of_one)) continue;
    one.element->find_inelastic(history_of_one, scratch_.element, scratch_.inelastic);
    add_inelastic(*one.element, made);
  }
  made.force = model_.expansion * made.full;
  return made;
}

BulkResponse PlasticBulk::respond(const Vector& displacement, const Update& step, PlasticState& now, Vector& size) const {
  const Vector full = model_.full(displacement, 0, step.at);
  scratch_.element.duration = step.duration;
  Vector& sizes = scratch_.sizes;
  sizes.setZero(full.size());
  now.history.resize(history_);
  clear(now);
  for (const One& one : elements_) {
    of_element(*one.element, full, scratch_.displacement);
    const auto history = std::span(now.history).subspan(one.first, static_cast<std::size_t>(one.element->num_history()));
    BulkResponse response =
        one.element->respond(scratch_.displacement, history_of(one, step.old), history, scratch_.element, scratch_.force, nullptr);
    if (!response.converged) return response;
    const int each = one.element->unknowns_per_node();
    Index i = 0;
    for (const int node : one.element->nodes())
      for (int c = 0; c < each; ++c) sizes[model_.space.unknowns() * node + c] += std::abs(scratch_.force[i++]);
    if (!one.element->has_yielded(history)) continue;
    one.element->find_inelastic_of_response(history, scratch_.element, scratch_.inelastic);
    add_inelastic(*one.element, now);
  }
  now.force = model_.expansion * now.full;
  size = spread_ * sizes;
  return {};
}

Sparse PlasticBulk::softening(const Vector& displacement, const Update& step, const PlasticState& now, bool& whole) const {
  constexpr double round_off = 1e-7;
  whole = true;
  const Vector full = model_.full(displacement, 0, step.at);
  scratch_.element.duration = step.duration;
  std::vector<Triplet> entries;
  std::vector<double> unused;
  Matrix tangent, elastic;
  for (const One& one : elements_) {
    const auto before = history_of(one, step.old);
    unused.assign(before.begin(), before.end());
    of_element(*one.element, full, scratch_.displacement);
    if (one.element->yields(before, history_of(one, now.history)) &&
        one.element->respond(scratch_.displacement, before, unused, scratch_.element, scratch_.force, &tangent).converged) {
      one.element->form({&elastic, nullptr, nullptr});
      whole = whole && (tangent - tangent.transpose()).norm() <= round_off * elastic.norm();
      tangent = (0.5 * (tangent + tangent.transpose()) - elastic).eval();
    } else {
      tangent.setZero(one.element->unknowns(), one.element->unknowns());  // so that all tangents have their entries in the same places
    }
    const auto nodes = one.element->nodes();
    const int each = one.element->unknowns_per_node();
    const auto unknown = [&](Index i) {
      return model_.space.unknowns() * nodes[static_cast<std::size_t>(i / each)] + static_cast<int>(i % each);
    };
    for (Index j = 0; j < tangent.cols(); ++j)
      for (Index i = 0; i < tangent.rows(); ++i) entries.emplace_back(unknown(i), unknown(j), tangent(i, j));
  }
  Sparse assembled(full.size(), full.size());
  assembled.setFromTriplets(entries.begin(), entries.end());
  return model_.expansion * assembled * model_.reduction;
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
    of_element(*one.element, u0, from_element);
    of_element(*one.element, u1, to_element);
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
