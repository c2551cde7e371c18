#include "uplift/case/mesh/mesh.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "simple_meshes.h"
#include "text_support.h"
#include "uplift/elements/solid.h"
#include "uplift/io/text/toml.h"
#include "uplift/math/sparse_solvers.h"
#include "uplift/model/builder.h"

// Cases with a mesh: against closed forms, and against the same mesh without an interface.
namespace uplift::mesh_test {
namespace {

constexpr double depth = 6, height = 4;  // m

/// Soil from -6 m to 0 and a block to 4 m on all of it (width 2 m), the interface between them.
Mesh column(Cell cell) {
  Grid lines{uniform_lines(-1, 1, 2), uniform_lines(-depth, height, 10), {}};
  const auto part_at = [](int, int j, int) { return j < 6 ? 0 : 1; };
  const auto face = [](int part, Direction direction, int other) -> std::string {
    if (part == 0 && other == 1) return "interface";
    if (other >= 0) return "";
    return (part == 0 ? "soil_" : "block_") + std::string(name_of(direction));
  };
  return with_cells(grid(lines, part_at, {"soil", "block"}, face), cell);
}

constexpr double soil_young = 5e7, soil_density = 1900, block_young = 2e9, block_density = 700, poisson = 0.3, gravity = 10;

std::string column_text(double joint, const std::string& extra = {}) {
  return R"(
title = "column"
[mesh]
file = "column.msh"
[[solid]]
group = "soil"
E = 5e7
poisson = 0.3
density = 1900
[[solid]]
group = "block"
E = 2e9
poisson = 0.3
density = 700
[[interface]]
name = "base"
surface = { group = "interface", lower = ["soil"] }
law = { type = "elastic", K_n = )" +
         std::to_string(joint) + R"(, tangential = "bonded" }
[gravity]
acceleration = [0, -10]
[[stage]]
type = "static"
[[stage]]
type = "dynamic"
duration = 1e-3
step = 1e-3
)" + extra;
}

constexpr const char* side_supports = R"(
[[support]]
group = "soil_bottom"
fixed = ["ux", "uy"]
[[support]]
group = "soil_left"
fixed = ["ux"]
[[support]]
group = "soil_right"
fixed = ["ux"]
[[support]]
group = "block_left"
fixed = ["ux"]
[[support]]
group = "block_right"
fixed = ["ux"]
)";

Case read_text(const std::string& text, const Mesh& mesh) {
  return check_case(read_toml_text(text, "case.toml"), "case.toml",
                    [&](const std::string&, const Where&, const std::string&) { return mesh; });
}

std::string refusal(const std::string& text, const Mesh& mesh) {
  return support::refusal_of([&] { build(read_text(text, mesh), RunSpec{}); });
}

/// Value of a column after the static stage.
double at_rest(const Case& read, const std::string& column) {
  BuiltCase built = build(read, RunSpec{});
  const RunResult result = run(built.model, built.plan, built.behaviours);
  EXPECT_EQ(to_string(result.status), "completed") << result.reason;
  for (std::size_t k = 0; k < result.columns.size(); ++k)
    if (result.columns[k].name == column) return result.table[k + 1].front();
  ADD_FAILURE() << "no column " << column;
  return 0;
}

double constrained(double young) {
  return young * (1 - poisson) / ((1 + poisson) * (1 - 2 * poisson));
}

TEST(CaseMesh, ColumnSettlesUnderItsWeightByTheClosedForm) {
  // One-dimensional strain: soil rho g H^2/(2 M) under its weight, p H/M and p/k under that of the block, the block rho g h^2/(2 M').
  constexpr double joint = 3e7;
  const double pressure = block_density * gravity * height;
  const double soil = soil_density * gravity * depth * depth / (2 * constrained(soil_young)) + pressure * depth / constrained(soil_young);
  const double block = block_density * gravity * height * height / (2 * constrained(block_young));
  for (const Cell cell : {Cell::quad4, Cell::quad8, Cell::tri6}) {
    const Case read = read_text(
        column_text(joint, std::string(side_supports) + "[[output.history]]\nname = \"ground\"\nat = [1, 0]\nquantity = \"uy\"\n"),
        column(cell));
    EXPECT_NEAR(at_rest(read, "ground"), -soil, 1e-9 * soil) << info(cell).name;
    EXPECT_NEAR(at_rest(read, "base.uy"), -soil - pressure / joint, 1e-9 * soil) << info(cell).name;
    EXPECT_NEAR(at_rest(read, "top.uy"), -soil - pressure / joint - block, 1e-9 * soil) << info(cell).name;
    EXPECT_NEAR(at_rest(read, "base.axial"), -2 * pressure, 1e-9 * pressure);
  }
}

