// Section forces in space and above a joint that opens; equilibrium with other schemes.
#include <algorithm>

#include "unit/run/section_forces_support.h"
#include "uplift/elements/space_beam.h"

namespace uplift::section_forces_joint_test {
namespace {

using namespace support;

// ---- in space: a leaning Timoshenko beam with distributed mass, shaken in all directions ----

TEST(SectionForces, LeaningBeamInSpaceHandsToItsSupportWhatItsSectionsCarry) {
  std::string text = R"(title = "leaning"
[nodes]
foot = [0, 0, 0]
head = [3, 2, 6]
[[beam]]
name = "mast"
nodes = ["foot", "head"]
E = 2e10
I_y = 0.03
I_z = 0.05
J = 0.04
A = 0.8
theory = "timoshenko"
shear_area = 0.5
density = 2500
mass = "MASS"
[[mass]]
node = "head"
mass = 4000
inertias = [800, 500, 900]
[[support]]
node = "foot"
fixed = ["ux", "uy", "uz", "rx", "ry", "rz"]
[gravity]
acceleration = [0, 0, -9.81]
[output]
automatic = false
energies = false
[[stage]]
type = "static"
)" + std::string(shaking);
  for (const auto& [direction, amplitude] : {std::pair("[1, 0, 0]", 3), std::pair("[0, -1, 0]", 2), std::pair("[0, 0, 1]", 1)})
    text += fmt::format("[[ground_acceleration]]\nname = \"quake {0}\"\ndirection = {0}\namplitude = {1}\nfunction = \"shake\"\n",
                        direction, amplitude);
  for (const double x : {0.0, 7.0})
    for (const char* word : {"axial", "shear_y", "shear_z", "torsion", "moment_y", "moment_z", "moment"})
      text += history(fmt::format("beam = \"mast\"\nposition = {}\nquantity = \"{}\"", x, word));
  text += node_histories({"foot"}, {"reaction_x", "reaction_y", "reaction_z", "reaction_mx", "reaction_my", "reaction_mz"});
  text += node_histories({"head"}, {"vx", "vy", "vz", "vrx", "vry", "vrz"});
  text += history("level = 0\nquantity = \"storey_shear_x\"") + history("level = 0\nquantity = \"storey_shear_y\"");
  for (const char* mass : {"consistent", "lumped", "none"}) {
    const Ran ran = run_balanced(support::replaced(text, "MASS", mass));
    const Vec3 head(3, 2, 6), along = head / 7;
    const Mat3 axes = beam_axes(head, std::nullopt).value();
    const auto of = [&](const char* x, std::size_t i) {
      const std::string start = std::string("mast.") + x + ".";
      const Vec3 force(ran[start + "axial"][i], ran[start + "shear_y"][i], ran[start + "shear_z"][i]);
      const Vec3 moment(ran[start + "torsion"][i], ran[start + "moment_y"][i], ran[start + "moment_z"][i]);
      return std::pair(Vec3(axes.transpose() * force), Vec3(axes.transpose() * moment));
    };
    double force_peak = 0, moment_peak = 0, foot_error = 0, head_error = 0, foot_moment_error = 0, head_moment_error = 0;
    for (std::size_t i = 1; i < ran.rows(); ++i) {
      const auto [foot_force, foot_moment] = of("0", i);
      const Vec3 reaction(ran["foot.reaction_x"][i], ran["foot.reaction_y"][i], ran["foot.reaction_z"][i]);
      const Vec3 turning(ran["foot.reaction_mx"][i], ran["foot.reaction_my"][i], ran["foot.reaction_mz"][i]);
      foot_error = std::max(foot_error, (reaction + foot_force).norm());
      foot_moment_error = std::max(foot_moment_error, (turning + foot_moment).norm());
      EXPECT_NEAR(ran["mast.0.moment"][i], std::hypot(ran["mast.0.moment_y"][i], ran["mast.0.moment_z"][i]), 1e-6);
      EXPECT_NEAR(ran["storey_shear_x.0"][i], foot_force.x(), 1e-9 * (1 + foot_force.norm()));
      // the mass at the head: what the section before it feels
      const double time = shake(dt * static_cast<double>(i)) + shake(dt * static_cast<double>(i - 1));
      const Vec3 acceleration =
          Vec3(rate(ran["head.vx"], i), rate(ran["head.vy"], i), rate(ran["head.vz"], i)) + Vec3(3, -2, 1) * time / 2 + Vec3(0, 0, 9.81);
      const Vec3 turn(800 * rate(ran["head.vrx"], i), 500 * rate(ran["head.vry"], i), 900 * rate(ran["head.vrz"], i));
      const auto [head_force, head_moment] = of("7", i);
      head_error = std::max(head_error, (head_force + 4000 * acceleration).norm());
      head_moment_error = std::max(head_moment_error, (head_moment + turn).norm());
      force_peak = std::max(force_peak, foot_force.norm());
      moment_peak = std::max(moment_peak, foot_moment.norm());
    }
    EXPECT_LT(foot_error, 1e-9 * force_peak) << mass;
    EXPECT_LT(head_error, 1e-9 * force_peak) << mass;
    EXPECT_LT(foot_moment_error, 1e-9 * moment_peak) << mass;
    EXPECT_LT(head_moment_error, 1e-9 * moment_peak) << mass;
    EXPECT_GT(std::abs(along.x()), 0);
  }
}

// ---- on a joint that opens ----

constexpr const char* rocking = R"(title = "rocking"
[nodes]
base = [0, 0]
deck = [0, 10]
[[beam]]
name = "pier"
nodes = ["base", "deck"]
E = 3e10
I = 0.7
A = 3.8
density = 2500
mass = "consistent"
elements = 3
[[mass]]
node = "deck"
mass = 3e5
[[rigid]]
name = "footing"
node = "base"
mass = 1e5
inertia = 4e5
[[interface]]
name = "soil"
footing = { body = "base", width = 6, thickness = 6, points = 21 }
LAW
[gravity]
acceleration = [0, -9.81]
[[stage]]
type = "static"
[output]
automatic = false
energies = false
[[ground_acceleration]]
name = "quake"
direction = [1, 0]
amplitude = 5
function = "shake"
)";

