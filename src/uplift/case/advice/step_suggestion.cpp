#include "uplift/case/advice/step_suggestion.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <set>
#include <utility>

#include "uplift/base/format.h"
#include "uplift/case/mesh/mesh.h"
#include "uplift/math/sparse_solvers.h"

namespace uplift {
namespace {

constexpr double steps_a_period = 20, highest_of_structure = 50;                // Hz
constexpr double steps_a_period_of_vibration = 16, highest_of_vibration = 300;  // Hz
constexpr double steps_a_period_of_bounces = 16, highest_of_bounces = 1000;  // Hz: faster impacts take less than a twentieth of the window
constexpr double steps_a_period_of_floors = 40, highest_of_floors = 33;      // Hz: above, the spectrum of an earthquake is that of the peak
constexpr double least_width_of_peaks = 0.005;                               // damping ratios of a mode and of the equipment together
constexpr double more_for_constraints = 3;
constexpr double accepted_difference = 0.01, least_step = 1e-5, most_step = 0.1;

/// What the joints of a structure ask of the steps a period.
struct ImpactDemand {
  ResolvedMode lowest;  // steps_for_memory; 0 Hz: nothing is handed on
  double more = 1;      // times the steps a period
  std::string_view reason() const { return more > 1 ? ", for impacts of constraints" : ""; }
};

/// The mode that takes the smallest step of those from one frequency to below another.
void bound_by_range(const std::vector<ResolvedMode>& modes, double from, double below, double steps, const ImpactDemand& demand,
                    std::string_view which, std::vector<StepBound>& bounds) {
  StepBound smallest;
  for (const ResolvedMode& mode : modes) {
    if (!(mode.frequency > 0 && mode.frequency >= from && mode.frequency < below)) continue;
    const double memory = steps_for_memory(mode, demand.lowest), factor = memory * demand.more,
                 step = 1 / (factor * steps * mode.frequency);
    if (smallest.step > 0 && step >= smallest.step) continue;
    const std::string count = factor > 1 ? fmt::format("{:.0f}", factor * steps) : steps == steps_a_period ? "twenty" : "sixteen";
    smallest = {step, fmt::format("{} steps a period of the mode of {} {}{}{}", count, format_quantity(mode.frequency, "Hz"), which,
                                  memory > 1 ? ", which is hardly damped" : "", demand.reason())};
  }
  if (smallest.step > 0) bounds.push_back(std::move(smallest));
}

/// Vibrations of the structure, `which`: "with the base bonded".
void bound_by_modes(const std::vector<ResolvedMode>& modes, const ImpactDemand& demand, std::string_view which,
                    std::vector<StepBound>& bounds) {
  bound_by_range(modes, 0, highest_of_structure, steps_a_period, demand, which, bounds);
  bound_by_range(modes, highest_of_structure, highest_of_vibration, steps_a_period_of_vibration, demand, which, bounds);
}

/// An impact on a stiff joint is half a period of the bounce on it. Whether the structure comes off again, and with it the momentum that
/// the window of the verdict sees, is decided within that time.
void bound_by_bounces(const std::vector<ResolvedMode>& moving, const ImpactDemand& demand, std::vector<StepBound>& bounds) {
  double highest = 0;
  for (const ResolvedMode& mode : moving) highest = std::max(highest, mode.frequency);
  if (highest < highest_of_vibration) return;
  const double resolved = std::min(highest, highest_of_bounces), steps = demand.more * steps_a_period_of_bounces;
  const std::string count = demand.more > 1 ? fmt::format("{:.0f}", steps) : "sixteen";
  const std::string reason =
      highest > resolved ? fmt::format("{} steps a period of {}: the bounce on the closed joint has {}", count,
                                       format_quantity(resolved, "Hz"), format_quantity(highest, "Hz"))
                         : fmt::format("{} steps a period of the bounce on the closed joint, {}", count, format_quantity(highest, "Hz"));
  bounds.push_back({1 / (steps * resolved), fmt::format("{}{}", reason, demand.reason())});
}

/// A wave shall not cross more than one face of the interface in a step, on the softer side: what a contact that opens or closes sends out
/// is not resolved otherwise.
void bound_by_contact_mesh(const Case& read, const BuiltCase& built, std::vector<StepBound>& bounds) {
  if (!read.mesh) return;
  const CaseSolids solids(*read.input, *read.mesh);
  for (std::size_t k = 0; k < built.facts.size(); ++k) {
    double speed = 0;
    for (const FacePair& faces : built.facts[k].faces)
      for (const CellId side : {faces.lower, faces.upper})
        if (const CaseSolids::Solid* solid = solids.beside(side); solid && solid->section.material.density > 0) {
          const double here = solid->section.material.p_wave_speed();
          speed = speed > 0 ? std::min(speed, here) : here;
        }
    const Interface& interface = built.model.interfaces[k];
    if (!(speed > 0)) continue;
    const double face = interface.area.sum() / static_cast<double>(built.facts[k].faces.size());
    const double size = interface.space.dimension == 3 ? std::sqrt(face) : face / built.facts[k].depth;
    bounds.push_back({size / speed, fmt::format("waves of {} cross a face of \"{}\", {}, in one step", format_quantity(speed, "m/s"),
                                                interface.name, format_quantity(size, "m"))});
  }
}

/// Floor spectra ask for more than the forces: the period error of the scheme, (w h)^2/12, moves their peaks. Equipment that is tuned to a
/// mode feels it by about half of 1/(damping of the mode + its own): the less both are damped, the narrower is the peak.
void bound_by_floors(const RunPlan& plan, const ResolvedModes& modes, std::vector<StepBound>& bounds) {
  double highest = 0, least_damping = 1;
  for (const FloorRequest& floor : plan.floors) {
    if (!floor.frequencies.empty()) highest = std::max(highest, std::min(floor.frequencies.back(), highest_of_floors));
    for (const double damping : floor.dampings) least_damping = std::min(least_damping, damping);
  }
  if (!(highest > 0)) return;
  bounds.push_back({1 / (steps_a_period_of_floors * highest),
                    fmt::format("forty steps a period of the floor spectra at {}", format_quantity(highest, "Hz"))});
  StepBound smallest;
  for (const std::vector<ResolvedMode>* each : {&modes.bonded, &modes.base_free})
    for (const ResolvedMode& mode : *each) {
      if (!(mode.frequency > 0 && mode.frequency <= highest)) continue;
      const double damping = mode.damping + least_damping, width = std::max(damping, least_width_of_peaks);
      const double steps = 2 * std::numbers::pi / std::sqrt(12 * accepted_difference * 2 * width), step = 1 / (steps * mode.frequency);
      if (smallest.step > 0 && step >= smallest.step) continue;
      const std::string damped = damping < least_width_of_peaks
                                     ? fmt::format("{:.2g} % together, taken as {:.2g} % at least", 100 * damping, 100 * width)
                                     : fmt::format("{:.2g} % together", 100 * width);
      smallest = {step, fmt::format("{:.0f} steps a period of the peak of the floor spectra at {}, where the mode and the equipment are "
                                    "damped by {}",
                                    steps, format_quantity(mode.frequency, "Hz"), damped)};
    }
  if (smallest.step > 0) bounds.push_back(std::move(smallest));
}

/// Lumped mass of one element: the diagonal of its matrix, scaled so that the translations have all of its mass (Hinton, Rock and
/// Zienkiewicz 1976). Sums of rows are negative at the corners of quadratic cells. The mass of a single node is whole as it is.
void add_lumped(const Element& element, Space space, std::vector<Triplet>& entries) {
  Matrix mass;
  Local wanted;
  wanted.mass = &mass;
  element.form(wanted);
  const std::vector<int> nodes(element.nodes().begin(), element.nodes().end());
  const Index each = element.unknowns_per_node();
  double total = 0, diagonal = 0;
  for (Index j = 0; j < mass.cols(); ++j) {
    if (j % each >= space.dimension) continue;
    diagonal += mass(j, j);
    for (Index i = j % each; i < mass.rows(); i += each) total += mass(i, j);
  }
  const bool single = nodes.size() == 1;
  const double scale = single ? 1 : diagonal > 0 ? total / diagonal : 0;
  const auto unknown = [&](Index i) { return space.unknowns() * nodes[static_cast<std::size_t>(i / each)] + static_cast<int>(i % each); };
  for (Index j = 0; j < mass.cols(); ++j)
    for (Index i = single ? 0 : j; i < (single ? mass.rows() : j + 1); ++i)
      if (mass(i, j) != 0) entries.emplace_back(unknown(i), unknown(j), scale * mass(i, j));
}

/// How easily the lumped masses follow a force on an interface row: b M^-1 b^T on the free unknowns, so that the faces of a rigid body move
/// with all of its mass and its rotary inertia, and supported ones not at all.
class Mobility {
 public:
  explicit Mobility(const Model& model) {
    std::vector<Triplet> entries;
    for (const auto& element : model.elements) add_lumped(*element, model.space, entries);
    Sparse full(model.full_unknowns(), model.full_unknowns());
    full.setFromTriplets(entries.begin(), entries.end());
    Sparse mass = model.expansion * full * model.reduction();
    diagonal_ = mass.diagonal();
    // Unknowns without mass are left out; motions without mass get a little, by which they are known.
    std::vector<Triplet> more;
    for (Index i = 0; i < diagonal_.size(); ++i)
      more.emplace_back(static_cast<int>(i), static_cast<int>(i), diagonal_[i] > 0 ? 1e-9 * diagonal_[i] : 1);
    Sparse little(mass.rows(), mass.cols());
    little.setFromTriplets(more.begin(), more.end());
    mass += little;
    factor_.compute(mass);
  }

