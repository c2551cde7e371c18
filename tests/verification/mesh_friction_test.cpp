// Friction between a rigid body and elastic ground that is meshed. Reference: Johnson, Contact Mechanics, 1985,
// sections 2.8 and 7.2.
#include <gtest/gtest.h>

#include "manual.h"
#include "punch_support.h"

namespace uplift::verification::mesh_friction_test {
namespace {

constexpr double radius = 0.1, young = 210e9, load = 3.5e7, friction = 0.3;  // m, Pa, N/m, 1

struct Partial {
  double contact = 0, stick = 0;  // m: half widths
};

/// Cylinder pressed down, then pushed aside by the shares of the friction bound in `shares` (ascending, in steps of 0.05), `cells` elements
/// over the contact half width a. Half widths from second moments: int x^2 p = P a^2/4, int x^2 (mu p - q) = (mu P - Q) c^2/4.
std::vector<Partial> mindlin(double a, int cells, double poisson, const std::vector<double>& shares) {
  const double h = a / cells, far = 30 * a, fine = h * std::ceil(1.2 * cells);
  const Mesh mesh = rectangle(refined_lines(-far, -fine, fine, far, h, far / 3, 1.3),
                              downwards(refined_lines(0, 0, fine / 2, far, h, far / 3, 1.3)), Cell::quad4);
  const std::vector<int> touching = nodes_where(mesh, [&](const Vec3& x) { return x.y() > -1e-12 && std::abs(x.x()) < fine + 1e-9; });
  Punch punch;
  punch.young = young;
  punch.poisson = poisson;
  punch.supports = fixed("bottom", "\"ux\", \"uy\"") + fixed("left", "\"ux\"") + fixed("right", "\"ux\"");
  punch.master = "\"rz\"";
  punch.height = radius;
  punch.law = fmt::format("{{ type = \"coulomb\", friction = {} }}", friction);
  // steps so large that inertia plays no part, and a scheme that keeps no velocity of the highest frequencies
  const double step = 1e-3, push = friction * load;
  const long steps = std::lround(shares.back() / 0.05);
  punch.extra = fmt::format(
      "[[load]]\nnode = \"master\"\nforce = [0, {:.17g}]\n[[function]]\nname = \"rise\"\nshape = {{ type = \"ramp\", duration = {:.17g} "
      "}}\n[[load]]\nnode = \"master\"\nforce = [{:.17g}, 0]\nfunction = \"rise\"\n",
      -load, 20 * step, push);
  const std::string text =
      "impact = \"none\"\n" + with(punch_text(punch, mesh, touching, h), "duration = 1e-7\nstep = 1e-7\n",
                                   fmt::format("duration = {:.17g}\nstep = {:.17g}\nscheme = {{ type = \"generalised_alpha\", rho = 0 }}\n",
                                               static_cast<double>(steps) * step, step));
  const MeshRun run = run_mesh(text, mesh, [&](BuiltCase& built) {
    watch_tractions(built);
    Interface& foot = built.model.interfaces.front();
    for (int i = 0; i < foot.batch.points; ++i) {
      const double x = foot.position[static_cast<std::size_t>(i)].x();
      foot.gap[foot.batch.points + i] = x * x / (2 * radius);
    }
  });
  EXPECT_TRUE(run.completed()) << run.result.reason;
  std::vector<Partial> found;
  for (const double share : shares) {
    const std::size_t row = static_cast<std::size_t>(std::lround(share / 0.05));
    double pressed = 0, pushed = 0, moment = 0, rest = 0;
    for (std::size_t i = 0; i < touching.size(); ++i) {
      const double x = mesh.nodes[static_cast<std::size_t>(touching[i])].x(), p = -h * run[fmt::format("p{}", i)][row],
                   q = h * std::abs(run[fmt::format("q{}", i)][row]);
      pressed += p, pushed += q;
      moment += x * x * p, rest += x * x * (friction * p - q);
    }
    EXPECT_NEAR(pressed, load, 1e-4 * load);
    EXPECT_NEAR(pushed, share * push, 2e-3 * push);
    found.push_back({std::sqrt(4 * moment / pressed), std::sqrt(4 * rest / (friction * pressed - pushed))});
  }
  return found;
}

// Claim: Cattaneo and Mindlin: a cylinder that is pressed down and then pushed aside with Q < mu P slips in from the edges of the contact
// and sticks on the half width c = a sqrt(1 - Q/(mu P)): 1 % with ten elements over a, less with twenty. The formula wants tangential
// forces that do not press: incompressible ground, nu = 0.4999 here.
TEST(MeshFriction, PartialSlipOfCattaneoAndMindlin) {
  VERIFIES({"Friction", "Partial slip of a pressed cylinder",
            "Cattaneo and Mindlin: c/a = √(1 − Q/μP); Johnson, Contact Mechanics (1985), section 7.2"});
  const double poisson = 0.4999, modulus = young / (1 - poisson * poisson), a = std::sqrt(4 * load * radius / (pi * modulus));
  const std::vector<double> shares{0.25, 0.5, 0.75};
  double before = 1;
  for (const int cells : {10, 20}) {
    const std::vector<Partial> found = mindlin(a, cells, poisson, shares);
    double worst = 0;
    for (std::size_t k = 0; k < shares.size(); ++k) {
      const double ratio = found[k].stick / found[k].contact, exact = std::sqrt(1 - shares[k]);
      RecordProperty(fmt::format("cells_{}_share_{}", cells, shares[k]), fmt::format("{:.2e}", ratio / exact - 1));
      VERIFY_NEAR("half width of the contact", "m", found[k].contact, a, 0.01 * a) << cells << " " << shares[k];
      VERIFY_NEAR("half width of the stick zone over that of the contact", "1", ratio, exact, 0.01 * exact) << cells << " " << shares[k];
      worst = std::max(worst, std::abs(ratio / exact - 1));
    }
    VERIFY_LT("largest error of the ratio (below that of the coarser mesh)", "1", worst, before);
    before = worst;
  }
}

/// Places of the nodes under a flat strip of half width 1 pressed down with P = 1e5 N/m, and the forces on them [N/m]. `cells` elements
/// over the half width shrink towards the edges, where the pressure is singular; the smallest is 1/cells^2.
std::vector<std::pair<double, double>> under_strip(int cells) {
  const double least = 1.0 / (cells * cells), far = 30;
  std::vector<double> across = refined_lines(1, 1, 1 + least, far, least, 6, 1.3);
  for (int k = 1; k <= cells; ++k) across.insert(across.begin(), 1 - std::pow(static_cast<double>(k) / cells, 2));
  for (std::size_t k = 1, n = across.size(); k < n; ++k) across.insert(across.begin(), -across[2 * k - 1]);
  const Mesh mesh = rectangle(across, downwards(refined_lines(0, 0, 2 * least, far, least, 6, 1.3)), Cell::quad4);
  const std::vector<int> touching = nodes_where(mesh, [](const Vec3& x) { return x.y() > -1e-9 && std::abs(x.x()) < 1 + 1e-9; });
  Punch punch;
  punch.supports = fixed("bottom", "\"ux\", \"uy\"") + fixed("left", "\"ux\"") + fixed("right", "\"ux\"");
  punch.master = "\"ux\", \"rz\"";
  punch.extra = "[[load]]\nnode = \"master\"\nforce = [0, -1e5]\n";
  const double area = 1.0 / cells;
  const MeshRun run = run_mesh(punch_text(punch, mesh, touching, area), mesh, watch_tractions);
  EXPECT_TRUE(run.completed()) << run.result.reason;
  std::vector<std::pair<double, double>> found;
  for (std::size_t i = 0; i < touching.size(); ++i)
    found.emplace_back(mesh.nodes[static_cast<std::size_t>(touching[i])].x(), -area * run[fmt::format("p{}", i)][0]);
  std::ranges::sort(found);
  return found;
}

// Claim: pressure under a rigid smooth strip, p = P/(pi sqrt(a^2 - x^2)): the nodes within 0.9 a carry what it gives on their halves of the
// elements to 2 % with ten elements over a, and less than half as far off as with five.
TEST(MeshFriction, PressureUnderAStrip) {
  VERIFIES({"Rigid bodies on elastic ground", "Pressure under a rigid strip",
            "Johnson, Contact Mechanics (1985), section 2.8: P/(π √(a² − x²))"});
  std::vector<double> worst;
  for (const int cells : {5, 10}) {
    const auto nodes = under_strip(cells);
    ASSERT_EQ(static_cast<int>(nodes.size()), 2 * cells + 1);
    worst.push_back(0);
    for (std::size_t i = 1; i + 1 < nodes.size(); ++i) {
      if (std::abs(nodes[i].first) > 0.9) continue;
      const double left = (nodes[i - 1].first + nodes[i].first) / 2, right = (nodes[i].first + nodes[i + 1].first) / 2;
      const double exact = 1e5 / pi * (std::asin(right) - std::asin(left));
      worst.back() = std::max(worst.back(), std::abs(nodes[i].second / exact - 1));
    }
    RecordProperty(fmt::format("cells_{}", cells), fmt::format("{:.2e}", worst.back()));
  }
  VERIFY_LT("largest relative error of a nodal force, ten elements", "1", worst.back(), 0.02);
  VERIFY_LT("the same, compared with half of that of five elements", "1", worst.back(), 0.5 * worst.front());
}

// Claim: a rigid body that slides along a slanted direction under Coulomb friction by constraints stops after v/(mu g) and v^2/(2 mu g),
// and the ledger holds m v^2/2 as dissipated by the interface: 1 % at 1 ms, a tenth of it at 0.1 ms (the step in which it stops: order 1).
TEST(MeshFriction, ASlidingBodyLeavesItsEnergyInTheLedger) {
  VERIFIES({"Friction", "Sliding body under Coulomb friction", "v²/(2μg) and ½mv²"});
  const double mass = 9e4, speed = 0.6, g = 9.81;
  std::vector<double> error;
  for (const double step : {1e-3, 1e-4}) {
    const MeshRun run = run_mesh(
        fmt::format(
            "title = \"slide\"\n[nodes]\nbase = [0, 0, 0]\n[[rigid]]\nname = \"raft\"\nnode = \"base\"\nmass = {}\ninertia = 3e5\n"
            "[[interface]]\nname = \"base\"\nfooting = {{ body = \"base\", width = 6, length = 4, points = 4, points_across = 3 }}\n"
            "law = {{ type = \"coulomb\", friction = {} }}\n[gravity]\nacceleration = [0, 0, -9.81]\n"
            "[[initial]]\nnode = \"base\"\nvelocity = [{}, {}, 0]\n[[stage]]\ntype = \"static\"\n[[stage]]\ntype = \"dynamic\"\n"
            "duration = 0.25\nstep = {}\n[output]\nframes = 0\n",
            mass, friction, 0.8 * speed, 0.6 * speed, step),
        {});
    ASSERT_TRUE(run.completed()) << run.result.reason;
    const double slid = speed * speed / (2 * friction * g), energy = 0.5 * mass * speed * speed;
    VERIFY_NEAR("way along x", "m", run["base.ux"].back(), 0.8 * slid, 0.01 * slid);
    VERIFY_NEAR("way along y", "m", run["base.uy"].back(), 0.6 * slid, 0.01 * slid);
    VERIFY_LT("kinetic energy at the end", "J", run["energy.kinetic"].back(), 1e-6 * energy);
    error.push_back(std::abs(run["energy.interface_dissipated"].back() / energy - 1));
    RecordProperty(fmt::format("step_{}", step), fmt::format("{:.2e}", error.back()));
  }
  VERIFY_LT("relative error of the dissipated energy, step of 1 ms", "1", error[0], 1e-2);
  VERIFY_LT("relative error of the dissipated energy, step of 0.1 ms", "1", error[1], 1e-3);
}

}  // namespace
}  // namespace uplift::verification::mesh_friction_test
