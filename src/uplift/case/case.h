#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "uplift/base/declare.h"
#include "uplift/case/build/records.h"
#include "uplift/case/constant_loads.h"
#include "uplift/case/schema/case_table.h"
#include "uplift/case/schema/verdict_quantities.h"
#include "uplift/mesh/split.h"
#include "uplift/run/run.h"

// From the checked case file to something that can be run.
namespace uplift {

struct CaseMesh;     // case/mesh/mesh.h
struct CaseDamping;  // case/schema/analysis_sections.h
struct CaseInput;    // case/schema/case_input.h
struct FreeInput {
  void operator()(const CaseInput* input) const;
};

/// A checked case file. It is moved and never copied: the input points into the values.
struct Case {
  Values values;                                      // of case_section()
  std::string file;                                   // as the user gave it
  std::shared_ptr<const CaseMesh> mesh;               // opened along the interfaces; null without
  std::vector<CaseRecord> records;                    // in the order of the file
  std::unique_ptr<const CaseInput, FreeInput> input;  // the values as structs
};

/// Reads the mesh of a path; the place names the file, the last text is the mesh to take when there are several.
using MeshReader = std::function<Mesh(const std::string&, const Where&, const std::string&)>;

/// Checks a case file that was read, reads or makes its mesh, and reads its records. A case with a mesh file needs a reader. Throws
/// InputError.
Case check_case(const Raw& raw, const std::string& file, const MeshReader& read_mesh = {});
/// The same for a file with the records of `like`, and with its mesh where `same_mesh`: these are not read or made again.
Case check_case_like(const Case& like, bool same_mesh, const Raw& raw, const MeshReader& read_mesh = {});

/// Other files that the case reads (tables of functions, the mesh, records), as paths that can be opened from here.
std::vector<std::string> input_files(const Case&);

/// One run of a case: what differs from the case as it stands. Null and empty: as in the case. Points into the case's values and input.
struct RunSpec {
  std::string name, label, group;
  std::string other_case;       // file of the case that is run; empty: this one
  const Values* law = nullptr;  // law or cone of the interface ...
  std::string interface;        // ... of this name; empty: of all
  const Values* method = nullptr;
  const Values* impact = nullptr;
  const Values* scheme = nullptr;
  const CaseDamping* damping = nullptr;
  std::optional<bool> path_average;
  std::optional<double> step, duration;     // s, of the dynamic stages
  double step_factor = 1;                   // of the steps of the dynamic stages
  std::optional<double> stiffness_ratio;    // the law's stiffness is chosen so that the largest k F_ii is this
  std::string stiffness_parameter;          // parameter of the law that is the stiffness
  const CaseOtherMotion* motion = nullptr;  // [[compare.motion]]: records that take the place of others; null: the case's own
  double motion_factor = 1;                 // of everything that moves the ground: records and functions
  std::string motion_label;                 // of a comparison over motions; empty: none
  bool bonded = false;                      // elastic interfaces that never open, as stiff as the closed joint
  bool rigid_ground = false;                // elastic beds are left out
  bool expected_to_fail = false;
  bool pictures = true;  // keep frames for the animation
};

/// What `uplift run` does: the case itself, then (unless it says bonded = false) the bonded model.
std::vector<RunSpec> runs_of_case(const Case&);

/// A dynamic stage with fewer steps than this is not run with twice the step.
inline constexpr double least_steps_to_compare = 4;

/// The companions of runs_of_case(): the same runs with twice the step, which tell how far the numbers depend on it. None where the case
/// does not ask for them, and without a dynamic stage of at least four steps.
std::vector<RunSpec> companions_of_case(const Case&);

/// What `uplift compare` does: every variant (the case itself when there are none) and the bonded model, with every damping and every
/// motion; and the runs of the stiffness sweep.
struct Comparison {
  std::vector<RunSpec> runs;
  std::vector<RunSpec> sweep;  // pairs: path average, end of step; in the order of the ratios
};
Comparison comparison_of_case(const Case&);
/// Whether a case has something to compare: variants, or other motions.
bool compares(const Case&);

/// What an interface is to the structure: a base below it, which may lift off, or a wall beside it.
enum class Role { base, wall };
std::string_view to_string(Role);

/// What the report and the verdict want to know of an interface beyond the model.
struct InterfaceFacts {
  std::string name, body;         // body: node that carries the upper side; empty when there is none
  std::vector<Place> corners;     // m, of a footing; without: the nodes of the upper side say how far it goes
  double friction = -1;           // coefficient; negative: none stated
  double cohesion = 0;            // Pa: shear strength without pressure
  double area = 0;                // m2
  double tension = 0;             // Pa: tensile strength of the law, 0 without
  std::vector<int> upper, lower;  // nodes of either side, each once
  Role role = Role::base;
  double depth = 0;                           // m out of the plane; 0 in space and for isolated pairs, which have only an area
  std::vector<FacePair> faces;                // of the mesh, opened along it
  std::string why_no_cones;                   // where its points are too many for constraints, in words; empty: they are not
  bool nodal = true;                          // its points stand at node pairs; of faces only
  std::shared_ptr<const FootingOnSoil> soil;  // whose stiffness it has; null: none
  std::shared_ptr<const Facets> facets;       // the surface between the points; null for node pairs on their own
};

/// Nodes of the model along beams, one after another, as they are drawn.
struct BeamLine {
  std::string name;  // of the beam
  std::vector<int> nodes;
  bool of_group = false;                   // of a group of the mesh: its inner nodes are the program's
  int first_element = 0, end_element = 0;  // elements of the model that the beam, all its lines, is made of
};

/// A limit that the user sets for a number of the verdict.
struct Criterion {
  const VerdictQuantity* quantity = nullptr;
  double limit = 0;    // in the quantity's unit
  std::string source;  // where the limit comes from, in the user's words
  int interface = -1;  // -1: all
  std::string beam;    // of the quantities of beams; empty: every beam with an envelope
};
/// What the case asks of the verdict.
struct VerdictRequest {
  double window = 0;               // s, see StepRecord::average
  std::vector<double> thresholds;  // of the uplifted share: how long it is above
  std::vector<Criterion> criteria;
};

/// Where a function of time of a run comes from: change_motion().
struct FunctionUse {
  std::shared_ptr<const TimeFunction> made;
  std::optional<NameUsed> name;    // where it is used; absent: constant
  std::optional<MotionKind> kind;  // the quantity taken of a record, none where no motion can stand
  std::optional<double> factor;    // that it is multiplied by
};

/// A case made ready to run.
struct BuiltCase {
  Model model;
  RunPlan plan;
  std::vector<const Values*> behaviours;               // one per interface: law or cone as in the case file
  std::vector<std::unique_ptr<const Values>> derived;  // behaviours made here (bonded, swept)
  std::vector<InterfaceFacts> facts;                   // one per interface, bases first
  VerdictRequest verdict_request;                      // thresholds and criteria
  std::vector<MotionUse> motions;                      // records that drive it
  std::vector<std::string> notes;                      // what was chosen automatically (tuned mass, scaled penalty)
  double tuned_mass = 0;                               // kg: of the tuned point mass, 0 without
  std::vector<FunctionUse> functions;                  // of all that moves or loads the model
  bool laws_of_step = false;                           // some behaviour made here depends on the step
  std::vector<ConstantLoads> constant_loads;           // one per interface (the soil's too where a surface ends inside it)
  // Nodes whose motion is shown: the one that the case names, or the highest one of the structure; the first interface's body
  int top = -1, base = -1;
  Vec3 top_arm = Vec3::Zero();  // m, from the node `top` to the top: the centre of mass of a rigid body that has no node as high, else zero
  Dof sway = ux;                // horizontal direction that is shown: in space that of the larger loads
  std::set<int> bare;           // nodes that stand outside of what their cut cells fill
  std::vector<BeamLine> beams;  // every beam of the case, one of a group in as many lines as it takes
  // Full unknowns that are shown; -1 without the node: sway of the top, vertical motion of the base, its rotation in the plane of the sway
  int top_sway() const { return top < 0 ? -1 : model.at(top, sway); }
  int base_lift() const { return base < 0 ? -1 : model.at(base, model.space.dof(model.space.up())); }
  int base_turn() const { return base < 0 ? -1 : model.at(base, model.space.dimension == 2 ? rz : sway == ux ? ry : rx); }
  Place top_place() const { return model.nodes[static_cast<std::size_t>(top)].position + top_arm; }  // where there is one
  std::string name_of_top() const;  // "node t", "the centre of mass of m"; empty: there is none
  /// N: of the constant loads on what the first interface carries, against its mean normal.
  double weight() const { return constant_loads.empty() ? 0 : constant_loads.front().all.force; }
  /// The interface's moment and rotation that go with the sway.
  Request::Kind base_moment() const;
  Request::Kind base_rotation() const;
  Request::Kind base_tilt() const;
  /// The model with all supports, those of static stages alone too.
  const Model& at_rest() const { return plan.rest ? *plan.rest : model; }
  /// Number of interfaces that are bases; they come first. All interfaces of a model without any base count as such in sums over bases.
  std::size_t bases() const;
  /// A model in the plane in which every interface is 1 m deep: its forces are per metre.
  bool is_strip() const;
};

/// Makes the model and the plan of one run. Throws InputError (dangling or duplicate names, mechanisms, contradictions).
BuiltCase build(const Case&, const RunSpec&);

/// Puts the motions of another run of the same case, with the same interfaces, into a run that was built: the functions of its loads and
/// ground accelerations. False, with the run unchanged, where more than these functions would have to follow (incident waves, prescribed
/// motions, static stages under a record).
bool change_motion(const Case&, const RunSpec&, BuiltCase&);

/// Puts the steps, the name and the pictures of another run of the same case into a run that was built. False, with the run unchanged,
/// where more depends on the step than functions that change_motion() can follow.
bool change_steps(const Case&, const RunSpec&, BuiltCase&);

/// The solver named by the case.
std::shared_ptr<const LinearSolver> bulk_solver(const Case&);

/// Natural modes with every interface closed and bonded: laws with their closed stiffness, cones held. Shapes on the free unknowns.
std::vector<Mode> bonded_modes(const Model&, int count);
/// Natural modes with every opening and sliding of the interfaces held to zero against rigid ground: the fixed-base frequencies.
/// What is connected to lower sides alone (an elastic bed, the soil) is held too.
std::vector<Mode> fixed_base_modes(const Model&, int count);
/// Of the model with open interfaces.
std::vector<Mode> base_free_modes(const Model&, int count);

/// What is to be known of floor spectra of a constraint method; a clause without a head.
inline constexpr std::string_view floors_of_constraints =
    "rigid ground stops what comes down within one step, and this impulse is in the spectra; the acceleration of the body itself lacks it. "
    "Do not believe high frequencies, where half the step changes them (`uplift trust`), or take a joint of finite stiffness";

/// What an engineer should know before believing the results: closure stress too large, step too coarse, suspicious magnitudes, unsound
/// combinations of method, impact rule and traction. One sentence each.
std::vector<std::string> warnings(const Case&, const RunSpec&, const BuiltCase&);

}  // namespace uplift
