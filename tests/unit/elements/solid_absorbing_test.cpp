#include <gtest/gtest.h>

#include <cmath>

#include "unit/elements/solid_support.h"
#include "uplift/elements/absorbing.h"
#include "uplift/math/dense.h"

namespace uplift::solid_absorbing_test {
namespace {

constexpr std::array<Cell, 7> faces{Cell::line2, Cell::line3, Cell::tri3, Cell::tri6, Cell::quad4, Cell::quad8, Cell::quad9};

AbsorbingFace face(Cell cell, const std::vector<Vec3>& positions, bool lumped) {
  return AbsorbingFace(cell, first_numbers(info(cell).nodes), std::make_shared<const std::vector<Vec3>>(positions),
                       {{80e6, 0.3, 1800}, 0.6, lumped});
}

/// A plane face anywhere: a distorted reference face, turned (in the plane z = 0 for lines).
struct Placed {
  std::vector<Vec3> positions;
  Vec3 normal;
  double area;  // m2, with the thickness of lines
};

Placed place(Cell cell, std::mt19937& random) {
  Placed placed;
  std::uniform_real_distribution<double> uniform(-1, 1);
  if (info(cell).dimension == 1) {
    const Vec3 a(uniform(random), uniform(random), 0), along(2 + uniform(random), uniform(random), 0);
    for (int i = 0; i < info(cell).nodes; ++i) placed.positions.push_back(a + along * (1 + local_node(cell, i).x()) / 2);
    placed.normal = Vec3(along.y(), -along.x(), 0).normalized();
    placed.area = along.norm() * 0.6;
    return placed;
  }
  placed.positions = distorted_nodes(cell, 0.15, random);
  // area of the polygon of the corners (shoelace)
  double area = 0;
  const int corners = info(cell).corners;
  for (int i = 0; i < corners; ++i) {
    const Vec3 &a = placed.positions[static_cast<std::size_t>(i)], &b = placed.positions[static_cast<std::size_t>((i + 1) % corners)];
    area += (a.x() * b.y() - b.x() * a.y()) / 2;
  }
  placed.area = area;
  const Matrix q = columns_of_q(Qr(Matrix::Random(3, 3)), 3);
  Mat3 turn = q;
  if (turn.determinant() < 0) turn = -turn;
  for (Vec3& x : placed.positions) x = (turn * x).eval();
  placed.normal = turn.col(2);
  return placed;
}

Vector everywhere(const Vec3& motion, int dimension, int nodes) {
  Vector v(dimension * nodes);
  for (int a = 0; a < nodes; ++a) v.segment(dimension * a, dimension) = motion.head(dimension);
  return v;
}

TEST(SolidAbsorbing, WholeFaceIsDensityTimesSpeedTimesArea) {
  std::mt19937 random(41);
  const double vp = std::sqrt(80e6 * 0.7 / (1.3 * 0.4) / 1800), vs = std::sqrt(80e6 / 2.6 / 1800);
  for (const Cell cell : faces)
    for (const bool lumped : {false, true}) {
      const Placed placed = place(cell, random);
      const AbsorbingFace f = face(cell, placed.positions, lumped);
      const int d = f.unknowns_per_node(), n = info(cell).nodes;
      EXPECT_NEAR(f.area(), placed.area, 1e-13 * placed.area) << info(cell).name;
      Matrix k, m, c;
      f.form({&k, &m, &c});
      EXPECT_EQ(k.rows(), d * n);
      EXPECT_EQ(k.norm() + m.norm(), 0);
      EXPECT_LE((c - c.transpose()).norm(), 1e-15 * c.norm()) << info(cell).name;
      EXPECT_GT(SymmetricEigen(c).eigenvalues()[0], 0) << info(cell).name << lumped;
      const Vec3 along = (placed.positions[1] - placed.positions[0]).normalized();
      const Vec3 across(placed.normal.y() * along.z() - placed.normal.z() * along.y(),
                        placed.normal.z() * along.x() - placed.normal.x() * along.z(),
                        placed.normal.x() * along.y() - placed.normal.y() * along.x());
      const double p = 1800 * vp * placed.area, s = 1800 * vs * placed.area;
      const Vector vn = everywhere(placed.normal, d, n), vt = everywhere(along, d, n);
      EXPECT_NEAR(vn.dot(c * vn), p, 1e-12 * p) << info(cell).name << lumped;
      EXPECT_NEAR(vt.dot(c * vt), s, 1e-12 * p) << info(cell).name << lumped;
      EXPECT_NEAR(vn.dot(c * vt), 0, 1e-12 * p) << info(cell).name << lumped;
      if (d == 3) {
        const Vector vb = everywhere(across, d, n);
        EXPECT_NEAR(vb.dot(c * vb), s, 1e-12 * p) << info(cell).name << lumped;
      }
      if (!lumped) continue;
      for (int a = 0; a < n; ++a)
        for (int b = 0; b < n; ++b)
          if (a != b) EXPECT_EQ(c.block(d * a, d * b, d, d).norm(), 0) << info(cell).name;
    }
}

TEST(SolidAbsorbing, NodalSharesAreTheTextbooks) {
  // shares of a uniform traction: consistent; lumped where row sums serve, else the scaled diagonal, of the reference faces
  struct Shares {
    Cell cell;
    std::vector<double> consistent, lumped;
  };
  const std::vector<Shares> all{
      {Cell::line2, {1. / 2, 1. / 2}, {1. / 2, 1. / 2}},
      {Cell::line3, {1. / 6, 1. / 6, 2. / 3}, {1. / 6, 1. / 6, 2. / 3}},
      {Cell::tri3, {1. / 3, 1. / 3, 1. / 3}, {1. / 3, 1. / 3, 1. / 3}},
      // int N^2 of the tri6: 6/180 at corners, 32/180 at mid-sides (of twice the area)
      {Cell::tri6, {0, 0, 0, 1. / 3, 1. / 3, 1. / 3}, {6. / 114, 6. / 114, 6. / 114, 32. / 114, 32. / 114, 32. / 114}},
      {Cell::quad4, {1. / 4, 1. / 4, 1. / 4, 1. / 4}, {1. / 4, 1. / 4, 1. / 4, 1. / 4}},
      // int N^2 of the quad8: 6/180 and 32/180 of the area, the 3/76 and 16/76 of Hinton, Rock & Zienkiewicz
      {Cell::quad8,
       {-1. / 12, -1. / 12, -1. / 12, -1. / 12, 1. / 3, 1. / 3, 1. / 3, 1. / 3},
       {3. / 76, 3. / 76, 3. / 76, 3. / 76, 16. / 76, 16. / 76, 16. / 76, 16. / 76}},
      {Cell::quad9,
       {1. / 36, 1. / 36, 1. / 36, 1. / 36, 1. / 9, 1. / 9, 1. / 9, 1. / 9, 4. / 9},
       {1. / 36, 1. / 36, 1. / 36, 1. / 36, 1. / 9, 1. / 9, 1. / 9, 1. / 9, 4. / 9}}};
  const double vp = std::sqrt(80e6 * 0.7 / (1.3 * 0.4) / 1800), vs = std::sqrt(80e6 / 2.6 / 1800);
  for (const Shares& shares : all)
    for (const bool lumped : {false, true}) {
      std::vector<Vec3> positions;
      for (int a = 0; a < info(shares.cell).nodes; ++a) positions.push_back(local_node(shares.cell, a));
      const AbsorbingFace f = face(shares.cell, positions, lumped);
      const int d = f.unknowns_per_node();
      const Vec3 normal = d == 2 ? Vec3(0, -1, 0) : Vec3(0, 0, 1);
      const Vector pressed = f.incident(normal), sheared = f.incident(Vec3::UnitX());
      const double p = 2 * 1800 * vp * f.area(), s = 2 * 1800 * vs * f.area();
      for (int a = 0; a < info(shares.cell).nodes; ++a) {
        const double share = (lumped ? shares.lumped : shares.consistent)[static_cast<std::size_t>(a)];
        EXPECT_LE((pressed.segment(d * a, d) - share * p * normal.head(d)).norm(), 1e-13 * p) << info(shares.cell).name << lumped << a;
        EXPECT_LE((sheared.segment(d * a, d) - share * s * Vec3::UnitX().head(d)).norm(), 1e-13 * p)
            << info(shares.cell).name << lumped << a;
      }
    }
}

TEST(SolidAbsorbing, WaveMotions) {
  EXPECT_EQ(wave_motion(Wave::p, 2), Vec3(0, 1, 0));
  EXPECT_EQ(wave_motion(Wave::sv, 2), Vec3(1, 0, 0));
  const double azimuth = 0.4;
  const Vec3 p = wave_motion(Wave::p, 3, azimuth), sv = wave_motion(Wave::sv, 3, azimuth), sh = wave_motion(Wave::sh, 3, azimuth);
  EXPECT_EQ(p, Vec3(0, 0, 1));
  EXPECT_NEAR(std::atan2(sv.y(), sv.x()), azimuth, 1e-15);
  Mat3 axes;
  axes << sv, sh, p;
  EXPECT_LE((axes.transpose() * axes - Mat3::Identity()).norm(), 1e-15);
  EXPECT_NEAR(axes.determinant(), 1, 1e-15);
}

}  // namespace
}  // namespace uplift::solid_absorbing_test
