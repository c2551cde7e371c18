// Orders of a cut mesh beside those of a mesh with lines along the joint: a rigid block and a raft that lift off.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "manual.h"
#include "simple_meshes.h"
#include "support.h"
#include "unit/case/cut_support.h"

namespace uplift::verification::cut_orders_test {
namespace {

using namespace uplift::support;

// Claim: on tensionless springs the rotation of a rigid block that a plane parts from its base converges with order 2 in the cells to that
// of the Winkler base, 4/(3 - M/M_u)^2 times that at uplift.
TEST(CutOrders, RockingBlock) {
  VERIFIES({"Cut elements", "Rocking block on tensionless springs: order in the cells", "Closed form of the Winkler base"});
  for (const double ratio : {1.5, 2.0, 2.5}) {
    const double exact = 4 / std::pow(3 - ratio, 2);
    std::vector<double> size, off;
    for (const int cells : {12, 24, 48, 96}) {
      size.push_back(3.0 / cells);
      off.push_back(std::abs(block_rotation(ratio, 0.37, cells) / exact - 1));
    }
    verified_case.curve(fmt::format("M/M_u = {}", ratio), size, off);
    VERIFY_NEAR("order of the rotation", "1", order(size, off), 2, 0.25) << ratio;
    VERIFY_NEAR("order of the last halving", "1", std::log2(off[2] / off[3]), 2, 0.1) << ratio;
  }
}

constexpr double width = 2, ground = 10, underside = 3.87, top = 4.47, force = 2e5;

/// Rotation and open share of a raft on soil under N and M = e N at its top, cells of 1/n m: aligned or cut.
struct Tilt {
  double rotation, open;
};
Tilt raft(int n, double eccentricity, bool aligned) {
  const auto x = uniform_lines(-ground / 2, ground / 2, static_cast<int>(ground) * n);
  std::vector<double> y;
  if (aligned) {
    y = lines_with(underside, top, n);
  } else {
    y = {0};
    for (int row = static_cast<int>(std::ceil(top * n - 1e-9)) - 1; row >= 0; --row) y.push_back(top - row / static_cast<double>(n));
  }
  const Grid lines{x, y, {}};
  const auto part = [&](int i, int j, int) {
    if (y[static_cast<std::size_t>(j)] < underside - 1e-9) return 0;
    return std::abs(x[static_cast<std::size_t>(i)] + x[static_cast<std::size_t>(i) + 1]) < width ? 1 : -1;
  };
  const auto face = [](int of, Direction direction, int other) -> std::string {
    if (of == 0 && other == 1) return "interface";
    return of == 1 && direction == Direction::top ? "top" : of == 0 && direction == Direction::bottom ? "bottom" : "";
  };
  const double most = eccentricity * 6 / width;  // linear traction with the moment e N
  const std::string text =
      "title = \"raft\"\n[mesh]\nfile = \"raft.msh\"\n" + solid("volume", 5e7, 0.2, 2000) + solid("raft", 3e10, 0.2, 2000) +
      "[[support]]\ngroup = \"bottom\"\nfixed = [\"ux\", \"uy\"]\n" +
      fmt::format("[[load]]\ngroup = \"top\"\ntraction = [0, {}]\n[load.profile]\nalong = \"x\"\npositions = [-1, 1]\nfactors = [{}, {}]\n",
                  -force / width, 1 - most, 1 + most) +
      "[[interface]]\nname = \"base\"\n" +
      (aligned ? std::string("surface = { group = \"interface\", lower = [\"volume\"] }\n")
               : fmt::format("cut = {{ through = [\"volume\"], level = {}, upper = \"raft\", x = [-1, 1] }}\n", underside)) +
      "law = { type = \"springs\", K_n = 1e9, K_t = 1e9, tangential = \"bonded\" }\n"
      "[[output.history]]\nname = \"left\"\nat = [-1, 4.47]\nquantity = \"uy\"\n"
      "[[output.history]]\nname = \"right\"\nat = [1, 4.47]\nquantity = \"uy\"\n" +
      at_rest_stages;
  const Mesh mesh = aligned ? grid(lines, part, {"volume", "raft"}, face) : rectangle(x, y);
  const RunResult result = run_on(text, mesh);
  return {(at_rest(result, "left") - at_rest(result, "right")) / width, at_rest(result, "base.uplifted_ratio")};
}

// Claim: the share of the points that are open is of order 1 in the cells, since a point changes as a whole: it is never off by more than
// the half of a cell beside which the base opens, and does reach a quarter. The share that results state, of an opening that is linear
// between the points, is of order 2 as the rotation is. Winkler base: 1 - sqrt(theta_u/theta) = (M/M_u - 1)/2.
TEST(CutOrders, OpenShareOfARockingBlock) {
  VERIFIES({"Cut elements", "Rocking block on tensionless springs: open share, order in the cells", "Closed form of the Winkler base"});
  const std::vector<int> all{12, 24, 48, 96};
  std::vector<double> size, worst(all.size(), 0.0), counted(all.size(), 0.0);
  for (const int cells : all) size.push_back(3.0 / cells);
  for (const double ratio : {1.3, 1.6, 1.9, 2.2, 2.45}) {
    for (std::size_t i = 0; i < all.size(); ++i) {
      const BlockAtRest at = block_at_rest(ratio, 0.37, all[i]);
      const double exact = (ratio - 1) / 2;
      worst[i] = std::max(worst[i], std::abs(at.open - exact));
      counted[i] = std::max(counted[i], std::abs(at.open_points - exact));
    }
  }
  verified_case.curve("share of the points", size, counted);
  verified_case.curve("share with linear openings", size, worst);
  for (std::size_t i = 0; i < all.size(); ++i) {
    VERIFY_LT("error of the share of the points over that of a cell", "1", counted[i] * all[i], 0.5 + 0.1) << all[i];
    VERIFY_GT("error of the share of the points over that of a cell", "1", counted[i] * all[i], 0.25) << all[i];
  }
  VERIFY_NEAR("order of the share of the points", "1", order(size, counted), 1, 0.2);
  VERIFY_NEAR("order of the share with linear openings", "1", order(size, worst), 2, 0.25);
}

// Claim: a raft on soil whose edge is a singularity of the pressure. Cut and aligned meshes of 1/4, 1/8, 1/16 m converge with order 1 to
// the same rotation; the open shares of the finest ones agree.
TEST(CutOrders, RaftOnSoil) {
  VERIFIES({"Cut elements", "Raft on soil that lifts off: cut and aligned meshes have one limit", "Own refinement"});
  for (const double eccentricity : {0.3, 0.7}) {
    std::vector<double> limit, share;
    for (const bool aligned : {true, false}) {
      std::vector<Tilt> found;
      for (const int n : {4, 8, 16}) found.push_back(raft(n, eccentricity, aligned));
      const double rate = std::log2((found[1].rotation - found[0].rotation) / (found[2].rotation - found[1].rotation));
      limit.push_back(2 * found[2].rotation - found[1].rotation);
      VERIFY_NEAR(aligned ? "order of the rotation, aligned" : "order of the rotation, cut", "1", rate, 1, 0.12) << eccentricity;
      if (eccentricity > 0.5) {
        VERIFY_GT("open share", "1", found[2].open, 0.4);
        share.push_back(found[2].open);
      }
    }
    VERIFY_NEAR("limit of the cut meshes over that of the aligned ones", "1", limit[1] / limit[0], 1, 1e-3) << eccentricity;
    if (share.size() == 2) VERIFY_NEAR("open share of the finest cut mesh", "1", share[1], share[0], 2e-3);
  }
}

}  // namespace
}  // namespace uplift::verification::cut_orders_test
