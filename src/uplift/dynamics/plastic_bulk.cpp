#include "uplift/dynamics/plastic_bulk.h"

#include <cassert>

namespace uplift {

PlasticBulk::PlasticBulk(const Model& model) : model_(model) {
  for (const auto& element : model.elements)
    if (const auto* solid = dynamic_cast<const NonlinearSolid*>(element.get()); solid != nullptr) {
      solids_.push_back({solid, history_});
      history_ += static_cast<std::size_t>(solid->num_history());
    }
  if (any()) spread_ = model.expansion.cwiseAbs();
}

Vector PlasticBulk::of_element(const NonlinearSolid& solid, const Vector& full) const {
  Vector result(solid.unknowns());
  const int each = solid.unknowns_per_node();
  Index i = 0;
  for (const int node : solid.nodes())
    for (int c = 0; c < each; ++c) result[i++] = full[model_.space.unknowns() * node + c];
  return result;
}

std::span<const double> PlasticBulk::history_of(const One& one, const std::vector<double>& all) const {
  return std::span(all).subspan(one.first, static_cast<std::size_t>(one.solid->num_history()));
}

void PlasticBulk::gather(PlasticState& state) const {
  state.full.setZero(model_.full_unknowns());
  state.energy = 0;
  for (const One& one : solids_) {
    const auto history = history_of(one, state.history);
    if (!one.solid->has_yielded(history)) continue;
    const NonlinearSolid::Yielded part = one.solid->yielded(history);
    const int each = one.solid->unknowns_per_node();
    Index i = 0;
    for (const int node : one.solid->nodes())
      for (int c = 0; c < each; ++c) state.full[model_.space.unknowns() * node + c] += part.force[i++];
    state.energy += part.energy;
  }
  state.force = model_.expansion * state.full;
}

PlasticState PlasticBulk::state(std::vector<double> history) const {
  PlasticState made;
  made.history = std::move(history);
  if (made.history.empty()) made.history.assign(history_, 0.0);
  assert(made.history.size() == history_);
  gather(made);
  return made;
}

BulkResponse PlasticBulk::respond(const Vector& displacement, MotionInstant at, const std::vector<double>& old, PlasticState& now,
                                  Vector& size) const {
  const Vector full = model_.full(displacement, 0, at);
  Vector sizes = Vector::Zero(full.size()), force;
  now.history.resize(history_);
  for (const One& one : solids_) {
    const auto count = static_cast<std::size_t>(one.solid->num_history());
    const BulkResponse response = one.solid->respond(of_element(*one.solid, full), history_of(one, old),
                                                     std::span(now.history).subspan(one.first, count), force, nullptr);
    if (!response.converged) return response;
    const int each = one.solid->unknowns_per_node();
    Index i = 0;
    for (const int node : one.solid->nodes())
      for (int c = 0; c < each; ++c) sizes[model_.space.unknowns() * node + c] += std::abs(force[i++]);
  }
  gather(now);
  size = spread_ * sizes;
  return {};
}

Sparse PlasticBulk::softening(const Vector& displacement, MotionInstant at, const std::vector<double>& old, const PlasticState& now) const {
  const Vector full = model_.full(displacement, 0, at);
  std::vector<Triplet> entries;
  std::vector<double> unused;
  Vector force;
  Matrix tangent, elastic;
  for (const One& one : solids_) {
    const auto before = history_of(one, old);
    if (!one.solid->yields(before, history_of(one, now.history))) continue;
    unused.assign(before.begin(), before.end());
    if (!one.solid->respond(of_element(*one.solid, full), before, unused, force, &tangent).converged) continue;
    one.solid->form({&elastic, nullptr, nullptr});
    tangent = (0.5 * (tangent + tangent.transpose()) - elastic).eval();
    const auto nodes = one.solid->nodes();
    const int each = one.solid->unknowns_per_node();
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

double PlasticBulk::dissipated(const Vector& from, double before, const PlasticState& old, const Vector& to, double after,
                               const PlasticState& now) const {
  const Vector u0 = model_.full(from, 0, before), u1 = model_.full(to, 0, after);
  double sum = 0;
  for (const One& one : solids_) {
    const auto was = history_of(one, old.history), is = history_of(one, now.history);
    if (one.solid->yields(was, is)) sum += one.solid->dissipated(of_element(*one.solid, u0), was, of_element(*one.solid, u1), is);
  }
  return sum;
}

double PlasticBulk::support_work(double before, const PlasticState& old, double after, const PlasticState& now) const {
  double work = 0;
  for (const PrescribedMotion& motion : model_.motions)
    work += 0.5 * (old.full + now.full).dot(motion.shape) * (motion.function->value(after) - motion.function->value(before));
  return work;
}

}  // namespace uplift
