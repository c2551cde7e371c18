#pragma once
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "uplift/dynamics/plastic_bulk.h"
#include "uplift/dynamics/step_balance.h"
#include "uplift/model/geometric.h"

// Forces inside the structure and at its supports, as linear functions of the motion that the scheme balanced (dynamics/step_balance.h).
namespace uplift {

/// Coefficients by number.
using Weights = std::map<int, double>;

/// A force [N, N m] as a linear function of one balanced instant.
struct ForceRow {
  Weights displacement, velocity, acceleration;  // of the full unknowns
  Weights free_velocity;                         // of the free unknowns: modal damping
  Weights joint;                                 // of the interface rows, all interfaces [N]
  Weights yielding;                              // of the forces of yielding solids, full unknowns
  struct Term {
    const TimeFunction* function;
    int derivative;
    double factor;
  };
  std::vector<Term> terms;
  std::vector<std::pair<std::size_t, Vector>> time_load_tables;  // table, factors of its functions
  double constant = 0;
};

/// What a stage knows beside its model. All of it must stay alive.
struct ForceStage {
  const Model& model;
  const SecondOrder* second_order = nullptr;  // P-Delta
  const Vector* held = nullptr;               // constant forces that released supports have borne, free unknowns
};

/// Makes the rows of one stage.
class ForceModel {
 public:
  explicit ForceModel(const ForceStage& stage);
  ~ForceModel();
  const Model& model() const { return stage_.model; }
  const ForceStage& stage() const { return stage_; }
  /// Section forces of a beam element at a share of its length, times a weight each (see SectionRows).
  void add_section(int element, double xi, const Vector& weights, ForceRow& row) const;
  /// Work of inertia, damping, internal, joint and applied forces on a virtual motion of the full unknowns:
  /// w . (M a + C v + K u + B^T p - f). In equilibrium it is the work of the constraint forces, which act on the structure.
  void add_work(const Weights& motion, ForceRow& row) const;
  /// Forces of the constraint rows [first, last) on the unknowns, times a weight each.
  void add_constraints(int first, int last, const Weights& of_unknown, ForceRow& row) const;
  /// The constraint forces for what add_work sums up on every unknown: the factors of the constraint rows G that give them, G^T factors.
  Vector constraint_factors(const Vector& unbalanced) const;

 private:
  /// (G G^T)^-1 x for x on the constraint rows G; G^T times it is how much each unknown moves for these rows alone.
  Vector solve_normal(const Vector& of_row) const;
  void add_constraint_rows(const Vector& of_row, ForceRow& row) const;

  const std::vector<int>& elements_of(int node) const;

  ForceStage stage_;
  mutable std::vector<std::vector<int>> elements_of_;  // node; made when it is first asked for
  struct Normal;
  mutable std::unique_ptr<Normal> normal_;  // factor of G G^T
};

/// A force that the case asks for: one row, or several whose Euclidean norm it is.
class ForceQuantity {
 public:
  virtual ~ForceQuantity() = default;
  virtual std::vector<ForceRow> rows(const ForceModel& model) const = 0;
};

/// Sums of section forces.
class SectionForces final : public ForceQuantity {
 public:
  struct Part {
    int element;
    double xi;       // share of its length
    Vector weights;  // of its section forces
  };
  explicit SectionForces(std::vector<std::vector<Part>> rows) : rows_(std::move(rows)) {}
  std::vector<ForceRow> rows(const ForceModel& model) const override;

 private:
  std::vector<std::vector<Part>> rows_;
};

/// Force of supports and prescribed motions, or of ties and rigid bodies, on nodes.
class ConstraintForce final : public ForceQuantity {
 public:
  enum class Of { supports, ties };
  ConstraintForce(Of of, Weights of_unknown) : of_(of), of_unknown_(std::move(of_unknown)) {}
  std::vector<ForceRow> rows(const ForceModel& model) const override;

 private:
  Of of_;
  Weights of_unknown_;
};

/// Evaluates many quantities at one instant after another.
class ForceMeter {
 public:
  ForceMeter(const ForceModel& model, const std::vector<const ForceQuantity*>& quantities);
  /// One value per quantity.
  void measure(const StepBalance& balance, std::vector<double>& values) const;

 private:
  struct Entry {
    int index;
    double factor;
  };
  struct Row {
    std::vector<Entry> displacement, velocity, acceleration, joint, yielding, terms;
    std::vector<std::pair<std::size_t, Vector>> time_load_tables;
    double constant = 0;
  };
  Row compiled(const ForceRow& row);
  /// `of_motion`: it moves supports, else it is a load.
  int term(const TimeFunction& function, int derivative, bool of_motion);
  std::vector<Entry> on_free(const Weights& full, int derivative, Row& row);

  const Model& model_;
  PlasticBulk yielding_;
  bool any_yielding_ = false, any_tables_ = false;
  struct Term {
    const TimeFunction* function;
    int derivative;
    bool of_motion;
    bool operator==(const Term&) const = default;
  };
  std::vector<Term> terms_;
  std::vector<Row> rows_;
  std::vector<std::size_t> first_row_;  // of every quantity, and the end
  mutable std::vector<double> term_values_;
};

}  // namespace uplift
