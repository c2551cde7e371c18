#include "uplift/run/equilibrium.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "uplift/model/reduced.h"
#include "uplift/run/force_rows.h"

namespace uplift {

/// The balanced motion is kept on the free unknowns: there are twice as many full ones in a mesh of solids. Of an instant that is summed
/// up at once it is not copied.
struct EquilibriumCheck::Snapshot {
  struct Motion {
    double (StepBalance::*part)(Index) const;
    Vector free;  // empty: `balance` has it
    const StepBalance* balance = nullptr;
    std::vector<double> prescribed = {};  // of each prescribed motion of the model, for a shape of 1
    /// Of a free unknown.
    double of_free(Index unknown) const { return balance != nullptr ? (balance->*part)(unknown) : free[unknown]; }
    /// Of a full unknown.
    double at(const Model& model, Index unknown) const {
      double sum = 0;
      for (Sparse::InnerIterator entry(model.expansion, unknown); entry; ++entry) sum += entry.value() * of_free(entry.row());
      for (std::size_t k = 0; k < prescribed.size(); ++k) sum += prescribed[k] * model.motions[k].shape[unknown];
      return sum;
    }
  };
  Motion displacement{&StepBalance::displacement, {}}, velocity{&StepBalance::velocity, {}}, acceleration{&StepBalance::acceleration, {}};
  Vector joint;
  Vector unbalanced;  // M a + C v + K u + B^T p - f, full unknowns; before the elements: -f. Held forces are part of f
  Vector yielding;
  Equilibrium::Instant sums;
};

namespace {

/// Adds a force on one unknown.
void add(double value, Space space, const Vec3& arm, Index unknown, Equilibrium::Sum& sum) {
  const Vec3 axis = space.axis(space.index_of(unknown));
  if (space.is_rotation(unknown)) {
    sum.moment += value * axis;
  } else {
    sum.force += value * axis;
    sum.moment += value * cross(arm, axis);
  }
}

/// A^T x, of which many full unknowns at a time are handed out: all of them are a large vector.
template <class Take>
void each_part(const Sparse& a, const Vector& x, const Take& take) {
  constexpr Index many = 4096;
  for (Index first = 0; first < a.cols(); first += many)
    take(first, Vector(a.middleCols(first, std::min(many, a.cols() - first)).transpose() * x));
}

double largest(const Vec3& v) {
  return v.cwiseAbs().maxCoeff();
}

}  // namespace

std::string Equilibrium::warning() const {
  if (!(residual > 1e-6)) return {};
  return fmt::format(
      "The forces on the whole model are not in equilibrium at t = {:.6g} s: the unbalanced part is {:.2g} of the largest force "
      "(or moment). Reactions and section forces there are no better than that.",
      time, residual);
}

EquilibriumCheck::EquilibriumCheck(const ForceStage& stage, int most)
    : stage_(std::make_unique<const ForceStage>(stage)), at_once_(stage.model.full_unknowns() > most) {
  const std::vector<Node>& nodes = stage.model.nodes;
  for (const Node& node : nodes) centre_ += node.position / static_cast<double>(nodes.size());
}

EquilibriumCheck::~EquilibriumCheck() = default;

void EquilibriumCheck::note(const StepBalance& balance) {
  const Model& model = stage_->model;
  if (is_reduced(model)) return;  // in equilibrium against the motions of its basis alone
  const Index free = model.free(), rows = model.rows();
  Snapshot at;
  at.sums.time = balance.time();
  for (Snapshot::Motion* motion : {&at.displacement, &at.velocity, &at.acceleration}) {
    if (at_once_) {
      motion->balance = &balance;
      continue;
    }
    motion->free.resize(free);
    for (Index i = 0; i < free; ++i) motion->free[i] = (balance.*motion->part)(i);
  }
  at.joint.resize(rows);
  for (Index i = 0; i < rows; ++i) at.joint[i] = balance.force(i);
  for (const PrescribedMotion& motion : model.motions) {
    at.displacement.prescribed.push_back(balance.motion(*motion.function, 0));
    at.velocity.prescribed.push_back(balance.motion(*motion.function, 1));
    at.acceleration.prescribed.push_back(balance.motion(*motion.function, 2));
  }
  Vector applied = Vector::Zero(model.full_unknowns());
  const double begin = balance.share_of_begin();
  for (std::size_t i = 0; i < model.time_loads.size(); ++i) {
    const TimeLoad& time_load = model.time_loads[i];
    if (i < model.assembly.loads.size() && model.assembly.loads[i].size() > 0)
      applied += (time_load.constant ? balance.load_factor() : balance.value(*time_load.function, static_cast<int>(time_load.order))) *
                 model.assembly.loads[i];
  }
  for (std::size_t i = 0; balance.moves() && i < model.time_load_tables.size(); ++i) {
    Vector last, first;
    model.time_load_tables[i].functions->values(balance.after().time, last);
    model.time_load_tables[i].functions->values(balance.before().time, first);
    applied += model.assembly.time_load_tables[i] * Vector((1 - begin) * last + begin * first);
  }
  if (const PlasticBulk yielding(model); yielding.any())
    at.yielding =
        (1 - begin) * yielding.state(balance.after().bulk_history).full + begin * yielding.state(balance.before().bulk_history).full;
  if (stage_->held != nullptr && stage_->held->size() > 0)
    for (Index i = 0; i < free; ++i) {
      const int unknown = model.kept[static_cast<std::size_t>(i)];
      const double held = (*stage_->held)[i];
      applied[unknown] += held;
      // the weight on released supports cancels what they have borne: at rest every sum is round-off
      if (!model.space.is_rotation(model.space.index_of(unknown)))
        at.sums.largest_reaction = std::max(at.sums.largest_reaction, std::abs(held));
    }
  sum_up(applied, 1, at.sums.applied);
  at.unbalanced.swap(applied);
  at.unbalanced *= -1;
  snapshots_.push_back(std::move(at));
  if (at_once_) balance_snapshots();
}

void EquilibriumCheck::sum_up(const Vector& forces, double sign, Equilibrium::Sum& sum, Index first) const {
  const Model& model = stage_->model;
  for (Index i = 0; i < forces.size(); ++i)
    if (forces[i] != 0) {
      const Index at = first + i;
      add(sign * forces[i], model.space, model.nodes[static_cast<std::size_t>(model.space.node_of(at))].position - centre_, at, sum);
    }
}

/// Every element is formed once and answers all instants.
void EquilibriumCheck::add_elements() {
  const Model& model = stage_->model;
  const Space space = model.space;
  Matrix stiffness, mass, damping;
  for (const auto& element : model.elements) {
    const int each = element->unknowns_per_node();
    const auto nodes = element->nodes();
    element->form({.stiffness = &stiffness, .mass = &mass, .damping = &damping});
    damping += (model.assembly.stiffness_damping + element->beta) * stiffness + model.assembly.mass_damping * mass;
    const auto unknown = [&](Index i) { return space.unknowns() * nodes[static_cast<std::size_t>(i) / each] + static_cast<int>(i) % each; };
    Vector u(stiffness.cols()), v(u), a(u);
    for (Snapshot& at : snapshots_) {
      for (Index i = 0; i < u.size(); ++i)
        u[i] = at.displacement.at(model, unknown(i)), v[i] = at.velocity.at(model, unknown(i)),
        a[i] = at.acceleration.at(model, unknown(i));
      const Vector internal = stiffness * u, damped = damping * v, inertia = mass * a;
      for (Index i = 0; i < u.size(); ++i) {
        const Vec3 arm = model.nodes[static_cast<std::size_t>(nodes[static_cast<std::size_t>(i) / each])].position - centre_;
        at.unbalanced[unknown(i)] += internal[i] + damped[i] + inertia[i];
        add(-internal[i], space, arm, unknown(i), at.sums.internal);
        add(-damped[i], space, arm, unknown(i), at.sums.damping);
        add(-inertia[i], space, arm, unknown(i), at.sums.inertia);
      }
    }
  }
  for (Snapshot& at : snapshots_) {  // what no other force asks for
    at.acceleration.free.resize(0);
    if (stage_->second_order == nullptr) at.displacement.free.resize(0);
    if (model.assembly.modal_damping.cols() == 0) at.velocity.free.resize(0);
  }
}

void EquilibriumCheck::add_forces(const ForceModel& forces, Snapshot& at) const {
  const Model& model = stage_->model;
  const auto put = [&](const Vector& internal, Equilibrium::Sum& sum, Index first = 0) {
    at.unbalanced.segment(first, internal.size()) += internal;
    sum_up(internal, -1, sum, first);
  };
  if (model.assembly.b.rows() > 0)
    each_part(model.assembly.b, at.joint, [&](Index first, const Vector& internal) { put(internal, at.sums.joint, first); });
  if (stage_->second_order != nullptr) {
    Vector displacement(model.full_unknowns());
    for (Index i = 0; i < displacement.size(); ++i) displacement[i] = at.displacement.at(model, i);
    put(stage_->second_order->stiffness * displacement, at.sums.second_order);
  }
  if (at.yielding.size() > 0) put(at.yielding, at.sums.internal);
  if (model.assembly.modal_damping.cols() > 0) {
    Vector velocity(model.free());
    for (Index i = 0; i < velocity.size(); ++i) velocity[i] = at.velocity.of_free(i);
    const Vector damped = model.assembly.modal_damping * velocity;
    Vector full = Vector::Zero(model.full_unknowns());
    for (Index i = 0; i < damped.size(); ++i) full[model.kept[static_cast<std::size_t>(i)]] = damped[i];
    put(full, at.sums.damping);
  }
  each_part(model.assembly.constraints, forces.constraint_factors(at.unbalanced), [&](Index first, const Vector& reactions) {
    for (Index i = 0; i < reactions.size(); ++i)
      if (!model.space.is_rotation(model.space.index_of(static_cast<int>(first + i))))
        at.sums.largest_reaction = std::max(at.sums.largest_reaction, std::abs(reactions[i]));
    sum_up(reactions, 1, at.sums.reactions, first);
    sum_up(reactions - at.unbalanced.segment(first, reactions.size()), 1, at.sums.residual, first);
  });
}

/// Turns the snapshots into their sums.
void EquilibriumCheck::balance_snapshots() {
  // The rows of a rigid body are coupled by its reference node: their forces cost the third power of its size.
  constexpr std::size_t most_tied = 250;
  if (stage_->model.assembly.ties.size() > most_tied) snapshots_.clear();
  if (snapshots_.empty()) return;
  add_elements();
  const ForceModel forces(*stage_);
  for (Snapshot& at : snapshots_) {
    add_forces(forces, at);
    instants_.push_back(at.sums);
  }
  snapshots_.clear();
}

void EquilibriumCheck::finish(Equilibrium& equilibrium) {
  balance_snapshots();
  if (instants_.empty()) return;
  equilibrium.instants.insert(equilibrium.instants.end(), instants_.begin(), instants_.end());
  instants_.clear();
  double force = 0, moment = 0;
  for (const Equilibrium::Instant& at : equilibrium.instants) {
    force = std::max(force, at.largest_reaction);  // of supports that settle the reactions cancel each other
    for (const Equilibrium::Sum* sum : {&at.inertia, &at.damping, &at.internal, &at.joint, &at.second_order, &at.applied, &at.reactions})
      force = std::max(force, largest(sum->force)), moment = std::max(moment, largest(sum->moment));
  }
  double size = 0;
  for (const Node& node : stage_->model.nodes) size = std::max(size, (node.position - centre_).norm());
  for (const Interface& interface : stage_->model.interfaces)  // of a single body, whose only node is the centre
    for (const Place& place : interface.position) size = std::max(size, (place - centre_).norm());
  moment = std::max(moment, force * size);  // forces through the middle have no moment to compare with
  equilibrium.residual = 0;
  for (const Equilibrium::Instant& at : equilibrium.instants) {
    const double share =
        std::max(force > 0 ? largest(at.residual.force) / force : 0, moment > 0 ? largest(at.residual.moment) / moment : 0);
    if (share > equilibrium.residual) equilibrium.residual = share, equilibrium.time = at.time;
  }
}

}  // namespace uplift
