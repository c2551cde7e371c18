#include <gtest/gtest.h>

#include "manual.h"
#include "solids_support.h"

// Claim: with incompatible modes one quad4 or hex8 over the thickness of a wall bends right; without them it locks.
// Source: beam theory. Tolerance: pure bending of rectangular elements 1e-9 (exact), cantilever 1 %.
namespace uplift::verification::solids_bending_test {
namespace {

constexpr double young = 30e9, poisson = 0.2, length = 20, width = 0.8, thickness = 1;
constexpr int pieces = 10;

struct Wall {
  Cell cell;
  int across;  // direction of the deflection: 1 or 2 (3D)
  PlaneState plane = PlaneState::stress;
  bool modes = true;
};

/// One row of elements along x; size 1 m along the direction of the deflection.
SmallMesh row(const Wall& wall) {
  Vec3 size(length, wall.across == 1 ? thickness : width, wall.across == 1 ? width : thickness);
  return small_mesh(wall.cell, size, {pieces, 1, 1}, [](const Vec3& x) { return x; });
}

SolidSection section(const Wall& wall) {
  SolidSection s;
  s.material = {young, poisson, 0};
  s.plane = wall.plane;
  s.thickness = width;
  s.incompatible_modes = wall.modes;
  return s;
}

/// The end x = 0 keeps its plane; across it only rigid motions are held, so that it may change its shape as the bent section wants.
std::vector<bool> clamp(const SmallMesh& mesh, const Wall& wall) {
  const auto d = static_cast<std::size_t>(info(mesh.cell).dimension), across = static_cast<std::size_t>(wall.across), other = 3 - across;
  std::vector<bool> fixed(d * mesh.before.size(), false);
  for (std::size_t a = 0; a < mesh.before.size(); ++a) {
    const Vec3& x = mesh.before[a];
    if (x.x() > 1e-9) continue;
    fixed[d * a] = true;
    const bool lower = x[wall.across] < 1e-9;
    fixed[d * a + across] = lower;
    if (d == 3 && lower && x[3 - wall.across] < 1e-9) fixed[d * a + other] = true;
  }
  return fixed;
}

/// Forces at the end x = length: `value(place)` along direction i, shared by the nodes.
Vector end_force(const SmallMesh& mesh, int i, const std::function<double(const Vec3&)>& value) {
  const int d = info(mesh.cell).dimension;
  Vector force = Vector::Zero(d * static_cast<Index>(mesh.before.size()));
  for (std::size_t a = 0; a < mesh.before.size(); ++a)
    if (mesh.before[a].x() > length - 1e-9) force[d * static_cast<Index>(a) + i] = value(mesh.before[a]);
  return force;
}

/// Mean motion of the end along i.
double end_motion(const SmallMesh& mesh, const Vector& u, int i) {
  const int d = info(mesh.cell).dimension;
  double sum = 0, count = 0;
  for (std::size_t a = 0; a < mesh.before.size(); ++a)
    if (mesh.before[a].x() > length - 1e-9) sum += u[d * static_cast<Index>(a) + i], ++count;
  return sum / count;
}

double cantilever(const Wall& wall) {
  const SmallMesh mesh = row(wall);
  const double nodes = info(wall.cell).dimension == 2 ? 2 : 4;
  const SolidSystem system = assemble(mesh, section(wall));
  Vector u = Vector::Zero(system.stiffness.rows());
  solve_held(system.stiffness, end_force(mesh, wall.across, [&](const Vec3&) { return 1e4 / nodes; }), clamp(mesh, wall), u);
  return end_motion(mesh, u, wall.across);
}

const std::vector<Wall> walls{{Cell::quad4, 1}, {Cell::quad4, 1, PlaneState::strain}, {Cell::hex8, 1}, {Cell::hex8, 2}};

TEST(SolidsBending, CantileverWithOneElementOverTheThickness) {
  VERIFIES({"Solids", "Cantilever with one element over its thickness", "Beam theory with shear: PL³/3EI + 1.2 PL/GA"});
  for (Wall wall : walls) {
    const bool slab = wall.cell == Cell::quad4 && wall.plane == PlaneState::strain;
    const double inertia = width * std::pow(thickness, 3) / 12, e = slab ? young / (1 - poisson * poisson) : young;
    const double shear = young / (2 * (1 + poisson)), area = width * thickness;
    const double beam = 1e4 * std::pow(length, 3) / (3 * e * inertia) + 1.2 * 1e4 * length / (shear * area);
    const double modes = cantilever(wall);
    VERIFY_NEAR("deflection of the tip", "m", modes, beam, 0.01 * beam) << info(wall.cell).name << wall.across;
    wall.modes = false;
    VERIFY_LT("deflection without incompatible modes (it locks)", "m", cantilever(wall), 0.5 * beam) << info(wall.cell).name << wall.across;
  }
}

TEST(SolidsBending, PureBendingIsExact) {
  VERIFIES({"Solids", "Pure bending", "Beam theory: ML²/2EI, My/I"});
  // a couple at the end, by the trilinear distribution of a linear traction: tip deflection M L^2/(2 E I), stress M y/I
  const double moment = 5e4;
  for (const Wall& wall : walls) {
    const SmallMesh mesh = row(wall);
    const SolidSystem system = assemble(mesh, section(wall));
    const bool slab = wall.cell == Cell::quad4 && wall.plane == PlaneState::strain;
    const double inertia = width * std::pow(thickness, 3) / 12, e = slab ? young / (1 - poisson * poisson) : young;
    const double nodes = info(wall.cell).dimension == 2 ? 1 : 2;
    Vector u = Vector::Zero(system.stiffness.rows());
    const Vector force =
        end_force(mesh, 0, [&](const Vec3& x) { return (x[wall.across] < 0.5 * thickness ? 1 : -1) * moment / thickness / nodes; });
    solve_held(system.stiffness, force, clamp(mesh, wall), u);
    const double tip = moment * length * length / (2 * e * inertia);
    double lower = 0;  // of the edge that is held at the other end
    const int d = info(wall.cell).dimension;
    for (std::size_t a = 0; a < mesh.before.size(); ++a)
      if (mesh.before[a].x() > length - 1e-9 && mesh.before[a][wall.across] < 1e-9) lower = u[d * static_cast<Index>(a) + wall.across];
    VERIFY_NEAR("deflection of the tip", "m", lower, tip, 1e-9 * tip) << info(wall.cell).name << wall.across;
    for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
      Vector of_cell(d * static_cast<Index>(mesh.cells[c].size()));
      for (std::size_t a = 0; a < mesh.cells[c].size(); ++a)
        of_cell.segment(d * static_cast<Index>(a), d) = u.segment(d * mesh.cells[c][a], d);
      const auto stress = system.solids[c].node_stress(of_cell);
      for (std::size_t a = 0; a < stress.size(); ++a) {
        const double y = (*mesh.nodes)[static_cast<std::size_t>(mesh.cells[c][a])][wall.across] - thickness / 2;
        VERIFY_NEAR("stress along the beam", "Pa", stress[a][0], -moment * y / inertia, 1e-8 * moment * thickness / inertia)
            << info(wall.cell).name;
        VERIFY_NEAR("stress across the beam", "Pa", stress[a][wall.across], 0, 1e-8 * moment * thickness / inertia) << info(wall.cell).name;
      }
    }
  }
}

}  // namespace
}  // namespace uplift::verification::solids_bending_test