TEST(SectionForces, FootOfAPierPlusTheInertiaOfItsFootingIsWhatTheJointCarries) {
  std::string text =
      support::replaced(rocking, "LAW", "law = { type = \"springs\", K_n = 1e8, K_t = 1e8, tangential = \"bonded\" }") + shaking;
  for (const char* word : {"axial", "shear", "moment"})
    text += history(fmt::format("beam = \"pier\"\nposition = 0\nquantity = \"{}\"", word));
  text += node_histories({"base"}, {"vx", "vy", "vrz"});
  for (int point = 1; point <= 21; ++point)
    for (const char* word : {"mean_traction", "mean_shear_traction"})
      text += history(fmt::format("interface = \"soil\"\npoint = {}\nquantity = \"{}\"", point, word));
  text += history("interface = \"soil\"\nquantity = \"uplifted_ratio\"");
  text += "[[output.beam_envelope]]\nbeam = \"pier\"\n";
  const Ran ran = run_balanced(text);
  const Interface& joint = ran.built.model.interfaces.front();
  const auto sum = [&](const char* word, std::size_t i, bool lever) {
    double total = 0;
    for (std::size_t k = 0; k < 21; ++k)
      total += ran[fmt::format("soil.{}.{}", k + 1, word)][i] * joint.area[static_cast<Index>(k)] * (lever ? joint.position[k].x() : 1);
    return total;
  };
  double open = 0;
  for (const double share : ran["soil.uplifted_ratio"]) open = std::max(open, share);
  EXPECT_GT(open, 0.2);  // it rocks
  // the footing: the pier's section acts on it, the joint pulls it with the opposite of its traction
  expect_column(
      ran, ran["pier.0.axial"], [&](std::size_t i) { return sum("mean_traction", i, false) + 1e5 * (rate(ran["base.vy"], i) + 9.81); },
      "axial force");
  expect_column(
      ran, ran["pier.0.shear"],
      [&](std::size_t i) {
        const double ground = 5 * (shake(dt * static_cast<double>(i)) + shake(dt * static_cast<double>(i - 1))) / 2;
        const double along = local_axis(joint.space, joint.normal.front(), 0).x();
        return -(along * sum("mean_shear_traction", i, false) + 1e5 * (rate(ran["base.vx"], i) + ground));
      },
      "shear");
  expect_column(
      ran, ran["pier.0.moment"], [&](std::size_t i) { return sum("mean_traction", i, true) + 4e5 * rate(ran["base.vrz"], i); }, "moment");
  // the envelope knows the extremes of every step
  const BeamEnvelope& envelope = ran.result.envelopes.at(0);
  ASSERT_EQ(envelope.components.size(), 3U);
  EXPECT_DOUBLE_EQ(envelope.at(0, 2).most, *std::ranges::max_element(ran["pier.0.moment"]));
  EXPECT_DOUBLE_EQ(envelope.at(0, 2).least, *std::ranges::min_element(ran["pier.0.moment"]));
  EXPECT_DOUBLE_EQ(envelope.at(0, 1).most, *std::ranges::max_element(ran["pier.0.shear"]));
  EXPECT_EQ(envelope.sections.front().along, 0);
  EXPECT_DOUBLE_EQ(envelope.sections.back().along, 10);
}

TEST(SectionForces, EquilibriumHoldsForOtherSchemesAndForConstraints) {
  for (const char* law : {"law = { type = \"springs\", K_n = 1e8, tangential = \"none\" }", "law = { type = \"unilateral\" }"})
    for (const char* scheme :
         {"scheme = { type = \"hht\", alpha = -0.1 }", "scheme = { type = \"generalised_alpha\", rho = 0.6 }", "traction = \"end\""}) {
      std::string text = support::replaced(rocking, "LAW", law);
      text += support::replaced(shaking, "step = 2e-3", std::string("step = 2e-3\n") + scheme);
      text += "[[support]]\nnode = \"base\"\nfixed = [\"ux\"]\n";
      if (std::string(law).find("unilateral") != std::string::npos) text += "[method]\ntype = \"lagrange\"\n";
      text += node_histories({"base"}, {"reaction_x"}) + history("beam = \"pier\"\nposition = 0\nquantity = \"shear\"");
      run_balanced(text);
    }
}

}  // namespace
}  // namespace uplift::section_forces_joint_test
