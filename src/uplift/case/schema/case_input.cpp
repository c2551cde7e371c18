#include "uplift/case/schema/case_input.h"

#include <map>
#include <set>

#include "uplift/mesh/mesh.h"

namespace uplift {
namespace {

/// The tables of one name.
template <class Table, class... More>
std::vector<Table> all(const Values& root, std::string_view key, Table (*read)(const Values&, More...), More... more) {
  std::vector<Table> made;
  for (const Values& table : root.tables(key)) made.push_back(read(table, more...));
  return made;
}

/// Waves of the same name, as without one, are told apart: a free field follows a wave by its name.
void number_waves(std::vector<CaseAbsorbing>& absorbing) {
  std::set<std::string> stated, used;
  for (const CaseAbsorbing& each : absorbing)
    if (each.incident) stated.insert(each.incident->name);
  std::map<std::string, int> count;
  for (CaseAbsorbing& each : absorbing) {
    if (!each.incident || used.insert(each.incident->name).second) continue;
    int& number = count.try_emplace(each.incident->name, 1).first->second;
    std::string name;
    do name = each.incident->name + " " + std::to_string(++number);
    while (stated.contains(name) || !used.insert(name).second);
    each.incident->name = name;
  }
}

int dimension_of_nodes(const Values& root) {
  const std::vector<Values>& nodes = root.tables("nodes");
  return nodes.empty() ? 2 : static_cast<int>(nodes.front().numbers("value").size());
}

}  // namespace

CaseInput input_of_mesh(const Values& root) {
  CaseInput made;
  if (const Values* mesh = table_if(root, "mesh")) made.mesh = case_mesh_source(*mesh);
  for (const ElementEntry* entry : element_catalog())
    for (const Values& table : root.tables(entry->name))
      made.elements[static_cast<std::size_t>(entry->place)].push_back(case_element(table, *entry));
  made.absorbing = all(root, "absorbing", case_absorbing);
  number_waves(made.absorbing);
  made.ties = all(root, "tie", case_tie);
  made.interfaces = all(root, "interface", case_interface);
  made.foundations = all(root, "foundation", case_foundation);
  return made;
}

void add_rest_of_input(const Values& root, const Mesh* mesh, CaseInput& made) {
  const Space space = made.space = {mesh != nullptr ? mesh->dimension : dimension_of_nodes(root)};
  made.nodes = all(root, "nodes", case_node, space);
  made.masses = all(root, "mass", case_mass, space);
  made.bodies = all(root, "rigid", case_body, space);
  made.supports = all(root, "support", case_support);
  made.motions = all(root, "motion", case_motion);
  made.grounds = all(root, "ground_acceleration", case_ground, space);
  if (const Values* gravity = table_if(root, "gravity")) made.gravity = case_gravity(*gravity, space);
  made.functions = all(root, "function", case_function);
  made.records = all(root, "record", case_record);
  made.loads = all(root, "load", case_load, space);
  made.initial = all(root, "initial", case_initial, space);
  made.stages = all(root, "stage", case_stage);
  made.energy = case_energy(root.table("energy"));
  made.limits = case_limits(root.table("limits"));
  made.output = case_output(root.table("output"), space);
  made.title = root.text("title");
  made.description = text_or(root, "description", "");
  made.bonded = root.flag("bonded");
  if (const Values* verdict = table_if(root, "verdict")) made.verdict = case_verdict(*verdict);
  made.method = table_if(root, "method");
  made.impact = table_if(root, "impact");
  made.solver = &root.part("solver");
  if (const Values* damping = table_if(root, "damping")) made.damping = case_damping(*damping);
  made.interface_solver = root.text("interface_solver");
  if (root.has("reduced_model")) made.reduced_model = root.text("reduced_model");
  made.variants = all(root, "variant", case_variant);
  if (const Values* compare = table_if(root, "compare")) made.compare = case_comparison(*compare);
  made.trust = case_trust(root.table("trust"));
  made.origins = all(root, "origin", case_origin);
  made.figures = all(root, "figure", case_figure);
}

}  // namespace uplift
