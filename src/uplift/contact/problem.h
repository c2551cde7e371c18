#pragma once
#include <memory>
#include <string>
#include <vector>

#include "uplift/contact/model.h"

// The interface problem of one step: the constant model (model.h) and the data of the step. A method solves it with work space of its own
// (method.h) and leaves nothing but results in the solution.
namespace uplift {

/// Joint filter of the scheme of filtered energy decay (laws/filter.h), frozen for one step. Without a gain there is none.
struct JointFilterInput {
  double gain = 0;          // b of the scheme
  double pole = 0;          // a of the scheme: how the lag goes on; not needed for one step, and not in its file
  Vector coefficient, lag;  // rows: c [Pa/m], d_f [m]; of points with rotations as in Batch
  bool acts() const { return gain > 0; }
};

/// Everything that a method may know about one step. It can be written to a file and solved again by any method.
struct InterfaceProblem {
  std::shared_ptr<const ContactModel> model;
  // data of the step
  Vector free_opening;            // m, initial gap included
  Vector from;                    // opening at the beginning of the step [m]
  Vector old;                     // memory at the beginning of the step
  Vector free_opening_increment;  // r: x with free_opening - from = C x; empty where it is not known
  JointFilterInput filter;
  int rows() const { return model != nullptr ? model->rows() : 0; }
};

/// A problem of a model, its data zero: for those who fill them step by step.
InterfaceProblem problem_of(std::shared_ptr<const ContactModel>);

/// Linear problems of interfaces with many independent rows that were solved: with a new factor of their matrix, and without one.
struct InterfaceSystems {
  long factored = 0, iterated = 0;
};

/// Contact status of a point. A closed point without friction slips.
enum class Status : signed char { open, stick, slip };

/// Work space of contact_residual.
struct ResidualScratch {
  Vector opening, moved, force, balance, jump;
  Vector traction, slope, end, next, plain;
  Vector now;
};

/// What a method has found.
struct InterfaceSolution {
  Vector z;             // on entry the first guess; a method may leave it behind where ContactModel::forces_suffice
  Vector opening;       // rows, end of step [m]
  Vector force;         // rows, p as it enters the balance [N]: scale * area * traction, tension > 0
  Vector plain;         // rows, with a joint filter: path average of the law alone [Pa]
  Vector end_traction;  // rows, path average only: traction at the end of the step [Pa]
  // path average only: slope of the path average in the step to come [Pa/m], per block (components x components x points), blocks one after
  // another
  Vector next_slope;
  Vector now;                  // memory at the end of the step
  bool fused = false;          // the law made all in one pass (laws/fused.h): its memory stays, and it stores this:
  double stored = 0;           // J
  std::vector<Status> status;  // per point, all blocks one after another (cones); on entry the first guess
  InterfaceSystems systems;
};

/// Sizes opening, force, status, now, and z for the problem; does nothing when they fit.
void size_solution(const InterfaceProblem&, InterfaceSolution&);

struct Outcome {
  bool converged = false;
  int iterations = 0;
  double residual = 0;  // the contact residual (see below)
  int cycles = 0;       // times that a repeated contact status was met and treated
  std::string why;      // when not converged; names the points
};

/// The one residual that judges every method, outside the methods: the largest of
///  - the balance |z + C^T (p - D opening)| / (|z| + |C^T p| + tiny)
///  - law blocks: |p - scale * area * t(opening)| / (max |p|)
///  - cone blocks: penetration, tension, friction bound and complementarity, each made dimensionless with max |p| and max |opening -
///  free_opening|.
double contact_residual(const InterfaceProblem&, const InterfaceSolution&);
/// The same without allocating after the first call.
double contact_residual(const InterfaceProblem&, const InterfaceSolution&, ResidualScratch&);

/// JSON text of a problem with its laws (names and parameters) and back. Throws InputError with the position on bad files.
std::string save_problem(const InterfaceProblem&, const std::vector<const Values*>& behaviours, const std::string& reason);
struct StoredProblem {
  InterfaceProblem problem;
  std::vector<std::unique_ptr<const InterfaceLaw>> laws;
  std::vector<std::unique_ptr<const Cone>> cones;
  std::string reason;
};
StoredProblem load_problem(const std::string& text, const std::string& file);

}  // namespace uplift