TEST(CaseMesh, DeadLoadIsThatOfTheBlockAlone) {
  const BuiltCase built = build(read_text(column_text(3e7, side_supports), column(Cell::quad4)), RunSpec{});
  EXPECT_NEAR(built.weight(), block_density * gravity * height * 2, 1e-6);
  const std::string roof = "[[load]]\nname = \"roof\"\ngroup = \"block_top\"\ntraction = [3, -500]\n";
  EXPECT_NEAR(build(read_text(column_text(3e7, side_supports + roof), column(Cell::quad4)), RunSpec{}).weight(),
              (block_density * gravity * height + 500) * 2, 1e-6);
}

TEST(CaseMesh, APointMassAtALowNodeIsNotTheTop) {
  const std::string text = column_text(3e7, side_supports);
  const BuiltCase plain = build(read_text(text, column(Cell::quad4)), RunSpec{});
  std::string low;  // a node of the underside of the block
  for (const auto& [name, node] : plain.model.second_names)
    if (node == plain.base) low = name;
  ASSERT_FALSE(low.empty());
  const std::string loaded = text + "[[mass]]\nnode = \"" + low + "\"\nmass = 1000\n";
  const BuiltCase built = build(read_text(loaded, column(Cell::quad4)), RunSpec{});
  EXPECT_EQ(built.top, plain.top);
  EXPECT_NEAR(built.top_place().y(), height, 1e-12);
}

TEST(CaseMesh, NodesThatAreShownAreFoundByTheirNumbersToo) {
  const std::string text = column_text(3e7, side_supports);
  const BuiltCase built = build(read_text(text, column(Cell::quad4)), RunSpec{});
  EXPECT_EQ(built.model.find_node("top"), built.top);
  for (int node = 0; node < static_cast<int>(built.model.nodes.size()); ++node)
    EXPECT_EQ(built.model.find_node("mesh." + std::to_string(node + 1)), node);
  for (const int node : {built.top, built.base}) {
    const std::string asked = "[[output.history]]\nname = \"asked\"\nnode = \"mesh." + std::to_string(node + 1) + "\"\nquantity = \"vy\"\n";
    const BuiltCase again = build(read_text(text + asked, column(Cell::quad4)), RunSpec{});
    const auto found = std::ranges::find(again.plan.requests, "asked", &Request::name);
    ASSERT_NE(found, again.plan.requests.end());
    EXPECT_EQ(found->unknown, again.model.at(node, uy));
  }
}

// A large model is made of nodes and solids: what they have in common is there once, and their lists are no longer than they need to be.
TEST(CaseMesh, SolidsOfOneTableShareWhatTheyAreMadeOf) {
  const BuiltCase built = build(read_text(column_text(3e7, side_supports), column(Cell::quad8)), RunSpec{});
  std::set<const SolidSection*> sections;
  for (const auto& element : built.model.elements)
    if (element->continuum() != nullptr) sections.insert(element->continuum());
  EXPECT_EQ(sections.size(), 2U);  // soil and block
  EXPECT_LE(built.model.nodes.capacity(), built.model.nodes.size() * 17 / 16);
  EXPECT_LE(built.model.elements.capacity(), built.model.elements.size() * 17 / 16);
}

/// Sway of the roof of the same block and soil without an interface, under the same traction at its left side, by the elements alone.
double unsplit_sway(const Mesh& mesh, double traction) {
  ModelBuilder builder;
  auto coordinates = std::make_shared<std::vector<Vec3>>(mesh.nodes);
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) builder.add_node(std::to_string(i), mesh.nodes[i].head<2>(), {});
  SolidSection soil, block;
  soil.material = {soil_young, poisson, soil_density};
  block.material = {block_young, poisson, block_density};
  for (const auto& [name, section] : {std::pair{"soil", soil}, std::pair{"block", block}})
    for (const CellId cell : mesh.groups.at(name).cells)
      builder.add_element(std::make_unique<Solid>(mesh.type(cell), mesh.cell(cell), coordinates, section), {});
  for (const int node : nodes_of(mesh, mesh.groups.at("soil_bottom")))
    for (const Dof dof : {ux, uy}) builder.fix(node, dof, {});
  // a unit of height of the left side: half of it to each end (linear edges)
  std::vector<std::pair<int, double>> pattern;
  int top = 0;
  for (int node = 0; node < static_cast<int>(mesh.nodes.size()); ++node) {
    const Vec3& x = mesh.nodes[static_cast<std::size_t>(node)];
    if (x.y() > height - 1e-9 && std::abs(x.x()) < 1e-9) top = node;
    if (x.x() > -1 + 1e-9 || x.y() < -1e-9) continue;
    const bool end = x.y() < 1e-9 || x.y() > height - 1e-9;
    pattern.emplace_back(3 * node, traction * (end ? 0.5 : 1));
  }
  builder.add_load("side", pattern, nullptr, true, {});
  const Model model = builder.finish();
  Vector force = Vector::Zero(model.free());
  model.add_force(0, force);
  const Vector q = SparseLdlt(model.stiffness).solve(force);
  return model.full(3 * top, q, 0, 0);
}

