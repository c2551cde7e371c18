#include "uplift/case/build/model.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "uplift/base/text.h"
#include "uplift/elements/discrete.h"
#include "uplift/elements/solid_nonlinear.h"
#include "uplift/mesh/parts.h"

namespace uplift {

int CaseNames::node(const NameUsed& name) const {
  const int node = nodes.find(name);
  if (bare.contains(node))
    fail(name, "a node of what is filled", in_quotes(nodes[node]) + ", around which the planes of interface.cut leave nothing");
  return node;
}

std::vector<int> CaseNames::nodes_of(const std::vector<NameUsed>& used) const {
  std::vector<int> found;
  for (const NameUsed& name : used) found.push_back(node(name));
  return found;
}

const CaseSolids& CaseNames::mesh_for(const NameUsed& group) const {
  if (!solids) fail(group, "a [mesh] with this group", "none");
  return *solids;
}

std::vector<int> CaseNames::nodes_of_cell(CellId cell) const {
  std::vector<int> found;
  for (const int node : solids->mesh().cell(cell)) found.push_back(first_of_mesh + node);
  return found;
}

std::vector<int> CaseNames::nodes_of(const NodeOrGroup& of) const {
  if (of.node) return {node(*of.node)};
  std::vector<int> found = mesh_for(*of.group).nodes(*of.group);
  for (int& each : found) each += first_of_mesh;
  return found;
}

namespace {

/// A function times an amplitude.
class Scaled final : public TimeFunction {
 public:
  Scaled(double factor, std::shared_ptr<const TimeFunction> function) : factor_(factor), function_(std::move(function)) {}
  double value(double time) const override { return factor_ * function_->value(time); }
  double rate(double time) const override { return factor_ * function_->rate(time); }
  double acceleration(double time) const override { return factor_ * function_->acceleration(time); }
  double smooth_acceleration(double time) const override { return factor_ * function_->smooth_acceleration(time); }

