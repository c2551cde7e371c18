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
Dof dof_of(const std::string& word, const Values& table, std::string_view key, Space space, bool rotations) {
  std::vector<std::string> words;
  for (int i = 0; i < (rotations ? space.unknowns() : space.dimension); ++i) {
    words.emplace_back(to_string(space.dof(i)));
    if (words.back() == word) return space.dof(i);
  }
  std::string wanted = fmt::format("{}", fmt::join(words.begin(), words.end() - 1, ", ")) + " or " + words.back();
  if (!rotations) wanted += " for a group of the mesh";
  fail(table, key, wanted, in_quotes(word), rotations ? nearest_name(word, words) : "");
}

bool is_released(const Values& support) {
  return support.text("stages") == "static";
}

using Unknown = std::pair<int, Dof>;

/// Unknowns that motions of groups prescribe, with the group.
std::map<Unknown, std::string> moved_by_groups(const Values& root, const CaseNames& names) {
  std::map<Unknown, std::string> moved;
  for (const Values& motion : root.tables("motion")) {
    if (!motion.has("group")) continue;
    const Dof dof = dof_of(motion.text("direction"), motion, "direction", names.space, false);
    for (const int node : names.node_or_group(motion)) moved.emplace(Unknown(node, dof), motion.text("group"));
  }
  return moved;
}

/// A length or an angle for a function, which has no unit; a factor for a record, which is a displacement.
double amplitude_of(const Values& motion, bool turns, const CaseNames& names) {
  const char* unit = names.is_record(motion) ? "1" : turns ? "rad" : "m";
  const Quantity amplitude = parse_quantity(motion.text("amplitude"), unit);
  if (!amplitude.ok) fail(motion, "amplitude", quantity_name(unit), amplitude.found, amplitude.nearest);
  constexpr double most = 1e10;
  if (std::abs(amplitude.value) > most)
    fail(motion, "amplitude", quantity_name(unit) + fmt::format(" of at most {:g}", most), in_quotes(motion.text("amplitude")));
  return amplitude.value;
}

}  // namespace

std::set<int> beam_nodes(const CaseNames& names) {
  std::set<int> nodes;
  for (const BeamLine& line : names.beams) nodes.insert(line.nodes.begin(), line.nodes.end());
  return nodes;
}

bool any_released(const Values& root) {
  return std::ranges::any_of(root.tables("support"), is_released);
}

void add_supports(const Values& root, ModelBuilder& builder, const CaseNames& names, bool at_rest) {
  const std::map<Unknown, std::string> moved = moved_by_groups(root, names);
  const std::set<int> turning = beam_nodes(names);
  std::set<Unknown> held;
  for (const Values& support : root.tables("support")) {
    if (is_released(support) && !at_rest) continue;
    const bool group = support.has("group");
    const std::vector<int> nodes = names.node_or_group(support);
    const bool turns = !group || std::ranges::any_of(nodes, [&](int node) { return turning.contains(node); });
    for (const int node : nodes)
      for (const std::string& word : support.texts("fixed")) {
        const Unknown unknown(node, dof_of(word, support, "fixed", names.space, turns));
        const auto motion = group ? moved.find(unknown) : moved.end();
        if (motion != moved.end() && motion->second != support.text("group")) continue;
        if (!group || held.insert(unknown).second) builder.fix(node, unknown.second, support.where("fixed"), group);
      }
  }
  for (const Values& motion : root.tables("motion")) {
    const std::vector<int> nodes = names.node_or_group(motion);
    const std::string name = motion.has("name") ? motion.text("name") : "motion of " + motion.text(motion.has("node") ? "node" : "group");
    const Dof dof = dof_of(motion.text("direction"), motion, "direction", names.space, motion.has("node"));
    const bool turns = motion.text("direction").front() == 'r';
    const std::vector<Values>& stages = root.tables("stage");
    if (!motion.has("function") && !stages.empty() && stages.front().text("type") != "static")
      fail(motion, "function", "the name of a function, or a static stage first, which applies a motion without a function", "neither");
    auto function = names.function(motion, turns ? std::nullopt : std::optional(MotionKind::displacement));
    builder.prescribe(nodes, dof, scaled(amplitude_of(motion, turns, names), std::move(function)), name, motion.where());
  }
}

}  // namespace uplift
