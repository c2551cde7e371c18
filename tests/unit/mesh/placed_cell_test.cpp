#include "uplift/mesh/placed_cell.h"

#include <gtest/gtest.h>

#include <random>

#include "uplift/mesh/cell_shapes.h"

// The mapping of a linear cell at its place, forth and back.
namespace uplift::placed_cell_test {
namespace {

constexpr std::array cells{Cell::line2, Cell::tri3, Cell::quad4, Cell::tet4, Cell::wedge6, Cell::hex8};

struct Random {
  explicit Random(unsigned seed) : engine(seed) {}
  double operator()(double from, double to) { return std::uniform_real_distribution<double>(from, to)(engine); }
  std::mt19937 engine;
};

/// The reference cell under x = A r + b, with its corners moved by up to `warp` within its own dimension.
std::vector<Vec3> corners_of(Cell cell, const std::array<Vec3, 3>& columns, const Vec3& offset, double warp, Random& random) {
  std::vector<Vec3> corners;
  for (const auto& node : cell_nodes(cell)) {
    Vec3 x = offset;
    for (std::size_t k = 0; k < static_cast<std::size_t>(info(cell).dimension); ++k) x += (node[k] + random(-warp, warp)) * columns[k];
    corners.push_back(x);
  }
  return corners;
}

std::array<Vec3, 3> columns(Random& random) {  // never near a singular matrix
  std::array<Vec3, 3> made;
  for (int k = 0; k < 3; ++k) {
    made[static_cast<std::size_t>(k)] = Vec3(random(-0.3, 0.3), random(-0.3, 0.3), random(-0.3, 0.3));
    made[static_cast<std::size_t>(k)][k] += 2;
  }
  return made;
}

Vec3 local_place(Cell cell, Random& random) {
  Vec3 local = cell_centre(cell);
  for (int k = 0; k < info(cell).dimension; ++k) local[k] += random(-0.3, 0.3);
  return local;
}

TEST(PlacedCell, ParallelCellsAreMappedByOneMatrix) {
  Random random(3);
  for (const Cell cell : cells)
    for (int repeat = 0; repeat < 20; ++repeat) {
      const std::array<Vec3, 3> a = columns(random);
      const Vec3 offset(random(-5, 5), random(-5, 5), random(-5, 5));
      const PlacedCell placed(cell, corners_of(cell, a, offset, 0, random));
      EXPECT_TRUE(placed.parallel()) << info(cell).name;
      const Vec3 local = local_place(cell, random);
      Vec3 place = offset;
      for (int k = 0; k < info(cell).dimension; ++k) place += local[k] * a[static_cast<std::size_t>(k)];
      EXPECT_NEAR((placed.place(local) - place).norm(), 0, 1e-14 * 10) << info(cell).name;
      EXPECT_NEAR((placed.local(place) - local).norm(), 0, 1e-14) << info(cell).name;
      const Vec3 area = cross(a[0], a[1]);
      const double measure = info(cell).dimension == 1 ? a[0].norm() : info(cell).dimension == 2 ? area.norm() : area.dot(a[2]);
      EXPECT_NEAR(placed.measure(local), measure, 1e-13);
    }
}

TEST(PlacedCell, WarpedCellsAreInvertedAndKnown) {
  Random random(5);
  for (const Cell cell : {Cell::quad4, Cell::wedge6, Cell::hex8})
    for (int repeat = 0; repeat < 20; ++repeat) {
      const PlacedCell placed(cell, corners_of(cell, columns(random), Vec3(1, 2, 3), 0.1, random));
      EXPECT_FALSE(placed.parallel()) << info(cell).name;
      const Vec3 local = local_place(cell, random);
      EXPECT_NEAR((placed.local(placed.place(local)) - local).norm(), 0, 1e-13) << info(cell).name;
      // the measure is that of the finite parallelepiped of three small steps
      constexpr double step = 1e-5;
      std::array<Vec3, 3> slope{Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()};
      for (int k = 0; k < info(cell).dimension; ++k) {
        Vec3 ahead = local, behind = local;
        ahead[k] += step, behind[k] -= step;
        slope[static_cast<std::size_t>(k)] = (placed.place(ahead) - placed.place(behind)) / (2 * step);
      }
      const Vec3 area = cross(slope[0], slope[1]);
      EXPECT_NEAR(placed.measure(local), info(cell).dimension == 2 ? area.norm() : area.dot(slope[2]), 1e-8) << info(cell).name;
    }
}

TEST(PlacedCell, SharesAreTheShapeFunctions) {
  Random random(7);
  for (const Cell cell : cells) {
    const PlacedCell placed(cell, corners_of(cell, columns(random), Vec3::Zero(), 0, random));
    const Vec3 local = local_place(cell, random);
    const CellShape shape = cell_shape(cell, local);
    const std::array<double, max_corners> share = placed.shares(local);
    for (std::size_t a = 0; a < max_corners; ++a)
      EXPECT_NEAR(share[a], a < static_cast<std::size_t>(shape.nodes) ? shape.value[a] : 0, 1e-15);
  }
}

}  // namespace
}  // namespace uplift::placed_cell_test
