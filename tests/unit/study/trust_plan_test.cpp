#include "uplift/study/trust_plan.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tower_case.h"
#include "uplift/io/text/toml.h"

// What `uplift trust` changes: every changed case passes the checks, differs in what it says it does, and in nothing else.
namespace uplift::trust_plan_test {
namespace {

std::string tower(const std::string& law, const std::string& more = "") {
  return "title = \"tower\"\n" + more + support::Tower{}.text() + support::weight + R"([[interface]]
name = "soil"
law = )" +
         law +
         R"(
[interface.footing]
body = "base"
width = 3
points = 11
[[stage]]
type = "static"
[[stage]]
type = "dynamic"
duration = 1
step = "2 ms"
)";
}

struct Planned {
  Raw raw;
  Case read;
  TrustPlan plan;
};

Planned planned(const std::string& text) {
  Planned made;
  made.raw = read_toml_text(text, "case.toml");
  made.read = check_case(made.raw, "case.toml");
  made.plan = trust_plan(made.read);
  return made;
}

/// The case as changed by the one of this name; a failure of the test when there is none.
Case changed(const Planned& planned, const std::string& name) {
  const auto found = std::ranges::find(planned.plan.changes, name, &TrustChange::name);
  EXPECT_NE(found, planned.plan.changes.end()) << name;
  return check_case(found == planned.plan.changes.end() ? planned.raw : edited(planned.raw, found->edits), "case.toml");
}

std::string reason(const Planned& planned, const std::string& choice) {
  for (const TrustPlan::LeftOut& each : planned.plan.left_out)
    if (each.choice == choice) return each.reason;
  return "";
}

const Values& law_of(const Case& read) {
  return read.values.tables("interface").front().part("law");
}

const std::string springs = R"({ type = "springs", K_n = "200 MPa/m", tangential = "none" })";

TEST(TrustPlan, StepStiffnessToleranceMethod) {
  const Planned tested = planned(tower(springs));
  ASSERT_EQ(tested.plan.changes.size(), 6u);
  const Case half = changed(tested, "step_half");
  EXPECT_DOUBLE_EQ(half.values.tables("stage")[1].number("step"), 1e-3);
  EXPECT_EQ(half.values.table("output").integer("every"), 2) << "columns keep their instants";
  EXPECT_DOUBLE_EQ(law_of(half).number("K_n"), 2e8);
  EXPECT_DOUBLE_EQ(law_of(changed(tested, "stiffer")).number("K_n"), 4e8) << "on fixed ground the joint is the soil";
  EXPECT_DOUBLE_EQ(law_of(changed(tested, "softer")).number("K_n"), 1e8);
  EXPECT_EQ(law_of(changed(tested, "stiffer")).text("tangential"), "none");
  const Case tight = changed(tested, "tighter");
  EXPECT_DOUBLE_EQ(tight.values.part("method").number("tolerance"), 1e-13);
  EXPECT_FALSE(tight.values.table("limits").has("gap_tolerance")) << "it follows the size of the model";
  const Planned stated = planned(tower(springs) + "[limits]\ngap_tolerance = 1e-8\n");
  EXPECT_DOUBLE_EQ(changed(stated, "tighter").values.table("limits").number("gap_tolerance"), 1e-9);
  const Case other = changed(tested, "other_law");
  EXPECT_EQ(law_of(other).type(), "sdm");
  EXPECT_EQ(law_of(other).number("F_u"), 0);
  EXPECT_DOUBLE_EQ(law_of(other).number("K_n"), 2e8);
  EXPECT_EQ(law_of(other).text("tangential"), "none");
  EXPECT_EQ(reason(tested, "mesh"), "the case has no mesh");
  // the case itself is not touched
  EXPECT_DOUBLE_EQ(law_of(check_case(tested.raw, "case.toml")).number("K_n"), 2e8);
}

TEST(TrustPlan, SdmThatWouldSnapBackIsNotMadeSofter) {
  const Planned tested = planned(tower(R"({ type = "sdm", K_n = "2 GPa/m", F_u = "10 kPa", G_f = 0.1, F_c = -1e3, tangential = "none" })"));
  EXPECT_NE(reason(tested, "joint stiffness, softer").find("a stiffness above 1e+09 Pa/m"), std::string::npos)
      << reason(tested, "joint stiffness, softer");
  EXPECT_DOUBLE_EQ(law_of(changed(tested, "stiffer")).number("K_n"), 4e9);
  const Case other = changed(tested, "other_scheme");
  EXPECT_EQ(other.values.tables("stage")[1].part("scheme").type(), "generalised_alpha");
  EXPECT_EQ(other.values.tables("stage")[1].text("traction"), "end");
  EXPECT_EQ(other.values.tables("stage")[0].text("traction"), "path") << "the static stage stays";
}

TEST(TrustPlan, AJointAboveElasticGroundIsAChoiceOfTheComputation) {
  std::string text = tower(springs);
  text.insert(text.find("[[stage]]"), "[interface.footing.bed]\nstiffness = 2e7\n");
  const Planned tested = planned(text);
  EXPECT_DOUBLE_EQ(law_of(changed(tested, "stiffer")).number("K_n"), 2e9);
  EXPECT_DOUBLE_EQ(law_of(changed(tested, "softer")).number("K_n"), 2e7);
  const Planned stated = planned(text + "[trust]\nstiffness_factor = 3\n");
  EXPECT_DOUBLE_EQ(law_of(changed(stated, "stiffer")).number("K_n"), 6e8);
}

