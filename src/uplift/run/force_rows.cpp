#include "uplift/run/force_rows.h"

#include <algorithm>
#include <cmath>

#include "uplift/math/sparse_solvers.h"
#include "uplift/model/reduced.h"

namespace uplift {
namespace {

void add(double value, int index, Weights& weights) {
  if (value != 0) weights[index] += value;
}

/// Number of an element's unknown i among all.
int unknown_of(Space space, const Element& element, Index i) {
  const int each = element.unknowns_per_node();
  return space.unknowns() * element.nodes()[static_cast<std::size_t>(i) / each] + static_cast<int>(i) % each;
}

}  // namespace

struct ForceModel::Normal {
  explicit Normal(const Sparse& g) : factor(Sparse(g * g.transpose())) {}  // regular: repeated constraints were refused
  SparseLdlt factor;
};

ForceModel::~ForceModel() = default;

ForceModel::ForceModel(const ForceStage& stage) : stage_(stage) {}

const std::vector<int>& ForceModel::elements_of(int node) const {
  const Model& model = stage_.model;
  if (elements_of_.empty()) {
    elements_of_.resize(model.nodes.size());
    for (std::size_t e = 0; e < model.elements.size(); ++e)
      for (const int each : model.elements[e]->nodes()) {
        std::vector<int>& here = elements_of_[static_cast<std::size_t>(each)];
        if (here.empty() || here.back() != static_cast<int>(e)) here.push_back(static_cast<int>(e));
      }
  }
  return elements_of_[static_cast<std::size_t>(node)];
}

void ForceModel::add_section(int element, double xi, const Vector& weights, ForceRow& row) const {
  const Model& model = stage_.model;
  const Element& beam = *model.elements[static_cast<std::size_t>(element)];
  const SectionRows rows = beam.section(xi);
  const Vector stiffness = rows.stiffness.transpose() * weights, mass = rows.mass.transpose() * weights;
  Vector geometric = Vector::Zero(stiffness.size());
  if (stage_.second_order != nullptr)
    geometric = stage_.second_order->axial[static_cast<std::size_t>(element)] * (rows.geometric.transpose() * weights);
  const double alpha = model.assembly.mass_damping, beta = model.assembly.stiffness_damping + beam.beta;
  const int each = beam.unknowns_per_node();
  for (Index i = 0; i < stiffness.size(); ++i) {
    const int unknown = unknown_of(model.space, beam, i);
    add(stiffness[i] + geometric[i], unknown, row.displacement);
    add(beta * stiffness[i] + alpha * mass[i], unknown, row.velocity);
    add(mass[i], unknown, row.acceleration);
    if (i % each >= model.space.dimension) continue;
    const Vec3 axis = model.space.axis(static_cast<int>(i) % each);
    row.constant -= mass[i] * model.assembly.gravity.dot(axis);
    for (const GroundAcceleration& ground : model.grounds)
      if (const double share = ground.direction.dot(axis); share != 0) row.terms.push_back({ground.function.get(), 0, mass[i] * share});
  }
  if (!beam.inextensible() || weights[0] == 0) return;
  const std::span<const int> nodes = beam.nodes();
  for (const Assembly::Link& link : model.assembly.links) {
    if (std::minmax(link.a, link.b) != std::minmax(nodes[0], nodes[1])) continue;
    // the tension is the constraint's force on the end b along the axis, with the opposite sign: the link pulls it back
    Vector of_row = Vector::Zero(model.assembly.constraints.rows());
    of_row[link.row] = -weights[0];
    return add_constraint_rows(of_row, row);
  }
}

void ForceModel::add_work(const Weights& motion, ForceRow& row) const {
  const Model& model = stage_.model;
  const Assembly& assembly = model.assembly;
  std::vector<int> touched;
  for (const auto& [unknown, weight] : motion)
    for (const int element : elements_of(model.space.node_of(unknown))) touched.push_back(element);
  std::ranges::sort(touched);
  touched.erase(std::ranges::unique(touched).begin(), touched.end());
  Matrix stiffness, mass, damping;
  for (const int e : touched) {
    const Element& element = *model.elements[static_cast<std::size_t>(e)];
    element.form({.stiffness = &stiffness, .mass = &mass, .damping = &damping});
    damping += (assembly.stiffness_damping + element.beta) * stiffness + assembly.mass_damping * mass;
    for (Index i = 0; i < stiffness.rows(); ++i) {
      const auto moved = motion.find(unknown_of(model.space, element, i));
      if (moved == motion.end()) continue;
      for (Index j = 0; j < stiffness.cols(); ++j) {
        const int unknown = unknown_of(model.space, element, j);
        add(moved->second * stiffness(i, j), unknown, row.displacement);
        add(moved->second * damping(i, j), unknown, row.velocity);
        add(moved->second * mass(i, j), unknown, row.acceleration);
      }
    }
  }
  for (const auto& [unknown, weight] : motion) {
    for (Sparse::InnerIterator entry(assembly.b, unknown); entry; ++entry)
      add(weight * entry.value(), static_cast<int>(entry.row()), row.joint);
    if (stage_.second_order != nullptr)
      for (Sparse::InnerIterator entry(stage_.second_order->stiffness, unknown); entry; ++entry)
        add(weight * entry.value(), static_cast<int>(entry.row()), row.displacement);
    add(weight, unknown, row.yielding);
    const Sparse::InnerIterator free(model.expansion, unknown);
    if (!free || is_reduced(model) || model.kept[static_cast<std::size_t>(free.row())] != unknown) continue;
    const auto column = static_cast<int>(free.row());
    if (stage_.held != nullptr && stage_.held->size() > 0) row.constant -= weight * (*stage_.held)[column];
    if (assembly.modal_damping.cols() > 0)
      for (Sparse::InnerIterator entry(assembly.modal_damping, column); entry; ++entry)
        add(weight * entry.value(), static_cast<int>(entry.row()), row.free_velocity);
  }
  for (std::size_t i = 0; i < assembly.loads.size(); ++i) {
    double work = 0;
    if (assembly.loads[i].size() > 0)
      for (const auto& [unknown, weight] : motion) work += weight * assembly.loads[i].coeff(unknown);
    if (work == 0) continue;
    if (model.time_loads[i].constant)
      row.constant -= work;
    else
      row.terms.push_back({model.time_loads[i].function.get(), static_cast<int>(model.time_loads[i].order), -work});
  }
  for (std::size_t i = 0; i < assembly.time_load_tables.size(); ++i) {
    Vector weights = Vector::Zero(assembly.time_load_tables[i].rows());
    for (const auto& [unknown, weight] : motion) weights[unknown] = weight;
    const Vector work = -(assembly.time_load_tables[i].transpose() * weights);
    if (!work.isZero(0)) row.time_load_tables.emplace_back(i, work);
  }
}

Vector ForceModel::solve_normal(const Vector& of_row) const {
  if (!normal_) normal_ = std::make_unique<Normal>(stage_.model.assembly.constraints);
  return normal_->factor.solve(of_row);
}

void ForceModel::add_constraint_rows(const Vector& of_row, ForceRow& row) const {
  const Vector motion = stage_.model.assembly.constraints.transpose() * solve_normal(of_row);
  const double size = motion.size() > 0 ? motion.cwiseAbs().maxCoeff() : 0;
  Weights moved;
  for (Index i = 0; i < motion.size(); ++i)
    if (std::abs(motion[i]) > 1e-14 * size) moved[static_cast<int>(i)] = motion[i];
  add_work(moved, row);
}

void ForceModel::add_constraints(int first, int last, const Weights& of_unknown, ForceRow& row) const {
  const Sparse& g = stage_.model.assembly.constraints;
  Vector of_row = Vector::Zero(g.rows());
  for (const auto& [unknown, weight] : of_unknown)
    for (Sparse::InnerIterator entry(g, unknown); entry; ++entry)
      if (entry.row() >= first && entry.row() < last) of_row[entry.row()] += weight * entry.value();
  if (!of_row.isZero(0)) add_constraint_rows(of_row, row);
}

Vector ForceModel::constraint_factors(const Vector& unbalanced) const {
  const Sparse& g = stage_.model.assembly.constraints;
  return g.rows() == 0 ? Vector() : solve_normal(g * unbalanced);
}

std::vector<ForceRow> SectionForces::rows(const ForceModel& model) const {
  std::vector<ForceRow> made(rows_.size());
  for (std::size_t k = 0; k < rows_.size(); ++k)
    for (const Part& part : rows_[k]) model.add_section(part.element, part.xi, part.weights, made[k]);
  return made;
}

std::vector<ForceRow> ConstraintForce::rows(const ForceModel& model) const {
  const Assembly& assembly = model.model().assembly;
  const auto all = static_cast<int>(assembly.constraints.rows());
  std::vector<ForceRow> made(1);
  if (of_ == Of::supports) {
    model.add_constraints(assembly.first_support, assembly.first_equal, of_unknown_, made[0]);
  } else {
    model.add_constraints(0, assembly.first_support, of_unknown_, made[0]);
    model.add_constraints(assembly.first_equal, all, of_unknown_, made[0]);
  }
  return made;
}

ForceMeter::ForceMeter(const ForceModel& model, const std::vector<const ForceQuantity*>& quantities)
    : model_(model.model()), yielding_(model.model()) {
  for (const ForceQuantity* quantity : quantities) {
    first_row_.push_back(rows_.size());
    for (const ForceRow& row : quantity->rows(model)) rows_.push_back(compiled(row));
  }
  first_row_.push_back(rows_.size());
  term_values_.resize(terms_.size());
}

int ForceMeter::term(const TimeFunction& function, int derivative, bool of_motion) {
  const Term wanted{&function, derivative, of_motion};
  const auto found = std::ranges::find(terms_, wanted);
  if (found != terms_.end()) return static_cast<int>(found - terms_.begin());
  terms_.push_back(wanted);
  return static_cast<int>(terms_.size()) - 1;
}

std::vector<ForceMeter::Entry> ForceMeter::on_free(const Weights& full, int derivative, Row& row) {
  Weights sums;
  for (const auto& [unknown, weight] : full) {
    for (Sparse::InnerIterator entry(model_.expansion, unknown); entry; ++entry)
      sums[static_cast<int>(entry.row())] += weight * entry.value();
    for (const PrescribedMotion& motion : model_.motions)
      if (const double shape = motion.shape[unknown]; shape != 0)
        row.terms.push_back({term(*motion.function, derivative, true), weight * shape});
  }
  std::vector<Entry> entries;
  for (const auto& [index, factor] : sums) entries.push_back({index, factor});
  return entries;
}

ForceMeter::Row ForceMeter::compiled(const ForceRow& given) {
  Row row;
  row.displacement = on_free(given.displacement, 0, row);
  row.velocity = on_free(given.velocity, 1, row);
  row.acceleration = on_free(given.acceleration, 2, row);
  for (const auto& [index, factor] : given.free_velocity) row.velocity.push_back({index, factor});
  for (const auto& [index, factor] : given.joint) row.joint.push_back({index, factor});
  if (yielding_.any())
    for (const auto& [index, factor] : given.yielding) row.yielding.push_back({index, factor});
  for (const ForceRow::Term& each : given.terms) row.terms.push_back({term(*each.function, each.derivative, false), each.factor});
  row.time_load_tables = given.time_load_tables;
  row.constant = given.constant;
  any_yielding_ = any_yielding_ || !row.yielding.empty();
  any_tables_ = any_tables_ || !row.time_load_tables.empty();
  return row;
}

void ForceMeter::measure(const StepBalance& balance, std::vector<double>& values) const {
  for (std::size_t k = 0; k < terms_.size(); ++k) {
    const auto& [function, derivative, of_motion] = terms_[k];
    term_values_[k] = of_motion ? balance.motion(*function, derivative) : balance.value(*function, derivative);
  }
  const double begin = balance.share_of_begin();
  Vector yielding;
  if (any_yielding_) {
    yielding = (1 - begin) * yielding_.state(balance.after().bulk_history).full;
    if (begin != 0) yielding += begin * yielding_.state(balance.before().bulk_history).full;
  }
  std::vector<Vector> fed(any_tables_ && balance.moves() ? model_.time_load_tables.size() : 0);
  for (std::size_t k = 0; k < fed.size(); ++k) {
    Vector last, first;
    model_.time_load_tables[k].functions->values(balance.after().time, last);
    model_.time_load_tables[k].functions->values(balance.before().time, first);
    fed[k] = (1 - begin) * last + begin * first;
  }
  const auto value_of = [&](const Row& row) {
    double sum = balance.load_factor() * row.constant;
    for (const auto& [i, factor] : row.displacement) sum += factor * balance.displacement(i);
    for (const auto& [i, factor] : row.velocity) sum += factor * balance.velocity(i);
    for (const auto& [i, factor] : row.acceleration) sum += factor * balance.acceleration(i);
    for (const auto& [i, factor] : row.joint) sum += factor * balance.force(i);
    for (const auto& [i, factor] : row.yielding) sum += factor * yielding[i];
    for (const auto& [i, factor] : row.terms) sum += factor * term_values_[static_cast<std::size_t>(i)];
    if (!fed.empty())
      for (const auto& [table, factors] : row.time_load_tables) sum += factors.dot(fed[table]);
    return sum;
  };
  values.resize(first_row_.size() - 1);
  for (std::size_t k = 0; k + 1 < first_row_.size(); ++k) {
    const std::size_t first = first_row_[k], last = first_row_[k + 1];
    double sum = 0;
    for (std::size_t row = first; row < last; ++row) sum += std::pow(value_of(rows_[row]), 2);
    values[k] = last == first + 1 ? value_of(rows_[first]) : std::sqrt(sum);
  }
}

}  // namespace uplift
