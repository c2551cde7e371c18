#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "manual.h"
#include "solids_support.h"

// Claim: any mesh of solids meets constant strain exactly (patch test; Taylor, Simo, Zienkiewicz & Chan, IJNME 22 (1986) 39-62).
// Source: the linear field itself and Hooke's law. Tolerance 1e-10.
namespace uplift::verification::solids_patch_test {
namespace {

constexpr double young = 2e9, poisson = 0.27;

/// Moves every corner at random, by its place alone so that neighbours agree; the surface too.
std::function<Vec3(const Vec3&)> random_move(double amplitude, int dimension, unsigned seed) {
  return [=](const Vec3& x) {
    std::seed_seq mix{static_cast<unsigned>(std::lround(x.x() * 1e6)), static_cast<unsigned>(std::lround(x.y() * 1e6)),
                      static_cast<unsigned>(std::lround(x.z() * 1e6)), seed};
    std::mt19937 random(mix);
    std::uniform_real_distribution<double> uniform(-amplitude, amplitude);
    Vec3 moved = x;
    for (int i = 0; i < dimension; ++i) moved[i] += uniform(random);
    return moved;
  };
}

TEST(SolidsPatch, ConstantStrainOnRandomMeshes) {
  VERIFIES({"Solids", "Patch test: constant strain on random meshes",
            "Taylor, Simo, Zienkiewicz & Chan, IJNME 22 (1986) 39-62; linear displacement and Hooke's law"});
  for (const CellInfo& cell : all_cells()) {
    if (cell.dimension < 2) continue;
    for (const bool modes : {false, true})
      for (const PlaneState plane : {PlaneState::strain, PlaneState::stress})
        for (const unsigned seed : {1u, 2u, 3u}) {
          const int d = cell.dimension;
          if (d == 3 && plane == PlaneState::stress) continue;
          const Vec3 size(1.5, 1, 1.2);
          const SmallMesh mesh = small_mesh(cell.cell, size, {3, 3, 3}, random_move(0.06, d, seed));
          SolidSection section;
          section.material = {young, poisson, 0};
          section.plane = plane;
          section.incompatible_modes = modes;
          const SolidSystem system = assemble(mesh, section);
          Mat3 gradient;
          gradient << 3e-4, -1e-4, 5e-4, 2e-4, -4e-4, 1e-4, -2e-4, 6e-4, 1e-4;
          if (d == 2) gradient.row(2).setZero(), gradient.col(2).setZero();
          Vector exact(system.stiffness.rows());
          for (std::size_t a = 0; a < mesh.nodes->size(); ++a)
            exact.segment(d * static_cast<Index>(a), d) = (gradient * (*mesh.nodes)[a]).head(d);
          const auto fixed = held_where(mesh, [&](const Vec3& x) { return on_surface(x, size, d); });
          Vector u = Vector::Zero(exact.size());
          for (std::size_t i = 0; i < fixed.size(); ++i)
            if (fixed[i]) u[static_cast<Index>(i)] = exact[static_cast<Index>(i)];
          ASSERT_NE(std::count(fixed.begin(), fixed.end(), false), 0);
          solve_held(system.stiffness, Vector::Zero(u.size()), fixed, u);
          VERIFY_LE("error of the displacements (sum norm)", "m", (u - exact).lpNorm<1>(), 1e-10 * exact.lpNorm<1>()) << cell.name << modes;
          // stress everywhere: lambda tr e I + 2 mu e
          const double mu = young / (2 * (1 + poisson)), trace = gradient.trace();
          const double lambda = plane == PlaneState::stress ? young * poisson / (1 - poisson * poisson)
                                                            : young * poisson / ((1 + poisson) * (1 - 2 * poisson));
          Stress expected;
          for (int i = 0; i < 3; ++i) {
            expected[i] = lambda * trace + 2 * mu * gradient(i, i);
            expected[3 + i] = mu * (gradient(i, (i + 1) % 3) + gradient((i + 1) % 3, i));
          }
          if (plane == PlaneState::stress) expected[2] = 0;
          for (std::size_t e = 0; e < mesh.cells.size(); ++e) {
            Vector of_cell(d * cell.nodes);
            for (int a = 0; a < cell.nodes; ++a) of_cell.segment(d * a, d) = u.segment(d * mesh.cells[e][static_cast<std::size_t>(a)], d);
            for (const Stress& s : system.solids[e].node_stress(of_cell))
              VERIFY_LE("error of the stress (norm)", "Pa", (s - expected).norm(), 1e-10 * expected.norm()) << cell.name;
          }
        }
  }
}

TEST(SolidsPatch, PullOnAHalfFreeBlock) {
  VERIFIES({"Solids", "Patch test: tension of a block", "Hooke's law: u = px/E, v = −νpy/E"});
  // the other form of the test: forces on one side, the least supports; plane stress and 3D, any Poisson ratio: u = p x/E, v = -nu p y/E
  const double p = 3e5;
  for (const CellInfo& cell : all_cells()) {
    const int d = cell.dimension;
    if (d < 2) continue;
    const Vec3 size(2, 1, 1);
    const auto inner = random_move(0.06, d, 4);
    const SmallMesh mesh = small_mesh(cell.cell, size, {3, 3, 3}, [&](const Vec3& x) { return on_surface(x, size, d) ? x : inner(x); });
    SolidSection section;
    section.material = {young, poisson, 0};
    section.plane = PlaneState::stress;
    const SolidSystem system = assemble(mesh, section);
    Vector force = Vector::Zero(system.stiffness.rows());
    for (const auto& nodes : mesh.cells) {
      std::size_t first = 0;
      for (const Cell side : cell.sides) {
        std::vector<Vec3> places;
        std::vector<int> on_side;
        bool pulled = true;
        for (int i = 0; i < info(side).nodes; ++i) {
          on_side.push_back(nodes[static_cast<std::size_t>(cell.side_nodes[first++])]);
          places.push_back((*mesh.nodes)[static_cast<std::size_t>(on_side.back())]);
          pulled &= std::abs(places.back().x() - size.x()) < 1e-9;
        }
        if (!pulled) continue;
        const CellRule rule = nodal_rule(side);  // a uniform traction is met exactly
        for (std::size_t q = 0; q < rule.point.size(); ++q) {
          const CellShape shape = cell_shape(side, rule.point[q]);
          const double area = rule.weight[q] * cell_area_vector(shape, places, side).norm();
          for (std::size_t a = 0; a < on_side.size(); ++a) force[d * on_side[a]] += p * area * shape.value[a];
        }
      }
    }
    std::vector<bool> fixed(static_cast<std::size_t>(force.size()), false);
    for (std::size_t a = 0; a < mesh.nodes->size(); ++a)
      for (int i = 0; i < d; ++i)
        if (std::abs((*mesh.nodes)[a][i]) < 1e-9) fixed[static_cast<std::size_t>(d) * a + static_cast<std::size_t>(i)] = true;
    Vector u = Vector::Zero(force.size());
    solve_held(system.stiffness, force, fixed, u);
    for (std::size_t a = 0; a < mesh.nodes->size(); ++a)
      for (int i = 0; i < d; ++i)
        VERIFY_NEAR("displacement", "m", u[d * static_cast<Index>(a) + i], (i == 0 ? 1 : -poisson) * p / young * (*mesh.nodes)[a][i],
                    1e-10 * p / young * 2)
            << cell.name;
  }
}

}  // namespace
}  // namespace uplift::verification::solids_patch_test
