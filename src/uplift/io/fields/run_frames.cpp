#include "uplift/io/fields/run_frames.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>

#include "uplift/base/text.h"
#include "uplift/case/mesh/mesh.h"
#include "uplift/elements/element_entry.h"

namespace uplift {
namespace {

struct MotionField {
  std::string_view name, unit;
};
constexpr std::array<MotionField, 3> motions{{{"displacement", "m"}, {"velocity", "m/s"}, {"acceleration", "m/s2"}}};  // by derivative

FieldValues field(std::string_view name, std::string_view unit, FieldKind kind) {
  return {std::string(name), std::string(unit), kind, {}};
}

[[noreturn]] void fail(const CaseFields& fields, std::string_view key, const std::vector<std::string>& known, const std::string& found) {
  std::vector<std::string> quoted;
  for (const std::string& name : known) quoted.push_back(in_quotes(name));
  throw InputError(fields.where(key), fields.path(key), listed(quoted), in_quotes(found), nearest_name(found, known));
}

const Case& with_mesh(const CaseFields& fields, const Case& read) {
  if (!read.mesh) throw InputError(fields.where(), fields.path(), "a [mesh], on which fields are written", "none");
  return read;
}

/// Groups with a solid or a beam that are wanted, in this order.
std::vector<std::string> wanted_groups(const CaseFields& fields, const Case& read) {
  std::vector<std::string> known;
  for (const CaseElement& solid : read.input->elements_at(ElementPlace::cells)) known.push_back(solid.group->name);
  for (const CaseElement& beam : read.input->elements_at(ElementPlace::lines))
    if (beam.group) known.push_back(beam.group->name);
  const std::vector<std::string> asked = fields.groups.value_or(known);
  for (const std::string& group : asked)
    if (std::ranges::find(known, group) == known.end()) fail(fields, "groups", known, group);
  if (asked.empty())
    throw InputError(fields.where("groups"), fields.path("groups"), "at least one group with a [[solid]] or a [[beam]]", "none");
  std::erase_if(known, [&](const std::string& group) { return std::ranges::find(asked, group) == asked.end(); });
  return known;
}

const CaseElement& beam_of(const Case& read, const std::string& group) {
  return *std::ranges::find_if(read.input->elements_at(ElementPlace::lines),
                               [&](const CaseElement& beam) { return beam.group && beam.group->name == group; });
}

/// The elements of every solid of the case. They were made solid after solid, cell after cell.
std::vector<std::vector<const Element*>> elements_of(const CaseSolids& solids, const Model& model) {
  std::vector<const Element*> all;
  for (const auto& element : model.elements)
    if (element->continuum() != nullptr) all.push_back(element.get());
  std::vector<std::vector<const Element*>> elements;
  auto next = all.begin();
  for (const CaseSolids::Solid& solid : solids.solids()) {
    assert(all.end() - next >= static_cast<std::ptrdiff_t>(solid.cells.size()));
    elements.emplace_back(next, next + static_cast<std::ptrdiff_t>(solid.cells.size()));
    next += static_cast<std::ptrdiff_t>(solid.cells.size());
  }
  assert(next == all.end());
  return elements;
}

/// The quantities that are asked for are those of every run or outputs of its solids.
void check_quantities(const CaseFields& fields, const std::vector<std::vector<const Element*>>& solids) {
  std::vector<std::string> known{"displacement", "velocity", "acceleration", "stress", "section_forces"};
  for (const std::vector<const Element*>& solid : solids)
    for (const ElementOutput& output : solid.front()->outputs())
      if (std::ranges::find(known, output.name) == known.end()) known.push_back(output.name);
  for (const std::string& quantity : fields.quantities)
    if (std::ranges::find(known, quantity) == known.end()) fail(fields, "quantities", known, quantity);
}

}  // namespace

RunFrames::RunFrames(const CaseFields& fields, const Case& read, const BuiltCase& built)
    : model_(&built.model), quantities_(fields.quantities), interfaces_(with_mesh(fields, read), built) {
  const CaseSolids solids(*read.input, *read.mesh);
  const Mesh& mesh = solids.mesh();
  const std::vector<std::vector<const Element*>> elements = elements_of(solids, *model_);
  check_quantities(fields, elements);
  const std::vector<std::string> groups = wanted_groups(fields, read);
  for (std::size_t k = 0; k < groups.size(); ++k) {
    blocks_.push_back(field_mesh(read.mesh->drawn(), groups[k], {groups[k]}, fields.where("groups")));
    CellMark& mark = blocks_.back().marks.front();  // programs that put the blocks together tell them apart by it
    mark.values.assign(mark.values.size(), static_cast<int>(k));
    mark.meanings = groups;
    const auto solid = std::ranges::find(solids.solids(), groups[k], &CaseSolids::Solid::group);
    if (solid == solids.solids().end()) {  // a beam: these come last
      if (wants("section_forces")) beams_.add(beam_of(read, groups[k]), solids, built, blocks_.back());
      continue;
    }
    solids_.push_back(elements[static_cast<std::size_t>(solid - solids.solids().begin())]);
  }
  for (const Follower& follower : mesh.followers) followers_[follower.node] = follower.of;
  std::size_t first_history = 0;
  for (const auto& element : model_->elements)
    if (const int size = element->num_history(); size > 0) {
      first_history_[element.get()] = first_history;
      first_history += static_cast<std::size_t>(size);
    }
  if (!interfaces_.mesh().face.empty()) blocks_.push_back(interfaces_.mesh().mesh);
  dimension_ = model_->space.dimension;
  stride_ = static_cast<std::size_t>(model_->space.unknowns());
  first_ = stride_ * read.input->nodes.size();  // nodes of the case, then those of the mesh
}

bool RunFrames::wants(std::string_view quantity) const {
  return quantities_.empty() || std::ranges::find(quantities_, quantity) != quantities_.end();
}

FieldFrame RunFrames::empty(const std::vector<double>& section_forces) const {
  FieldFrame frame;
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    std::vector<FieldValues>& points = frame.blocks.emplace_back().points;
    for (const MotionField& motion : motions)
      if (wants(motion.name)) points.push_back(field(motion.name, motion.unit, FieldKind::vector));
    if (b < solids_.size()) {
      for (const ElementOutput& output : solids_[b].front()->outputs())
        if (wants(output.name))
          points.push_back(field(output.name, output.unit, output.components == 6 ? FieldKind::tensor : FieldKind::scalar));
    } else if (b - solids_.size() < beams_.beams()) {
      frame.blocks.back().cells = beams_.fields(b - solids_.size(), section_forces);
    } else if (&blocks_[b] == &blocks_.back() && !interfaces_.mesh().face.empty()) {
      points.push_back(field("opening", "m", FieldKind::scalar));
      points.push_back(field("slip", "m", FieldKind::vector));
      points.push_back(field("traction", "Pa", FieldKind::vector));
      points.push_back(field("pressure", "Pa", FieldKind::scalar));
      points.push_back(field("status", "", FieldKind::scalar));
    }
  }
  return frame;
}

