#include "uplift/analysis/case_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "uplift/elements/beam.h"
#include "uplift/elements/discrete.h"

namespace uplift {

Vec2 vec2(const std::vector<double>& numbers) {
  return {numbers[0], numbers[1]};
}

const Values* table_if(const Values& values, std::string_view key) {
  return values.has(key) ? &values.table(key) : nullptr;
}

std::vector<int> CaseNames::nodes_of(const Values& table, std::string_view key) const {
  std::vector<int> found;
  if (!table.has(key)) return found;
  for (const std::string& name : table.texts(key)) found.push_back(nodes.find(name, table.where(key), table.path(key)));
  return found;
}

const CaseSolids& CaseNames::mesh_for(const Values& table) const {
  if (!solids) throw InputError(table.where("group"), table.path("group"), "a [mesh] with this group", "none");
  return *solids;
}

std::vector<int> CaseNames::node_or_group(const Values& table) const {
  const bool node_given = table.has("node");
  if (node_given == table.has("group"))
    throw InputError(table.where(node_given ? "group" : ""), table.path(node_given ? "group" : ""), "either node or group",
                     node_given ? "both" : "neither");
  if (node_given) return {node(table, "node")};
  std::vector<int> found = mesh_for(table).nodes(table, "group");
  for (int& each : found) each += first_of_mesh;
  return found;
}

namespace {

class One final : public TimeFunction {
 public:
  double value(double) const override { return 1; }
  double rate(double) const override { return 0; }
  double acceleration(double) const override { return 0; }
};

/// A function times an amplitude.
class Scaled final : public TimeFunction {
 public:
  Scaled(double factor, std::shared_ptr<const TimeFunction> function) : factor_(factor), function_(std::move(function)) {}
  double value(double time) const override { return factor_ * function_->value(time); }
  double rate(double time) const override { return factor_ * function_->rate(time); }
  double acceleration(double time) const override { return factor_ * function_->acceleration(time); }