TEST(TrustPlan, FootingsGetTwiceAsManyStrips) {
  const auto points = [](const Planned& tested) {
    return changed(tested, "more_points").values.tables("interface").front().table("footing").integer("points");
  };
  EXPECT_EQ(points(planned(tower(springs))), 21) << "10 strips between 11 points become 20";
  std::string text = tower(springs);
  text.insert(text.find("points = 11"), "rule = \"midpoint\"\n");
  EXPECT_EQ(points(planned(text)), 22) << "11 strips become 22";
}

TEST(TrustPlan, ConstraintsChangeTheMethod) {
  const Planned lagrange = planned(tower("\"unilateral\""));
  EXPECT_EQ(reason(lagrange, "joint stiffness"), "constraints are rigid");
  EXPECT_EQ(changed(lagrange, "other_method").values.part("method").type(), "augmented_lagrangian");
  EXPECT_FALSE(changed(lagrange, "tighter").values.part("method").has("gap_tolerance")) << "it follows the size of the interfaces";
  EXPECT_DOUBLE_EQ(changed(lagrange, "tighter").values.part("method").number("tolerance"), 1e-13);

  const Planned penalty = planned(tower("\"unilateral\"", "method = { type = \"penalty\", stiffness = \"2 GPa/m\" }"));
  EXPECT_DOUBLE_EQ(changed(penalty, "stiffer").values.part("method").number("stiffness"), 2e10);
  EXPECT_DOUBLE_EQ(changed(penalty, "softer").values.part("method").number("stiffness"), 2e8);
  EXPECT_EQ(changed(penalty, "other_method").values.part("method").type(), "lagrange");
}

TEST(TrustPlan, MadeMeshesAreRefined) {
  const Planned tested = planned(R"(
title = "block"
[mesh.soil_box.soil]
width = "40 m"
size = "4 m"
[[mesh.soil_box.soil.layers]]
thickness = "8 m"
size = "2 m"
[mesh.soil_box.block]
width = "8 m"
height = "10 m"
size = "2 m"
[[solid]]
group = "soil_1"
E = 1e8
poisson = 0.3
density = 2000
[[solid]]
group = "block"
E = 1e10
poisson = 0.2
density = 2500
[[support]]
group = "soil_bottom"
fixed = ["ux", "uy"]
[[interface]]
name = "base"
law = { type = "springs", K_n = 1e10, K_t = 1e10, tangential = "coulomb", friction = 0.5, c = 1e5 }
surface = { group = "interface", lower = ["soil_1"] }
[[stage]]
type = "dynamic"
duration = 1
step = 1e-2
[trust]
stiffness_factor = 1
mesh_factor = 0.5
)");
  const Case finer = changed(tested, "finer");
  const Values& box = finer.values.table("mesh").table("soil_box");
  EXPECT_DOUBLE_EQ(box.table("soil").number("size"), 2);
  EXPECT_DOUBLE_EQ(box.table("soil").tables("layers").front().number("size"), 1);
  EXPECT_DOUBLE_EQ(box.table("block").number("size"), 1);
  EXPECT_DOUBLE_EQ(box.table("block").number("height"), 10);
  EXPECT_EQ(reason(tested, "joint stiffness"), "stiffness_factor = 1");
  EXPECT_EQ(changed(tested, "other_scheme").values.tables("stage")[0].part("scheme").type(), "generalised_alpha")
      << "springs with dashpots have no other law";
}

TEST(TrustPlan, MeshesMoveBesideTheirCuts) {
  const std::string text = R"(
title = "block"
[mesh.soil_box.soil]
width = "40 m"
size = "4 m"
[[mesh.soil_box.soil.layers]]
thickness = "8 m"
size = "2 m"
[[solid]]
group = "soil_1"
E = 1e8
poisson = 0.3
density = 2000
[[solid]]
group = "raft"
E = 1e10
poisson = 0.2
density = 2500
[[support]]
group = "soil_bottom"
fixed = ["ux", "uy"]
[[interface]]
name = "base"
law = { type = "springs", K_n = 1e10, K_t = 1e10, tangential = "coulomb", friction = 0.5 }
cut = { through = ["soil_1"], level = -2.9, upper = "raft", mesh_shift = 0.2, x = [-8, 8] }
[[stage]]
type = "dynamic"
duration = 1
step = 1e-2
)";
  const auto shift = [](const Case& read) { return read.values.tables("interface")[0].table("cut").number("mesh_shift"); };
  const Planned tested = planned(text);
  EXPECT_DOUBLE_EQ(shift(changed(tested, "mesh_forth")), 0.45) << "0.2 and 0.3, but less than half a cell";
  EXPECT_NEAR(shift(changed(tested, "mesh_back")), -0.1, 1e-15);
  EXPECT_EQ(reason(planned(text + "[trust]\nmesh_shift = 0\n"), "place of the mesh"), "mesh_shift = 0");
  EXPECT_TRUE(reason(tested, "place of the mesh").empty());

  // constraints along faces of triangles: refused wherever the plane leaves them
  std::string along = text;
  along.replace(along.find("[mesh.soil_box.soil]"), 0, "[mesh.soil_box]\ncell = \"tri3\"\n");
  along.replace(along.find("law = {"), along.find("cut =") - along.find("law = {"), "law = { type = \"coulomb\", friction = 0.5 }\n");
  along.replace(along.find("-2.9"), 4, "-4.0");
  along.replace(along.find("mesh_shift = 0.2, "), 18, "");
  for (const char* choice : {"mesh", "place of the mesh"}) {
    EXPECT_NE(reason(planned(along), choice).find("refused"), std::string::npos) << choice;
    std::string quads = along;
    quads.replace(quads.find("tri3"), 4, "quad4");
    EXPECT_TRUE(reason(planned(quads), choice).empty()) << choice;
  }
}

}  // namespace
}  // namespace uplift::trust_plan_test
