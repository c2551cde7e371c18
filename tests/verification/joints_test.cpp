// Joint elements and footings against closed forms.
#include <gtest/gtest.h>

#include "unit/model/model_support.h"
#include "uplift/linear/solver.h"
#include "uplift/math/dense.h"
#include "uplift/model/damping.h"
#include "uplift/model/tuned_mass.h"
#include "verification/manual.h"

namespace uplift::joints_test {
namespace {

using std::numbers::pi;
using support::here;

/// Stiffness sum B^T diag(area k) B of the joint on the full unknowns of one side, for a normal-only joint of stiffness k on fixed ground.
Matrix normal_block(const std::vector<Vec2>& nodes, int per_element, LineQuadrature quadrature, double k, double thickness, Vec2 n) {
  ModelBuilder builder;
  LineJoint joint;
  joint.nodes_per_element = per_element;
  joint.quadrature = quadrature;
  joint.thickness = thickness;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    builder.add_node("n" + std::to_string(i), nodes[i], here);
    joint.upper.push_back({static_cast<int>(i), nodes[i]});
  }
  builder.add_interface(support::linear_interface("joint", line_points(joint, here), {k}), here);
  const Model model = builder.finish();
  const Interface& face = model.interfaces[0];
  const Matrix b = face.b * model.expansion;  // back on the full unknowns: here T only drops some
  const Matrix full = b.transpose() * (k * face.area).asDiagonal() * b;
  Matrix block(nodes.size(), nodes.size());  // (n . u) of the nodes
  for (std::size_t i = 0; i < nodes.size(); ++i)
    for (std::size_t j = 0; j < nodes.size(); ++j) block(i, j) = n.dot(full.block<2, 2>(3 * i, 3 * j) * n);
  return block;
}

TEST(JointElement, NormalBlocksOfLines) {
  VERIFIES({"Joint elements", "Stiffness matrices of line joints",
            "Exact integrals of shape functions: Gauss and Lobatto quadrature of two and three nodes"});
  const double k = 3e9, length = 1.7, thickness = 0.4;
  for (const double angle : {0.0, 0.9, -2.0}) {
    const Vec2 e(std::cos(angle), std::sin(angle)), n(-e.y(), e.x());
    const double kl = k * length * thickness;
    const std::vector<Vec2> two{{0.2, 0.1}, Vec2(0.2, 0.1) + length * e};
    Matrix gauss(2, 2), nodal(2, 2);
    gauss << 2, 1, 1, 2;
    nodal << 1, 0, 0, 1;
    VERIFY_LE("difference of the matrix, two nodes, Gauss", "N/m",
              (normal_block(two, 2, LineQuadrature::gauss, k, thickness, n) - kl / 6 * gauss).norm(), 1e-14 * kl);
    VERIFY_LE("difference of the matrix, two nodes, nodal", "N/m",
              (normal_block(two, 2, LineQuadrature::nodal, k, thickness, n) - kl / 2 * nodal).norm(), 1e-14 * kl);

    const std::vector<Vec2> three{{0, 0}, length / 2 * e, length * e};
    Matrix quadratic(3, 3);  // integral of N_i N_j of the 3-node line
    quadratic << 4, 2, -1, 2, 16, 2, -1, 2, 4;
    VERIFY_LE("difference of the matrix, three nodes, Gauss", "N/m",
              (normal_block(three, 3, LineQuadrature::gauss, k, thickness, n) - kl / 30 * quadratic).norm(), 1e-14 * kl);
    const Matrix simpson = Vec3(1, 4, 1).asDiagonal();
    VERIFY_LE("difference of the matrix, three nodes, nodal", "N/m",
              (normal_block(three, 3, LineQuadrature::nodal, k, thickness, n) - kl / 6 * simpson).norm(), 1e-14 * kl);
  }
}

TEST(JointElement, NeighboursAreAdded) {
  VERIFIES({"Joint elements", "Assembly of neighbouring joints", "Sum of the element matrices"});
  const std::vector<Vec2> nodes{{0, 0}, {1, 0}, {3, 0}};
  Matrix nodal = Vec3(0.5, 1.5, 1).asDiagonal();
  VERIFY_LE("difference of the matrix, nodal", "N/m", (normal_block(nodes, 2, LineQuadrature::nodal, 6, 1, {0, 1}) - 6 * nodal).norm(),
            1e-14);
  Matrix gauss(3, 3);
  gauss << 2, 1, 0, 1, 6, 2, 0, 2, 4;
  VERIFY_LE("difference of the matrix, Gauss", "N/m", (normal_block(nodes, 2, LineQuadrature::gauss, 6, 1, {0, 1}) - gauss).norm(), 1e-13);
}

/// Bar of unit width on a joint on rigid ground: springs as the bar; uniform traction at the top.
TEST(JointElement, PatchAndShear) {
  VERIFIES({"Joint elements", "Patch test of a line joint under normal and shear traction", "Uniform state: openings p/K_n and τ/K_t"});
  const double kn = 4e8, kt = 9e7, p = 2e5, tau = 3e4;
  for (const int per : {2, 3})
    for (const LineQuadrature quadrature : {LineQuadrature::nodal, LineQuadrature::gauss}) {
      ModelBuilder builder;
      const std::vector<double> x = per == 2 ? std::vector<double>{0, 0.7, 1.1, 2} : std::vector<double>{0, 0.35, 0.7, 1.35, 2};
      LineJoint joint;
      joint.nodes_per_element = per;
      joint.quadrature = quadrature;
      for (std::size_t i = 0; i < x.size(); ++i) {
        builder.add_node("u" + std::to_string(i), {x[i], 0}, here);
        builder.add_node("l" + std::to_string(i), {x[i], 0}, here);
        joint.upper.push_back({static_cast<int>(2 * i), {x[i], 0}});
        joint.lower.push_back({static_cast<int>(2 * i + 1), {x[i], 0}});
        for (const Dof dof : {ux, uy, rz}) builder.fix(static_cast<int>(2 * i + 1), dof, here);
      }
      // consistent nodal loads of the uniform traction
      Vector share = Vector::Zero(static_cast<Index>(x.size()));
      for (std::size_t i = 0; i + per <= x.size(); i += per - 1) {
        const double length = x[i + per - 1] - x[i];
        if (per == 2)
          share.segment(static_cast<Index>(i), 2) += length / 2 * Vec2::Ones();
        else
          share.segment(static_cast<Index>(i), 3) += length / 6 * Vec3(1, 4, 1);
      }
      std::vector<std::pair<int, double>> load;
      for (int i = 0; i < static_cast<int>(x.size()); ++i) {
        load.emplace_back(6 * i, tau * share[i]);
        load.emplace_back(6 * i + 1, p * share[i]);
      }
      builder.add_load("traction", load, nullptr, true, here);
      builder.add_interface(support::linear_interface("joint", line_points(joint, here), {kt, kn}), here);
      const Model model = builder.finish();
      Vector force = Vector::Zero(model.free());
      model.add_force(0, force);
      const Vector q = PivotedLdlt(Matrix(bonded_stiffness(model))).solve(force);
      const Interface& face = model.interfaces[0];
      const Vector opening = face.b * q;
      for (int i = 0; i < face.batch.points; ++i) {
        VERIFY_NEAR("slip of a point", "m", opening[i], tau / kt, 1e-10 * tau / kt);
        VERIFY_NEAR("opening of a point", "m", opening[face.batch.points + i], p / kn, 1e-10 * p / kn);
      }
      Vector forces(face.rows());
      forces << kt * face.area.cwiseProduct(opening.head(face.batch.points)), kn * face.area.cwiseProduct(opening.tail(face.batch.points));
      const Resultant r = resultant(face, forces.data());
      VERIFY_NEAR("normal resultant", "N", r.axial, 2 * p, 1e-9 * p);
      VERIFY_NEAR("shear resultant", "N", r.shear, 2 * tau, 1e-9 * tau);
      VERIFY_NEAR("moment resultant", "N m", r.moment, 2 * p, 1e-9 * p);  // about (0, 0): resultant p L at x = 1
    }
}

TEST(JointElement, InclinedInterfaceSplitsAUniaxialStress) {
  VERIFIES({"Joint elements", "Inclined joint under uniaxial stress", "Mohr: σ cos²θ and σ sinθ cosθ"});
  // a column of stress sigma along y, cut at the angle theta: traction sigma n_y, so t_n = sigma cos^2, t_t = +- sigma sin cos of the
  // interface's inclination
  const double k = 1e9, sigma = 1e6, theta = 0.4, length = 2;
  const Vec2 e(std::cos(theta), std::sin(theta));
  ModelBuilder builder;
  LineJoint joint;
  for (int i = 0; i < 2; ++i) {
    builder.add_node("n" + std::to_string(i), length * i * e, here);
    joint.upper.push_back({i, length * i * e});
  }
  const double pull = sigma * length * std::cos(theta) / 2;  // the column's width is the projection
  builder.add_load("pull", {{1, pull}, {4, pull}}, nullptr, true, here);
  builder.add_interface(support::linear_interface("joint", line_points(joint, here), {k, k}), here);
  const Model model = builder.finish();
  Vector force = Vector::Zero(model.free());
  model.add_force(0, force);
  const Vector traction = k * (model.interfaces[0].b * PivotedLdlt(Matrix(bonded_stiffness(model))).solve(force));
  for (int i = 0; i < 2; ++i) {
    VERIFY_NEAR("normal traction", "Pa", traction[2 + i], sigma * std::pow(std::cos(theta), 2), 1e-10 * sigma);
    VERIFY_NEAR("shear traction", "Pa", traction[i], sigma * std::sin(theta) * std::cos(theta),
                1e-10 * sigma);  // t points up the slope, as the pull does
  }
}

TEST(JointElement, RigidMotionsOpenNothing) {
  VERIFIES({"Joint elements", "Rigid motions open nothing", "Kinematics of rigid bodies"});
  ModelBuilder builder;
  LineJoint joint;
  const std::vector<Vec2> x{{0, 0}, {1, 0.5}, {2, 1.5}};
  for (int i = 0; i < 3; ++i) {
    builder.add_node("u" + std::to_string(i), x[i], here);
    builder.add_node("l" + std::to_string(i), x[i], here);
    joint.upper.push_back({2 * i, x[i]});
    joint.lower.push_back({2 * i + 1, x[i]});
  }
  joint.quadrature = LineQuadrature::gauss;
  builder.add_interface(support::linear_interface("joint", line_points(joint, here), {1, 1}), here);
  const Model model = builder.finish();
  Vector u(18);
  for (int i = 0; i < 3; ++i)
    for (int side = 0; side < 2; ++side) u.segment<3>(6 * i + 3 * side) << 0.3 - 0.1 * x[i].y(), -0.2 + 0.1 * x[i].x(), 0.1;
  VERIFY_LE("norm of the openings under a rigid motion", "m", (model.assembly.b * u).norm(), 1e-15);
}

TEST(Footing, QuadratureErrorOfTheUpliftMoment) {
  VERIFIES({"Footings", "Quadrature error of the uplift moment", "Closed form of the Winkler strip at θ = 2.6 θ_u"});
  // Rigid strip on tensionless Winkler springs at theta = 2.6 theta_u: M/M_u = 3 - 2 sqrt(theta_u/theta). The number of joints is the
  // number of cells.
  const double k = 2e8, half = 1.5, weight = 1e6, mu = weight * half / 3, theta_u = weight / (2 * k * half * half), theta = 2.6 * theta_u;
  const double exact = (3 - 2 / std::sqrt(2.6)) * mu;
  const double stated[] = {2.7e-2, 6.4e-3, 1.4e-3, 3.0e-4};
  double errors[4];
  for (int level = 0; level < 4; ++level) {
    const auto points = footing_points({.width = 2 * half, .points = (8 << level) + 1}, here);
    double low = -0.1, high = 0.1, moment = 0;  // settlement such that the vertical force is the weight
    for (int i = 0; i < 100; ++i) {
      const double settlement = (low + high) / 2;
      double force = 0;
      moment = 0;
      for (const JointPoint& p : points) {
        const double compression = k * p.area * std::max(settlement + theta * p.position.x(), 0.0);
        force += compression;
        moment += compression * p.position.x();
      }
      (force < weight ? low : high) = settlement;
    }
    errors[level] = std::abs(moment / exact - 1);
    VERIFY_NEAR("relative error of the moment", "1", errors[level], stated[level], 0.12 * stated[level]) << (8 << level);
  }
  VERIFY_NEAR("order of convergence", "1", std::log2(errors[0] / errors[3]) / 3, 2, 0.2);
}

/// The reference oscillator (oscillator_test.cpp) with bonded joints: the top mass acts in both directions, column massless and
/// inextensible.
Model oscillator(double top_mass, double k_w, int points, bool two_springs) {
  ModelBuilder builder;
  builder.add_node("base", {0, 0}, here);
  builder.add_node("top", {0, 5}, here);
  BeamSection column;
  column.bending = 20000e6 * 0.2;
  support::add_beam(builder, 0, 1, {0, 0}, {0, 5}, column);
  builder.add_element(std::make_unique<PointMass>(0, 1e4, 7500.0), here);
  if (top_mass > 0) builder.add_element(std::make_unique<PointMass>(1, top_mass), here);
  builder.fix(0, ux, here);
  auto joints = footing_points({.body = 0, .width = 3, .points = points}, here);
  if (two_springs)
    for (JointPoint& p : joints) p.area = 1;
  builder.add_interface(support::linear_interface("soil", joints, {k_w}), here);
  return builder.finish();
}

TEST(ReferenceOscillator, FixedBaseAndBondedFrequencies) {
  VERIFIES({"Reference oscillator", "Frequencies of the reference oscillator, fixed and bonded",
            "Closed form f₀/√(1 + ω₀² m h²/k_θ) and a 2 × 2 eigenproblem in the test"});
  const double h = 5, k = 3 * 4e9 / (h * h * h), w0 = 2 * pi * 10, mass = k / (w0 * w0);
  VERIFY_NEAR("m h³ of 10 Hz", "kg m3", mass * h * h * h, 3.039636e6, 1);
  VERIFY_NEAR("tuned mass", "kg", tuned_mass(oscillator(0, 2e8, 11, false), 1, 10, here), mass, 1e-9 * mass);
  for (const bool two_springs : {false, true}) {
    const double k_w = two_springs ? 3e8 : 2e8;
    const int points = two_springs ? 2 : 401;
    const Model model = oscillator(mass, k_w, points, two_springs);
    VERIFY_EQ("free unknowns", "1", model.free(), 4);  // top.ux, top.rz, one vertical, the rotation of the base
    double k_theta = 0, k_vertical = 0;
    for (int i = 0; i < points; ++i) {
      k_theta += k_w * model.interfaces[0].area[i] * std::pow(model.interfaces[0].position[i].x(), 2);
      k_vertical += k_w * model.interfaces[0].area[i];
    }
    VERIFY_NEAR("rotational stiffness of the bed", "N m/rad", k_theta, two_springs ? 2 * k_w * 2.25 : 2.0 / 3 * k_w * 3.375,
                2e-5 * k_theta);
    // own 2 x 2 problem in (x of the top, rotation of the base): deflection x + h theta
    Matrix stiff(2, 2), inertia(2, 2);
    stiff << k, k * h, k * h, k * h * h + k_theta;
    inertia << mass, 0, 0, 7500;
    const GeneralisedEigen eigen(stiff, inertia);
    const auto found = modes(bonded_stiffness(model), model.mass, 9);
    ASSERT_EQ(found.size(), 3u);  // the rotation of the top has no mass
    std::vector<double> expected{std::sqrt(eigen.eigenvalues()[0]), std::sqrt(eigen.eigenvalues()[1]),
                                 std::sqrt(k_vertical / (mass + 1e4))};
    std::sort(expected.begin(), expected.end());
    for (int i = 0; i < 3; ++i) VERIFY_NEAR("circular frequencies", "rad/s", 2 * pi * found[i].frequency, expected[i], 1e-10 * expected[i]);
    // the closed form neglects the rotary inertia of the base, 1.2 % of M h^2; with it the frequency is lower by half of its share in the
    // kinetic energy
    const double closed = 10 / std::sqrt(1 + w0 * w0 * mass * h * h / k_theta);
    VERIFY_LT("bonded frequency, upper bound by the closed form", "Hz", found[0].frequency, closed);
    VERIFY_NEAR("bonded frequency", "Hz", found[0].frequency, closed, 0.5 * 7500 / (mass * h * h) * closed);
    Matrix light = inertia;
    light(1, 1) = 1e-6;  // without it the closed form is exact
    VERIFY_NEAR("bonded frequency without rotary inertia of the base", "Hz",
                std::sqrt(GeneralisedEigen(stiff, light).eigenvalues()[0]) / (2 * pi), closed, 1e-7);
  }
}

}  // namespace
}  // namespace uplift::joints_test