TEST(CaseMesh, StiffJointComesToTheUnsplitMeshWithOrderOne) {
  const Mesh mesh = column(Cell::quad4);
  const std::string loaded = R"(
[[support]]
group = "soil_bottom"
fixed = ["ux", "uy"]
[[load]]
name = "side"
group = "block_left"
traction = [1e5, 0]
[[output.history]]
name = "sway"
at = [0, 4]
quantity = "ux"
)";
  const double wanted = unsplit_sway(mesh, 1e5);
  std::vector<double> errors;
  for (const double joint : {1e9, 1e10, 1e11}) {
    const std::string text = support::replaced(column_text(joint, loaded), "[gravity]\nacceleration = [0, -10]\n", "");
    errors.push_back(std::abs(at_rest(read_text(text, mesh), "sway") - wanted) / wanted);
  }
  EXPECT_LT(errors.back(), 1e-3);
  for (std::size_t i = 1; i < errors.size(); ++i)
    EXPECT_NEAR(std::log10(errors[i - 1] / errors[i]), 1, 0.05) << errors[i - 1] << " " << errors[i];
}

TEST(CaseMesh, LoadsOnEdgesAreConsistent) {
  // Whole force and its moment about the origin, whatever the cell; on an edge of second degree 1/6, 4/6, 1/6.
  for (const Cell cell : {Cell::quad4, Cell::quad9}) {
    const std::string load = "[[load]]\nname = \"roof\"\ngroup = \"block_top\"\nforce = [6, -12]\n";
    const BuiltCase built = build(read_text(column_text(1e9, side_supports + load), column(cell)), RunSpec{});
    Vector pattern;
    for (std::size_t i = 0; i < built.model.time_loads.size(); ++i)
      if (built.model.time_loads[i].name == "roof") pattern = built.model.assembly.loads[i];
    ASSERT_GT(pattern.size(), 0);
    Vec2 sum = Vec2::Zero();
    double moment = 0;
    for (int node = 0; node < static_cast<int>(built.model.nodes.size()); ++node) {
      const Vec2 force = pattern.segment<2>(3 * node), at = built.model.nodes[static_cast<std::size_t>(node)].position.head<2>();
      sum += force;
      moment += at.x() * force.y() - at.y() * force.x();
      if (cell == Cell::quad9 && at.y() > height - 1e-9 && std::abs(at.x() - 0.5) < 1e-9) EXPECT_NEAR(force.x(), 3 * 4.0 / 6, 1e-12);
    }
    EXPECT_NEAR(sum.x(), 6, 1e-12);
    EXPECT_NEAR(sum.y(), -12, 1e-12);
    EXPECT_NEAR(moment, -6 * height, 1e-12);
  }
}

TEST(CaseMesh, ThicknessOfTheSurfaceIsTheSmallerOne) {
  std::string text = support::replaced(column_text(3e7, side_supports), "density = 700", "density = 700\nthickness = 0.5");
  EXPECT_NEAR(build(read_text(text, column(Cell::quad4)), RunSpec{}).facts.front().area, 2 * 0.5, 1e-12);
  text = support::replaced(text, "lower = [\"soil\"]", "lower = [\"soil\"], thickness = 0.25");
  EXPECT_NEAR(build(read_text(text, column(Cell::quad4)), RunSpec{}).facts.front().area, 2 * 0.25, 1e-12);
}

TEST(CaseMesh, FixedBaseFrequenciesAreThoseOfTheBlockAlone) {
  // The soil, however soft, stands still: the block between smooth walls on held ground, first mode of a column c/(4 h), c = sqrt(M/rho).
  const BuiltCase built =
      build(read_text(support::replaced(column_text(3e9, side_supports), "E = 5e7", "E = 5e5"), column(Cell::quad8)), RunSpec{});
  const double wave = std::sqrt(constrained(block_young) / block_density);
  const std::vector<Mode> modes = fixed_base_modes(built.model, 1);
  ASSERT_EQ(modes.size(), 1u);
  EXPECT_NEAR(modes[0].frequency, wave / (4 * height), 1e-3 * wave / (4 * height));
}

