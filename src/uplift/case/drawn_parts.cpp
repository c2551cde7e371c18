#include "uplift/case/drawn_parts.h"

#include <algorithm>

#include "uplift/case/build/model.h"
#include "uplift/case/mesh/mesh.h"
#include "uplift/elements/element_entry.h"
#include "uplift/mesh/sides.h"

namespace uplift {
namespace {

int node_if_named(const NodeOrGroup& of, const Model& model) {
  return of.node ? model.find_node(of.node->name) : -1;
}

std::string group_if_named(const NodeOrGroup& of) {
  return of.group ? of.group->name : std::string();
}

std::vector<double> force_of(const CaseLoad& load, const Model& model) {
  if (!load.force && !load.traction && !load.pressure) return {};
  const Vec3 sum = load.force ? *load.force : load.traction ? *load.traction : resultant_of_load(load, model);
  return {sum.data(), sum.data() + model.space.dimension};
}

void add_links(const CaseInput& input, const Model& model, std::vector<DrawnParts::Link>& links) {
  for (const CaseElement& link : input.elements_at(ElementPlace::nodes))
    links.push_back({model.find_node(link.nodes.front().name), link.nodes.size() > 1 ? model.find_node(link.nodes.back().name) : -1,
                     link.entry->symbol});
}

void add_bodies(const CaseInput& input, const Model& model, std::vector<DrawnParts::Body>& bodies) {
  for (std::size_t k = 0; k < model.interfaces.size(); ++k) {
    const std::string& name = model.interfaces[k].name;
    for (const CaseInterface& interface : input.interfaces) {
      const CaseFooting* footing = interface.name.name == name ? interface.footing() : nullptr;
      if (footing == nullptr) continue;
      const bool grid = footing->rule == FootingRule::nodal && model.space.dimension == 3;
      bodies.push_back(
          {k, model.find_node(footing->body.name), false, grid ? footing->points : 0, grid ? footing->points_across.value_or(0) : 0});
    }
    for (const CaseFoundation& foundation : input.foundations)
      if (foundation.name.name == name) bodies.push_back({k, model.find_node(foundation.body.name), true, 0, 0});
  }
}

}  // namespace

std::set<int> DrawnParts::nodes() const {
  std::set<int> all;
  for (const Mass& each : masses) all.insert(each.node);
  for (const Support& each : supports) all.insert(each.node);
  for (const Load& each : loads) all.insert(each.node);
  for (const Link& each : links) all.insert({each.node, each.other});
  for (const Body& each : bodies) all.insert(each.node);
  all.erase(-1);
  return all;
}

const DrawnParts::Body* DrawnParts::body_above(std::size_t interface) const {
  const auto found = std::ranges::find(bodies, interface, &Body::interface);
  return found == bodies.end() ? nullptr : &*found;
}

DrawnParts drawn_parts(const Case& read, const BuiltCase& built) {
  const Model& model = built.model;
  DrawnParts parts;
  parts.first_of_mesh = static_cast<int>(read.input->nodes.size());
  for (const CaseElement& solid : read.input->elements_at(ElementPlace::cells)) parts.solids.push_back(solid.group->name);
  for (const CaseMass& mass : read.input->masses)
    parts.masses.push_back({model.find_node(mass.node.name), mass.mass.value_or(built.tuned_mass)});
  for (const CaseSupport& support : read.input->supports) {
    std::vector<std::string> fixed;
    for (const NameUsed& unknown : support.fixed) fixed.push_back(unknown.name);
    parts.supports.push_back({node_if_named(support.of, model), group_if_named(support.of), std::move(fixed), support.statics_only});
  }
  for (const CaseLoad& load : read.input->loads)
    parts.loads.push_back({load.name, node_if_named(load.of, model), group_if_named(load.of), force_of(load, model)});
  add_links(*read.input, model, parts.links);
  for (const CaseAbsorbing& face : read.input->absorbing)
    parts.absorbing.push_back({face.group.name, face.free_field, face.incident.has_value()});
  add_bodies(*read.input, model, parts.bodies);
  return parts;
}

std::vector<int> nodes_drawn_in_space(const Case& read, const BuiltCase& built, const DrawnParts& parts) {
  std::set<int> all = parts.nodes();
  for (int i = 0; i < parts.first_of_mesh; ++i) all.insert(i);
  std::vector<int> nodes;
  for (const std::string& group : parts.solids) {
    const Mesh& mesh = read.mesh->drawn();
    const Sides sides(mesh, mesh.groups.at(group).cells);
    for (int cell = 0; cell < std::ssize(sides.cells()); ++cell)
      for (int side = 0; side < sides.count(cell); ++side) {
        if (sides.twin(Sides::stride * cell + side) >= 0) continue;
        sides.nodes_of(mesh, Sides::stride * cell + side, nodes);
        const Cell type = info(mesh.type(sides.cells()[static_cast<std::size_t>(cell)])).sides[static_cast<std::size_t>(side)];
        for (int k = 0; k < info(type).corners; ++k) all.insert(parts.first_of_mesh + nodes[static_cast<std::size_t>(k)]);
      }
  }
  for (const BeamLine& beam : built.beams) all.insert(beam.nodes.begin(), beam.nodes.end());
  for (const int node : {built.top, built.base})
    if (node >= 0) all.insert(node);
  return {all.begin(), all.end()};
}

std::size_t most_pictures_in_space(std::size_t nodes) {
  constexpr std::size_t numbers = 900'000;
  return std::max<std::size_t>(12, numbers / (3 * nodes + 1));
}

}  // namespace uplift
