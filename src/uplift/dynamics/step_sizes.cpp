#include "uplift/dynamics/step_sizes.h"

#include <cassert>
#include <cmath>
#include <utility>

#include "uplift/dynamics/closed_joint.h"
#include "uplift/dynamics/monolithic.h"
#include "uplift/model/mechanism.h"

namespace uplift {

StepSizes::StepSizes(const StageModel& stage, const ContactChoice& contact, const ImpactRule* impact, const SupportMotion& motion,
                     const LinearSolver& solver, const StepOptions& options, LinearCounts& counts)
    : stage_(stage),
      contact_(contact),
      impact_(impact),
      motion_(motion),
      solver_(solver),
      options_(options),
      counts_(counts),
      sizes_(static_cast<std::size_t>(options.halvings) + 1) {
  if (!options.monolithic) shift_ = stiffness_for_massless();
}

std::vector<int> StepSizes::made() const {
  std::vector<int> halvings;
  for (std::size_t halving = 0; halving < sizes_.size(); ++halving)
    if (sizes_[halving] != nullptr) halvings.push_back(static_cast<int>(halving));
  return halvings;
}

void StepSizes::forget() {
  for (const std::unique_ptr<StepSize>& size : sizes_)
    if (size != nullptr && size->solver != nullptr) size->solver->forget();
}

std::unique_ptr<StepSolver> StepSizes::condensed(std::shared_ptr<const BulkFactor> factor, ContactModel contact) const {
  return std::make_unique<Condensed>(stage_.model, stage_.b, motion_.gap(), motion_.acts(), std::move(factor), std::move(contact),
                                     contact_.method, counts_);
}

StepSize& StepSizes::make(int halving) {
  solver_.wait_for_room();
  auto& slot = sizes_[static_cast<std::size_t>(halving)];
  slot = std::make_unique<StepSize>();
  StepSize& made = *slot;
  made.step = options_.step / std::pow(2.0, halving);
  made.weights = weights_of(options_.scheme, made.step);
  ContactModel contact = contact_model_of(made);
  if (options_.monolithic) {
    made.solver = make_monolithic(matrix_of(made), stage_.b, motion_.gap(), std::move(contact));
    ++counts_.factorisations;
  } else {
    // Yielding solids halve steps often. The matrices of all lengths have their entries in the same places: one symbolic analysis serves
    // them. Other models may share their factors with other runs (linear/lockstep.h), which the solver does for itself.
    const bool like = halving > 0 && sizes_.front() != nullptr && sizes_.front()->solver != nullptr && PlasticBulk(stage_.model).any();
    auto factor = std::make_shared<const BulkFactor>(upper_of(made), &stage_.b, stage_.bulk.small, solver_, stage_.model, counts_,
                                                     like ? sizes_.front()->solver->factor() : nullptr);
    if (!factor->ok()) {
      made.why = factor->why();
      made.hopeless = factor->too_large();
      return made;
    }
    std::unique_ptr<StepSolver> oracle;
    if (options_.oracle_tolerance > 0) oracle = make_monolithic(matrix_of(made), stage_.b, motion_.gap(), contact);
    made.solver = condensed(std::move(factor), std::move(contact));
    if (oracle != nullptr)
      made.solver = make_compared(matrix_of(made), std::move(made.solver), std::move(oracle), options_.oracle_tolerance);
  }
  if (impact_ != nullptr) make_impact_factors(made);
  return made;
}

std::unique_ptr<StepSolver> StepSizes::softened(StepSize& size, const Sparse& softening, std::string& why) const {
  if (options_.monolithic) return make_monolithic(matrix_of(size) + softening, stage_.b, motion_.gap(), contact_model_of(size));
  OwnedSum matrix = upper_of(size);
  matrix.here += Sparse(softening.triangularView<upper_triangle>());
  auto factor = std::make_shared<const BulkFactor>(matrix, &stage_.b, stage_.bulk.small, solver_, stage_.model, counts_,
                                                   size.tangent != nullptr ? size.tangent.get() : size.solver->factor());
  why = factor->why();
  if (!factor->ok()) return nullptr;
  size.tangent = factor;
  return condensed(std::move(factor), contact_model_of(size));
}

/// A matrix that cannot be factorised is the failure of the step size.
void StepSizes::make_impact_factors(StepSize& size) const {
  const Scheme& s = options_.scheme;
  ImpactFactors& made = size.impacts;
  made.step = size.step;
  made.mass = size.weights.mass;
  const auto spread_by = [&](const OwnedSum& matrix, std::unique_ptr<Spread>& spread) {
    made.factor = std::make_unique<BulkFactor>(matrix, &stage_.b, stage_.bulk.small, solver_, stage_.model, counts_);
    if (!made.factor->ok()) size.why = "the matrix of impacts: " + made.factor->why();
    size.hopeless = made.factor->too_large();
    if (size.why.empty()) spread = std::make_unique<Spread>(made.factor->spread(stage_.b, counts_));
  };
  if (impact_->needs_dynamic()) spread_by(stage_.bulk.upper(1, 0, 4 / (size.step * size.step)), made.dynamic);
  if (!impact_->holds_acceleration() || stage_.bulk.damping.zero()) return;
  if (!s.average_acceleration()) {
    made.effective = size.solver->factor();
    if (made.effective != nullptr) return;
    made.factor = std::make_unique<BulkFactor>(upper_of(size), &stage_.b, stage_.bulk.small, solver_, stage_.model, counts_);
    made.effective = made.factor.get();
    size.why = made.factor->why();
    return;
  }
  spread_by(damped_mass(s.velocity_weight(size.step)), made.damped);
  const std::vector<Block> blocks = blocks_of(stage_.model, contact_.laws).blocks;
  if (made.damped != nullptr && any_friction(blocks)) made.coulomb = std::make_unique<CoulombRates>(blocks, made.damped->factor);
}

/// M + w D, with a trace of mass where there is none and perhaps no damping either.
OwnedSum StepSizes::damped_mass(double w) const {
  const Bulk& bulk = stage_.bulk;
  constexpr double trace = 1e-12;
  OwnedSum sum = bulk.upper(0, w, 1);
  const Vector diagonal = bulk.mass_diagonal() + w * bulk.damping_diagonal() + w * w * bulk.stiffness_diagonal();
  std::vector<Triplet> light;
  for (int i = 0; i < bulk.unknowns; ++i)
    if (bulk.massless[static_cast<std::size_t>(i)] != 0) light.emplace_back(i, i, trace * diagonal[i]);
  if (light.empty()) return sum;
  Sparse here(bulk.unknowns, bulk.unknowns);
  here.setFromTriplets(light.begin(), light.end());
  if (sum.here.size() > 0) here += sum.here;
  sum.here.swap(here);
  return sum;
}

/// Unknowns without mass that nothing but the laws of interfaces holds make K_eff singular: like in a static stage, the closed joint is
/// factored with it and taken back in the interface problem.
Vector StepSizes::stiffness_for_massless() const {
  const Bulk& bulk = stage_.bulk;
  Vector touching = Vector::Zero(stage_.b.rows());
  for (int column = 0; column < stage_.b.outerSize(); ++column)
    if (bulk.massless[static_cast<std::size_t>(column)] != 0)
      for (Sparse::InnerIterator entry(stage_.b, column); entry; ++entry) touching[entry.row()] = 1;
  if (touching.isZero(0) || unresisted_motion(stage_.model, Resistance::dynamic_open).size() == 0) return {};
  return touching.cwiseProduct(
      closed_joint(stage_.model, diagonal_of(solver_.matrices_of(stage_.model), &Model::stiffness), stage_.b, contact_.laws));
}

Sparse StepSizes::matrix_of(const StepSize& size) const {
  const Bulk& bulk = stage_.bulk;
  assert(!bulk.distributed());
  Sparse linear = bulk.stiffness_matrix + size.weights.damping * bulk.damping_matrix + size.weights.mass * bulk.mass_matrix;
  if (shift_.size() > 0) linear += joint_stiffness(stage_.b, shift_);
  if (!options_.scheme.filtered() || bulk.geometric == nullptr) return linear;
  return linear - (1 - 1 / options_.scheme.stretch()) * *bulk.geometric;  // the geometric stiffness is not filtered
}

/// The upper triangle of the same: what a factor is made of.
OwnedSum StepSizes::upper_of(const StepSize& size) const {
  const Bulk& bulk = stage_.bulk;
  const bool unfiltered = options_.scheme.filtered() && bulk.geometric != nullptr;
  if (!bulk.distributed() && (shift_.size() > 0 || unfiltered)) return {matrix_of(size).triangularView<upper_triangle>(), {}};
  OwnedSum sum = bulk.upper(1, size.weights.damping, size.weights.mass);
  if (!bulk.distributed()) return sum;
  if (shift_.size() > 0) sum.here += Sparse(joint_stiffness(stage_.b, shift_).triangularView<upper_triangle>());
  if (unfiltered) sum.here -= Sparse((1 - 1 / options_.scheme.stretch()) * bulk.geometric->triangularView<upper_triangle>());
  return sum;
}

ContactModel StepSizes::contact_model_of(const StepSize& size) const {
  ContactModel contact = blocks_of(stage_.model, contact_.laws);
  contact.average = options_.path_average;
  contact.scale = options_.path_average ? 2 / options_.scheme.stretch() : 1;
  contact.step = size.step;
  contact.shift = shift_;
  return contact;
}

}  // namespace uplift
