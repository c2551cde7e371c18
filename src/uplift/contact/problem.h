#pragma once
#include <memory>
#include <string>
#include <vector>

#include "uplift/contact/kernel/kernel.h"
#include "uplift/interface/interface.h"
#include "uplift/laws/fused.h"
#include "uplift/math/linalg.h"

// The interface problem of one step. With the linear bulk condensed, the step is
//     opening = free_opening + C z        z + C^T (p - D opening) = 0        p in law(opening)
// where F = C C^T = B K_eff^-1 B^T is the compliance [m/N] and z [sqrt(J)] are coordinates in which the energy of K_eff is |z|^2/2.
// C has as many columns as the smaller of the two exact forms needs (docs/theory, eq (13)): the interface rows m, or the independent
// unknowns that the interface touches (three for a rigid footing in 2D). F itself is never inverted; it is singular under a rigid footing.
// D [N/m] is zero in dynamics; in statics it takes back the closed joint that was put into the factored matrix (docs/theory, section 4).
namespace uplift {

/// One interface inside the problem.
struct Block {
  std::string name;
  int first = 0;          // first row
  int first_history = 0;  // first memory value
  Batch batch;
  const InterfaceLaw* law = nullptr;  // one of the two
  const Cone* cone = nullptr;
  Vector area;  // m2 per point
  // of a stored problem: the law that a method had put in the cone's place (penalty)
  double substitute_stiffness = 0;        // Pa/m
  std::vector<double> substitute_memory;  // at the beginning of the step
  int rows() const { return batch.points * batch.components; }
};

/// How the linear problems of interfaces with many independent rows are solved, see PointRows.
enum class InterfaceSolver : signed char { automatic, direct, krylov };

/// Joint filter of the scheme of filtered energy decay (laws/filter.h), frozen for one step. Without a gain there is none.
struct JointFilterInput {
  double gain = 0;          // b of the scheme
  Vector coefficient, lag;  // rows: c [Pa/m], d_f [m]
  bool acts() const { return gain > 0; }
};

/// Frozen: everything that a method may know about one step. It can be written to a file and solved again by any method.
struct InterfaceProblem {
  std::vector<Block> blocks;
  Matrix factor;         // C: rows x r [m/sqrt(J)]
  Vector shift;          // D: rows [N/m]; in dynamics empty, unless interfaces alone hold a massless unknown
  bool average = false;  // path-averaged traction: p = scale * area * mean(from -> opening)
  InterfaceSolver solver = InterfaceSolver::automatic;
  double scale = 1;  // weight of the interface force in the scheme's balance: with the path average 2/(1 + 2 b), else 1
  double step = 0;   // s; 0 in statics
  // what changes from step to step
  Vector free_opening;            // m, initial gap included
  Vector from;                    // opening at the beginning of the step [m]
  Vector old;                     // memory at the beginning of the step
  Vector free_opening_increment;  // r: x with free_opening - from = C x; empty where it is not known
  JointFilterInput filter;
  int rows() const { return static_cast<int>(factor.rows()); }
};

/// Linear problems of interfaces with many independent rows that were solved: with a new factor of their matrix, and without one.
struct InterfaceSystems {
  long factored = 0, iterated = 0;
};

/// Contact status of a point. A closed point without friction slips.
enum class Status : signed char { open, stick, slip };

/// Work space that a method keeps behind a class of its own. A copy of it starts empty.
struct MethodWork {
  virtual ~MethodWork() = default;
};
class KeptWork {
 public:
  KeptWork() = default;
  KeptWork(const KeptWork&) {}
  KeptWork(KeptWork&&) = default;
  KeptWork& operator=(const KeptWork&) { return *this; }
  KeptWork& operator=(KeptWork&&) = default;
  ~KeptWork() = default;
  std::unique_ptr<MethodWork> work;
};

/// Work space of Newton's method, sized once.
struct NewtonScratch {
  FusedEvaluation evaluation;  // laid out for this solution and the problem that it was last asked for, where it can be fused
  Vector slope;                // per block (components x components x points), blocks one after another [N/m]
  std::vector<int> first_slope;
  Vector gradient, direction, origin;
  Vector end;   // traction at the end of the step [Pa], path average only
  Vector next;  // as slope, for the step to come [Pa/m], path average only
  Vector pull;  // rows: k times one column of C, of one block; in the units of slope times those of the factor
  Matrix hessian;
  Vector end_pull;             // C^T (scale area end) [sqrt(J)], of a fused solution
  bool follows = false;        // the next problem may be guessed from this solution: slope, end and hessian are those of a converged step
  KeptWork direction_of_many;  // more than twelve coordinates
};

/// Work space of the augmented Lagrangian, sized once.
struct AugmentedScratch {
  Vector multiplier, stiffness;  // rows [N], [N/m]
  double growth = 1;             // of the stiffness in this step
};

/// Work space of the Lagrange method, sized once.
struct LagrangeScratch {
  KernelScratch kernel;
  Vector limit, held;  // rows: area of the normal rows of cones, and the same where they are closed
  KeptWork frictionless, frictional;
};

/// Work space of contact_residual.
struct ResidualScratch {
  Vector opening, moved, force, balance;
  Vector traction, slope, end, next, plain;
  Vector now;
};

/// The unknowns of a step, and the work space of the methods (kept from step to step, so that nothing is allocated after the first).
struct InterfaceSolution {
  Vector z;                    // on entry the first guess
  Vector opening;              // rows, end of step [m]
  Vector force;                // rows, p as it enters the balance [N]: scale * area * traction, tension > 0
  Vector plain;                // rows, with a joint filter: path average of the law alone [Pa]
  Vector now;                  // memory at the end of the step
  bool fused = false;          // the law made all in one pass (laws/fused.h): its memory stays, and it stores this:
  double stored = 0;           // J
  std::vector<Status> status;  // per point, all blocks one after another (cones)
  NewtonScratch newton;
  AugmentedScratch augmented;
  LagrangeScratch lagrange;
  ResidualScratch residual_scratch;
  InterfaceSystems systems;
};

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
/// The same in the solution's own work space.
double contact_residual(const InterfaceProblem&, const InterfaceSolution&, ResidualScratch&);

/// Force of a law block [N] and its slope [N/m], scale * area times those of the law for the way from problem.from to `opening` (all rows;
/// path-averaged where the problem says so). `response` points to the block's own rows, as in InterfaceLaw; `end` stays a traction.
void law_force(const InterfaceProblem&, const Block&, const double* opening, const LawResponse& response);

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
