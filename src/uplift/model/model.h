#pragma once
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "uplift/elements/element.h"
#include "uplift/interface/interface.h"
#include "uplift/math/symmetric_sum.h"
#include "uplift/model/function.h"

namespace uplift {

struct Node {
  std::string name;
  Place position;  // m
};

/// A force pattern on the free unknowns times a function of time.
struct TimeLoad {
  std::string name;
  Vector shape;  // free unknowns
  std::shared_ptr<const TimeFunction> function;
  enum class Order { value, rate, acceleration } order = Order::value;  // which derivative multiplies the shape
  bool dead = false;                                                    // gravity and constant loads: applied (in steps) by static stages
  bool constant = false;                                                // its factor is 1 at all times
  bool of_motion = false;                                               // what a prescribed motion does to the free unknowns
  double factor(double time) const;                                     // the function's derivative of this order
  /// Static stages apply it, by the load factor.
  bool is_static() const { return dead || (of_motion && order == Order::value); }
};

/// Many functions of time at once.
class TimeFunctions {
 public:
  virtual ~TimeFunctions() = default;
  /// Fills (overwrites) the values at a time.
  virtual void values(double time, Vector& values) const = 0;
};

/// Forces that follow many functions of time: pattern * values(t). Never a dead load.
struct TimeLoadTable {
  std::string name;
  Sparse pattern;  // free unknowns x functions
  std::shared_ptr<const TimeFunctions> functions;
};

/// What prescribed motions are evaluated for: a time, and the share of them that a static stage has applied so far.
struct MotionInstant {
  MotionInstant(double at, double of_motions = 1) : time(at), share(of_motions) {}  // NOLINT(google-explicit-constructor)
  double time, share;
};

/// Motion of supported unknowns: full displacement += shape * function(t).
struct PrescribedMotion {
  std::string name;
  Vector shape;    // full unknowns
  Vector opening;  // interface rows, all interfaces: opening += opening * function(t)
  std::shared_ptr<const TimeFunction> function;
};

/// Acceleration of the ground in the relative frame: direction * function(t) [m/s2]. Its load is one of the time loads; what moves with the
/// ground is at rest in this frame.
struct GroundAcceleration {
  std::string name;
  Vec3 direction;
  std::shared_ptr<const TimeFunction> function;
};

/// What the elimination hides but reactions and the P-Delta effect need: everything on the full unknowns, but for the matrices, which are
/// large and soon made again (assembled).
struct Assembly {
  Sparse b;                         // interface rows x full unknowns
  Sparse constraints;               // independent rows g with g . u = prescribed: supports, rigid ties, inextensible beams
  std::vector<SparseVector> loads;  // full pattern of time load i; empty for those that prescribed motions make
  Vec3 gravity = Vec3::Zero();      // m/s2
  /// slave's constraint rows start at `row`, one per unknown of a node; offset = slave - master [m]
  struct Tie {
    int slave = 0, row = 0;
    Vec3 offset = Vec3::Zero();
  };
  std::vector<Tie> ties;
  struct Link {
    int a = 0, b = 0, row = 0;
  };
  std::vector<Link> links;  // inextensible beams
  /// An interface point that is rigidly offset from a node; sign -1: upper side, +1: lower side.
  struct Arm {
    int node = 0, interface = 0, point = 0;
    double weight = 1, sign = -1;
    Vec3 offset = Vec3::Zero();
  };
  std::vector<Arm> arms;
  std::vector<Where> interface_where;
  // Rows of `constraints` from here on: rigid ties come first, then supports and prescribed motions, equal ties, inextensible beams.
  int first_support = 0, first_equal = 0, first_link = 0;
  std::vector<Sparse> time_load_tables;            // full pattern of table i
  double mass_damping = 0, stiffness_damping = 0;  // Rayleigh: alpha [1/s], beta [s]
  Sparse modal_damping;                            // free x free, part of Model::damping; empty without
};

/// The matrices of a model whose rows are distributed. Rayleigh damping is no matrix of its own: C = damping + alpha M + beta K.
struct DistributedMatrices {
  std::shared_ptr<const DistributedMatrix> stiffness, mass, damping;  // damping: of dashpots and elements' own factors; null without any
  std::shared_ptr<const DistributedCells> cells;                      // that add to them; null without
};

/// What is built once, checked once and never changes; shared by every thread.
/// Full unknowns: those of all nodes (elements/space.h). Free unknowns q: what is left after supports, rigid bodies and inextensible beams
/// are eliminated exactly: full = T q + sum of prescribed motions.
struct Model {
  Space space;
  std::vector<Node> nodes;
  std::map<std::string, int, std::less<>> second_names;  // by which some nodes are found, too
  std::vector<std::unique_ptr<const Element>> elements;
  std::vector<Interface> interfaces;
  std::vector<TimeLoad> time_loads;
  std::vector<TimeLoadTable> time_load_tables;
  std::vector<PrescribedMotion> motions;
  std::vector<GroundAcceleration> grounds;