 private:
  double factor_;
  std::shared_ptr<const TimeFunction> function_;
};

[[noreturn]] void fail(const Values& table, std::string_view key, const std::string& wanted, const std::string& found,
                       const std::string& nearest = {}) {
  throw InputError(table.where(key), table.path(key), wanted, found, nearest);
}

Dof dof_of(const std::string& word, const Values& table, std::string_view key) {
  if (word == "ux") return ux;
  if (word == "uy") return uy;
  if (word == "rz") return rz;
  fail(table, key, "ux, uy or rz", "\"" + word + "\"", nearest_name(word, {"ux", "uy", "rz"}));
}

/// Exactly one of two keys must be given.
bool first_of_two(const Values& table, std::string_view first, std::string_view second) {
  const bool a = table.has(first), b = table.has(second);
  if (a == b) fail(table, a ? second : "", fmt::format("either {} or {}", first, second), a ? "both" : "neither");
  return a;
}

void add_beam(const Values& beam, ModelBuilder& builder, CaseNames& names, Names& beams) {
  beams.add(beam, "name");
  const std::vector<int> ends = names.nodes_of(beam, "nodes");
  if (ends.size() != 2) fail(beam, "nodes", "two nodes", fmt::format("{}", ends.size()));
  const Vec2 a = names.positions[ends[0]], b = names.positions[ends[1]];
  if ((b - a).norm() == 0) fail(beam, "nodes", "two nodes at different places", "two nodes at the same place");
  const double young = beam.number("E");
  BeamSection section;
  section.bending = young * beam.number("I");
  if (beam.has("A")) section.axial = young * beam.number("A");
  if (beam.text("theory") == "timoshenko") {
    if (!beam.has("shear_area")) fail(beam, "", "shear_area for theory = \"timoshenko\"", "none");
    section.shear = young / (2 * (1 + beam.number("poisson"))) * beam.number("shear_area");
  }
  if (beam.text("mass") != "none") {
    if (!beam.has("density") || !beam.has("A"))
      fail(beam, "mass", "density and A of the beam", !beam.has("density") ? "no density" : "no A");
    section.mass = beam.text("mass") == "consistent" ? BeamSection::Mass::consistent : BeamSection::Mass::lumped;
    section.mass_per_length = beam.number("density") * beam.number("A");
    if (beam.text("theory") == "timoshenko") section.rotary_per_length = beam.number("density") * beam.number("I");
  }
  const int pieces = beam.integer("elements");
  int last = ends[0];
  Vec2 from = a;
  for (int k = 1; k <= pieces; ++k) {
    const Vec2 to = k == pieces ? b : Vec2(a + (b - a) * (static_cast<double>(k) / pieces));
    int next = ends[1];
    if (k < pieces) {
      const std::string name = fmt::format("{}.{}", beam.text("name"), k);
      next = builder.add_node(name, to, beam.where());
      names.nodes.add(name, beam.where("name"), beam.path("name"));
      names.positions.push_back(to);
    }
    auto element = std::make_unique<Beam>(last, next, from, to, section);
    element->beta = beam.number("damping_beta");
    if (!section.axial) builder.inextensible(last, next, beam.where());
    builder.add_element(std::move(element), beam.where());
    last = next;
    from = to;
  }
}

Connection connection_of(const Values& table, const CaseNames& names, bool along) {
  Connection connection;
  connection.nodes = names.nodes_of(table, "nodes");
  if (connection.nodes.empty() || connection.nodes.size() > 2)
    fail(table, "nodes", "one node or two nodes", fmt::format("{}", connection.nodes.size()));
  if (along != table.has("direction"))
    fail(table, along ? "" : "direction", along ? "direction = [x, y]" : "no direction for a rotational one", along ? "none" : "one");
  if (along) {
    connection.direction = vec2(table.numbers("direction"));
    if (connection.direction->norm() == 0) fail(table, "direction", "a direction", "[0, 0]");
  }
  return connection;
}

void add_masses(const Values& root, ModelBuilder& builder, CaseNames& names, const std::vector<double>& tuned) {
  std::size_t next = 0;
  for (const Values& mass : root.tables("mass")) {
    const int node = names.node(mass, "node");
    const double value = first_of_two(mass, "mass", "tuned_frequency") ? mass.number("mass") : tuned.at(next++);
    builder.add_element(std::make_unique<PointMass>(node, value, mass.number("inertia")), mass.where());
  }
  Names bodies("rigid body");
  for (const Values& body : root.tables("rigid")) {
    bodies.add(body, "name");
    const int master = names.node(body, "node");
    for (const int slave : names.nodes_of(body, "slaves")) {
      if (slave == master) fail(body, "slaves", "nodes other than the master", "\"" + names.nodes[master] + "\"");
      builder.tie_rigid(master, slave, body.where("slaves"));
    }
    const Vec2 offset = body.has("centre") ? Vec2(vec2(body.numbers("centre")) - names.positions[master]) : Vec2::Zero();
    if (body.number("mass") > 0 || body.number("inertia") > 0)
      builder.add_element(std::make_unique<PointMass>(master, body.number("mass"), body.number("inertia"), offset), body.where());
  }
}

/// A node of the mesh has no rotation to be held or moved.
Dof dof_for(const std::string& word, const Values& table, std::string_view key) {
  const Dof dof = dof_of(word, table, key);
  if (dof == rz && table.has("group")) fail(table, key, "ux or uy for a group of the mesh", "\"rz\"");
  return dof;
}

void add_supports(const Values& root, ModelBuilder& builder, const CaseNames& names) {
  std::set<std::pair<int, int>> held;  // by groups: those of two sides share the corner
  for (const Values& support : root.tables("support"))
    for (const int node : names.node_or_group(support))
      for (const std::string& word : support.texts("fixed")) {
        const Dof dof = dof_for(word, support, "fixed");
        if (!support.has("group") || held.emplace(node, dof).second) builder.fix(node, dof, support.where("fixed"));
      }
  for (const Values& motion : root.tables("motion")) {
    const std::vector<int> nodes = names.node_or_group(motion);
    const std::string name = motion.has("name") ? motion.text("name") : "motion of " + motion.text(motion.has("node") ? "node" : "group");
    for (const int node : nodes)
      builder.prescribe(node, dof_for(motion.text("direction"), motion, "direction"),
                        std::make_shared<Scaled>(motion.number("amplitude"), names.function(motion)), name, motion.where());
  }
}

using Pattern = std::vector<std::pair<int, double>>;

void add_force(int node, const Vec2& force, Pattern& pattern) {
  if (force.x() != 0) pattern.emplace_back(3 * node + ux, force.x());
  if (force.y() != 0) pattern.emplace_back(3 * node + uy, force.y());
}

Pattern node_load(const Values& load, int node) {
  if (load.has("traction")) fail(load, "traction", "force or moment on a node", "a traction");
  if (!load.has("force") && !load.has("moment")) fail(load, "", "force or moment", "neither");
  Pattern pattern;
  if (load.has("force")) add_force(node, vec2(load.numbers("force")), pattern);
  if (load.has("moment") && load.number("moment") != 0) pattern.emplace_back(3 * node + rz, load.number("moment"));
  return pattern;
}

/// Consistent forces of a uniform traction on edges of the mesh.
Pattern edge_load(const Values& load, const CaseNames& names) {
  if (load.has("moment")) fail(load, "moment", "force or traction on a group", "a moment");
  const bool traction = first_of_two(load, "traction", "force");
  if (!load.has("name")) fail(load, "", "a name for the load on a group", "none");
  const CaseSolids& solids = names.mesh_for(load);
  const std::vector<std::pair<int, double>> areas = tributary_areas(solids, solids.edges(load, "group"));
  double area = 0;
  for (const auto& [node, share] : areas) area += share;
  const Vec2 per_area = traction ? vec2(load.numbers("traction")) : Vec2(vec2(load.numbers("force")) / area);
  Pattern pattern;
  for (const auto& [node, share] : areas) add_force(names.first_of_mesh + node, share * per_area, pattern);
  return pattern;
}

}  // namespace

std::shared_ptr<const TimeFunction> scaled(double factor, std::shared_ptr<const TimeFunction> function) {
  return std::make_shared<Scaled>(factor, std::move(function));
}

std::shared_ptr<const TimeFunction> CaseNames::function(const Values& table) const {
  if (!table.has("function")) return std::make_shared<One>();
  return functions_made[functions.find(table, "function")];
}

void add_nodes(const Values& root, ModelBuilder& builder, CaseNames& names) {
  for (const Values& node : root.tables("nodes")) {
    names.nodes.add(node.key(), node.where(), node.path());
    names.positions.push_back(vec2(node.numbers("value")));
    builder.add_node(node.key(), names.positions.back(), node.where());
  }
}

void add_mesh(const Case& read, ModelBuilder& builder, CaseNames& names) {
  if (!read.mesh) return;
  const Mesh& mesh = read.mesh->mesh;
  const Values& table = read.values.table("mesh");
  names.solids = std::make_shared<const CaseSolids>(read.values, *read.mesh);
  names.first_of_mesh = names.nodes.size();
  auto coordinates = std::make_shared<std::vector<Vec3>>(names.positions.size(), Vec3::Zero());
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) {
    const std::string name = fmt::format("mesh.{}", i + 1);
    coordinates->push_back(mesh.nodes[i]);
    names.nodes.add(name, table.where(), table.path());
    names.positions.push_back(mesh.nodes[i].head<2>());
    builder.add_node(name, names.positions.back(), table.where());
  }
  names.coordinates = coordinates;
  std::vector<int> nodes;
  for (const CaseSolids::Solid& solid : names.solids->solids())
    for (const CellId cell : solid.cells) {
      nodes.clear();
      for (const int node : mesh.cell(cell)) nodes.push_back(names.first_of_mesh + node);
      auto element = std::make_unique<Solid>(mesh.type(cell), nodes, coordinates, solid.section);
      element->beta = solid.table->number("damping_beta");
      builder.add_element(std::move(element), solid.table->where());
    }
}