 private:
  double factor_;
  std::shared_ptr<const TimeFunction> function_;
};

void add_masses(const CaseInput& input, ModelBuilder& builder, CaseNames& names, const std::vector<double>& tuned) {
  std::size_t next = 0;
  for (const CaseMass& mass : input.masses) {
    const int node = names.node(mass.node);
    const double value = mass.mass ? *mass.mass : tuned.at(next++);
    builder.add_element(std::make_unique<PointMass>(names.space, node, value, mass.inertia), mass.where());
  }
  Names bodies("rigid body");
  for (const CaseBody& body : input.bodies) {
    if (body.name) bodies.add(*body.name);
    const int master = master_of(body, names);
    for (const NameUsed& name : body.slaves) {
      const int slave = names.node(name);
      if (slave == master) fail(name, "nodes other than the master", "\"" + names.nodes[master] + "\"");
      builder.tie_rigid(master, slave, name.where());
    }
    if (body.group)
      for (const int node : names.mesh_for(*body.group).nodes(*body.group))
        if (names.first_of_mesh + node != master) builder.tie_rigid(master, names.first_of_mesh + node, body.group->where());
    Place offset;
    if (body.centre) offset = *body.centre - names.positions[master];
    if (body.mass > 0 || !body.inertia.isZero(0))
      builder.add_element(std::make_unique<PointMass>(names.space, master, body.mass, body.inertia, offset), body.where());
  }
}

/// The elements on named nodes: one for each table [[name]].
void add_elements(const CaseInput& input, ModelBuilder& builder, const CaseNames& names) {
  for (const CaseElement& element : input.elements_at(ElementPlace::nodes)) {
    ElementSite site{names.space, names.nodes_of(element.nodes), {}};
    for (const int node : site.nodes) site.positions.push_back(names.positions[static_cast<std::size_t>(node)]);
    builder.add_element(element.entry->make(site, *element.table), element.where());
  }
}

}  // namespace

int master_of(const CaseBody& body, const CaseNames& names) {
  if (body.node) return names.node(*body.node);
  if (!body.group) fail(body, "", "node, or a group of the mesh", "neither");
  std::vector<int> nodes = names.mesh_for(*body.group).nodes(*body.group);
  const auto position = [&](int node) -> const Place& { return names.positions[static_cast<std::size_t>(names.first_of_mesh + node)]; };
  Vec3 middle = Vec3::Zero();
  for (const int node : nodes) middle += position(node) / static_cast<double>(nodes.size());
  return names.first_of_mesh + *std::ranges::min_element(nodes, {}, [&](int node) { return (position(node) - middle).norm(); });
}

std::shared_ptr<const TimeFunction> scaled(double factor, std::shared_ptr<const TimeFunction> function) {
  return std::make_shared<Scaled>(factor, std::move(function));
}

int CaseNames::index_taken(const NameUsed& function) const {
  return functions.find(name_taken(instead, function.name), function.where(), function.path());
}

bool CaseNames::is_record(const std::optional<NameUsed>& function) const {
  return function && functions_made[static_cast<std::size_t>(index_taken(*function))] == nullptr;
}

std::shared_ptr<const TimeFunction> CaseNames::function(const std::optional<NameUsed>& name, std::optional<MotionKind> kind,
                                                        std::optional<double> factor) const {
  std::shared_ptr<const TimeFunction> made = make_function(name, kind);
  if (factor) made = scaled(*factor, std::move(made));
  if (functions_used) functions_used->push_back({made, name, kind, factor});
  return made;
}

std::shared_ptr<const TimeFunction> CaseNames::make_function(const std::optional<NameUsed>& name, std::optional<MotionKind> kind) const {
  if (!name) return std::make_shared<One>();
  const auto found = static_cast<std::size_t>(index_taken(*name));
  if (functions_made[found]) return kind && motion_factor != 1 ? scaled(motion_factor, functions_made[found]) : functions_made[found];
  const CaseRecord& record = (*records)[found - (functions_made.size() - records->size())];
  if (!kind) fail(*name, "a function (a record is a motion: no load, no rotation)", "the record " + in_quotes(record.name));
  return std::make_shared<MotionFunction>(giving(scaled(record.history, motion_factor), *kind), *kind, share);
}

void add_nodes(const CaseInput& input, ModelBuilder& builder, CaseNames& names) {
  for (const CaseNode& node : input.nodes) {
    names.nodes.add(node.name, node.where(), node.path());
    names.positions.push_back(node.position);
    builder.add_node(node.name, node.position, node.where());
  }
}

namespace {

/// Nodes of the mesh that are a group of their own: the group's name is theirs, unless another node has it.
std::map<int, std::string> named_nodes(const Mesh& mesh, const Names& taken) {
  std::map<int, std::string> named;
  for (const auto& [name, group] : mesh.groups)
    if (group.dimension == 0 && !taken.has(name) && !name.starts_with("mesh."))
      if (const std::vector<int> nodes = nodes_of(mesh, group); nodes.size() == 1) named.emplace(nodes.front(), name);
  return named;
}

}  // namespace

void add_mesh(const Case& read, ModelBuilder& builder, CaseNames& names) {
  if (!read.mesh) return;
  const Mesh& mesh = read.mesh->mesh;
  const CaseTable& table = *read.input->mesh;
  names.solids = std::make_shared<const CaseSolids>(*read.input, *read.mesh);
  names.first_of_mesh = names.nodes.size();
  const std::map<int, std::string> named = named_nodes(mesh, names.nodes);
  std::size_t cells = 0;
  for (const CaseSolids::Solid& solid : names.solids->solids()) cells += solid.cells.size();
  const auto with_few_more = [](std::size_t count) { return count + count / 16; };  // beams, dashpots of faces
  builder.reserve(with_few_more(mesh.nodes.size()), with_few_more(cells));
  names.positions.reserve(names.positions.size() + with_few_more(mesh.nodes.size()));
  names.nodes.add_numbered(
      "mesh.", static_cast<int>(mesh.nodes.size()), [from = read.mesh](int node) { return from->mesh.number(node); }, table.where(),
      table.path());
  if (names.first_of_mesh == 0) {  // the nodes of the mesh itself
    names.coordinates = Coordinates(read.mesh, &mesh.nodes);
  } else {
    std::vector<Vec3> all(names.positions.size(), Vec3::Zero());
    all.insert(all.end(), mesh.nodes.begin(), mesh.nodes.end());
    names.coordinates = std::make_shared<const std::vector<Vec3>>(std::move(all));
  }
  for (int i = 0; i < static_cast<int>(mesh.nodes.size()); ++i) {
    const int node = names.first_of_mesh + i;
    const std::string number = names.nodes[node];
    const auto name = named.find(i);
    names.positions.emplace_back(mesh.nodes[static_cast<std::size_t>(i)]);
    if (name == named.end()) {
      builder.add_node(number, names.positions.back(), table.where());
    } else {
      names.nodes.also(name->second, node);
      builder.add_node(name->second, names.positions.back(), table.where(), number);
    }
  }
  const std::vector<bool> bare = bare_nodes(mesh);
  for (std::size_t i = 0; i < bare.size(); ++i)
    if (bare[i]) names.bare.insert(names.first_of_mesh + static_cast<int>(i));
  for (const Follower& follower : mesh.followers) {
    std::vector<std::pair<int, double>> of = follower.of;
    for (auto& [node, weight] : of) node += names.first_of_mesh;
    builder.follow(names.first_of_mesh + follower.node, of, table.where());
  }
  std::vector<int> nodes;
  for (const CaseSolids::Solid& solid : names.solids->solids())
    for (const CellId cell : solid.cells) {
      nodes.clear();
      for (const int node : mesh.cell(cell)) nodes.push_back(names.first_of_mesh + node);
      const bool part = mesh.part(cell) != nullptr;
      const CellRule rule = part ? rule_of_part(mesh, cell) : CellRule{};
      builder.add_element(solid.filling->make({mesh.type(cell), nodes, names.coordinates, part ? &rule : nullptr}), solid.table->where());
    }
}

void add_functions(const Case& read, CaseNames& names) {
  if (!read.records.empty()) names.functions = Names("function or record");
  for (const CaseFunction& function : read.input->functions) {
    names.functions.add(function.name);
    names.functions_made.push_back(make_part(function_catalog(), *function.shape));
  }
  for (const CaseRecordSource& record : read.input->records) {
    names.functions.add(record.name);
    names.functions_made.push_back(nullptr);
  }
  names.records = &read.records;
}

void add_structure(const Case& read, ModelBuilder& builder, CaseNames& names, const std::vector<double>& tuned, bool at_rest) {
  add_beams(read, builder, names);
  add_masses(*read.input, builder, names, tuned);
  add_elements(*read.input, builder, names);
  add_supports(read, builder, names, at_rest);
}

}  // namespace uplift
