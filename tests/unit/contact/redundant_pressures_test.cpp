#include "unit/contact/contact_support.h"

// How the augmented Lagrangian shares a force among redundant points: as the multipliers do, with the least sum p^2/area.
namespace uplift::contact_test::redundant_pressures_test {
namespace {

/// A rigid footing (u_y, theta, with two components u_x) that stays flat under a load W at x = e.
struct RigidFooting {
  Own own;
  Footing base;
  RigidFooting(double eccentricity, double weight, int components, double friction) : base(footing(41, 1.5)) {
    const int points = 41, unknowns = components == 2 ? 3 : 2;
    Matrix b = Matrix::Zero(points * components, unknowns);
    b.bottomLeftCorner(points, 2) = base.b;
    if (components == 2) b.topRightCorner(points, 1).setOnes();
    Vector load = Vector::Zero(unknowns);
    load[0] = -weight, load[1] = -weight * eccentricity;
    if (components == 2) load[2] = 0.02 * weight;
    Matrix stiffness = Matrix::Identity(unknowns, unknowns) * 4e9;
    stiffness(1, 1) = 3e9;
    own.add_cone("footing", points, components, friction, base.area);
    own.set(spread_of(stiffness, b).factor, b * inverse(stiffness) * load);
  }
};

/// Navier: p/area = -(W/A)(1 + e x/i^2) inside the kernel. With friction 0.5 a shear of 0.02 W sticks at every point, shared by the areas.
TEST(AugmentedLagrangian, PressuresUnderARigidBaseAreNaviers) {
  const double weight = 1e6;
  for (const int components : {1, 2})
    for (const double e : {0.0, 0.2, -0.45}) {
      const RigidFooting footing(e, weight, components, components == 2 ? 0.5 : 0);
      double area = 0, second = 0;
      for (std::size_t i = 0; i < 41; ++i) {
        area += footing.base.area[i];
        second += footing.base.area[i] * footing.base.x[i] * footing.base.x[i];
      }
      InterfaceSolution solution;
      const Outcome outcome = method("augmented_lagrangian")->solve(footing.own.problem, solution);
      ASSERT_TRUE(outcome.converged) << outcome.why;
      EXPECT_LE(contact_residual(footing.own.problem, solution), 1e-9);
      for (Index i = 0; i < 41; ++i) {
        const double x = footing.base.x[static_cast<std::size_t>(i)], a = footing.base.area[static_cast<std::size_t>(i)];
        const Index normal = (components - 1) * 41 + i;
        EXPECT_NEAR(solution.force[normal] / a, -weight * (1 / area + e * x / second), 1e-9 * weight) << components << " " << e << " " << i;
        if (components == 2) {
          EXPECT_NEAR(std::abs(solution.force[i]) / a, 0.02 * weight / area, 1e-9 * weight) << e << " " << i;
        }
      }
    }
}

}  // namespace
}  // namespace uplift::contact_test::redundant_pressures_test
