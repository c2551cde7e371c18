// Cases in space: what they refuse, and closed forms of a tower on a raft.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "simple_meshes.h"
#include "text_support.h"
#include "uplift/case/case.h"
#include "uplift/dynamics/statics.h"
#include "uplift/dynamics/step.h"
#include "uplift/io/text/toml.h"

namespace uplift::space_test {
namespace {

constexpr const char* tower = R"(title = "tower"
[nodes]
base = [0, 0, 0]
top = [0, 0, 8]
[[beam]]
name = "shaft"
nodes = ["base", "top"]
E = 3e10
I_y = 0.3
I_z = 0.5
J = 0.4
A = 2
elements = 2
[[mass]]
node = "top"
mass = 5e4
inertias = [4e4, 6e4, 3e4]
[[rigid]]
name = "raft"
node = "base"
mass = 2e4
inertias = [5e4, 8e4, 1.2e5]
[[interface]]
name = "soil"
footing = { body = "base", width = 6, length = 4, points = 7, points_across = 5, azimuth = 0.3 }
law = { type = "springs", K_n = 5e7, K_t = 2e7, tangential = "coulomb", friction = 0.7 }
[gravity]
acceleration = [0, 0, -9.81]
)";
constexpr const char* at_rest = R"([[stage]]
type = "static"
)";

BuiltCase built_of(const std::string& text) {
  static std::vector<std::unique_ptr<Case>> kept;  // a model points into its case
  kept.push_back(std::make_unique<Case>(check_case(read_toml_text(text, "case.toml"), "case.toml")));
  return build(*kept.back(), RunSpec{});
}

/// Full displacements under the dead loads.
Vector rest_of(const BuiltCase& built) {
  const Bulk bulk(built.model, nullptr);
  const Sparse b = stack_interfaces(built.model);
  const Behaviours behaviours(built.model, *built.plan.method, nullptr);
  LinearCounts counts;
  State state;
  state.displacement = state.velocity = state.acceleration = Vector::Zero(built.model.free());
  state.opening = state.force = state.mean_force = Vector::Zero(b.rows());
  state.history.setZero(behaviours.history);
  const Vector gap = Vector::Zero(b.rows());
  const StaticOutcome rest =
      solve_statics({built.model, bulk, b, gap}, {behaviours, *built.plan.method}, *built.plan.solver, {.steps = 5}, state, counts);
  EXPECT_TRUE(rest.converged) << rest.why;
  return built.model.full(state.displacement, 0, 0);
}

std::string refusal(const std::string& text) {
  return support::refusal_of([&] { built_of(text); });
}

TEST(CaseSpace, FootingOnSpringsTiltsAsItsSecondMomentsSay) {
  // Loads small enough that nothing lifts: moments M about the axes of the footing tilt it by M/(k I), torsion by M/(k_t (I_1 + I_2)).
  const double k = 5e7, kt = 2e7, a = 6, b = 4, azimuth = 0.3;
  const auto sum = [](double width, int points) {  // trapezoidal rule of s^2 over the width
    double total = 0;
    for (int i = 0; i < points; ++i) {
      const double s = -width / 2 + width * i / (points - 1);
      total += (i == 0 || i == points - 1 ? 0.5 : 1) * width / (points - 1) * s * s;
    }
    return total;
  };
  const double i_1 = a * sum(b, 5), i_2 = b * sum(a, 7);  // about the axis along the width, and across it
  const double m_x = 2e5, m_y = -3e5, m_z = 1e5;
  const std::string load = "[[load]]\nnode = \"base\"\nmoments = [2e5, -3e5, 1e5]\n";
  const BuiltCase built = built_of(std::string(tower) + load + at_rest);
  const Vector u = rest_of(built);
  const double c = std::cos(azimuth), s = std::sin(azimuth);
  const double m_1 = c * m_x + s * m_y, m_2 = -s * m_x + c * m_y;
  const double theta_1 = m_1 / (k * i_1), theta_2 = m_2 / (k * i_2);
  const int base = built.model.find_node("base");
  // the shaft's weight-free mass at the top adds nothing without P-Delta
  EXPECT_NEAR(u[built.model.at(base, rx)], c * theta_1 - s * theta_2, 1e-9 * std::abs(theta_2));
  EXPECT_NEAR(u[built.model.at(base, ry)], s * theta_1 + c * theta_2, 1e-9 * std::abs(theta_2));
  EXPECT_NEAR(u[built.model.at(base, rz)], m_z / (kt * (i_1 + i_2)), 1e-9 * std::abs(theta_2));
  EXPECT_NEAR(u[built.model.at(base, uz)], -9.81 * 7e4 / (k * a * b), 1e-9 * 9.81 * 7e4 / (k * a * b));
}

