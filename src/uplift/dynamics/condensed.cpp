#include "uplift/dynamics/condensed.h"

#include <algorithm>
#include <utility>

#include "uplift/math/columns.h"
#include "uplift/math/dense.h"
#include "uplift/math/small.h"
#include "uplift/model/base_size.h"

namespace uplift {

Behaviours::Behaviours(const Model& model, const ContactMethod& method, const ContactModel* probe) {
  for (std::size_t i = 0; i < model.interfaces.size(); ++i) {
    const Interface& interface = model.interfaces[i];
    One one{interface.law.get(), interface.cone.get()};
    if (one.cone != nullptr && probe != nullptr) {
      if (auto law = method.substitute(*one.cone, flexibility(*probe, probe->blocks[i])); law != nullptr) {
        owned.push_back(std::move(law));
        one = {owned.back().get(), nullptr};
      }
    }
    interfaces.push_back(one);
    first_history.push_back(history);
    if (one.law != nullptr) history += one.law->num_history(interface.batch.components) * interface.batch.points;
  }
}

ContactModel blocks_of(const Model& model, const Behaviours& behaviours) {
  ContactModel contact;
  contact.solver = behaviours.solver;
  if (const double size = base_size(model); size > 0) contact.size = size;
  int first = 0;
  for (std::size_t i = 0; i < model.interfaces.size(); ++i) {
    const Interface& interface = model.interfaces[i];
    Block block;
    block.name = interface.name;
    block.first = first;
    block.first_history = behaviours.first_history[i];
    block.batch = interface.batch;
    block.law = behaviours.interfaces[i].law;
    block.cone = behaviours.interfaces[i].cone;
    block.area = interface.weight;
    block.footprint = interface.footprint;
    first += block.rows();
    contact.blocks.push_back(std::move(block));
  }
  return contact;
}

namespace {

constexpr std::size_t most_touched = 64;  // unknowns whose columns of B are kept as a full matrix

/// That of a reduced model, with many coordinates.
bool is_full(const Sparse& b) {
  return b.cols() > static_cast<Index>(most_touched) && b.nonZeros() > b.size() / 2;
}

}  // namespace

Condensed::Condensed(const Model& model, const Sparse& b, const Vector& gap, bool gap_moves, std::shared_ptr<const BulkFactor> factor,
                     ContactModel frame, const ContactMethod& method, LinearCounts& counts)
    : b_(b), gap_(gap), factor_(std::move(factor)), work_(counts), method_(method), method_work_(method.make_work()) {
  if (factor_->split() != nullptr) {
    split_ = std::make_unique<SplitResponse>(*factor_, b, counts);
    frame.factor = split_->factor();
    frame.jumps = split_->jumps();
  } else if (factor_->reach() > 0 && b.rows() > 0) {
    solved_ = std::make_unique<SolvedResponse>(*factor_, model, b, counts);
    frame.factor = solved_->take_factor();
  } else {
    Spread spread = factor_->spread(b, counts);
    frame.factor = std::move(spread.factor);
    if (is_full(b) && factor_->keeps_inverse() && frame.shift.size() == 0) {
      full_b_.setZero(whole_registers(b.rows()), b.cols());
      full_b_.topRows(b.rows()) = b;
      of_rows_.setZero(full_b_.rows());
      frame.forces_suffice = true;
    } else {
      spread_ = std::move(spread.spread);
    }
  }
  problem_ = problem_of(std::make_shared<const ContactModel>(std::move(frame)));
  if (split_ == nullptr && solved_ == nullptr) list_touched(model, gap_moves);
}

void Condensed::list_touched(const Model& model, bool gap_moves) {
  free_.setZero(model.free());
  if (full_b_.size() > 0) return;
  touched_ = touched_unknowns(b_);
  if (touched_.size() > most_touched) {
    touched_.clear();
    return;
  }
  touched_b_.setZero(b_.rows(), static_cast<Eigen::Index>(touched_.size()));
  for (std::size_t j = 0; j < touched_.size(); ++j)
    for (Sparse::InnerIterator entry(b_, touched_[j]); entry; ++entry)
      touched_b_(entry.row(), static_cast<Eigen::Index>(j)) = entry.value();
  for (Vector* touched : {&touched_value_, &touched_free_}) touched->setZero(std::ssize(touched_));
  if (gap_moves || spread_.cols() > 3 || spread_.cols() != touched_value_.size()) return;
  Matrix touched_spread(spread_.cols(), spread_.cols());
  for (std::size_t j = 0; j < touched_.size(); ++j) touched_spread.row(static_cast<Eigen::Index>(j)) = spread_.row(touched_[j]);
  to_free_increment_ = inverse(touched_spread);
  if (!to_free_increment_.allFinite()) return;
  to_free_increment_product_ = small::product_of(to_free_increment_);
  problem_.free_opening_increment.setZero(spread_.cols());
}

inline void Condensed::free_opening(const Vector& right, const Vector& displacement) {
  if (split_ != nullptr) {
    problem_.free_opening.noalias() = b_ * displacement;
    problem_.free_opening += gap_;
    split_->forward(right, problem_.free_opening);
    return;
  }
  factor_->solve(right, free_, work_);
  if (touched_.empty()) {
    touched_value_ = displacement + free_;
    problem_.free_opening = gap_;
    if (full_b_.size() > 0) {
      of_rows_.noalias() = full_b_ * touched_value_;
      problem_.free_opening += of_rows_.head(gap_.size());
    } else {
      problem_.free_opening.noalias() += b_ * touched_value_;
    }
    return;
  }
  Index j = 0;
  for (const int unknown : touched_) {
    touched_free_[j] = free_[unknown];
    touched_value_[j++] = displacement[unknown] + free_[unknown];
  }
  if (to_free_increment_product_ != nullptr)
    to_free_increment_product_(to_free_increment_, touched_free_.data(), problem_.free_opening_increment.data());
  small::affine(touched_b_, gap_.data(), touched_value_.data(), problem_.free_opening.data());
}

void Condensed::forget() {
  solution_ = {}, method_work_ = method_.make_work();
  if (solved_ != nullptr) solved_->forget();
}

/// Nothing touches.
Outcome Condensed::free_step(const Vector& right, Vector& increment) {
  factor_->solve(right, increment, work_);
  Outcome outcome;
  outcome.converged = true;
  return outcome;
}

Outcome Condensed::solve(const Vector& right, const StepStart& start, Vector& increment) {
  return problem_.rows() == 0 ? free_step(right, increment) : contact_step(right, start, increment);
}

namespace {

/// The first guess of a static stage. The closed joint D goes through the origin; the ground of a foundation that has settled or slid
/// stands elsewhere: with p = D (g - g_p), z = C^T D g_p, and D g_p = D g - p of the old state. Empty without foundations, and in dynamics.
Vector guess_of_foundations(const InterfaceProblem& problem) {
  const ContactModel& model = *problem.model;
  const auto is_whole = [](const Block& block) { return block.footprint.has_value(); };
  if (model.shift.size() == 0 || std::ranges::none_of(model.blocks, is_whole)) return {};
  Vector permanent = Vector::Zero(model.rows());
  for (const Block& block : model.blocks) {
    if (!block.footprint) continue;
    Vector force(block.rows()), now(block.law->num_history(block.batch.components));
    const double* from = problem.from.data() + block.first;
    block.law->respond(block.batch, from, from, problem.old.data() + block.first_history, {.traction = force.data(), .now = now.data()});
    permanent.segment(block.first, block.rows()) =
        model.shift.segment(block.first, block.rows()).cwiseProduct(problem.from.segment(block.first, block.rows())) - force;
  }
  return model.factor.transpose() * permanent;
}

}  // namespace

inline Outcome Condensed::contact_step(const Vector& right, const StepStart& start, Vector& increment) {
  small::copy(start.opening.size(), start.opening.data(), problem_.from.data());
  small::copy(start.history.size(), start.history.data(), problem_.old.data());
  if (start.filter != nullptr && start.filter != &problem_.filter) problem_.filter = *start.filter;
  if (solution_.z.size() == 0) solution_.z = guess_of_foundations(problem_);
  Outcome outcome =
      solved_ == nullptr ? solve_interfaces(right, start.displacement, increment) : solve_by_reach(right, start.displacement, increment);
  const InterfaceSystems solved = std::exchange(solution_.systems, {});
  work_.counts->systems.factored += solved.factored;
  work_.counts->systems.iterated += solved.iterated;
  return outcome;
}

/// Through a factor with a reach.
Outcome Condensed::solve_by_reach(const Vector& right, const Vector& displacement, Vector& increment) {
  return solved_->solve(right, gap_ + b_ * displacement, method_, *method_work_, problem_, solution_, increment);
}

/// du = A^-1 (R - B^T p)
void Condensed::respond_to_forces(const Vector& right, Vector& increment) {
  of_rows_.head(solution_.force.size()) = solution_.force;
  loaded_ = right;
  loaded_.noalias() -= full_b_.transpose() * of_rows_;
  factor_->solve(loaded_, increment, work_);
}

/// du = du_free + X z
inline void Condensed::add_spread(Vector& increment) const {
  constexpr Index few_columns = 12;
  if (spread_.cols() <= few_columns) return small::affine(spread_, free_.data(), solution_.z.data(), increment.data());
  increment = free_;
  increment.noalias() += spread_ * solution_.z;
}

/// The interface problem, and the displacement that follows from it.
inline Outcome Condensed::solve_interfaces(const Vector& right, const Vector& displacement, Vector& increment) {
  free_opening(right, displacement);
  Outcome outcome = method_.solve(problem_, *method_work_, solution_);
  if (!outcome.converged) return outcome;
  if (split_ != nullptr)
    split_->backward(solution_.z, increment);
  else if (full_b_.size() > 0)
    respond_to_forces(right, increment);
  else
    add_spread(increment);
  return outcome;
}

}  // namespace uplift