void add_functions(const Values& root, CaseNames& names) {
  for (const Values& function : root.tables("function")) {
    names.functions.add(function, "name");
    names.functions_made.push_back(make_part(function_catalog(), function.part("shape")));
  }
}

void add_structure(const Values& root, ModelBuilder& builder, CaseNames& names, const std::vector<double>& tuned) {
  Names beams("beam");
  for (const Values& beam : root.tables("beam")) add_beam(beam, builder, names, beams);
  add_masses(root, builder, names, tuned);
  for (const Values& spring : root.tables("spring")) {
    const bool along = first_of_two(spring, "stiffness", "rotational_stiffness");
    builder.add_element(
        std::make_unique<Spring>(connection_of(spring, names, along), spring.number(along ? "stiffness" : "rotational_stiffness")),
        spring.where());
  }
  for (const Values& dashpot : root.tables("dashpot")) {
    const bool along = first_of_two(dashpot, "damping", "rotational_damping");
    builder.add_element(
        std::make_unique<Dashpot>(connection_of(dashpot, names, along), dashpot.number(along ? "damping" : "rotational_damping")),
        dashpot.where());
  }
  add_supports(root, builder, names);
}

void add_loads(const Values& root, ModelBuilder& builder, const CaseNames& names) {
  for (const Values& load : root.tables("load")) {
    std::vector<std::pair<int, double>> pattern =
        first_of_two(load, "node", "group") ? node_load(load, names.node(load, "node")) : edge_load(load, names);
    const std::string name = load.has("name") ? load.text("name") : "load on " + load.text("node");
    builder.add_load(name, std::move(pattern), names.function(load), !load.has("function"), load.where());
  }
  if (const Values* gravity = table_if(root, "gravity"); gravity && gravity->has("acceleration"))
    builder.set_gravity(vec2(gravity->numbers("acceleration")), gravity->where());
  for (const Values& ground : root.tables("ground_acceleration")) {
    const std::string name = ground.has("name") ? ground.text("name") : "ground acceleration";
    builder.add_ground_acceleration(vec2(ground.numbers("direction")),
                                    std::make_shared<Scaled>(ground.number("amplitude"), names.function(ground)), name, ground.where());
  }
}