/// Rock and "building" of one material, held against vertical motion, on an absorbing base; a shear wave comes up.
std::string shear_column(const std::string& kind) {
  std::string text = column_text(1e13, R"(
[[absorbing]]
group = "soil_bottom"
incident = { wave = "SV", kind = ")" + kind +
                                           R"(", velocity = "0.2 m/s", function = "wave" }
[[function]]
name = "wave"
shape = { type = "half_sine", duration = 0.1 }
[[support]]
group = "soil"
fixed = ["uy"]
[[support]]
group = "block"
fixed = ["uy"]
[[spring]]                     # nothing else holds the column at rest; far softer than the wave is fast
nodes = ["mesh.1"]
direction = [1, 0]
stiffness = 100
)");
  text = support::replaced(text, "[gravity]\nacceleration = [0, -10]\n", "");
  text = support::replaced(text, "E = 2e9\npoisson = 0.3\ndensity = 700", "E = 5e7\npoisson = 0.3\ndensity = 1900");
  return support::replaced(text, "duration = 1e-3\nstep = 1e-3", "duration = 0.4\nstep = 5e-4");
}

TEST(CaseMesh, WaveThroughAnAbsorbingBaseDoublesAtTheSurfaceAndLeaves) {
  // Joyner & Chen (1975): the surface moves twice as fast as the incoming wave, later by H/c; after 2 H/c nothing is left in the column.
  const double speed = std::sqrt(soil_young / (2 * (1 + poisson)) / soil_density), travel = (depth + height) / speed;
  for (const auto& [kind, surface] : {std::pair{"incoming", 0.4}, std::pair{"outcrop", 0.2}}) {
    BuiltCase built = build(read_text(shear_column(kind), column(Cell::quad8)), RunSpec{});
    const RunResult result = run(built.model, built.plan, built.behaviours);
    ASSERT_EQ(to_string(result.status), "completed") << result.reason;
    const auto column = std::ranges::find(result.columns, "top.vx", &Request::name);
    ASSERT_NE(column, result.columns.end());
    const std::vector<double>& time = result.table[0];
    const std::vector<double>& velocity = result.table[1 + static_cast<std::size_t>(column - result.columns.begin())];
    double late = 0;
    for (std::size_t i = 0; i < time.size(); ++i) {
      const double since = time[i] - travel;
      const double wanted = since > 0 && since < 0.1 ? surface * std::sin(std::numbers::pi * since / 0.1) : 0;
      // the kinks of a half sine hold frequencies beyond those that the mesh carries
      const bool kink = std::min(std::abs(since), std::abs(since - 0.1)) < 4e-3;
      if (!kink) EXPECT_NEAR(velocity[i], wanted, 0.03 * surface) << kind << " at " << time[i] << " s";
      if (since > 0.2) late = std::max(late, std::abs(velocity[i]));
    }
    EXPECT_LT(late, 0.005 * surface);
  }
}

TEST(CaseMesh, AbsorbingFacesNeedTheMaterialOfRock) {
  const Mesh mesh = column(Cell::quad4);
  const std::string good = column_text(1e9, std::string(side_supports) + "[[absorbing]]\ngroup = \"block_top\"\n");
  EXPECT_EQ(refusal(good, mesh), "accepted");
  EXPECT_EQ(
      refusal(support::replaced(good, "density = 700\n", "density = 700\nplane = \"stress\"\n"), mesh),
      "case.toml:45: absorbing[0].group: expected edges of a solid in plane strain, found edges of the solid \"block\" in plane stress");
  EXPECT_EQ(refusal(support::replaced(good, "\"block_top\"", "\"block\""), mesh),
            "case.toml:44: absorbing[0].group: expected a group of edges, found a group of cells");
}

