#include "uplift/run/probe.h"

#include <algorithm>
#include <utility>

#include "uplift/dynamics/closed_joint.h"
#include "uplift/dynamics/solved_response.h"
#include "uplift/dynamics/split_response.h"
#include "uplift/dynamics/statics.h"
#include "uplift/dynamics/step.h"

namespace uplift {

namespace {

/// `contact` with the compliance of this matrix; without one, and with the reason, where it cannot be factorised.
ContactModel with_compliance(ContactModel contact, const SymmetricSum& matrix, const Sparse& b, const Model& model, const Bulk& bulk,
                             const LinearSolver& solver, LinearCounts& counts, std::string& why) {
  BulkFactor factor(matrix, &b, bulk.small, solver, model, counts);
  why = factor.why();
  if (!factor.ok()) return contact;
  if (factor.split() != nullptr)
    contact.factor = SplitResponse(factor, b, counts).take_factor();
  else if (factor.reach() > 0)
    contact.factor = SolvedResponse(factor, model, b, counts).take_factor();
  else
    contact.factor = factor.spread(b, counts).factor;
  return contact;
}

}  // namespace

ContactModel probe(const Model& model, const Bulk& bulk, const Sparse& b, const Stage& stage, const LinearSolver& solver,
                   LinearCounts& counts, std::string& why) {
  const StepWeights weights = weights_of(stage.scheme, stage.step);
  const OwnedSum matrix = bulk.upper(1, weights.damping, weights.mass);
  ContactModel contact = blocks_of(model, Behaviours(model, NoContact(), nullptr));
  contact.step = stage.step;
  return with_compliance(std::move(contact), matrix, b, model, bulk, solver, counts, why);
}

ContactModel static_probe(const Model& model, const LinearSolver& solver, LinearCounts& counts, std::string& why) {
  const Bulk bulk(solver.matrices_of(model), nullptr);
  const Sparse b = stack_interfaces(model);
  const Behaviours behaviours(model, NoContact(), nullptr);
  OwnedSum matrix = bulk.upper(1, 0, 0);
  const Vector joint = closed_joint(model, bulk.stiffness_diagonal(), b, behaviours);
  matrix.here += Sparse(joint_stiffness(b, joint).triangularView<upper_triangle>());
  return with_compliance(blocks_of(model, behaviours), matrix, b, model, bulk, solver, counts, why);
}

std::vector<StiffnessRatio> stiffness_ratios(const Model& model, const Stage& stage, const LinearSolver& solver) {
  const Bulk bulk(model, nullptr);
  LinearCounts counts;
  std::string why;
  const ContactModel contact = probe(model, bulk, stack_interfaces(model), stage, solver, counts, why);
  std::vector<StiffnessRatio> ratios;
  if (!why.empty()) return ratios;
  for (std::size_t k = 0; k < contact.blocks.size(); ++k) {
    const Block& block = contact.blocks[k];
    StiffnessRatio ratio{block.name, 1e300, 0, 0};
    double stiffness[most_components] = {};
    if (block.law != nullptr) block.law->closed_stiffness(block.batch.components, stiffness);
    for (int i = 0; i < block.batch.points; ++i) {
      const double compliance = contact.factor.row(block.normal_row() + i).squaredNorm();
      const double value = stiffness[block.batch.translations() - 1] * block.area[static_cast<std::size_t>(i)] * compliance;
      ratio.least = std::min(ratio.least, value);
      ratio.most = std::max(ratio.most, value);
      ratio.compliance = std::max(ratio.compliance, compliance);
    }
    ratios.push_back(ratio);
  }
  return ratios;
}

}  // namespace uplift