BulkDamping bulk_damping(const Values& damping) {
  BulkDamping made{damping.number("alpha"), damping.number("beta"), damping.numbers("modal"), damping.integer("modes")};
  if (made.modal_count == 0) made.modal_count = static_cast<int>(made.modal.size());
  const std::vector<Values>& pairs = damping.tables("rayleigh");
  if (pairs.size() > 2) fail(damping, "rayleigh", "one or two pairs of frequency and ratio", fmt::format("{}", pairs.size()));
  if (!pairs.empty() && (made.alpha > 0 || made.beta > 0)) fail(damping, "rayleigh", "either rayleigh or alpha and beta", "both");
  // ratio(w) = alpha/(2 w) + beta w/2
  const auto omega = [](const Values& pair) { return 2 * std::numbers::pi * pair.number("frequency"); };
  if (pairs.size() == 1) made.beta = 2 * pairs[0].number("ratio") / omega(pairs[0]);
  if (pairs.size() == 2) {
    const double w1 = omega(pairs[0]), w2 = omega(pairs[1]), r1 = pairs[0].number("ratio"), r2 = pairs[1].number("ratio");
    if (w1 == w2)
      fail(pairs[1], "frequency", "a frequency that differs from the first", fmt::format("{} Hz again", pairs[1].number("frequency")));
    made.beta = 2 * (r2 * w2 - r1 * w1) / (w2 * w2 - w1 * w1);
    made.alpha = 2 * w1 * r1 - made.beta * w1 * w1;
    if (made.alpha < 0 || made.beta < 0)
      fail(damping, "rayleigh", "two pairs that give no negative factor",
           fmt::format("alpha = {:.4g} 1/s, beta = {:.4g} s", made.alpha, made.beta));
  }
  return made;
}

}  // namespace uplift