  /// 1/kg; 0: nothing moves, or something without mass.
  double of_row(const Sparse& b, Index row) const {
    Vector force = Vector::Zero(diagonal_.size());
    double alone = 0;  // without what couples the unknowns
    for (Index i = 0; i < diagonal_.size(); ++i)
      if (diagonal_[i] > 0) {
        force[i] = b.coeff(row, i);
        alone += force[i] * force[i] / diagonal_[i];
      }
    if (!(alone > 0) || factor_.info() != Success) return 0;
    const double whole = force.dot(Vector(factor_.solve(force)));
    return whole < 1e6 * alone ? whole : 0;
  }

 private:
  Vector diagonal_;
  SparseLdlt factor_;
};

/// A floor at the lip of a joint feels what each closing does to the two faces there: half a period of their own vibration on the closed
/// joint, w^2 = A K (1/m + 1/m') with the masses that move with the faces.
void bound_by_lips(const BuiltCase& built, std::vector<StepBound>& bounds) {
  const Model& model = built.model;
  if (built.plan.floors.empty() || model.interfaces.empty() || model.distributed != nullptr) return;
  std::set<int> floors;
  for (const FloorRequest& floor : built.plan.floors) floors.insert(floor.node);
  const SparseRows rows = model.assembly.b;
  std::optional<Mobility> mobility;
  double highest = 0;
  Index first = 0;
  for (const Interface& joint : model.interfaces) {
    const int points = joint.batch.points, components = joint.batch.components;
    double stiffness[most_components] = {};
    if (joint.law != nullptr && joint.batch.rotations == 0) joint.law->closed_stiffness(components, stiffness);
    for (int row = 0; row < components * points; ++row) {
      bool at_floor = false;
      for (SparseRows::InnerIterator entry(rows, first + row); entry; ++entry)
        at_floor = at_floor || floors.contains(static_cast<int>(model.space.node_of(entry.col())));
      if (!at_floor) continue;
      if (!mobility) mobility.emplace(model);
      const double square = joint.weight[row % points] * stiffness[row / points] * mobility->of_row(joint.b, row);
      highest = std::max(highest, std::sqrt(square) / (2 * std::numbers::pi));
    }
    first += joint.rows();
  }
  if (!(highest > 0)) return;
  const double resolved = std::min(highest, highest_of_bounces);
  bounds.push_back({1 / (steps_a_period_of_bounces * resolved),
                    fmt::format("sixteen steps a period of {}: the faces of the joint at a floor vibrate on it with {}",
                                format_quantity(resolved, "Hz"), format_quantity(highest, "Hz"))});
}

void bound_by_loads(const BuiltCase& built, std::vector<StepBound>& bounds) {
  double smallest = most_step;
  const TimeLoad* fastest = nullptr;
  for (const TimeLoad* time_load : varying_loads(built.model)) {
    const double step =
        step_that_resolves(*time_load->function, static_cast<int>(time_load->order), dynamic_duration(built.plan), smallest);
    if (step < smallest) smallest = step, fastest = time_load;
  }
  if (fastest)
    bounds.push_back({smallest, fmt::format("straight lines between the steps follow the load \"{}\" within 1 %", fastest->name)});
}

}  // namespace

std::vector<const TimeLoad*> varying_loads(const Model& model) {
  std::vector<const TimeLoad*> found;
  for (const TimeLoad& time_load : model.time_loads)
    if (!time_load.constant && !time_load.dead && time_load.function) found.push_back(&time_load);
  return found;
}

double dynamic_duration(const RunPlan& plan) {
  double duration = 0;
  for (const Stage& stage : plan.stages)
    if (stage.type == Stage::Type::dynamics) duration += stage.duration;
  return duration;
}

double unresolved_share(const TimeFunction& function, int derivative, double duration, double step) {
  constexpr double most_samples = 2e5;
  const double fine = std::max({least_step, duration / most_samples, step / 1000});
  const auto count = std::max(1L, std::lround(duration / fine));
  double difference = 0, size = 0, begin = 0, left = smooth_derivative_of(function, derivative, 0),
         right = smooth_derivative_of(function, derivative, step);
  for (long i = 0; i < count; ++i) {
    const double time = (static_cast<double>(i) + 0.5) * fine;
    while (time > begin + step) begin += step, left = right, right = smooth_derivative_of(function, derivative, begin + step);
    const double value = smooth_derivative_of(function, derivative, time), share = (time - begin) / step;
    difference += std::abs(value - (left + share * (right - left)));
    size += std::abs(value);
  }
  return size > 0 ? difference / size : 0;
}

double step_that_resolves(const TimeFunction& function, int derivative, double duration, double most) {
  double step = most;
  while (step > least_step * (1 + 1e-9) && unresolved_share(function, derivative, duration, step) > accepted_difference)
    step = rounded_down(0.6 * step);
  return std::max(step, least_step);
}

double steps_for_memory(const ResolvedMode& mode, const ResolvedMode& lowest) {
  constexpr double measured_damping = 0.02, little = 1.05, most = 4;  // of the structures with which the steps a period were measured
  if (!(lowest.frequency > 0)) return 1;
  const double damping = std::max(mode.damping, lowest.damping);
  const double until_impact = 2 * std::numbers::pi * mode.frequency / lowest.frequency;  // w t
  const double remembered = damping > 0 ? std::min(until_impact, 1 / (std::numbers::e * damping)) : until_impact;
  const double factor = std::sqrt(remembered * std::numbers::e * measured_damping);
  return factor < little ? 1 : std::min(factor, most);
}

std::vector<StepBound> step_bounds(const Case& read, const BuiltCase& built, const ResolvedModes& modes) {
  std::vector<StepBound> bounds;
  const bool opens = !built.model.interfaces.empty();
  // Without impacts no phase matters. An impact of constraints comes at the end of its step, half a step late on average: an error of first
  // order, which outweighs what is handed on.
  ImpactDemand demand;
  if (opens && built.plan.method->constrains())
    demand.more = more_for_constraints;
  else if (opens)
    demand.lowest = modes.lowest;
  bound_by_modes(modes.bonded, demand, "with the base bonded", bounds);
  if (opens) {
    bound_by_modes(modes.base_free, demand, "with the base free", bounds);
    bound_by_bounces(modes.moving, demand, bounds);
  }
  bound_by_contact_mesh(read, built, bounds);
  bound_by_floors(built.plan, modes, bounds);
  bound_by_lips(built, bounds);
  bound_by_loads(built, bounds);
  std::ranges::stable_sort(bounds, {}, &StepBound::step);
  return bounds;
}

}  // namespace uplift
