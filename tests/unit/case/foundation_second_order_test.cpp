// P-Delta of a structure on a [[foundation]] against closed forms: the weight times its height comes off the rocking stiffness.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "ran_support.h"
#include "text_support.h"

namespace uplift::foundation_second_order_test {
namespace {

using support::Ran;

constexpr double weight = 9.81e5, height = 6, width = 4, rocking = 1e8, mass = 1e5, inertia = 1e5;
constexpr double first_moment = weight * width / 4, first_rotation = first_moment / rocking;  // where uplift begins, alpha = 4

constexpr const char* second_order = "[[stage]]\ntype = \"static\"\nsteps = 2\np_delta = true\n";

std::string dynamic(const std::string& step, const std::string& scheme) {
  return "[[stage]]\ntype = \"dynamic\"\nduration = 1.5\nstep = " + step + "\np_delta = true\nscheme = \"" + scheme + "\"\n";
}

/// A rigid mast, its mass at the top, on ground that is stiff but for rocking; pushed there.
std::string mast(const std::string& model, double push, const std::string& stages, const std::string& more = {}) {
  return "title = \"mast\"\nbonded = false\n[nodes]\nbase = [0, 0]\ntop = [0, 6]\n[[rigid]]\nname = \"mast\"\nnode = \"base\"\nslaves = "
         "[\"top\"]\n[[mass]]\nnode = \"top\"\nmass = 1e5\ninertia = 1e5\n[[foundation]]\nname = \"soil\"\nbody = \"base\"\nwidth = 4\n"
         "model = { type = \"" +
         model + ", K_r = 1e8 }\n[gravity]\nacceleration = [0, -9.81]\n" +
         (push > 0 ? fmt::format("[[load]]\nnode = \"top\"\nforce = [{:.17g}, 0]\n", push) : "") + more + stages +
         "[output]\nframes = 0\nenergies = true\n[[output.history]]\nnode = \"base\"\nquantity = \"rz\"\nname = \"rz\"\n"
         "[[output.history]]\ninterface = \"soil\"\nquantity = \"moment\"\nname = \"moment\"\n";
}
const std::string stiff = "K_v = 1e10, K_h = 1e12", elastic = "elastic\", " + stiff, strip = "macro_element\", shape_number = 4, ",
                  element = strip + stiff, soft = strip + "K_v = 6e8, K_h = 3e8";

TEST(FoundationSecondOrder, TheLeanIsThatOfTheReducedStiffness) {
  const double push = 5e4, turned = push * height / (rocking - weight * height);
  for (const std::string& model : {elastic, element}) {
    const Ran ran = support::run_text(mast(model, push, second_order));
    ASSERT_EQ(ran.result.status, RunStatus::completed) << ran.result.reason;
    EXPECT_NEAR(std::abs(ran["rz"].back()), turned, 1e-8 * turned);
    EXPECT_NEAR(std::abs(ran["moment"].back()), rocking * turned, 1e-8 * rocking * turned);
    EXPECT_NEAR(std::abs(ran["rz"][2]), push * height / rocking, 1e-8 * turned) << "of first order before";
    EXPECT_LE(std::abs(ran.result.final_energy.residual), 1e-9 * std::abs(ran.result.final_energy.external));
  }
}

// alpha = 4: M = M_0 (2 - theta_0/theta) at constant N (eq M2), and equilibrium M = H h + W h theta is a quadratic equation.
TEST(FoundationSecondOrder, TheLeanWithUpliftSolvesTheQuadraticEquation) {
  for (const double push : {1.9e5, 2.3e5}) {
    const double a = weight * height, b = 2 * first_moment - push * height, c = first_moment * first_rotation;
    const double turned = 2 * c / (b + std::sqrt(b * b - 4 * a * c));
    EXPECT_GT(turned, 1.3 * first_rotation);
    const Ran ran = support::run_text(mast(element, push, second_order));
    ASSERT_EQ(ran.result.status, RunStatus::completed) << ran.result.reason;
    EXPECT_NEAR(std::abs(ran["rz"].back()), turned, 1e-6 * turned);
    EXPECT_NEAR(std::abs(ran["moment"].back()), push * height + weight * height * turned, 1e-6 * push * height);
    EXPECT_LE(std::abs(ran.result.final_energy.residual), 1e-8 * std::abs(ran.result.final_energy.external));
  }
}

// The largest of M_0 (2 - theta_0/theta) - W h theta is (W D/2) (1 - sqrt(W h/K_r)); without P-Delta it is W D/2.
TEST(FoundationSecondOrder, ItOverturnsUnderAReducedMoment) {
  const double largest = 0.5 * weight * width * (1 - std::sqrt(weight * height / rocking)) / height;
  EXPECT_EQ(support::run_text(mast(element, 0.99 * largest, second_order)).result.status, RunStatus::completed);
  EXPECT_EQ(support::run_text(mast(element, 1.01 * largest, second_order)).result.status, RunStatus::failed);
  EXPECT_EQ(support::run_text(mast(element, 1.01 * largest, "[[stage]]\ntype = \"static\"\nsteps = 2\n")).result.status,
            RunStatus::completed);
}

// Free rocking in full contact: omega^2 = (K_r - W h)/(m h^2 + I), theta = v/(h omega) sin(omega t).
TEST(FoundationSecondOrder, RocksWithTheReducedStiffness) {
  const double omega = std::sqrt((rocking - weight * height) / (mass * height * height + inertia)), velocity = 0.1;
  const std::string moving = "[[initial]]\nnode = \"top\"\nvelocity = [0.1, 0]\n[[initial]]\nnode = \"base\"\nvelocity = [0, 0]\n";
  for (const char* scheme : {"average_acceleration", "energy_decay"}) {
    const Ran ran = support::run_text(mast(element, 0, second_order + dynamic("2e-3", scheme), moving));
    ASSERT_EQ(ran.result.status, RunStatus::completed) << ran.result.reason;
    EXPECT_EQ(ran.result.max_uplifted_ratio.value, 0);
    const double size = velocity / (height * omega), start = ran.result.table[0][ran.rows() - 751];
    for (std::size_t i = ran.rows() - 751; i < ran.rows(); ++i)
      ASSERT_NEAR(-ran["rz"][i], size * std::sin(omega * (ran.result.table[0][i] - start)), 2e-3 * size) << scheme << ' ' << i;
    EXPECT_LT(std::abs(ran.result.final_energy.residual), 1e-10 * ran.result.energy_scale);
  }
}

// With uplift and yielding the ledger of a dynamic stage of second order closes at any step, with both schemes.
TEST(FoundationSecondOrder, TheLedgerClosesWithUpliftAndYielding) {
  const std::string pushed = "[[initial]]\nnode = \"top\"\nvelocity = [0.9, 0]\n[[initial]]\nnode = \"base\"\nvelocity = [0, 0]\n";
  for (const std::string& model : {soft, soft + ", V_s = 3e6, friction_angle = \"35 deg\""})
    for (const char* scheme : {"average_acceleration", "energy_decay"})
      for (const char* step : {"1e-3", "10e-3"}) {
        const Ran ran = support::run_text(mast(model, 0, second_order + dynamic(step, scheme), pushed));
        SCOPED_TRACE(model + scheme + step);
        ASSERT_EQ(ran.result.status, RunStatus::completed) << ran.result.reason;
        EXPECT_GT(ran.result.max_uplifted_ratio.value, 0.1);
        EXPECT_LT(std::abs(ran.result.final_energy.residual), 1e-10 * ran.result.energy_scale);
        if (model != soft) EXPECT_GT(ran.result.final_energy.interface_dissipated, 0.01 * ran.result.energy_scale);
      }
}

}  // namespace
}  // namespace uplift::foundation_second_order_test
