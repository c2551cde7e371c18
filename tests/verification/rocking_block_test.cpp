// A rigid block that rocks on its two corners (VERIFICATION section 4): half width b = 0.5, half height h = 2, g = 9.81, R = sqrt(b^2 + h^2),
// alpha = atan(b/h), p = sqrt(3 g/4R). Small rotations with the P-Delta effect ("linearised"): theta'' = p^2 (theta - alpha) about a corner.
#include <gtest/gtest.h>

#include <cmath>

#include "support.h"

namespace uplift::verification {
namespace {

constexpr double b = 0.5, h = 2, g = 9.81, block_mass = 1000;
const double radius = std::sqrt(b * b + h * h), alpha = std::atan(b / h), p = std::sqrt(3 * g / (4 * radius));

struct Block {
  double rotation = 0;          // about the right corner (clockwise, given > 0) or zero
  double angular_velocity = 0;  // counter-clockwise
  std::string law = "\"unilateral\"", impact = "\"project_hold\"", support;
  double step = 1e-3, duration = 1;
  bool p_delta = true;
  /// The block's node is its centre; its corners are the two points of the footing.
  std::string text() const;
};

std::string number(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", value);
  return text;
}

std::string Block::text() const {
  // turned by `rotation` clockwise about the right corner (b, -h from the centre): small displacements (h rotation, b rotation)
  std::string out = "title = \"Rocking block\"\nimpact = " + impact + "\n[nodes]\nblock = [0, " + number(h) + "]\n";
  out += "[[rigid]]\nname = \"block\"\nnode = \"block\"\nmass = " + number(block_mass) + "\ninertia = " + number(block_mass * radius * radius / 3) + "\n";
  out += support;
  out += "[[interface]]\nname = \"base\"\nfooting = { body = \"block\", width = 1, points = 2, offset = [0, " + number(-h) + "] }\nlaw = " + law + "\n";
  out += "[gravity]\nacceleration = [0, " + number(-g) + "]\n";
  out += "[[stage]]\ntype = \"static\"\nsteps = 1\n";
  out += "[[initial]]\nnode = \"block\"\ndisplacement = [" + number(h * rotation) + ", " + number(b * rotation) + "]\nrotation = " + number(-rotation) +
         "\nvelocity = [" + number(-h * angular_velocity) + ", " + number(b * std::abs(angular_velocity)) +
         "]\nangular_velocity = " + number(angular_velocity) + "\n";
  out += "[[stage]]\ntype = \"dynamic\"\nduration = " + number(duration) + "\nstep = " + number(step) + "\np_delta = " + (p_delta ? "true" : "false") + "\n";
  out += "[limits]\nrotation = 0.5\n[output]\nframes = 0\nautomatic = false\nhistory = [{ name = \"turn\", node = \"block\", quantity = \"rz\" },\n"
         "  { name = \"turn.v\", node = \"block\", quantity = \"vrz\" }, { interface = \"base\", quantity = \"axial\" },\n"
         "  { interface = \"base\", quantity = \"max_opening\" }]\n";
  return out;
}

TEST(RockingBlock, Look) {
  for (const double dt : {2e-3, 1e-3, 5e-4}) {
    Block block;
    block.law = "{ type = \"coulomb\", friction = 100 }";
    block.rotation = alpha / 2;
    block.duration = 2;
    block.step = dt;
    const History run = run_text(block.text());
    printf("%s %s rows %zu\n", run.status.c_str(), run.reason.c_str(), run.rows());
    const auto& turn = run["turn"];
    double upright = 0;
    for (std::size_t i = 1; i < run.rows(); ++i)
      if (turn[i - 1] < 0 && turn[i] >= 0) { upright = run.time()[i - 1] - turn[i - 1] / (turn[i] - turn[i - 1]) * dt;
        printf("i %zu v before %g after %g %g %g turn %g\n", i, run["turn.v"][i - 1], run["turn.v"][i], run["turn.v"][i+1], run["turn.v"][i+2], turn[i]);
        break; }
    printf("upright %.8f exact %.8f start turn %g axial %g\n", upright, std::acosh(1 / (1 - 0.5)) / p, turn[0], run["base.axial"][0]);
  }
}

}  // namespace
}  // namespace uplift::verification
