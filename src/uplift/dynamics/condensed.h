#pragma once
#include <memory>
#include <vector>

#include "uplift/contact/method.h"
#include "uplift/dynamics/bulk.h"
#include "uplift/dynamics/solved_response.h"
#include "uplift/dynamics/split_response.h"

// One step of the discrete system in the displacement increment:
//     K_eff du + B^T P = R       opening = gap + B (u0 + du)       P in law(opening)
namespace uplift {

/// What each interface does in a run: its own law or cone, or the law that the method puts in the cone's place (penalty).
struct Behaviours {
  struct One {
    const InterfaceLaw* law = nullptr;
    const Cone* cone = nullptr;
  };
  std::vector<One> interfaces;
  std::vector<std::unique_ptr<const InterfaceLaw>> owned;
  std::vector<int> first_history;
  int history = 0;  // memory values of all interfaces
  InterfaceSolver solver = InterfaceSolver::automatic;

  /// `probe`: a model with the compliance of the dynamic step, from which automatic stiffnesses are scaled; may be null when no method
  /// substitutes.
  Behaviours(const Model& model, const ContactMethod& method, const ContactModel* probe);
};

/// The blocks of the interfaces (no compliance yet).
ContactModel blocks_of(const Model& model, const Behaviours& behaviours);

/// The beginning of a step.
struct StepStart {
  const Vector &displacement, &opening, &history;
  const JointFilterInput* filter = nullptr;  // null: none; may be that of the solver's own problem
};

/// Solves one step for the displacement increment. Owned by a run; its problem and solution hold the last step.
class StepSolver {
 public:
  virtual ~StepSolver() = default;
  /// `increment` receives du.
  virtual Outcome solve(const Vector& right, const StepStart& start, Vector& increment) = 0;
  virtual const InterfaceProblem& problem() const = 0;
  virtual const InterfaceSolution& solution() const = 0;
  /// The joint filter of its problem, for those who fill it in place.
  virtual JointFilterInput& filter() = 0;
  /// The factor of the bulk; null where there is none.
  virtual const BulkFactor* factor() const { return nullptr; }
  /// The next solve does not begin at the last solution, which led nowhere.
  virtual void forget() {}
};

/// The condensed step: the free response, the small interface problem, and what its forces add. Through a split factor (SplitResponse) that
/// is one back-solve; through any other one back-solve and the kept spread of the interface forces; with a kept inverse no back-solve, and
/// where B is full no spread either: B itself, which the free openings have just brought into the cache, takes its place;
/// through a factor with a reach some solves (SolvedResponse).
class Condensed final : public StepSolver {
 public:
  /// `factor` is that of K_eff (with B^T D B in statics); `frame` lacks nothing but the factor C. `gap_moves`: the gap
  /// changes from step to step.
  Condensed(const Model& model, const Sparse& b, const Vector& gap, bool gap_moves, std::shared_ptr<const BulkFactor> factor,
            ContactModel frame, const ContactMethod& method, LinearCounts& counts);
  Outcome solve(const Vector& right, const StepStart& start, Vector& increment) override;
  const InterfaceProblem& problem() const override { return problem_; }
  const InterfaceSolution& solution() const override { return solution_; }
  JointFilterInput& filter() override { return problem_.filter; }
  const BulkFactor* factor() const override { return factor_.get(); }
  void forget() override;

 private:
  void list_touched(const Model& model, bool gap_moves);
  void free_opening(const Vector& right, const Vector& displacement);
  Outcome solve_interfaces(const Vector& right, const Vector& displacement, Vector& increment);
  Outcome solve_by_reach(const Vector& right, const Vector& displacement, Vector& increment);
  void add_spread(Vector& increment) const;
  void respond_to_forces(const Vector& right, Vector& increment);
  Outcome free_step(const Vector& right, Vector& increment);
  Outcome contact_step(const Vector& right, const StepStart& start, Vector& increment);

  const Sparse& b_;
  const Vector& gap_;
  std::shared_ptr<const BulkFactor> factor_;
  BulkWork work_;
  std::unique_ptr<SplitResponse> split_;
  std::unique_ptr<SolvedResponse> solved_;
  Matrix touched_b_;  // columns of B that are not empty
  std::vector<int> touched_;
  Matrix full_b_;             // B where it is full and A^-1 is kept, of a reduced model, with rows of zeros (whole_registers); else empty
  Matrix spread_;             // X: du = du_free + X z; empty where B is full: du = A^-1 (R - B^T p)
  Matrix to_free_increment_;  // inverse of its touched rows where they are as many as its columns and few, and the gap stays: C = B X
  small::Product to_free_increment_product_ = nullptr;  // null: not so
  InterfaceProblem problem_;
  InterfaceSolution solution_;
  const ContactMethod& method_;
  std::unique_ptr<MethodWork> method_work_;
  Vector free_, touched_value_, touched_free_, of_rows_, loaded_;
};

}  // namespace uplift
