#pragma once
#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "uplift/contact/impact/impact.h"
#include "uplift/contact/method.h"
#include "uplift/dynamics/energy.h"
#include "uplift/dynamics/scheme.h"
#include "uplift/model/model.h"
#include "uplift/run/beam_envelope.h"
#include "uplift/run/equilibrium.h"
#include "uplift/run/step_record.h"

namespace uplift {

class Stepper;
struct Facets;
struct ForceStage;
struct Keeping;

// ---- what is to be done ----

struct Stage {
  enum class Type { statics, dynamics } type = Type::dynamics;
  int steps = 1;        // statics: equal load steps
  double duration = 0;  // s
  double step = 0;      // s
  Scheme scheme;
  bool path_average = true;  // traction laws; average acceleration only, filtered or not
  bool p_delta = false;      // constant geometric stiffness of the preceding static state; of a static stage, at the end of its load steps
  int halvings = 8;          // a step that fails is halved at most so often
};

/// One column of the output.
struct Request {
  enum class Kind {
    displacement,
    velocity,
    acceleration,           // full unknown
    absolute_acceleration,  // of a translation: with the ground's in the relative frame
    opening,
    traction,      // interface, point, component (normal last): mean over the step, the force that did its work
    end_traction,  // the same at the end of the step
    axial,
    shear,
    moment,
    rotation,
    shear_1,
    shear_2,
    moment_1,
    moment_2,
    torsion,
    rotation_1,
    rotation_2,  // space only
    uplifted_ratio,
    max_opening,
    max_pressure,  // interface
    bearing_utilisation,
    sliding_utilisation,
    bearing_capacity,  // of a whole foundation, at the end of the step
    law_axial,
    law_shear,
    law_moment,
    law_shear_1,
    law_shear_2,
    law_moment_1,
    law_moment_2,
    law_torsion,  // of a whole foundation: InterfaceView::in_law
    kinetic,
    strain,
    stored,
    interface_dissipated,
    damping,
    impact,
    external,
    residual,
    plastic,
    algorithmic,
    filter,
    stop,  // energies [J]
    settlement,
    tilt_1,
    tilt_2,  // of the base above an interface: BasePose [m, rad]
    force    // inside the structure or of its constraints, see `force` below
  } kind = Kind::displacement;
  std::string name, unit;
  int unknown = 0;                              // full unknown
  int below = -1;                               // full unknown whose displacement is subtracted (drift); -1: none
  double factor = 1;                            // of the difference
  std::optional<double> level;                  // m: of a storey shear, with its axis as component, like a drift
  std::shared_ptr<const ForceQuantity> force;   // kind `force`
  int interface = 0, point = 0, component = 0;  // `rotation` of an interface: slope of the opening's best plane [rad]
};

/// A motion, a storey shear or a drift made of several columns, whose largest length is kept, formed at every step.
struct CombinedRequest {
  struct Term {
    Request::Kind kind = Request::Kind::displacement;
    int of = 0;  // the full unknown of a displacement, else the interface
    double factor = 1;
    std::string column = {};  // its name, where kind and `of` do not tell it from others
  };
  std::string name, unit = "m";                    // N: storey shear, 1: drift ratio
  std::vector<std::vector<Term>> components = {};  // sums of columns, at right angles; one alone keeps its sign. At most two
};

/// The first column of this kind and this unknown (of a motion of a node, no drift) or interface; -1: there is none.
int find_request(const std::vector<Request>& columns, Request::Kind kind, int unknown_or_interface);
/// The column of this name; -1: there is none.
int find_request(const std::vector<Request>& columns, std::string_view name);

/// A floor whose response spectra are wanted, from its absolute acceleration.
struct FloorRequest {
  std::string name;
  int node = 0;
  Vec3 direction = Vec3::UnitX();   // of length 1
  std::vector<double> dampings;     // ratios to the critical damping, of the equipment
  std::vector<double> frequencies;  // Hz, ascending
  double broadening = 0.15;         // share to either side; 0: none
};

struct RunPlan {
  std::string name, label, group;
  std::vector<Stage> stages;
  // With the supports that hold in static stages alone, which the run's model lacks; null: there are none. Same nodes and interface rows.
  std::shared_ptr<const Model> rest;
  std::shared_ptr<const ContactMethod> method;
  std::shared_ptr<const ImpactRule> impact;
  std::shared_ptr<const LinearSolver> solver;  // of the bulk when it is not small
  InterfaceSolver interface_solver = InterfaceSolver::automatic;
  bool monolithic = false;  // the oracle: Newton on all unknowns
  std::vector<Request> requests;
  std::vector<CombinedRequest> combined;
  std::vector<FloorRequest> floors;  // with these, all dynamic stages have the same step
  std::vector<double> floor_bands;   // Hz, ascending: what parts the bands in which floor spectra are compared
  std::vector<EnvelopeRequest> envelopes;
  int every = 1;                 // record every n-th step
  double created_limit = 0.01;   // of the external work; a run that creates more fails
  bool stop_at_limit = false;    // else it goes on to the end and is marked
  double rotation_limit = 0.15;  // rad: beyond the small-displacement model: overturned
  // m, beyond the initial gap: an interface that is open everywhere by more is as far beyond that model: separated. 0: no limit
  double separation_limit = 0;
  double window = 0;                                  // s: forces of the verdict are means over it, or over the step where that is longer
  double gap_tolerance = 1e-9;                        // m: a gap larger than this counts as uplifted
  std::vector<std::shared_ptr<const Facets>> facets;  // of every interface, see InterfaceFacts; may be empty
  std::vector<char> is_wall;            // per interface: not a base, left out of what is said of the bases; empty: all are bases
  std::vector<std::vector<int>> bases;  // nodes of the upper side of every interface, whose settlement and tilt are kept; may be empty
  bool expected_to_fail = false;
  int frames = 0;                                 // pictures kept for the animation (0: none)
  std::vector<int> pictured;                      // nodes whose motion they keep, ascending; empty: all
  Vector initial_displacement, initial_velocity;  // free unknowns; empty: zero
  double oracle_tolerance = 0;  // > 0: every condensed step is also taken by the oracle; a larger relative difference fails it
};

/// The first dynamic stage of a plan, or null.
const Stage* dynamic_stage(const RunPlan&);
/// There are stages, and none of them is dynamic: how the structure stands at their end is the result.
bool statics_alone(const RunPlan&);
/// Static stages that follow a dynamic one at once: positions in the plan.
std::vector<std::size_t> stopping_stages(const RunPlan&);

// ---- what came out ----

enum class RunStatus { completed, overturned, separated, failed, interrupted };
std::string_view to_string(RunStatus);

struct Peak {
  std::string name, unit;
  double value = 0;  // signed value of largest magnitude
  double time = 0;   // s
};

/// Of a CombinedRequest.
struct CombinedPeak {
  double value = 0, time = 0;             // the largest length, with the sign of a component alone; s
  std::array<double, 2> least{}, most{};  // of every component
  bool known = false;                     // something was recorded
};

struct Counts {
  long steps = 0, load_steps = 0, retries = 0, iterations = 0, cycles = 0;  // load_steps: of the static stages, those that converged
  long factorisations = 0, back_solves = 0;
  InterfaceSystems systems;
};

struct Frame {
  double time = 0;
  Vector displacement;           // full unknowns of all nodes, or of those of RunPlan::pictured, one node after another
  Vector opening, pressure;      // normal rows of all interfaces [m], [Pa] compression > 0
  std::vector<double> uplifted;  // share of the area of every interface
};

/// Absolute acceleration of a floor at every step of the dynamic stages, from their beginning, whatever the output's `every` is.
struct FloorRecord {
  double step = 0;                   // s
  std::vector<double> acceleration;  // m/s2
};

struct RunResult {
  std::string name, label, group;
  RunStatus status = RunStatus::completed;
  std::string reason;  // why it failed or stopped
  bool expected_to_fail = false;
  Counts counts;
  double wall = 0;               // s, without what the observer takes
  double step_seconds = 0;       // s of computing for a step of the last dynamic stage, its first step (which makes the factor) left out
  double end_time = 0;           // s reached
  std::vector<Request> columns;  // as requested; the table below has time first
  // table[0]: time [s], table[1 + k]: column k. Of static stages alone it holds their load steps: load_steps is then empty.
  std::vector<std::vector<double>> table;
  // Static stages before or between dynamic ones: load_steps[0] is the load factor (1 at the end of the first static stage, 2 at the end of
  // the second one), load_steps[1 + k] column k. Empty without static stages.
  std::vector<std::vector<double>> load_steps;
  std::vector<Peak> peaks;              // one per column
  std::vector<CombinedPeak> combined;   // one per motion of the plan that is made of several columns
  std::vector<FloorRecord> floors;      // one per floor of the plan
  std::vector<BeamEnvelope> envelopes;  // one per envelope of the plan
  Equilibrium equilibrium;              // of the whole model, at a few instants
  StepRecord steps;                     // what the verdict is made of
  bool step_means = false;              // forces of interfaces and accelerations are means over the step before their instant
  Peak max_uplifted_ratio, max_opening;
  Peak max_base_moment, max_base_shear, max_pressure;                                         // of the bases, means over RunPlan::window
  Peak max_step_pressure;                                                                     // mean over one step
  double time_uplifted = 0;                                                                   // s with a gap open anywhere
  double first_uplift = -1;                                                                   // s; -1: never
  double full_loss = 0;                                                                       // s without any contact
  double energy_created = 0, energy_created_time = 0, energy_lost = 0, energy_lost_time = 0;  // J
  double energy_scale = 0;     // J: largest external work, or the initial energy without any
  double max_penetration = 0;  // m
  std::string created_percent() const;
  Energies final_energy;
  std::vector<Frame> frames;
  std::string problem;             // the interface problem of the failed step, JSON text
  std::string not_unique;          // why the equilibrium of the last static stage is one of several; empty where it is the only one
  std::vector<std::string> notes;  // what the engineer should know: cycles treated, halvings, warnings of laws
};

/// Told now and then; returning false stops the run after the present step (its results are complete up to there).
struct Progress {
  double fraction = 0, time = 0, step = 0, open_fraction = 0, energy_error = 0;
};
using Watch = std::function<bool(const Progress&)>;

/// A state that a run has reached. Everything ends with the call.
struct Snapshot {
  const State& state;
  const Stepper* stepper;    // of a dynamic stage, for accelerations; null at the end of a static stage or where it failed
  const RunResult& so_far;   // peaks and counts up to here
  std::size_t stage;         // of the plan
  long step;                 // of the stage, from 0
  bool last;                 // of the stage, also when the run ends here
  const ForceStage& forces;  // what the forces inside the structure depend on beside the state
};
/// Sees the end of every static stage, the state at the beginning of the first dynamic one, and every step.
using Observe = std::function<void(const Snapshot&)>;

/// Runs all stages. `behaviours` are the checked parameters of the interfaces' laws (for problem files). Never throws for numerical
/// reasons; what the observer throws ends it. `keeping` (run_state.h): states of the run that another run can go on from; null: none.
RunResult run(const Model& model, const RunPlan& plan, const std::vector<const Values*>& behaviours, const Watch& watch = {},
              const Observe& observe = {}, const Keeping* keeping = nullptr);

/// What `uplift check` says of an interface: stiffness of a closed joint times compliance at the dynamic step.
struct StiffnessRatio {
  std::string interface;
  double least = 0, most = 0;  // k F_ii over the points
  double compliance = 0;       // largest normal F_ii [m/N]
};
std::vector<StiffnessRatio> stiffness_ratios(const Model& model, const Stage& dynamic_stage, const LinearSolver& solver);

}  // namespace uplift
