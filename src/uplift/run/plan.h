#pragma once
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "uplift/contact/impact/impact.h"
#include "uplift/contact/method.h"
#include "uplift/dynamics/scheme.h"
#include "uplift/model/model.h"
#include "uplift/run/beam_envelope.h"

namespace uplift {

struct Facets;

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

}  // namespace uplift
