#pragma once
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "uplift/dynamics/energy.h"
#include "uplift/run/beam_envelope.h"
#include "uplift/run/equilibrium.h"
#include "uplift/run/plan.h"
#include "uplift/run/step_record.h"

namespace uplift {

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

/// What is recorded of the stages of one type: the columns as requested, their table, and what a plan asks for beside it.
struct Recorded {
  std::vector<Request> columns;  // as requested; the table below has time first
  // table[0]: time [s], of static stages the load factor (see RunResult::load_steps); table[1 + k]: column k.
  std::vector<std::vector<double>> table;
  std::vector<Peak> peaks;              // one per column
  std::vector<CombinedPeak> combined;   // one per motion of the plan that is made of several columns
  std::vector<FloorRecord> floors;      // one per floor of the plan
  std::vector<BeamEnvelope> envelopes;  // one per envelope of the plan
  std::vector<Frame> frames;
};

struct RunResult : Recorded {
  std::string name, label, group;
  RunStatus status = RunStatus::completed;
  std::string reason;  // why it failed or stopped
  bool expected_to_fail = false;
  Counts counts;
  double wall = 0;          // s, without what the observer takes
  double step_seconds = 0;  // s of computing for a step of the last dynamic stage, its first step (which makes the factor) left out
  double end_time = 0;      // s reached
  // Static stages before or between dynamic ones: load_steps[0] is the load factor (1 at the end of the first static stage, 2 at the end of
  // the second one), load_steps[1 + k] column k. Empty without static stages, and where there are no others: these are in `table`.
  std::vector<std::vector<double>> load_steps;
  Equilibrium equilibrium;  // of the whole model, at a few instants
  StepRecord steps;         // what the verdict is made of
  bool step_means = false;  // forces of interfaces and accelerations are means over the step before their instant
  Peak max_uplifted_ratio{"max_uplifted_ratio", "1"}, max_opening{"max_opening", "m"};
  // of the bases, means over RunPlan::window
  Peak max_base_moment{"max_base_moment", "N m"}, max_base_shear{"max_base_shear", "N"}, max_pressure{"max_pressure", "Pa"};
  Peak max_step_pressure;      // mean over one step
  double time_uplifted = 0;    // s with a gap open anywhere
  double first_uplift = -1;    // s; -1: never
  double full_loss = 0;        // s without any contact
  double max_penetration = 0;  // m
  // J, and when [s]
  double energy_created = 0, energy_created_time = 0, energy_lost = 0, energy_lost_time = 0;
  double energy_scale = 0;  // J: largest external work, or the initial energy without any
  std::string created_percent() const;
  Energies final_energy;
  std::string problem;             // the interface problem of the failed step, JSON text
  std::string not_unique;          // why the equilibrium of the last static stage is one of several; empty where it is the only one
  std::string solver;              // how it solved with the matrix of a step, where it chose; empty as a rule
  std::vector<std::string> notes;  // what the engineer should know: cycles treated, halvings, warnings of laws
};

}  // namespace uplift