TEST(CaseMesh, MistakesAreNamed) {
  const Mesh mesh = column(Cell::quad4);
  const std::string good = column_text(1e9, side_supports);
  EXPECT_EQ(refusal(good, mesh), "accepted");
  EXPECT_EQ(refusal(support::replaced(good, "[[solid]]\ngroup = \"block\"\nE = 2e9\npoisson = 0.3\ndensity = 700\n", ""), mesh),
            "case.toml:3: solid: expected a [[solid]] for every cell of the mesh, found none for \"block\"");
  EXPECT_EQ(refusal(support::replaced(good, "group = \"block\"", "group = \"blok\""), mesh),
            "case.toml:11: solid[1].group: expected a group of cells, found no group \"blok\" in the mesh (did you mean \"block\"?)");
  EXPECT_EQ(refusal(support::replaced(good, "group = \"block\"", "group = \"soil\""), mesh),
            "case.toml:11: solid[1].group: expected cells without another solid, found " +
                describe_cell(mesh, mesh.groups.at("soil").cells.front()) + ", which belongs to the solid \"soil\" too");
  EXPECT_EQ(refusal(support::replaced(good, "group = \"block\"", "group = \"block_top\""), mesh),
            "case.toml:11: solid[1].group: expected a group of cells, found a group of edges");
  EXPECT_EQ(refusal(support::replaced(good, "E = 2e9\n", ""), mesh),
            "case.toml:10: solid[1]: expected either E or shear_wave_speed, found neither");
  EXPECT_EQ(refusal(support::replaced(good, "density = 700\n", ""), mesh),
            "case.toml:10: solid[1]: expected density, or mass = \"none\", found none");
  EXPECT_EQ(refusal(support::replaced(good, "[mesh]\nfile = \"column.msh\"\n", ""), mesh),
            "case.toml:15: interface[0].surface: expected a [mesh] for the surface, found none");
  EXPECT_EQ(refusal(good + "[[support]]\nfixed = [\"ux\"]\n", mesh),
            "case.toml:43: support[5]: expected either node or group, found neither");
  EXPECT_EQ(refusal(good + "[[support]]\ngroup = \"block_top\"\nfixed = [\"rz\"]\n", mesh),
            "case.toml:45: support[5].fixed: expected ux or uy for a group of the mesh, found \"rz\"");
  EXPECT_EQ(refusal(good + "[[load]]\ngroup = \"block_top\"\nforce = [1, 0]\n", mesh), "accepted");  // it needs no name
  EXPECT_EQ(refusal(good + "[[motion]]\ngroup = \"soil_bottom\"\ndirection = \"uz\"\nfunction = \"f\"\n", mesh),
            "case.toml:45: motion[0].direction: expected ux or uy for a group of the mesh, found \"uz\"");
  EXPECT_EQ(refusal(good + "[[load]]\nname = \"a\"\ngroup = \"block\"\nforce = [1, 0]\n", mesh),
            "case.toml:45: load[0].group: expected a group of edges, found a group of cells");
}

TEST(CaseMesh, MeshesThatWereDrawnOtherwiseAreNamed) {
  const std::string good = column_text(1e9, side_supports);
  Mesh turned = column(Cell::quad4);  // drawn in x and z
  turned.dimension = 3;
  for (Vec3& place : turned.nodes) place = {place.x(), 0, place.y()};
  EXPECT_EQ(
      refusal(good, turned),
      "case.toml:4: mesh.file: expected cells of space (tet, hex, wedge), or a mesh in the plane: x to the right, y up, all z equal, found "
      "no solid cells, nodes with x from -1 to 1, y from 0 to 0, z from -6 to 4");
  Mesh nameless = column(Cell::quad4);
  nameless.groups = {{"1", nameless.groups.at("soil")}, {"2", nameless.groups.at("block")}};
  EXPECT_NE(refusal(good, nameless).find("found no group \"soil\" in the mesh, whose groups are \"1\", \"2\""), std::string::npos)
      << refusal(good, nameless);
  nameless.groups.clear();
  EXPECT_NE(refusal(good, nameless).find("found no group \"soil\" in the mesh, which has no groups"), std::string::npos);
}

TEST(CaseMesh, ExchangedSidesAreWarnedOf) {
  for (const char* lower : {"soil", "block"}) {
    const std::string text =
        support::replaced(column_text(1e9, side_supports), "lower = [\"soil\"]", fmt::format("lower = [\"{}\"]", lower));
    const Case read = check_case(read_toml_text(text, "case.toml"), "case.toml",
                                 [](const std::string&, const Where&, const std::string&) { return column(Cell::quad4); });
    const RunSpec spec = runs_of_case(read).front();
    const std::vector<std::string> said = warnings(read, spec, build(read, spec));
    EXPECT_EQ(std::ranges::count_if(said, [](const std::string& each) { return each.find("pulls the upper side off") != each.npos; }),
              lower == std::string("block") ? 1 : 0);
  }
}

}  // namespace
}  // namespace uplift::mesh_test
