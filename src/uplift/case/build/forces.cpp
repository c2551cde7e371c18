#include "uplift/case/build/forces.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "uplift/base/text.h"
#include "uplift/case/build/model.h"
#include "uplift/run/force_rows.h"

namespace uplift {

std::vector<SectionComponent> section_components(Space space) {
  if (space.dimension == 2) return {{"axial", "N", 1}, {"shear", "N", 1}, {"moment", "N m", -1}};
  return {{"axial", "N", 1},     {"shear_y", "N", 1},    {"shear_z", "N", -1},
          {"torsion", "N m", 1}, {"moment_y", "N m", 1}, {"moment_z", "N m", -1}};
}

namespace {

using Part = SectionForces::Part;

/// What can be asked of a section: a component, or in space the length of two of them.
struct SectionWord {
  std::string_view word, unit;
  std::vector<int> components;
};
std::vector<SectionWord> section_words(Space space) {
  std::vector<SectionWord> words;
  for (const SectionComponent& each : section_components(space)) words.push_back({each.word, each.unit, {static_cast<int>(words.size())}});
  if (space.dimension == 3) {
    words.push_back({"shear", "N", {1, 2}});
    words.push_back({"moment", "N m", {4, 5}});
  }
  return words;
}

/// One element of a line, in the direction of the line.
struct Stretch {
  int element;
  bool reversed;
  double begin, length;  // m along the line
  Vec3 from, to;
};

std::vector<Stretch> stretches(const Model& model, const BeamLine& line) {
  std::vector<Stretch> made;
  double along = 0;
  for (std::size_t k = 0; k + 1 < line.nodes.size(); ++k) {
    const int a = line.nodes[k], b = line.nodes[k + 1];
    const Vec3 from = model.nodes[static_cast<std::size_t>(a)].position, to = model.nodes[static_cast<std::size_t>(b)].position;
    for (int e = line.first_element; e < line.end_element; ++e) {
      const auto nodes = model.elements[static_cast<std::size_t>(e)]->nodes();
      if (std::minmax(nodes[0], nodes[1]) != std::minmax(a, b)) continue;
      made.push_back({e, nodes[0] != a, along, (to - from).norm(), from, to});
      break;
    }
    along += (to - from).norm();
  }
  return made;
}

/// The section forces named by a word at a share of a stretch.
std::shared_ptr<const ForceQuantity> section(const Stretch& stretch, double share, const SectionWord& word, Space space) {
  const std::vector<SectionComponent> components = section_components(space);
  std::vector<std::vector<Part>> rows;
  for (const int k : word.components) {
    Vector weights = Vector::Zero(static_cast<Index>(components.size()));
    weights[k] = stretch.reversed ? components[static_cast<std::size_t>(k)].reversed : 1;
    rows.push_back({{stretch.element, stretch.reversed ? 1 - share : share, std::move(weights)}});
  }
  return std::make_shared<const SectionForces>(std::move(rows));
}

std::vector<const BeamLine*> lines_of(const NameUsed& beam, const BuiltCase& built) {
  Names beams("beam");
  std::vector<const BeamLine*> lines;
  for (const BeamLine& line : built.beams)
    if (!beams.has(line.name)) beams.add(line.name, {}, {});
  const std::string& name = beams[beams.find(beam)];
  for (const BeamLine& line : built.beams)
    if (line.name == name) lines.push_back(&line);
  return lines;
}

Request column(const CaseHistory& history, std::string automatic, std::string_view unit, std::shared_ptr<const ForceQuantity> force) {
  Request request;
  request.kind = Request::Kind::force;
  request.name = history.name ? history.name->name : std::move(automatic);
  request.unit = unit;
  request.force = std::move(force);
  return request;
}

[[noreturn]] void no_such_quantity(const CaseHistory& history, const std::vector<std::string>& words, const char* of) {
  const std::string& word = history.quantity.name;
  fail(history.quantity, fmt::format("a quantity of {}: {}", of, fmt::join(words, ", ")), in_quotes(word), nearest_name(word, words));
}

/// The section at `position` or nearest to `at`.
std::pair<Stretch, double> asked_section(const CaseHistory& history, const BuiltCase& built) {
  const std::vector<const BeamLine*> lines = lines_of(*history.beam, built);
  const Model& model = built.model;
  if (history.position.has_value() == history.at.has_value())
    fail(history, "", "exactly one of position and at, for a section of a beam", history.at ? "both" : "neither");
  if (history.position) {
    if (lines.size() > 1)
      fail(history, "position", "at, for a beam that consists of several lines", fmt::format("position, of {} lines", lines.size()));
    const std::vector<Stretch> all = stretches(model, *lines.front());
    const double position = *history.position, length = all.back().begin + all.back().length;
    if (position > length * (1 + 1e-9))
      fail(history, "position", fmt::format("a distance of at most {:.6g} m, the length of the beam", length),
           fmt::format("{:.6g} m", position));
    for (const Stretch& each : all)
      if (position < (each.begin + each.length) - 1e-9 * length) return {each, std::max(0.0, (position - each.begin) / each.length)};
    return {all.back(), 1.0};
  }
  const Vec3 at = *history.at;
  std::pair<Stretch, double> nearest{};
  double least = std::numeric_limits<double>::infinity();
  for (const BeamLine* line : lines)
    for (const Stretch& each : stretches(model, *line)) {
      const Vec3 axis = each.to - each.from;
      const double share = std::clamp((at - each.from).dot(axis) / axis.squaredNorm(), 0.0, 1.0);
      const double distance = (each.from + share * axis - at).norm();
      if (distance < least - 1e-9) least = distance, nearest = {each, share};
    }
  return nearest;
}

Request section_request(const CaseHistory& history, const BuiltCase& built) {
  const Space space = built.model.space;
  std::vector<std::string> words;
  for (const SectionWord& word : section_words(space)) {
    words.emplace_back(word.word);
    if (word.word != history.quantity.name) continue;
    const auto [stretch, share] = asked_section(history, built);
    const double along = stretch.begin + share * stretch.length;
    return column(history, fmt::format("{}.{:.6g}.{}", history.beam->name, along, word.word), word.unit,
                  section(stretch, share, word, space));
  }
  no_such_quantity(history, words, "a beam");
}

/// Horizontal force that what lies above a level exerts on what lies below, through all beams that cross it.
Request storey_shear(const CaseHistory& history, const BuiltCase& built) {
  const Model& model = built.model;
  const int dimension = model.space.dimension, up = model.space.up();
  int direction = -1;
  std::vector<std::string> words;
  for (int k = 0; k < dimension - 1; ++k) {
    words.push_back(dimension == 2 ? "storey_shear" : k == 0 ? "storey_shear_x" : "storey_shear_y");
    if (words.back() == history.quantity.name) direction = k;
  }
  if (direction < 0) no_such_quantity(history, words, "a level");
  const double level = *history.level;
  std::vector<Part> parts;
  double least = std::numeric_limits<double>::infinity(), most = -least;
  for (const BeamLine& line : built.beams)
    for (const Stretch& each : stretches(model, line)) {
      const double from = each.from[up], to = each.to[up];
      least = std::min({least, from, to}), most = std::max({most, from, to});
      if (!(std::min(from, to) <= level && level < std::max(from, to))) continue;
      const double share = (level - from) / (to - from);
      const Mat3 axes = model.elements[static_cast<std::size_t>(each.element)]->axes();
      const double sign = (to > from) != each.reversed ? 1 : -1;  // the part beyond the section of the element is the upper one
      Vector weights = Vector::Zero(dimension == 2 ? 3 : 6);
      for (int k = 0; k < dimension; ++k) weights[k] = sign * axes(k, direction);
      parts.push_back({each.element, each.reversed ? 1 - share : share, std::move(weights)});
    }
  if (parts.empty())
    fail(history, "level", fmt::format("a height that beams cross, from {:.6g} m to below {:.6g} m", least, most),
         fmt::format("{:.6g} m", level));
  Request request = column(history, fmt::format("{}.{:.6g}", history.quantity.name, level), "N",
                           std::make_shared<const SectionForces>(std::vector<std::vector<Part>>{std::move(parts)}));
  request.level = level;
  request.component = direction;
  return request;
}

/// Displacement of a node relative to one below, as it is or over the difference of heights.
Request drift(const CaseHistory& history, const BuiltCase& built, int node) {
  const Model& model = built.model;
  const int below = model.find_node(history.below->name);
  if (below < 0) {
    std::vector<std::string> nodes;
    for (const Node& each : model.nodes) nodes.push_back(each.name);
    fail(*history.below, "the name of a node", in_quotes(history.below->name), nearest_name(history.below->name, nodes));
  }
  const int up = model.space.up();
  const double height =
      model.nodes[static_cast<std::size_t>(node)].position[up] - model.nodes[static_cast<std::size_t>(below)].position[up];
  std::vector<std::string> words;
  for (const bool ratio : {false, true})
    for (int k = 0; k < up; ++k) {
      words.push_back(fmt::format("drift_{}{}", ratio ? "ratio_" : "", "xy"[k]));
      if (words.back() != history.quantity.name) continue;
      if (!(height > 0))
        fail(*history.below, "a node below " + in_quotes(model.nodes[static_cast<std::size_t>(node)].name),
             fmt::format("one {:.6g} m higher", -height));
      Request request;
      request.kind = Request::Kind::displacement;
      request.name =
          history.name ? history.name->name : fmt::format("{}.{}", model.nodes[static_cast<std::size_t>(node)].name, words.back());
      request.unit = ratio ? "1" : "m";
      request.unknown = model.space.unknowns() * node + k;
      request.below = model.space.unknowns() * below + k;
      request.component = k;
      request.factor = ratio ? 1 / height : 1;
      return request;
    }
  no_such_quantity(history, words, "a node and the one below it");
}

std::vector<std::string> constraint_words(Space space) {
  std::vector<std::string> words;
  for (const char* of : {"reaction", "tie"})
    for (int k = 0; k < space.unknowns(); ++k)
      words.push_back(fmt::format("{}_{}", of,
                                  !space.is_rotation(k)  ? std::string(to_string(space.dof(k)).substr(1))
                                  : space.dimension == 2 ? "moment"
                                                         : "m" + std::string(to_string(space.dof(k)).substr(1))));
  return words;
}

/// Sum of the constraint forces on nodes; moments about the mean of their positions.
Request constraint_force(const CaseHistory& history, const BuiltCase& built, const std::vector<int>& nodes, const std::string& of) {
  const Model& model = built.model;
  const Space space = model.space;
  const std::vector<std::string> words = constraint_words(space);
  const auto word = std::ranges::find(words, history.quantity.name);
  if (word == words.end()) no_such_quantity(history, words, "supports and ties");
  const int index = static_cast<int>(word - words.begin()), component = index % space.unknowns();
  const bool ties = index >= space.unknowns();
  Vec3 centre = Vec3::Zero();
  for (const int node : nodes) centre += model.nodes[static_cast<std::size_t>(node)].position / static_cast<double>(nodes.size());
  Weights weights;
  for (const int node : nodes)
    for (int k = 0; k < space.unknowns(); ++k) {
      const Vec3 axis = space.axis(component), arm = model.nodes[static_cast<std::size_t>(node)].position - centre;
      double weight = k == component ? 1 : 0;
      if (space.is_rotation(component)) weight = space.is_rotation(k) ? axis.dot(space.axis(k)) : axis.dot(cross(arm, space.axis(k)));
      if (weight != 0) weights[space.unknowns() * node + k] = weight;
    }
  const Assembly& assembly = model.assembly;
  const bool any = std::ranges::any_of(weights, [&](const auto& each) {
    for (Sparse::InnerIterator entry(assembly.constraints, each.first); entry; ++entry) {
      const bool support = entry.row() >= assembly.first_support && entry.row() < assembly.first_equal;
      if (support != ties) return true;
    }
    return false;
  });
  if (!any)
    fail(history.quantity,
         ties ? "a node that a tie or a rigid body holds"
              : "nodes that supports or prescribed motions hold in this direction in dynamic stages",
         fmt::format("\"{}\" of {}, which none holds", *word, of));
  return column(
      history, fmt::format("{}.{}", of, *word), space.is_rotation(component) ? "N m" : "N",
      std::make_shared<const ConstraintForce>(ties ? ConstraintForce::Of::ties : ConstraintForce::Of::supports, std::move(weights)));
}

}  // namespace

bool is_constraint_force(const std::string& quantity) {
  return quantity.starts_with("reaction") || quantity.starts_with("tie_");
}

Request force_request(const CaseHistory& history, const BuiltCase& built, const CaseNames& names, int node) {
  const int given = history.node.has_value() + history.interface.has_value() + history.beam.has_value() + history.level.has_value() +
                    history.group.has_value();
  if (given > 1) fail(history, "", "exactly one of node, at, interface, beam, level and group", fmt::format("{}", given));
  if (history.beam) return section_request(history, built);
  if (history.level) return storey_shear(history, built);
  if (history.below) return drift(history, built, node);
  if (node >= 0) return constraint_force(history, built, {node}, built.model.nodes[static_cast<std::size_t>(node)].name);
  return constraint_force(history, built, names.nodes_of({{history.table}, {}, history.group}), history.group->name);
}

void add_envelopes(const CaseOutput& output, BuiltCase& built) {
  const Space space = built.model.space;
  const std::vector<SectionWord> words = section_words(space);
  Names used("beam");
  for (const CaseEnvelope& asked : output.envelopes) {
    used.add(asked.beam);
    const std::vector<const BeamLine*> lines = lines_of(asked.beam, built);
    for (std::size_t k = 0; k < lines.size(); ++k) {
      EnvelopeRequest envelope;
      envelope.beam = lines.size() == 1 ? lines[k]->name : fmt::format("{}, line {}", lines[k]->name, k + 1);
      for (const SectionWord& word : words) envelope.components.emplace_back(word.word);
      const std::vector<Stretch> all = stretches(built.model, *lines[k]);
      const int each = std::max(1, static_cast<int>(std::ceil(asked.sections / static_cast<double>(all.size()))));
      for (const Stretch& stretch : all)
        for (int i = 0; i <= each; ++i) {
          const double share = static_cast<double>(i) / each;
          envelope.sections.push_back({stretch.begin + share * stretch.length, stretch.from + share * (stretch.to - stretch.from)});
          for (const SectionWord& word : words) envelope.forces.push_back(section(stretch, share, word, space));
        }
      built.plan.envelopes.push_back(std::move(envelope));
    }
  }
}

}  // namespace uplift