TEST(CaseSpace, TowerBendsAboutBothAxesAndTwists) {
  const std::string load = "[[load]]\nnode = \"top\"\nforce = [1e4, 2e4, 0]\nmoments = [0, 0, 5e4]\n";
  const BuiltCase built = built_of(std::string(tower) + load + at_rest);
  const Vector u = rest_of(built);
  const int base = built.model.find_node("base"), top = built.model.find_node("top");
  const auto at = [&](int node, Dof dof) { return u[built.model.at(node, dof)]; };
  // A vertical beam has its local z along x: I_z resists bending about x, that is motion along y (local y is z cross x, the y axis).
  const double h = 8, e = 3e10, g = e / 2.6;
  EXPECT_NEAR(at(top, ux) - at(base, ux) - h * at(base, ry), 1e4 * h * h * h / (3 * e * 0.3), 1e-12);
  EXPECT_NEAR(at(top, uy) - at(base, uy) + h * at(base, rx), 2e4 * h * h * h / (3 * e * 0.5), 1e-12);
  EXPECT_NEAR(at(top, rz) - at(base, rz), 5e4 * h / (g * 0.4), 1e-12);
}

TEST(CaseSpace, RigidBodyOverAGroupOfTheMesh) {
  // A pile of bricks without Poisson's ratio under a rigid cap with a mass on a mast: compressed by W h/(E A); the cap's nodes move with
  // it.
  const Mesh mesh = box(uniform_lines(-1, 1, 2), uniform_lines(-0.5, 0.5, 2), uniform_lines(0, 3, 3));
  const std::string text = R"(title = "pile"
[nodes]
cap = [0, 0, 3]
[mesh]
file = "pile.msh"
[[solid]]
group = "volume"
E = 1e7
poisson = 0
mass = "none"
[[rigid]]
name = "cap"
node = "cap"
group = "top"
mass = 5000
inertia = 1e3
[[support]]
group = "bottom"
fixed = ["ux", "uy", "uz"]
[gravity]
acceleration = [0, 0, -10]
[[load]]
node = "cap"
moments = [1e3, 2e3, 3e3]
[[stage]]
type = "static"
)";
  const Case read = check_case(read_toml_text(text, "case.toml"), "case.toml",
                               [&](const std::string&, const Where&, const std::string&) { return mesh; });
  const BuiltCase built = build(read, RunSpec{});
  const Vector u = rest_of(built);
  const int cap = built.model.find_node("cap");
  EXPECT_NEAR(u[built.model.at(cap, uz)], -5e4 * 3 / (1e7 * 2), 1e-12);
  Vec3 turn;
  for (int k = 0; k < 3; ++k) turn[k] = u[6 * cap + 3 + k];
  EXPECT_GT(turn.cwiseAbs().minCoeff(), 1e-6);
  for (const int node : nodes_of(mesh, mesh.groups.at("top"))) {
    const int at = cap + 1 + node;  // nodes of the case stand first
    const Vec3 moved = u.segment<3>(6 * at) - u.segment<3>(6 * cap);
    EXPECT_LE((moved - cross(turn, built.model.nodes[static_cast<std::size_t>(at)].position - Vec3(0, 0, 3))).norm(), 1e-14);
  }
}

TEST(CaseSpace, MistakesAreNamed) {
  const std::string good = std::string(tower) + at_rest;
  EXPECT_EQ(refusal(good), "accepted");
  EXPECT_EQ(refusal(support::replaced(good, "[0, 0, 8]", "[0, 8]")),
            "case.toml:4: nodes.top.value: expected three numbers [x, y, z] in a model in space, found 2");
  EXPECT_EQ(refusal(support::replaced(good, "[0, 0, -9.81]", "[0, -9.81]")),
            "case.toml:28: gravity.acceleration: expected three numbers [x, y, z] in a model in space, found 2");
  EXPECT_EQ(refusal(support::replaced(good, "J = 0.4\n", "")),
            "case.toml:5: beam[0]: expected J, the torsion constant, in a model in space, found none");
  EXPECT_EQ(refusal(support::replaced(good, "I_z = 0.5\n", "")), "case.toml:5: beam[0]: expected either I, or I_y and I_z, found neither");
  EXPECT_EQ(refusal(support::replaced(good, "J = 0.4\n", "J = 0.4\nup = [0, 0, 2]\n")),
            "case.toml:12: beam[0].up: expected a direction that is not along the beam, found one along it");
  EXPECT_EQ(refusal(support::replaced(good, "length = 4, ", "")),
            "case.toml:25: interface[0].footing.length: expected length and points_across in space, found none");
  EXPECT_EQ(refusal(good + "[[support]]\nnode = \"top\"\nfixed = [\"rw\"]\n"),
            "case.toml:33: support[0].fixed: expected ux, uy, uz, rx, ry or rz, found \"rw\" (did you mean \"rx\"?)");
}

/// case.resolved.toml holds every default; it must be a case itself, of the same model.
TEST(SpaceCase, AResolvedCaseIsTheSameCase) {
  const Case first = check_case(read_toml_text(std::string(tower) + "[[stage]]\ntype = \"static\"\n", "case.toml"), "case.toml");
  const Case second = check_case(read_toml_text(to_toml(first.values), "resolved.toml"), "resolved.toml");
  const BuiltCase one = build(first, {}), two = build(second, {});
  EXPECT_EQ(Matrix(one.model.mass), Matrix(two.model.mass));
  EXPECT_EQ(Matrix(one.model.stiffness), Matrix(two.model.stiffness));
}

}  // namespace
}  // namespace uplift::space_test