std::vector<double> RunFrames::motion(const FieldMesh& block, const Vector& full) const {
  const std::span<const double> nodal(full.data(), static_cast<std::size_t>(full.size()));
  return at_points(block, FieldKind::vector, nodal.subspan(first_), static_cast<int>(stride_), dimension_);
}

/// At the nodes, the mean of the cells of this material.
std::vector<double> RunFrames::of_elements(std::size_t block, std::size_t output, const Vector& full,
                                           const std::vector<double>& history) const {
  const auto width = static_cast<std::size_t>(solids_[block].front()->outputs()[output].components);
  const std::size_t nodes_of_mesh = static_cast<std::size_t>(full.size()) / stride_ - first_ / stride_;
  std::vector<double> sum(width * nodes_of_mesh, 0), count(nodes_of_mesh, 0);
  for (const Element* element : solids_[block]) {
    Vector displacement(element->unknowns());
    const std::span<const int> nodes = element->nodes();
    for (std::size_t a = 0; a < nodes.size(); ++a)
      displacement.segment(dimension_ * static_cast<Index>(a), dimension_) =
          full.segment(static_cast<Index>(stride_) * nodes[a], dimension_);
    std::span<const double> memory;
    if (const auto first = first_history_.find(element); first != first_history_.end() && !history.empty())
      memory = std::span(history).subspan(first->second, static_cast<std::size_t>(element->num_history()));
    const std::vector<double> values = element->at_nodes(output, displacement, memory);
    for (std::size_t a = 0; a < nodes.size(); ++a) {
      const std::size_t node = static_cast<std::size_t>(nodes[a]) - first_ / stride_;
      count[node] += 1;
      for (std::size_t c = 0; c < width; ++c) sum[width * node + c] += values[width * a + c];
    }
  }
  const auto mean = [&](int node, double weight, double* to) {
    const auto n = static_cast<std::size_t>(node);
    for (std::size_t c = 0; c < width; ++c) to[c] += weight * sum[width * n + c] / count[n];
  };
  std::vector<double> at_points(width * blocks_[block].node.size(), 0);
  for (std::size_t point = 0; point < blocks_[block].node.size(); ++point) {
    const int node = blocks_[block].node[point];
    const auto follower = followers_.find(node);
    if (follower == followers_.end()) {
      mean(node, 1, &at_points[width * point]);
    } else {
      for (const auto& [of, weight] : follower->second) mean(of, weight, &at_points[width * point]);
    }
  }
  return at_points;
}

FieldFrame RunFrames::of(const State& state, const Vector* acceleration, const std::vector<double>& section_forces, double time) const {
  const std::array<const Vector*, 3> free{&state.displacement, acceleration ? &state.velocity : nullptr, acceleration};
  std::array<Vector, 3> full;
  for (int d = 0; d < 3; ++d) {
    const auto k = static_cast<std::size_t>(d);
    full[k] = free[k] ? model_->full(*free[k], d, state.instant()) : Vector::Zero(model_->full_unknowns());
  }
  const InterfaceFrames::JointValues joint = interfaces_.at(state);
  const auto at_lips = [&](FieldKind kind, const std::vector<double>& values) { return at_points(interfaces_.mesh(), kind, values); };
  FieldFrame frame = empty(section_forces);
  frame.time = time;
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    const std::vector<ElementOutput> outputs = b < solids_.size() ? solids_[b].front()->outputs() : std::vector<ElementOutput>{};
    for (FieldValues& field : frame.blocks[b].points) {
      for (std::size_t d = 0; d < motions.size(); ++d)
        if (field.name == motions[d].name) field.values = motion(blocks_[b], full[d]);
      for (std::size_t k = 0; k < outputs.size(); ++k)
        if (field.name == outputs[k].name) field.values = of_elements(b, k, full[0], state.bulk_history);
      if (field.name == "opening") field.values = at_lips(field.kind, joint.opening);
      if (field.name == "slip") field.values = at_lips(field.kind, joint.slip);
      if (field.name == "traction") field.values = at_lips(field.kind, joint.traction);
      if (field.name == "pressure") field.values = at_lips(field.kind, joint.pressure);
      if (field.name == "status") field.values = at_lips(field.kind, joint.status);
    }
  }
  return frame;
}

}  // namespace uplift