  Sparse expansion;                 // T^T, free x full: column i is the row of T for full unknown i
  Sparse stiffness, mass, damping;  // free x free; damping: Rayleigh, dashpots, modal
  // null: the matrices above are whole; else they hold nothing (model/matrix_sum.h)
  std::shared_ptr<const DistributedMatrices> distributed;
  std::vector<int> kept;  // full unknown that each free unknown is; empty: a free unknown is no full one (is_reduced)
  Assembly assembly;

  int free() const { return static_cast<int>(expansion.rows()); }
  int full_unknowns() const { return static_cast<int>(expansion.cols()); }
  Sparse reduction() const { return expansion.transpose(); }       // T, made when it is asked for: in a large model it takes as much again
  Vector expand(const Vector& q) const;                            // T q
  int at(int node, Dof dof) const { return space.at(node, dof); }  // full unknown
  /// Upwards, of length 1: against gravity, without gravity the vertical axis.
  Vec3 up() const;
  int rows() const;                             // interface rows, of all interfaces
  int find_node(std::string_view name) const;   // -1 when absent
  std::string name_of(int full_unknown) const;  // "top.ux"
  std::string unknown_name(Index free) const;   // of a free unknown; its number where it is no full one
  /// Full displacement (derivative 0), velocity (1) or acceleration (2) of one full unknown from the free ones.
  double full(int full_unknown, const Vector& q, int derivative, MotionInstant at) const;
  /// All full unknowns at once.
  Vector full(const Vector& q, int derivative, MotionInstant at) const;
  /// Acceleration of the relative frame along a direction [m/s2].
  double ground_acceleration(const Vec3& direction, double time) const;
  /// Adds the force of all time loads at a time to `force` (free unknowns).
  void add_force(double time, Vector& force) const;
  /// Its two parts: of the loads that never change, and all the rest.
  void add_constant_force(Vector& force) const;
  void add_varying_force(double time, Vector& force) const;
  /// Adds what the prescribed motions do to the openings (rows of all interfaces).
  void add_prescribed_opening(double time, Vector& opening) const;
};

/// Sum of one matrix of all elements, before elimination: full x full. Damping: with what the elements' own factors beta make of their
/// stiffness, without the rest of the Rayleigh damping.
Sparse assembled(Space space, std::size_t nodes, const std::vector<std::unique_ptr<const Element>>& elements, Matrix* Local::*wanted);
Sparse assembled(const Model& model, Matrix* Local::*wanted);

/// Free unknowns (values or rates) with the smallest weighted norm that give the wanted values of some full unknowns, zero prescribed
/// motion; for initial conditions. Throws InputError when supports, rigid bodies or inextensible beams make the wanted values impossible.
Vector free_values(const Model& model, const std::vector<std::pair<int, double>>& wanted, const Where& where);

/// What the scheme of filtered energy decay remembers (dynamics/joint_filter.h); empty with other schemes.
struct FilterMemory {
  double gain = 0;                // b of the scheme that remembers; 0: none
  double step = 0;                // s that the filtered increments belong to; 0: nothing is remembered
  Vector displacement, velocity;  // filtered increments of the free unknowns
  // Interface rows, as the step to come needs them: lags d_f [m] and coefficients c [Pa/m], negative where a point is open (laws/filter.h);
  // of a point with rotations filtered increments [m, rad] and, in its first row, d_f . C d_f [J]. In the state that a march hands out.
  Vector opening, coefficient;
  double stored = 0;  // J, by the filters of the interfaces
};

/// Everything that changes: a value. Copy to go back, move to accept.
struct State {
  double time = 0;                              // s
  Vector displacement, velocity, acceleration;  // free unknowns; m, m/s, m/s2
  Vector opening;                               // interface rows, all interfaces one after another [m], initial gap included
  Vector force;                                 // interface rows, end of step [N], tension > 0
  Vector mean_force;                            // the same, mean over the last step: what did the work of the step, and what is reported
  Vector history;                               // memory of all laws, one flat array
  std::vector<double> bulk_history;             // memory of all yielding solids, one flat array; empty without any
  FilterMemory filter;
  double load_factor = 1;  // share of the dead loads and prescribed motions that act; below 1 only in the first static stage

  MotionInstant instant() const { return {time, load_factor}; }
};

}  // namespace uplift
