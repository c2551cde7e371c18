#include "uplift/dynamics/statics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "uplift/contact/unheld.h"
#include "uplift/dynamics/closed_joint.h"
#include "uplift/dynamics/energy.h"
#include "uplift/dynamics/lifted.h"
#include "uplift/dynamics/rigid_motions.h"
#include "uplift/linear/large.h"

namespace uplift {

namespace {

/// Largest entry.
double size_of(const Vector& v) {
  return v.size() > 0 ? v.cwiseAbs().maxCoeff() : 0;
}

/// Why a load step has no solution: a small share of the closed joint is left as springs, with which every load has an equilibrium, and the
/// movement shows what these springs alone hold. Empty when it is not that.
std::string diagnose(const InterfaceProblem& problem, const ContactMethod& method) {
  InterfaceProblem held = problem;
  for (const double share : {1e-6, 1e-4}) {
    auto model = std::make_shared<ContactModel>(*problem.model);
    model->shift *= 1 - share;
    held.model = std::move(model);
    InterfaceSolution solution;
    if (method.solve(held, solution).converged) return unheld_motion(held, solution, 5e-3 / share);
  }
  return {};
}

/// One static stage.
class LoadSteps {
 public:
  LoadSteps(const StageModel& stage, const ContactChoice& contact, const LinearSolver& solver, const StaticOptions& options, State& state,
            LinearCounts& counts);
  StaticOutcome run();

 private:
  std::shared_ptr<const BulkFactor> factor(const SymmetricSum& matrix, const BulkFactor* like) const {
    const LinearSolver& solver = of_statics_ != nullptr ? *of_statics_ : solver_;
    return std::make_shared<const BulkFactor>(matrix, &stage_.b, stage_.bulk.small, solver, stage_.model, counts_, like);
  }
  std::unique_ptr<StepSolver> condensed(std::shared_ptr<const BulkFactor> made) const {
    return std::make_unique<Condensed>(stage_.model, stage_.b, gap_, !motion_.isZero(0), std::move(made), blocks_, method_, counts_);
  }
  void assemble();
  OwnedSum softened(const Sparse& d) const;
  void soften_joint();
  void find_loads();
  double load_factor(double share) const { return share < 1 ? first_factor_ + share * (1 - first_factor_) : 1; }
  bool go(double from, double to, int depth);
  bool go_on();
  bool retry_with_softer_joint();
  std::string solve(double to, int depth);
  std::string imbalance(const Vector& unbalanced, const Vector& moved) const;
  bool nothing_acts();
  void take_solution();
  void book(double to);
  void accept(double to);

