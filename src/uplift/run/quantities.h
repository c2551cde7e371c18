#pragma once
#include <span>
#include <string_view>

#include "uplift/dynamics/energy.h"
#include "uplift/run/plan.h"
#include "uplift/run/step_record.h"

namespace uplift {

/// A number of a whole interface that can be a column of the output: its word in a case, what the interface must have for it, and where it
/// is found.
struct InterfaceQuantity {
  enum class Needs { nothing, points, dashpots, bearing_strength, growing_strength, friction };
  Request::Kind kind;
  std::string_view word, unit;
  bool step_mean;  // is_step_mean
  int dimension;   // of the space; 0: in both
  Needs needs;
  const double* (*in_view)(const InterfaceView&) = nullptr;  // null: not a number of a view
  double BasePose::*in_pose = nullptr;                       // of the base above the interface; null: no motion of it
};
/// All of them, in the order of the columns.
std::span<const InterfaceQuantity> interface_quantities();
/// That of a column; null: it is of another kind.
const InterfaceQuantity* find_interface_quantity(Request::Kind kind, int dimension);

struct EnergyQuantity {
  Request::Kind kind;
  std::string_view word;
  double Energies::*of;  // J
};
/// All of them, in the order of the columns.
std::span<const EnergyQuantity> energy_quantities();
/// That of a column; null: it is no energy.
const EnergyQuantity* find_energy_quantity(Request::Kind kind);

/// Whether a column of this kind is the mean over the step before its instant where RunResult::step_means; else it belongs to the instant.
bool is_step_mean(Request::Kind kind);

}  // namespace uplift
