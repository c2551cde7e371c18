// Beams along groups of lines of a mesh: against the same beams between nodes, against closed forms, on rigid bodies and solids.
#include <gtest/gtest.h>

#include <cmath>

#include "simple_meshes.h"
#include "text_support.h"
#include "uplift/case/mesh/beam_cells.h"
#include "uplift/io/text/toml.h"
#include "uplift/model/hinges.h"

namespace uplift::beam_group_test {
namespace {

/// Adds a group of lines of one type between nodes.
void add_lines(Mesh& mesh, const std::string& name, Cell cell, const std::vector<std::vector<int>>& lines) {
  CellBlock& block = mesh.block(cell);
  Group group{1, {}, {}};
  for (const std::vector<int>& nodes : lines) {
    group.cells.push_back({mesh.find_block(cell), block.count()});
    block.nodes.insert(block.nodes.end(), nodes.begin(), nodes.end());
  }
  mesh.groups[name] = group;
}

Mesh mesh_of(int dimension, const std::vector<Vec3>& nodes) {
  Mesh mesh;
  mesh.dimension = dimension;
  mesh.nodes = nodes;
  return mesh;
}

void name_node(Mesh& mesh, const std::string& name, int node) {
  mesh.groups[name] = Group{0, {}, {node}};
}

Case read_text(const std::string& text, const Mesh& mesh) {
  return check_case(read_toml_text(text, "case.toml"), "case.toml",
                    [&](const std::string&, const Where&, const std::string&) { return mesh; });
}

std::string refusal(const std::string& text, const Mesh& mesh) {
  return support::refusal_of([&] { build(read_text(text, mesh), RunSpec{}); });
}

/// The last row of a column.
double last_of(const std::string& text, const Mesh& mesh, const std::string& column) {
  const Case read = read_text(text, mesh);
  const BuiltCase built = build(read, RunSpec{});
  const RunResult result = run(built.model, built.plan, built.behaviours);
  EXPECT_EQ(to_string(result.status), "completed") << result.reason;
  for (std::size_t k = 0; k < result.columns.size(); ++k)
    if (result.columns[k].name == column) return result.table[k + 1].back();
  ADD_FAILURE() << "no column " << column;
  return 0;
}

std::string history(const std::string& node, const std::string& quantity) {
  return "[[output.history]]\nnode = \"" + node + "\"\nquantity = \"" + quantity + "\"\n";
}

constexpr const char* mesh_table = "[mesh]\nfile = \"frame.msh\"\n";
constexpr const char* static_stage = "[[stage]]\ntype = \"static\"\n";
constexpr double young = 3e10, inertia = 0.02, area = 0.3, shear_area = 0.25, poisson = 0.2, density = 2500;

std::string beam(const std::string& where, const std::string& section) {
  return "[[beam]]\nname = \"mast\"\n" + where + "\nE = 3e10\npoisson = 0.2\n" + section + "\n";
}

// ---- a mast with a heavy top, in the plane ----

constexpr double height = 6;
constexpr const char* mast_section =
    "I = 0.02\nA = 0.3\ntheory = \"timoshenko\"\nshear_area = 0.25\nmass = \"consistent\"\ndensity = 2500\n"
    "damping_beta = 1e-3\n";
constexpr const char* mast_rest =
    "[[support]]\nnode = \"foot\"\nfixed = [\"ux\", \"uy\", \"rz\"]\n[[mass]]\nnode = \"tip\"\nmass = 2e4\ninertia = 1e3\n"
    "[[load]]\nnode = \"tip\"\nforce = [3e4, 0]\n[gravity]\nacceleration = [0, -9.81]\n";

std::string between_nodes(int elements, const std::string& section) {
  return "title = \"t\"\n[nodes]\nfoot = [0, 0]\ntip = [0, 6]\n" +
         beam("nodes = [\"foot\", \"tip\"]\nelements = " + std::to_string(elements), section);
}

/// The mast of so many lines, one of which is drawn downwards, or half as many with a node in their middle.
Mesh mast(int lines, Cell cell) {
  Mesh mesh = mesh_of(2, {});
  for (int i = 0; i <= lines; ++i) mesh.nodes.push_back({0, height * i / lines, 0});
  std::vector<std::vector<int>> cells;
  if (cell == Cell::line2)
    for (int i = 0; i < lines; ++i) cells.push_back({i, i + 1});
  else
    for (int i = 0; i < lines; i += 2) cells.push_back({i, i + 2, i + 1});
  std::swap(cells[0][0], cells[0][1]);
  add_lines(mesh, "mast lines", cell, cells);
  name_node(mesh, "foot", 0);
  name_node(mesh, "tip", lines);
  return mesh;
}

std::string along_lines(int elements, const std::string& section) {
  return std::string("title = \"t\"\n") + mesh_table + beam("group = \"mast lines\"\nelements = " + std::to_string(elements), section);
}

TEST(CaseBeamGroup, MastOfLinesIsTheMastBetweenNodes) {
  const std::string dynamics =
      "[[function]]\nname = \"f\"\nshape = { type = \"harmonic\", frequency = 2 }\n"
      "[[load]]\nnode = \"tip\"\nforce = [1e5, 2e4]\nfunction = \"f\"\n" +
      std::string(static_stage) + "p_delta = true\n[[stage]]\ntype = \"dynamic\"\nduration = 0.3\nstep = 0.01\np_delta = true\n" +
      history("tip", "ux") + history("tip", "vy") + history("tip", "rz");
  for (const bool extensible : {true, false}) {
    std::string section = mast_section;
    if (!extensible) section = "I = 0.02\n";
    const std::string rest = mast_rest + dynamics;
    for (const char* column : {"tip.ux", "tip.vy", "tip.rz"}) {
      const double wanted = last_of(between_nodes(4, section) + rest, {}, column);
      if (extensible || std::string(column) != "tip.vy") EXPECT_NE(wanted, 0);
      const double tolerance = 1e-12 * std::abs(wanted);
      EXPECT_NEAR(last_of(along_lines(1, section) + rest, mast(4, Cell::line2), column), wanted, tolerance) << column;
      EXPECT_NEAR(last_of(along_lines(1, section) + rest, mast(4, Cell::line3), column), wanted, tolerance) << column;
      EXPECT_NEAR(last_of(along_lines(2, section) + rest, mast(2, Cell::line2), column), wanted, tolerance) << column;
      EXPECT_NEAR(last_of(along_lines(2, section) + rest, mast(2, Cell::line3), column), wanted, tolerance) << column;
    }
  }
}

TEST(CaseBeamGroup, MastBendsAndShearsByTheClosedForm) {
  const double force = 3e4,
               sway = force * std::pow(height, 3) / (3 * young * inertia) + force * height / (young / (2 * (1 + poisson)) * shear_area);
  const double weight = 9.81 * (2e4 * height + density * area * height * height / 2) / (young * area);
  const std::string text = along_lines(1, mast_section) + mast_rest + static_stage + history("tip", "ux") + history("tip", "uy");
  for (const Cell cell : {Cell::line2, Cell::line3}) {
    EXPECT_NEAR(last_of(text, mast(4, cell), "tip.ux"), sway, 1e-10 * sway);
    EXPECT_NEAR(last_of(text, mast(4, cell), "tip.uy"), -weight, 1e-10 * weight);
  }
}

TEST(CaseBeamGroup, GroupsCanBeClampedWhereBeamsAre) {
  Mesh mesh = mast(4, Cell::line2);
  mesh.groups["feet"] = Group{0, {}, {0}};
  mesh.groups.erase("foot");
  const std::string text = support::replaced(along_lines(1, mast_section) + mast_rest, "node = \"foot\"", "group = \"feet\"");
  EXPECT_EQ(refusal(text + static_stage, mesh), "accepted");
}

// ---- in space ----

TEST(CaseBeamGroup, BracketBendsAndTwistsInItsOwnAxesEverywhere) {
  // A column, a girder along x and one along y at its end; loads at the end, by the unit-load method:
  // P along z: girders P L^3/(3 E I_y), the first one twisted by P b^2 a/(G J); the column bent by P a and P b over its height, stretched.
  constexpr double h = 4, a = 3, b = 2, iy = 0.02, iz = 0.05, torsion = 0.03, force = 1e4;
  constexpr double shear = young / (2 * (1 + poisson));
  Mesh mesh = mesh_of(3, {{0, 0, 0}, {0, 0, h}, {a, 0, h}, {a, b, h}, {a / 2, 0, h}});
  add_lines(mesh, "bracket", Cell::line2, {{1, 0}, {1, 4}, {4, 2}, {3, 2}});
  name_node(mesh, "foot", 0);
  name_node(mesh, "end", 3);
  const std::string text = std::string("title = \"t\"\n") + mesh_table +
                           beam("group = \"bracket\"", "I_y = 0.02\nI_z = 0.05\nJ = 0.03\nA = 0.3") +
                           "[[support]]\nnode = \"foot\"\nfixed = [\"ux\", \"uy\", \"uz\", \"rx\", \"ry\", \"rz\"]\n"
                           "[[load]]\nnode = \"end\"\nforce = [0, 0, 1e4]\n" +
                           static_stage + history("end", "uz");
  // local z of the column is along x: P a turns it about y, its local y: I_y; P b turns it about x: I_z
  const double wanted = force * ((a * a * a + b * b * b) / (3 * young * iy) + b * b * a / (shear * torsion) + a * a * h / (young * iy) +
                                 b * b * h / (young * iz) + h / (young * area));
  EXPECT_NEAR(last_of(text, mesh, "end.uz"), wanted, 1e-10 * wanted);
}

TEST(CaseBeamGroup, PortalInSpaceIsThatBetweenNodes) {
  const std::vector<Vec3> places{{0, 0, 0}, {0, 0, 4}, {5, 0.5, 4.5}, {5, 4, 4}, {5, 4, 0}};
  Mesh mesh = mesh_of(3, places);
  add_lines(mesh, "frame", Cell::line2, {{0, 1}, {1, 2}, {2, 3}, {3, 4}});
  std::string nodes = "[nodes]\n", beams;
  const std::string section = "I_y = 0.02\nI_z = 0.05\nJ = 0.03\nA = 0.3\nup = [1, 1, 0.2]\nmass = \"lumped\"\ndensity = 2500";
  for (int i = 0; i < 5; ++i) {
    const Vec3& x = places[static_cast<std::size_t>(i)];
    const std::string name = "n" + std::to_string(i);
    name_node(mesh, name, i);
    nodes += name + " = [" + std::to_string(x.x()) + ", " + std::to_string(x.y()) + ", " + std::to_string(x.z()) + "]\n";
    if (i > 0)
      beams += support::replaced(beam("nodes = [\"n" + std::to_string(i - 1) + "\", \"" + name + "\"]", section), "mast",
                                 "mast " + std::to_string(i));
  }
  std::string rest =
      "[gravity]\nacceleration = [0.5, 0.2, -9.81]\n" + std::string(static_stage) + history("n2", "ux") + history("n2", "ry");
  for (const char* foot : {"n0", "n4"})
    rest += std::string("[[support]]\nnode = \"") + foot + "\"\nfixed = [\"ux\", \"uy\", \"uz\", \"rx\", \"ry\", \"rz\"]\n";
  for (const char* column : {"n2.ux", "n2.ry"}) {
    const double wanted = last_of("title = \"t\"\n" + nodes + beams + rest, {}, column);
    EXPECT_NEAR(last_of(std::string("title = \"t\"\n") + mesh_table + beam("group = \"frame\"", section) + rest, mesh, column), wanted,
                1e-12 * std::abs(wanted));
  }
}

// ---- on solids ----

constexpr double foot_at = 2;  // m: the column's foot on the middle of the raft's top

/// Soil of 4 x 2 m with a raft of 4 x 1 m on it, in squares of 1 m, and a column of 3 m from `from` on: 0 at the raft's top, -1 at its
/// underside.
Mesh column_on_raft(int from) {
  const auto part_at = [](int, int j, int) { return j < 2 ? 0 : 1; };
  const auto face = [](int part, Direction direction, int other) -> std::string {
    return other < 0 && part == 0 && direction == Direction::bottom ? "bottom" : "";
  };
  Mesh mesh = grid({uniform_lines(0, 4, 4), uniform_lines(-3, 0, 3), {}}, part_at, {"soil", "raft"}, face);
  const auto node_at = [&](double y) {
    for (int i = 0; i < static_cast<int>(mesh.nodes.size()); ++i)
      if ((mesh.nodes[static_cast<std::size_t>(i)] - Vec3(foot_at, y, 0)).norm() < 1e-9) return i;
    mesh.nodes.push_back({foot_at, y, 0});
    return static_cast<int>(mesh.nodes.size()) - 1;
  };
  std::vector<std::vector<int>> lines;
  for (int y = from; y < 3; ++y) lines.push_back({node_at(y), node_at(y + 1)});
  add_lines(mesh, "column", Cell::line2, lines);
  name_node(mesh, "tip", node_at(3));
  return mesh;
}

std::string raft_text(const std::string& extra) {
  return std::string("title = \"t\"\n") + mesh_table +
         "[[solid]]\ngroup = \"soil\"\nE = 5e7\npoisson = 0.3\ndensity = 1900\n"
         "[[solid]]\ngroup = \"raft\"\nE = 3e10\npoisson = 0.2\ndensity = 2500\n" +
         beam("group = \"column\"", "I = 0.02\nA = 0.3") +
         "[[support]]\ngroup = \"bottom\"\nfixed = [\"ux\", \"uy\"]\n[[load]]\nnode = \"tip\"\nforce = [3e4, 0]\n" + extra + static_stage;
}

TEST(CaseBeamGroup, ColumnOnARigidRaftIsClampedToIt) {
  const std::string text = raft_text("[[rigid]]\nname = \"raft\"\ngroup = \"raft\"\n") + history("tip", "ux") +
                           "[[output.history]]\nname = \"foot\"\nat = [2, 0]\nquantity = \"ux\"\n[[output.history]]\nname = \"turn\"\nat = "
                           "[2, 0]\nquantity = \"rz\"\n"
                           "[[output.history]]\nname = \"left\"\nat = [0, 0]\nquantity = \"uy\"\n[[output.history]]\nname = \"right\"\nat "
                           "= [4, 0]\nquantity = \"uy\"\n";
  const Mesh mesh = column_on_raft(0);
  const double turn = last_of(text, mesh, "turn");
  EXPECT_NEAR(turn, (last_of(text, mesh, "right") - last_of(text, mesh, "left")) / 4, 1e-12 * std::abs(turn));
  EXPECT_LT(turn, 0);
  const double bent = 3e4 * 27 / (3 * young * inertia);
  EXPECT_NEAR(last_of(text, mesh, "tip.ux") - last_of(text, mesh, "foot") + 3 * turn, bent, 1e-9 * bent);
  const Case read = read_text(text, mesh);
  EXPECT_TRUE(hinges(build(read, RunSpec{}).model).empty());
}

TEST(CaseBeamGroup, ColumnThatEndsOnSolidsIsHinged) {
  const Mesh mesh = column_on_raft(0);
  const int foot = mesh.cell(mesh.groups.at("column").cells.front())[0];
  EXPECT_EQ(refusal(raft_text(""), mesh),
            "case.toml: expected a structure that its supports hold, found a mechanism: \"mesh." + std::to_string(foot + 1) +
                "\", \"mesh.21\", \"mesh.22\", \"tip\" can turn about the point (2, 0) m without resistance; beams end in hinges of "
                "solids: \"mesh." +
                std::to_string(foot + 1) + "\" at (2, 0) m");
}

TEST(CaseBeamGroup, ColumnThatRunsOnIntoSolidsIsHeldByThem) {
  // The moment at the raft's top is a pair of forces over the depth of the raft, which is a thousand times stiffer than the soil.
  const std::string text = raft_text("") + history("tip", "ux");
  const Case read = read_text(text, column_on_raft(-1));
  EXPECT_TRUE(hinges(build(read, RunSpec{}).model).empty());
  const double rigid =
      last_of(raft_text("[[rigid]]\nname = \"raft\"\ngroup = \"raft\"\n") + history("tip", "ux"), column_on_raft(0), "tip.ux");
  const double embedded = last_of(text, column_on_raft(-1), "tip.ux");
  EXPECT_GT(embedded, rigid);
  EXPECT_LT(embedded, 1.5 * rigid);
}

TEST(CaseBeamGroup, HingesOfAStrutAreNamed) {
  // A strut between two corners of the raft's and the soil's sides turns freely at both ends; along an edge of the solids it does not.
  Mesh mesh = column_on_raft(-1);
  add_lines(mesh, "strut", Cell::line2, {{0, 9}});
  const std::string strut = support::replaced(beam("group = \"strut\"", "I = 0.02\nA = 0.3"), "mast", "strut");
  const Case read = read_text(raft_text(strut), mesh);
  EXPECT_EQ(hinges(build(read, RunSpec{}).model), (std::vector<int>{0, 9}));
}

/// A block of 2 x 2 x 2 m in bricks of 1 m, z from 0 down, and lines of 1 m on its axis from `from` to `to` m.
Mesh block_with_axis(int from, int to) {
  Mesh mesh = box(uniform_lines(-1, 1, 2), uniform_lines(-1, 1, 2), uniform_lines(-2, 0, 2));
  const auto node_at = [&](double z) {
    for (int i = 0; i < static_cast<int>(mesh.nodes.size()); ++i)
      if ((mesh.nodes[static_cast<std::size_t>(i)] - Vec3(0, 0, z)).norm() < 1e-9) return i;
    mesh.nodes.push_back({0, 0, z});
    return static_cast<int>(mesh.nodes.size()) - 1;
  };
  std::vector<std::vector<int>> lines;
  for (int z = from; z < to; ++z) lines.push_back({node_at(z), node_at(z + 1)});
  add_lines(mesh, "axis", Cell::line2, lines);
  name_node(mesh, "first", lines.front()[0]);
  name_node(mesh, "last", lines.back()[1]);
  return mesh;
}

std::string block_text(const std::string& extra) {
  return std::string("title = \"t\"\n") + mesh_table + "[[solid]]\ngroup = \"volume\"\nE = 5e8\npoisson = 0.3\ndensity = 1900\n" +
         beam("group = \"axis\"", "I_y = 0.02\nI_z = 0.05\nJ = 0.03\nA = 0.3") +
         "[[support]]\ngroup = \"bottom\"\nfixed = [\"ux\", \"uy\", \"uz\"]\n[[load]]\nnode = \"last\"\nforce = [3e4, 0, 0]\n" +
         "moments = [0, 0, 2e4]\n" + extra + static_stage;
}

TEST(CaseBeamGroup, PlateHoldsAColumnInSpaceAgainstBendingAndTorsion) {
  const std::string text = block_text("[[rigid]]\nname = \"plate\"\ngroup = \"top\"\n");
  const Mesh mesh = block_with_axis(0, 3);
  const auto difference = [&](const char* of) {
    const std::string both = text + history("first", of) + history("last", of);
    return last_of(both, mesh, std::string("last.") + of) - last_of(both, mesh, std::string("first.") + of);
  };
  const double twist = 2e4 * 3 / (young / (2 * (1 + poisson)) * 0.03), bent = 3e4 * 27 / (3 * young * inertia);  // about y: I_y
  EXPECT_NEAR(difference("rz"), twist, 1e-9 * twist);
  EXPECT_NEAR(difference("ux"), bent + 3 * last_of(text + history("first", "ry"), mesh, "first.ry"), 1e-9 * bent);
}

TEST(CaseBeamGroup, PileTurnsAboutItselfUntilItsTipIsHeld) {
  const Mesh mesh = block_with_axis(-2, 0);
  const std::string said = refusal(block_text(""), mesh);
  EXPECT_NE(said.find("can turn about the axis (0, 0, 1)"), std::string::npos) << said;
  EXPECT_EQ(refusal(block_text("[[support]]\ngroup = \"first\"\nfixed = [\"rz\"]\n"), mesh), "accepted");
}

// ---- mistakes ----

TEST(CaseBeamGroup, MistakesAreNamed) {
  Mesh mesh = column_on_raft(-1);
  add_lines(mesh, "twice", Cell::line2, {{0, 5}, {5, 0}});
  mesh.groups["some"] = mesh.groups.at("column");
  mesh.groups.at("some").cells.erase(mesh.groups.at("some").cells.begin());
  const std::string good = raft_text("");
  EXPECT_EQ(refusal(good, mesh), "accepted");
  const auto with = [&](const std::string& group) { return support::replaced(good, "group = \"column\"", group); };
  EXPECT_EQ(refusal(with("group = \"colum\""), mesh),
            "case.toml:16: beam[0].group: expected a group of lines, found no group \"colum\" in the mesh (did you mean \"column\"?)");
  EXPECT_EQ(refusal(with("group = \"raft\""), mesh), "case.toml:16: beam[0].group: expected a group of lines, found a group of cells");
  EXPECT_EQ(refusal(with("group = \"tip\""), mesh), "case.toml:16: beam[0].group: expected a group of lines, found a group of nodes");
  EXPECT_EQ(refusal(with(""), mesh), "case.toml:14: beam[0]: expected either nodes or group, found neither");
  EXPECT_EQ(refusal(with("group = \"column\"\nnodes = [\"tip\", \"mesh.1\"]"), mesh),
            "case.toml:16: beam[0].group: expected either nodes or group, found both");
  const auto cell = [&](const char* group, std::size_t i) { return describe_cell(mesh, mesh.groups.at(group).cells[i]); };
  EXPECT_EQ(refusal(with("group = \"twice\""), mesh), "case.toml:16: beam[0].group: expected lines without another beam, found " +
                                                          cell("twice", 1) + ", between whose nodes the group has another line");
  EXPECT_EQ(refusal(good + support::replaced(beam("group = \"some\"", "I = 0.02"), "mast", "other"), mesh),
            "case.toml:31: beam[1].group: expected lines without another beam, found " + cell("some", 0) +
                ", which is the beam \"mast\" already");
  EXPECT_EQ(refusal(good + "[[absorbing]]\ngroup = \"column\"\n", mesh),
            "case.toml:16: beam[0].group: expected lines that are beams alone, found " + cell("column", 0) +
                ", which is absorbing too (\"column\")");
  EXPECT_EQ(refusal("title = \"t\"\n" + beam("group = \"column\"", "I = 0.02") + static_stage, {}),
            "case.toml:4: beam[0].group: expected a [mesh] with this group, found none");
}

TEST(CaseBeamGroup, LinesWhereTheMeshOpensAreNoBeams) {
  Mesh mesh = column_on_raft(0);
  add_lines(mesh, "base", Cell::line2, {{10, 11}, {11, 12}, {12, 13}, {13, 14}});
  const std::string text = support::replaced(raft_text(""), "group = \"column\"", "group = \"base\"") +
                           "[[interface]]\nname = \"joint\"\nsurface = { group = \"base\", lower = [\"soil\"] }\nlaw = \"unilateral\"\n";
  EXPECT_EQ(refusal(text, mesh), "case.toml:16: beam[0].group: expected lines that are beams alone, found " +
                                     describe_cell(mesh, mesh.groups.at("base").cells[0]) + ", where the interface \"joint\" opens");
}

TEST(CaseBeamGroup, DirectionAlongALineIsNamed) {
  Mesh mesh = mesh_of(3, {{0, 0, 0}, {0, 0, 4}, {3, 0, 4}});
  add_lines(mesh, "frame", Cell::line2, {{0, 1}, {1, 2}});
  const std::string text =
      std::string("title = \"t\"\n") + mesh_table + beam("group = \"frame\"", "I = 0.02\nJ = 0.03\nA = 0.3\nup = [2, 0, 0]") + static_stage;
  EXPECT_EQ(refusal(text, mesh), "case.toml:12: beam[0].up: expected a direction that is along none of its lines, found one along " +
                                     describe_cell(mesh, mesh.groups.at("frame").cells[1]));
  mesh.nodes.push_back(mesh.nodes[1]);
  mesh.groups.clear();
  mesh.blocks.clear();
  add_lines(mesh, "frame", Cell::line3, {{0, 1, 3}});
  EXPECT_EQ(refusal(text, mesh), "case.toml:6: beam[0].group: expected lines between different places, found " +
                                     describe_cell(mesh, mesh.groups.at("frame").cells[0]) + ", a part of which has no length");
}

TEST(CaseBeamGroup, GroupsOfOneNodeNameItUnlessAnotherNodeHasTheName) {
  const Mesh mesh = mast(4, Cell::line2);
  const std::string rest = mast_rest + std::string(static_stage);
  const BuiltCase built = build(read_text(along_lines(1, mast_section) + rest, mesh), RunSpec{});
  EXPECT_EQ(built.model.find_node("tip"), 4);
  EXPECT_EQ(built.model.find_node("mesh.5"), 4);
  EXPECT_EQ(refusal(support::replaced(along_lines(1, mast_section) + rest, "node = \"tip\"", "node = \"mesh.5\""), mesh), "accepted");
  EXPECT_EQ(refusal(support::replaced(along_lines(1, mast_section) + rest, "node = \"tip\"", "node = \"tipp\""), mesh),
            "case.toml:22: mass[0].node: expected the name of a node, found \"tipp\" (did you mean \"tip\"?)");
  const std::string own = "[nodes]\ntip = [0, 6]\n" + std::string("[[rigid]]\nname = \"top\"\nnode = \"tip\"\nslaves = [\"mesh.5\"]\n");
  const BuiltCase other = build(read_text(along_lines(1, mast_section) + rest + own, mesh), RunSpec{});
  EXPECT_EQ(other.model.find_node("tip"), 0);
}

TEST(CaseBeamGroup, RigidBodiesWithoutANodeTurnAboutTheMiddleOfTheirGroup) {
  const BuiltCase built =
      build(read_text(raft_text("[[rigid]]\nname = \"raft\"\ngroup = \"raft\"\nmass = 1e3\n"), column_on_raft(0)), RunSpec{});
  for (const auto& element : built.model.elements)
    if (element->nodes().size() == 1) EXPECT_NEAR(built.model.nodes[static_cast<std::size_t>(element->nodes()[0])].position.x(), 2, 1e-12);
  EXPECT_EQ(refusal(raft_text("[[rigid]]\nname = \"raft\"\n"), column_on_raft(0)),
            "case.toml:27: rigid[0]: expected node, or a group of the mesh, found neither");
}

TEST(CaseBeamGroup, RigidBodiesOfManySolidsAreNoMechanisms) {
  Mesh mesh = rectangle(uniform_lines(0, 10, 10), {0, 1, 2, 4});  // its middle is at no node
  name_node(mesh, "left", 0);
  name_node(mesh, "right", 10);
  const std::string text = std::string("title = \"t\"\n") + mesh_table +
                           "[[solid]]\ngroup = \"volume\"\nE = 3e10\npoisson = 0.2\ndensity = 2500\n"
                           "[[rigid]]\nname = \"body\"\ngroup = \"volume\"\n"
                           "[[spring]]\nnodes = [\"left\"]\ndirection = [1, 0]\nstiffness = 1e8\n"
                           "[[spring]]\nnodes = [\"left\"]\ndirection = [0, 1]\nstiffness = 1e8\n" +
                           static_stage;
  const std::string right = "[[spring]]\nnodes = [\"right\"]\ndirection = [0, 1]\nstiffness = 1e8\n";
  EXPECT_EQ(refusal(text + right, mesh), "accepted");
  EXPECT_NE(refusal(text, mesh).find("can turn about the point (0, 0) m without resistance"), std::string::npos) << refusal(text, mesh);
}

TEST(CaseBeamGroup, TopOfAFrameOnAFootingIsItsRoof) {
  Mesh mesh = mast(4, Cell::line2);
  mesh.groups.erase("tip");
  const std::string text =
      along_lines(1, mast_section) +
      "[nodes]\nslab = [0, -0.5]\n[[rigid]]\nname = \"slab\"\nnode = \"slab\"\ngroup = \"foot\"\nmass = 1e4\ninertia = 1e4\n"
      "[[interface]]\nname = \"base\"\nfooting = { body = \"slab\", width = 3, points = 5 }\n"
      "law = { type = \"springs\", K_n = 1e8, K_t = 1e8, tangential = \"bonded\" }\n" +
      static_stage;
  const BuiltCase built = build(read_text(text, mesh), RunSpec{});
  EXPECT_EQ(built.model.nodes[static_cast<std::size_t>(built.top)].position, Vec3(0, height, 0));
  EXPECT_EQ(built.model.nodes[static_cast<std::size_t>(built.base)].name, "slab");
}

// ---- what is drawn ----

TEST(CaseBeamGroup, LinesAreStrungTogetherWhereTheyDoNotBranch) {
  using Lines = std::vector<std::vector<int>>;
  EXPECT_EQ(strung({{0, 1}, {2, 1}, {2, 3}}), (Lines{{0, 1, 2, 3}}));
  EXPECT_EQ(strung({{1, 0}, {1, 2}, {3, 1}}), (Lines{{0, 1}, {1, 2}, {1, 3}}));
  EXPECT_EQ(strung({{0, 7, 1}, {2, 8, 1}}), (Lines{{0, 7, 1, 8, 2}}));
  const Lines closed = strung({{0, 1}, {1, 2}, {2, 0}});
  ASSERT_EQ(closed.size(), 1u);
  EXPECT_EQ(closed.front(), (std::vector<int>{0, 1, 2, 0}));
}

TEST(CaseBeamGroup, DrawnLinesHoldTheirInnerNodes) {
  const BuiltCase built = build(read_text(along_lines(3, mast_section) + mast_rest + static_stage, mast(2, Cell::line2)), RunSpec{});
  ASSERT_EQ(built.beams.size(), 1u);
  const std::vector<int>& line = built.beams.front().nodes;
  ASSERT_EQ(line.size(), 7u);
  for (std::size_t i = 0; i < line.size(); ++i)
    EXPECT_NEAR(built.model.nodes[static_cast<std::size_t>(line[i])].position.y(), static_cast<double>(i), 1e-12);
  EXPECT_EQ(built.model.nodes[static_cast<std::size_t>(line[1])].name, "mast.1.2");  // its line is drawn downwards
  EXPECT_EQ(built.model.nodes[static_cast<std::size_t>(line[5])].name, "mast.2.2");
}

}  // namespace
}  // namespace uplift::beam_group_test
