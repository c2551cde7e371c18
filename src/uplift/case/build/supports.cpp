#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "uplift/base/text.h"
#include "uplift/base/units.h"
#include "uplift/case/build/model.h"

// Supports and prescribed motions of a case.
namespace uplift {
namespace {

/// Some unknowns of a node by name: all, or the translations.
Dof dof_of(const NameUsed& unknown, Space space, bool rotations) {
  std::vector<std::string> words;
  for (int i = 0; i < (rotations ? space.unknowns() : space.dimension); ++i) {
    words.emplace_back(to_string(space.dof(i)));
    if (words.back() == unknown.name) return space.dof(i);
  }
  std::string wanted = fmt::format("{}", fmt::join(words.begin(), words.end() - 1, ", ")) + " or " + words.back();
  if (!rotations) wanted += " for a group of the mesh";
  fail(unknown, wanted, in_quotes(unknown.name), rotations ? nearest_name(unknown.name, words) : "");
}

using Unknown = std::pair<int, Dof>;

/// Unknowns that motions of groups prescribe, with the group.
std::map<Unknown, std::string> moved_by_groups(const CaseInput& input, const CaseNames& names) {
  std::map<Unknown, std::string> moved;
  for (const CaseMotion& motion : input.motions) {
    if (!motion.of.group) continue;
    const Dof dof = dof_of(motion.direction, names.space, false);
    for (const int node : names.nodes_of(motion.of)) moved.emplace(Unknown(node, dof), motion.of.name());
  }
  return moved;
}

/// A length or an angle for a function, which has no unit; a factor for a record, which is a displacement.
double amplitude_of(const CaseMotion& motion, const CaseNames& names) {
  const char* unit = names.is_record(motion.function) ? "1" : motion.turns ? "rad" : "m";
  const Quantity amplitude = parse_quantity(motion.amplitude, unit);
  if (!amplitude.ok) fail(motion, "amplitude", quantity_name(unit), amplitude.found, amplitude.nearest);
  constexpr double most = 1e10;
  if (std::abs(amplitude.value) > most)
    fail(motion, "amplitude", quantity_name(unit) + fmt::format(" of at most {:g}", most), in_quotes(motion.amplitude));
  return amplitude.value;
}

}  // namespace

std::set<int> beam_nodes(const CaseNames& names) {
  std::set<int> nodes;
  for (const BeamLine& line : names.beams) nodes.insert(line.nodes.begin(), line.nodes.end());
  return nodes;
}

bool any_released(const CaseInput& input) {
  return std::ranges::any_of(input.supports, &CaseSupport::statics_only);
}

void add_supports(const Case& read, ModelBuilder& builder, const CaseNames& names, bool at_rest) {
  const std::map<Unknown, std::string> moved = moved_by_groups(*read.input, names);
  const std::set<int> turning = beam_nodes(names);
  std::set<Unknown> held;
  for (const CaseSupport& support : read.input->supports) {
    if (support.statics_only && !at_rest) continue;
    const bool group = support.of.group.has_value();
    const std::vector<int> nodes = names.nodes_of(support.of);
    const bool turns = !group || std::ranges::any_of(nodes, [&](int node) { return turning.contains(node); });
    for (const int node : nodes)
      for (const NameUsed& word : support.fixed) {
        const Unknown unknown(node, dof_of(word, names.space, turns));
        const auto motion = group ? moved.find(unknown) : moved.end();
        if (motion != moved.end() && motion->second != support.of.name()) continue;
        if (!group || held.insert(unknown).second) builder.fix(node, unknown.second, word.where(), group);
      }
  }
  for (const CaseMotion& motion : read.input->motions) {
    const std::vector<int> nodes = names.nodes_of(motion.of);
    const Dof dof = dof_of(motion.direction, names.space, motion.of.node.has_value());
    const std::vector<CaseStage>& stages = read.input->stages;
    if (!motion.function && !stages.empty() && !stages.front().statics)
      fail(motion, "function", "the name of a function, or a static stage first, which applies a motion without a function", "neither");
    auto function = names.function(motion.function, motion.turns ? std::nullopt : std::optional(MotionKind::displacement));
    builder.prescribe(nodes, dof, scaled(amplitude_of(motion, names), std::move(function)), motion.name, motion.where());
  }
}

}  // namespace uplift
