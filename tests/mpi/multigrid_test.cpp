#include <gtest/gtest.h>

#include <cstdio>

#include "uplift/distributed/ranks.h"
#include "uplift/elements/solid.h"
#include "uplift/linear/large.h"

namespace uplift {
namespace {

/// A block of n x n x n bricks with sides of 1 m in all, held below: its stiffness, and the motions of a rigid body.
struct Block {
  Sparse stiffness;
  RigidMotions motions;
};

Block block_of_bricks(int n) {
  ElasticMaterial soil;
  soil.young = 2e8, soil.poisson = 0.3, soil.density = 2000;
  SolidSection section;
  section.material = soil;
  const int side = n + 1, held = side * side;
  std::vector<Vec3> places;
  for (int i = 0; i < side * side * side; ++i) places.push_back(Vec3(i % side, i / side % side, i / held) / n);
  const auto shared = std::make_shared<const std::vector<Vec3>>(places);
  std::vector<Triplet> entries;
  Matrix stiffness;
  for (int z = 0; z < n; ++z)
    for (int y = 0; y < n; ++y)
      for (int x = 0; x < n; ++x) {
        const int first = x + side * (y + side * z);
        const int nodes[] = {first,        first + 1,        first + side + 1,        first + side,  // as in VTK
                             first + held, first + held + 1, first + held + side + 1, first + held + side};
        Solid(Cell::hex8, nodes, shared, section).form({&stiffness, nullptr, nullptr});
        for (int a = 0; a < 24; ++a)
          for (int b = 0; b < 24; ++b)
            if (nodes[a / 3] >= held && nodes[b / 3] >= held)
              entries.emplace_back(3 * (nodes[a / 3] - held) + a % 3, 3 * (nodes[b / 3] - held) + b % 3, stiffness(a, b));
      }
  const int rows = 3 * (side * side * side - held);
  Block block{Sparse(rows, rows), {Matrix::Zero(rows, 6), {}}};
  block.stiffness.setFromTriplets(entries.begin(), entries.end());
  for (int i = 0; i < rows; ++i) {
    block.motions.node.push_back(held + i / 3);
    block.motions.motions(i, i % 3) = 1;
    for (int axis = 0; axis < 3; ++axis)
      block.motions.motions(i, 3 + axis) = cross(Vec3::Unit(axis), places[static_cast<std::size_t>(held + i / 3)])[i % 3];
  }
  return block;
}

/// The same between planes of symmetry: nodes on two of its sides keep two unknowns or one.
Block held_on_two_sides(const Block& block, int n) {
  std::vector<int> kept;
  const int side = n + 1;
  for (int i = 0; i < block.stiffness.rows(); ++i)
    if (!(i % 3 == 0 && i / 3 % side == 0) && !(i % 3 == 1 && i / 3 / side % side == 0)) kept.push_back(i);
  Sparse choice(block.stiffness.rows(), std::ssize(kept));
  for (int k = 0; k < std::ssize(kept); ++k) choice.insert(kept[k], k) = 1;
  Block held{Sparse(choice.transpose() * block.stiffness * choice), {block.motions.motions(kept, Eigen::all), {}}};
  for (const int i : kept) held.motions.node.push_back(block.motions.node[i]);
  return held;
}

/// For the weight of the block: what acts along the last unknown of every node.
long iterations_with(const LinearSolver& solver, const Block& block) {
  const Factorisation made = solver.factorise(block.stiffness);
  EXPECT_TRUE(made.factor) << made.why;
  if (!made.factor) return 0;
  Matrix weight = Matrix::Zero(block.stiffness.rows(), 1), x;
  for (Index i = 0; i < weight.rows(); ++i)
    if (i + 1 == weight.rows() || block.motions.node[i] != block.motions.node[i + 1]) weight(i, 0) = -1;
  const long before = Ranks::all().iterations();
  made.factor->solve(weight, x);
  EXPECT_LE((block.stiffness * x - weight).norm(), 1e-9 * weight.norm());
  return Ranks::all().iterations() - before;
}

std::unique_ptr<const LinearSolver> multigrid_in_statics() {
  auto table = std::make_shared<RawTable>();
  for (const auto& [key, text] :
       {std::pair("type", "petsc"), std::pair("options", "-pc_type jacobi"), std::pair("static_options", "-pc_type gamg")})
    table->entries.emplace_back(key, Raw{std::string(text), {"case.toml", 3}, std::string("solver.") + key});
  return make_part(solver_catalog(), check_part(Raw{table, {"case.toml", 3}, "solver"}, linear_solvers()));
}

/// Diagonals of elements are all but equal, so Jacobi's preconditioner does nothing for long waves: iterations grow with the number of
/// bricks along a side. Coarse levels that have the motions of rigid bodies in them make them stay.
TEST(Multigrid, IterationsOfAStaticStageDoNotGrowWithTheMesh) {
  const auto of_steps = multigrid_in_statics();
  std::vector<long> jacobi, multigrid;
  for (const int n : {6, 12, 24}) {
    const Block block = block_of_bricks(n);
    jacobi.push_back(iterations_with(*of_steps, block));
    multigrid.push_back(iterations_with(*solver_for_statics(*of_steps, block.motions), block));
    std::printf("multigrid: %d bricks, %ld iterations, Jacobi %ld\n", n * n * n, multigrid.back(), jacobi.back());
  }
  EXPECT_GE(jacobi.back(), 3 * jacobi.front());
  EXPECT_LE(multigrid.back(), 1.5 * static_cast<double>(multigrid.front()));
}

/// Supports hold more motions than they did before, so that they leave nothing that would be harder to find.
TEST(Multigrid, NodesWithFewerUnknownsAreNodesToo) {
  const int n = 12;
  const auto of_steps = multigrid_in_statics();
  const Block whole = block_of_bricks(n), held = held_on_two_sides(whole, n);
  const long of_whole = iterations_with(*solver_for_statics(*of_steps, whole.motions), whole),
             of_held = iterations_with(*solver_for_statics(*of_steps, held.motions), held);
  std::printf("multigrid: %ld iterations, with supports %ld\n", of_whole, of_held);
  EXPECT_LE(of_held, 1.2 * static_cast<double>(of_whole));
}

}  // namespace
}  // namespace uplift