  const StageModel stage_;
  const ContactMethod& method_;
  const LinearSolver& solver_;
  const std::unique_ptr<const LinearSolver> of_statics_;  // null: the same
  const StaticOptions& options_;
  State& state_;
  LinearCounts& counts_;
  const PlasticBulk yielding_;
  const double first_factor_;   // load factor at the beginning
  Vector gap_, motion_;         // rows: gap of the present load step, and what the prescribed motions open [m]
  Vector first_load_, change_;  // N: internal force at the beginning, and what the stage adds to it
  Vector dead_load_;            // N: the static loads at the load factor 1
  ContactModel blocks_;
  OwnedSum matrix_;  // upper triangle of K + B^T D B: all that a factor is made of
  std::unique_ptr<StepSolver> linear_;
  std::shared_ptr<const BulkFactor> tangent_;  // the last one, whose analysis serves the next one
  std::unique_ptr<PlasticNewton> newton_;
  const StepSolver* last_ = nullptr;  // solver of the last load step
  bool softens_ = false;              // a joint, where the last load step failed
  PlasticState plastic_now_, plastic_next_;
  Vector load_, product_, reaction_, moved_, increment_;
  Vector opening_, force_, history_;  // of the interfaces at the end of the load step
  LooseMotions loose_;
  std::string not_unique_;  // see StaticOutcome
  StaticProgress progress_;
  StaticOutcome outcome_;
};

LoadSteps::LoadSteps(const StageModel& stage, const ContactChoice& contact, const LinearSolver& solver, const StaticOptions& options,
                     State& state, LinearCounts& counts)
    : stage_(stage),
      method_(contact.method),
      solver_(solver),
      of_statics_(stage.bulk.small ? nullptr : solver_for_statics(solver, rigid_motions(stage.model))),
      options_(options),
      state_(state),
      counts_(counts),
      yielding_(stage.model),
      first_factor_(state.load_factor),
      gap_(stage.gap),
      motion_(Vector::Zero(stage.gap.size())),
      blocks_(blocks_of(stage.model, contact.laws)) {
  blocks_.shift = closed_joint(stage.model, diagonal_of(solver.matrices_of(stage.model), &Model::stiffness), stage.b, contact.laws);
  assemble();
  if (yielding_.any()) {
    newton_ = std::make_unique<PlasticNewton>(yielding_, SymmetricSum(matrix_).diagonal(), options.plastic);
    plastic_now_ = yielding_.state(state.bulk_history);
  }
  product_ = reaction_ = increment_ = Vector::Zero(stage.bulk.unknowns);
  find_loads();
}

/// K + B^T D B with the closed joint D.
void LoadSteps::assemble() {
  solver_.wait_for_room();
  OwnedSum stiffness = stage_.bulk.upper(1, 0, 0);
  matrix_.here.swap(stiffness.here);
  matrix_.there.swap(stiffness.there);
  if (stage_.b.rows() > 0) matrix_.here += Sparse(joint_stiffness(stage_.b, blocks_.shift).triangularView<upper_triangle>());
}

/// The same with the tangent of solids that yield.
OwnedSum LoadSteps::softened(const Sparse& d) const {
  return {matrix_.here + d, matrix_.there};
}

/// Where the matrix or a load step fails: a joint that is no stiffer than the parts that it joins. It is as exact (any stiffness is), but
/// soft parts on both sides are not lost in its round-off.
void LoadSteps::soften_joint() {
  blocks_.shift = blocks_.shift.cwiseMin(stiffness_of_parts(stage_.model, stage_.bulk.stiffness_diagonal(), stage_.b));
  assemble();
}

void LoadSteps::find_loads() {
  stage_.bulk.stiffness.multiply(state_.displacement, product_);
  first_load_ = product_;
  if (yielding_.any()) first_load_ += plastic_now_.force;
  if (stage_.b.rows() > 0) first_load_ += stage_.b.transpose() * state_.force;
  dead_load_ = Vector::Zero(stage_.bulk.unknowns);
  for (const TimeLoad& time_load : stage_.model.time_loads)
    if (time_load.is_static()) dead_load_ += time_load.factor(state_.time) * time_load.shape;
  if (options_.second_order != nullptr)
    for (const TimeLoad& time_load : *options_.second_order) dead_load_ += time_load.factor(state_.time) * time_load.shape;
  change_ = dead_load_ - first_load_;
  stage_.model.add_prescribed_opening(state_.time, motion_);
}

/// Why this is no equilibrium; empty when it is one. A structure that nothing holds has none, but the balance of an interface problem is
/// relative to its own forces, the closed joint that is taken back among them: it is met at infinity by every method. The balance of the
/// whole structure, f - K u - B^T p against the loads, is not. `unbalanced` is that difference; what round-off makes of K u does not count,
/// unless it is so much that nothing can be told. A stage without loads is measured against the forces at its beginning, and against those
/// of the interfaces, which may balance each other: a footing that supports press down has a moment of none.
std::string LoadSteps::imbalance(const Vector& unbalanced, const Vector& moved) const {
  if (unbalanced.size() == 0) return {};
  if (!unbalanced.allFinite()) return "the forces are not finite";
  double size = std::max({size_of(load_), size_of(reaction_), size_of(first_load_)});
  if (stage_.b.rows() > 0) size = std::max(size, size_of(stage_.b.cwiseAbs().transpose() * force_.cwiseAbs()));
  Index stiffest = 0, worst = 0;
  const double round_off = stage_.bulk.stiffness_diagonal().cwiseProduct(moved).cwiseAbs().maxCoeff(&stiffest);
  const double lost = 64 * std::numeric_limits<double>::epsilon() * round_off;
  if (lost > 1e-3 * size)
    return fmt::format(
        "the balance of the structure is lost in round-off: at {} stiffness times displacement is {:.1e} times the largest "
        "force; {}",
        stage_.model.unknown_name(stiffest), round_off / std::max(size, 1e-300), too_much_contrast);
  if (const double rest = unbalanced.cwiseAbs().maxCoeff(&worst); rest > 1e-6 * size + lost)
    return fmt::format("the balance of the structure is not met at {}: {:.1e} of the largest force is left",
                       stage_.model.unknown_name(worst), rest / std::max(size, 1e-300));
  return {};
}

/// No load, no motion, no force in structure and joints: a structure above its gaps stays where it is. There is nothing to iterate on, and
/// nothing that round-off could be compared with. The state is then the solution.
bool LoadSteps::nothing_acts() {
  if (!change_.isZero(0) || !first_load_.isZero(0) || !motion_.isZero(0) || !state_.force.isZero(0) || yielding_.any()) return false;
  moved_ = state_.displacement, opening_ = state_.opening, force_ = state_.force, history_ = state_.history;
  for (const Block& block : blocks_.blocks) {
    if (block.law != nullptr) {
      block.law->respond(block.batch, opening_.data() + block.first, opening_.data() + block.first,
                         state_.history.data() + block.first_history,
                         {.traction = force_.data() + block.first, .now = history_.data() + block.first_history});
    } else if (opening_.segment(block.first + block.batch.normal(), block.batch.points).minCoeff() < 0) {
      return false;
    }
  }
  return force_.isZero(0);
}

/// Solves for a share of the stage; why there is no equilibrium, or empty.
std::string LoadSteps::solve(double to, int depth) {
  gap_ = stage_.gap + load_factor(to) * motion_;
  load_ = first_load_ + to * change_;
  stage_.bulk.stiffness.multiply(state_.displacement, product_);
  Vector right = to * change_ + (first_load_ - product_);
  if (stage_.b.rows() > 0) {  // what the closed joint bears without any increment
    const Vector opening = state_.opening + (load_factor(to) - state_.load_factor) * motion_;
    right -= stage_.b.transpose() * blocks_.shift.cwiseProduct(opening).eval();
  }
  const StepStart start{state_.displacement, state_.opening, state_.history};
  Outcome step;
  last_ = linear_.get();
  if (nothing_acts()) return {};
  if (yielding_.any()) {
    const PlasticNewton::Make soften = [this](const Sparse& d, std::string& why) -> std::unique_ptr<StepSolver> {
      std::shared_ptr<const BulkFactor> softer = factor(softened(d), tangent_ != nullptr ? tangent_.get() : linear_->factor());
      why = softer->why();
      if (!softer->ok()) return nullptr;
      tangent_ = softer;
      return condensed(std::move(softer));
    };
    const PlasticNewton::Step whole{
        .right = right, .start = start, .old = plastic_now_, .at = {state_.time, load_factor(to)}, .share = to - outcome_.reached};
    step = newton_->solve(whole, *linear_, soften, increment_, plastic_next_);
    last_ = &newton_->last();
    outcome_.newton = newton_->residuals();
  } else {
    step = linear_->solve(right, start, increment_);
  }
  outcome_.iterations += step.iterations;
  if (!step.converged) {
    if (stage_.b.rows() == 0 || depth < options_.halvings) return step.why;
    std::string found = diagnose(last_->problem(), method_);
    if (found.empty()) found = softening_joint(last_->problem(), last_->solution()), softens_ = !found.empty();
    return found.empty() ? step.why : found + "; " + step.why;
  }
  take_solution();
  stage_.bulk.stiffness.multiply(moved_, product_);
  Vector unbalanced = load_ - product_;
  if (yielding_.any()) unbalanced -= plastic_next_.force;
  if (stage_.b.rows() > 0) reaction_.noalias() = stage_.b.transpose() * force_;
  unbalanced -= reaction_;
  std::string trouble = imbalance(unbalanced, moved_);
  if (trouble.empty() || stage_.b.rows() == 0) return trouble;
  const std::string unheld = unheld_motion(last_->problem(), last_->solution(), runaway_ratio);
  return unheld.empty() ? trouble : unheld;
}

/// What the solver has found for a load step, without motions that nothing determines.
void LoadSteps::take_solution() {
  moved_ = state_.displacement + increment_;
  not_unique_.clear();
  if (stage_.b.rows() == 0) return;
  const InterfaceSolution& solution = last_->solution();
  opening_ = solution.opening, force_ = solution.force, history_ = solution.now;
  if (yielding_.any()) return;
  Lifted lifted = keep_undetermined(stage_.model, stage_.b, last_->problem(), solution, increment_, loose_);
  if (lifted.notice.empty()) return;
  moved_ = state_.displacement + lifted.increment;
  opening_.swap(lifted.opening), force_.swap(lifted.force), history_.swap(lifted.history);
  not_unique_ = std::move(lifted.notice);
}

/// Adds a load step to the work done.
void LoadSteps::book(double to) {
  const double before = state_.load_factor, after = load_factor(to);
  progress_.work += 0.5 * (before + after) * dead_load_.dot(moved_ - state_.displacement);
  if (yielding_.any()) {
    const MotionInstant from = state_.instant(), now{state_.time, after};
    progress_.work += yielding_.support_work(from, plastic_now_, now, plastic_next_);
    progress_.dissipated += yielding_.dissipated(state_.displacement, from, plastic_now_, moved_, now, plastic_next_);
  }
  if (stage_.b.rows() == 0) return;
  progress_.work += 0.5 * (after - before) * motion_.dot(state_.force + force_);
  State next;
  next.opening = opening_, next.force = force_;
  progress_.friction += friction_work(last_->problem().model->blocks, state_, next, 0.5);
}

void LoadSteps::accept(double to) {
  book(to);
  state_.displacement = moved_;
  state_.load_factor = load_factor(to);
  if (stage_.b.rows() > 0) {
    state_.opening = opening_;
    state_.force = state_.mean_force = force_;
    state_.history = history_;
  }
  outcome_.not_unique = not_unique_;
  if (yielding_.any()) {
    std::swap(plastic_now_, plastic_next_);
    state_.bulk_history = plastic_now_.history;
  }
  outcome_.reached = progress_.share = to;
  ++outcome_.steps;
}

/// From one share of the stage to another, halved when it fails.
bool LoadSteps::go(double from, double to, int depth) {
  std::string why = solve(to, depth);
  if (why.empty() && !moved_.allFinite()) why = "the displacement is not finite";
  if (why.empty()) {
    accept(to);
    return !options_.after_step || options_.after_step(progress_);
  }
  outcome_.why = fmt::format("static stage, {:.3g} % of the load: {}", 100 * to, why);
  if (depth < options_.halvings) {
    linear_->forget();
    ++outcome_.retries;
    const double middle = 0.5 * (from + to);
    return go(from, middle, depth + 1) && go(middle, to, depth + 1);
  }
  outcome_.why += fmt::format(" (equilibrium up to {:.4g} % of the load)", 100 * outcome_.reached);
  outcome_.failed = last_->problem();
  return false;
}

/// The load steps that are not reached yet.
bool LoadSteps::go_on() {
  for (int k = 0; k < options_.steps; ++k) {
    const double from = static_cast<double>(k) / options_.steps, to = static_cast<double>(k + 1) / options_.steps;
    if (to > outcome_.reached && !go(std::max(from, outcome_.reached), to, 0)) return false;
  }
  return true;
}

/// Where that led no farther, the first reason is kept: it belongs to the joint as it is.
bool LoadSteps::retry_with_softer_joint() {
  const double reached = outcome_.reached;
  const std::string why = outcome_.why;
  const std::optional<InterfaceProblem> failed = std::exchange(outcome_.failed, std::nullopt);
  soften_joint();
  std::shared_ptr<const BulkFactor> made = factor(matrix_, nullptr);
  if (made->ok()) {
    linear_ = condensed(std::move(made));
    if (go_on()) return true;
    if (!outcome_.failed || outcome_.reached > reached) return false;
  }
  outcome_.why = why, outcome_.failed = failed;
  return false;
}

StaticOutcome LoadSteps::run() {
  std::shared_ptr<const BulkFactor> made = factor(matrix_, nullptr);
  if (!made->ok() && !made->too_large() && stage_.b.rows() > 0) {
    soften_joint();
    made = factor(matrix_, nullptr);
  }
  if (!made->ok()) {
    outcome_.why = "static stage: " + made->why();
    return std::move(outcome_);
  }
  linear_ = condensed(std::move(made));
  if (!yielding_.any()) Sparse().swap(matrix_.here);  // tangents alone are made of it
  bool all = go_on();
  if (!all && outcome_.failed && stage_.b.rows() > 0 && !softens_ && !yielding_.any()) all = retry_with_softer_joint();
  state_.velocity.setZero();
  state_.acceleration.setZero(state_.velocity.size());  // the path average has left none
  state_.filter = {};
  outcome_.converged = all;
  if (!outcome_.failed) outcome_.why.clear();  // of a load step that was halved
  return std::move(outcome_);
}

}  // namespace

StaticOutcome solve_statics(const StageModel& stage, const ContactChoice& contact, const LinearSolver& solver, const StaticOptions& options,
                            State& state, LinearCounts& counts) {
  return LoadSteps(stage, contact, solver, options, state, counts).run();
}

}  // namespace uplift
