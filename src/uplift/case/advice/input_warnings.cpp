#include "uplift/case/advice/input_warnings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "uplift/base/format.h"
#include "uplift/base/text.h"
#include "uplift/case/build/model.h"
#include "uplift/case/build/records.h"
#include "uplift/elements/bulk_laws/drucker_prager.h"
#include "uplift/laws/stated.h"
#include "uplift/model/function_jumps.h"
#include "uplift/motion/formats/record_format.h"
#include "uplift/motion/intensity.h"

namespace uplift {
namespace {

std::string place_of(const Values& table, std::string_view key) {
  return fmt::format("{}:{}: ", table.where(key).file, table.where(key).line);
}

/// Rough rock has at most about 1.
void warn_friction(const BuiltCase& built, std::vector<std::string>& said) {
  constexpr double most = 2;
  for (const Values* law : built.behaviours)
    if (const auto friction = stated_numbers(*law).friction; friction && *friction > most)
      said.push_back(
          place_of(*law, "friction") +
          fmt::format("friction = {:g} is a coefficient, not an angle: an angle of 35 degrees has tan(35 deg) = 0.70", *friction));
}

/// A circle around Tresca's hexagon: without friction the compression edges are those of extension, and pure shear bears 2/sqrt(3) c.
void warn_cone(const CaseInput& input, std::vector<std::string>& said) {
  if (input.space.dimension != 2) return;
  for (const CaseElement& solid : input.elements_at(ElementPlace::cells)) {
    const Values* law = stated_bulk_law(*solid.table);
    const std::string* fit = law != nullptr ? fit_too_strong(*law) : nullptr;
    if (fit == nullptr) continue;
    said.push_back(place_of(*law, "friction_angle") +
                   fmt::format("fit = \"{}\" in plane strain: without friction the ground bears 2/sqrt(3) = 1.15 times what its cohesion "
                               "does; take fit = \"plane_strain\"",
                               *fit));
  }
}

void warn_gravity(const std::optional<CaseGravity>& gravity, std::vector<std::string>& said) {
  const double size = gravity ? gravity->acceleration.norm() : 0;
  if (size > 0 && (size < 9 || size > 10.5))
    said.push_back(place_of(*gravity->table, "acceleration") +
                   fmt::format("the weight acts with {:g} m/s2, on Earth it is 9.81 m/s2; is the unit right (981 cm/s2)?", size));
}

void warn_damping(const std::optional<CaseDamping>& damping, std::vector<std::string>& said) {
  constexpr double most = 0.5;
  if (!damping) return;
  for (const CaseDamping::Ratio& ratio : damping->ratios)
    if (ratio.value >= most)
      said.push_back(
          place_of(*ratio.table, ratio.key) +
          fmt::format("a damping ratio of {:g} is {:g} % of the critical damping; 5 % are 0.05", ratio.value, 100 * ratio.value));
}

/// Positive upwards, where positive downwards is meant.
void warn_upward_gravity(const CaseInput& input, const BuiltCase& built, std::vector<std::string>& said) {
  const std::optional<CaseGravity>& gravity = input.gravity;
  const int up = input.space.dimension - 1;
  if (!gravity || !(gravity->acceleration[up] > 0) || built.weight() > 0 || input.interfaces.empty()) return;
  said.push_back(
      place_of(*gravity->table, "acceleration") +
      fmt::format("gravity acts upwards, along +{}, and presses no base onto the ground; is its sign right?", up == 1 ? "y" : "z"));
}

/// Accelerations of a file that are no earthquake in the unit that the case states, and would be one in another unit.
void warn_units_of_records(const Case& read, std::vector<std::string>& said) {
  constexpr double weakest = 0.6, strongest = 25;  // m/s2
  const auto is_earthquake = [](double peak) { return peak >= weakest && peak <= strongest; };
  for (const CaseRecordSource& source : read.input->records) {
    const std::optional<MotionUnit> stated = motion_unit(source.options.unit);
    const auto record = std::ranges::find(read.records, source.name.name, &CaseRecord::name);
    if (!source.file || !source.processes.empty() || !stated || stated->kind != MotionKind::acceleration || record == read.records.end())
      continue;
    double peak = 0;  // m/s2
    for (const double value : record->motion().values) peak = std::max(peak, std::abs(value));
    if (is_earthquake(peak)) continue;
    for (const std::string_view unit : {"g", "m/s2", "cm/s2"})
      if (is_earthquake(peak / stated->factor * motion_unit(unit)->factor)) {
        said.push_back(place_of(*source.table, "unit") +
                       fmt::format("in this unit the record {} reaches {}, {:.3g} g, which is {} for an earthquake; are its numbers in {}?",
                                   in_quotes(source.name.name), format_quantity(peak, "m/s2"), peak / standard_gravity,
                                   peak < weakest ? "low" : "high", unit));
        break;
      }
  }
}

/// Lengths in other units, and masses in tonnes.
void warn_size(const BuiltCase& built, std::vector<std::string>& said) {
  constexpr double smallest = 0.1, largest = 3000;  // m
  constexpr double least_pressure = 1e3;            // Pa: half a decimetre of concrete
  const std::vector<Node>& nodes = built.model.nodes;
  if (nodes.size() < 2) return;
  Vec3 least = nodes.front().position, most = least;
  for (const Node& node : nodes) least = least.cwiseMin(node.position), most = most.cwiseMax(node.position);
  const double size = (most - least).maxCoeff();
  if (size > 0 && (size < smallest || size > largest))
    said.push_back(fmt::format("the model extends over {:g} m: nodes are given in metres; is the unit right?", size));
  double area = 0;
  for (std::size_t k = 0; k < built.bases(); ++k) area += built.facts[k].area;
  if (area > 0 && built.weight() > 0 && built.weight() / area < least_pressure)
    said.push_back(
        fmt::format("the dead load of {} presses the base with {} alone, less than a floor slab: masses are given in kg (1 t is "
                    "1000 kg); are the units right?",
                    format_quantity(built.weight(), "N"), format_quantity(built.weight() / area, "Pa")));
}

/// Names of functions that drive the run.
std::set<std::string> functions_used(const Case& read, const RunSpec& spec) {
  std::set<std::string> names;
  for (const DrivenBy& place : motions_wanted(read)) names.insert(name_taken(spec.motion, place.function.name));
  for (const CaseLoad& load : read.input->loads)
    if (load.function) names.insert(load.function->name);
  return names;
}

/// A table that ends with a value is let go there: a motion comes back in one step.
void warn_jumps(const Case& read, const RunSpec& spec, const BuiltCase& built, std::vector<std::string>& said) {
  double end = 0;
  for (const Stage& stage : built.plan.stages)
    if (stage.type == Stage::Type::dynamics) end += stage.duration;
  const std::set<std::string> used = functions_used(read, spec);
  for (const CaseFunction& function : read.input->functions) {
    if (end == 0 || !used.contains(function.name.name)) continue;
    const std::unique_ptr<const TimeFunction> made = make_part(function_catalog(), *function.shape);
    for (const FunctionJump& jump : jumps_of(*made))
      if (jump.time > 1e-9 * end && jump.time < end * (1 - 1e-9))
        said.push_back(
            place_of(*function.table, function.name.key) +
            fmt::format("the function {} jumps from {:.4g} to {:.4g} at {}, and the run goes on to {}: let it {} with 0, or take "
                        "outside = \"hold\"",
                        in_quotes(function.name.name), jump.before, jump.after, format_quantity(jump.time, "s"), format_quantity(end, "s"),
                        jump.after == 0 ? "end" : "begin"));
  }
}

}  // namespace

void warn_input(const Case& read, const RunSpec& spec, const BuiltCase& built, std::vector<std::string>& said) {
  warn_friction(built, said);
  warn_cone(*read.input, said);
  warn_gravity(read.input->gravity, said);
  warn_upward_gravity(*read.input, built, said);
  warn_damping(read.input->damping, said);
  warn_units_of_records(read, said);
  warn_size(built, said);
  warn_jumps(read, spec, built, said);
}

}  // namespace uplift
