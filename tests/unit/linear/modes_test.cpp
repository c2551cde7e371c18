// Modes of large models: closed forms with repeated and rigid ones, a dense solution, masses few and far between.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "two_boxes.h"
#include "uplift/linear/solver.h"
#include "uplift/math/vibration.h"

namespace uplift::modes_test {
namespace {

using std::numbers::pi;

/// `copies` square nets of n x n masses, not connected to each other; springs to the neighbours, on the rim to ground when `held`.
Sparse nets(int n, int copies, double k, bool held) {
  std::vector<Triplet> entries;
  for (int copy = 0; copy < copies; ++copy)
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) {
        const int here = (copy * n + i) * n + j;
        for (const auto& [a, b] : {std::pair(i - 1, j), std::pair(i + 1, j), std::pair(i, j - 1), std::pair(i, j + 1)}) {
          const bool inside = a >= 0 && a < n && b >= 0 && b < n;
          if (inside || held) entries.emplace_back(here, here, k);
          if (inside) entries.emplace_back(here, (copy * n + a) * n + b, -k);
        }
      }
  Sparse matrix(copies * n * n, copies * n * n);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

Sparse equal_masses(Index n, double m) {
  Sparse mass(n, n);
  mass.setIdentity();
  return m * mass;
}

/// Every mode meets K x = w^2 M x, and x^T M y is the identity.
void expect_modes(const Sparse& stiffness, const Sparse& mass, const std::vector<Mode>& found) {
  Matrix shapes(mass.rows(), static_cast<Index>(found.size()));
  for (std::size_t i = 0; i < found.size(); ++i) {
    const Vector& x = shapes.col(static_cast<Index>(i)) = found[i].shape;
    const double w = 2 * pi * found[i].frequency;
    const Vector size = stiffness.cwiseAbs() * x.cwiseAbs();
    EXPECT_LE((stiffness * x - w * w * (mass * x)).norm(), 1e-8 * size.norm()) << i;
  }
  EXPECT_LE((shapes.transpose() * mass * shapes - Matrix::Identity(shapes.cols(), shapes.cols())).cwiseAbs().maxCoeff(), 1e-8);
}

TEST(ModesOfMany, RepeatedAndRigidOnesInClosedForm) {
  const double k = 3e6, m = 20;
  const int n = 41, count = 20;
  for (const int copies : {1, 3})
    for (const bool held : {true, false}) {
      std::vector<double> exact;  // w
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
          const auto part = [&](int q) { return held ? std::sin((q + 1) * pi / (2 * (n + 1))) : std::sin(q * pi / (2 * n)); };
          for (int copy = 0; copy < copies; ++copy) exact.push_back(2 * std::sqrt(k / m) * std::hypot(part(i), part(j)));
        }
      std::sort(exact.begin(), exact.end());
      const Sparse stiffness = nets(n, copies, k, held), mass = equal_masses(stiffness.rows(), m);
      const std::vector<Mode> found = modes(stiffness, mass, count);
      ASSERT_EQ(found.size(), static_cast<std::size_t>(count));
      for (int i = 0; i < count; ++i) {
        const double w = exact[static_cast<std::size_t>(i)], value = 2 * pi * found[static_cast<std::size_t>(i)].frequency;
        if (!held && i < copies)
          EXPECT_EQ(value, 0) << i;
        else
          EXPECT_NEAR(value, w, 1e-9 * w) << i << " " << copies << held;
      }
      expect_modes(stiffness, mass, found);
    }
}

TEST(ModesOfMany, BarOfManyElements) {
  // consistent mass, both ends free or one held: w of the discrete bar, c sqrt(6 (1 - cos) / (2 + cos)) / h
  const int n = 20000, count = 20;
  const double h = 100.0 / n, c = 3000, area_density = 2500;
  for (const bool held : {true, false}) {
    std::vector<Triplet> k, m;
    for (int e = 0; e < n; ++e)
      for (int i = 0; i < 2; ++i)
        for (int j = 0; j < 2; ++j) {
          const int row = e + i - (held ? 1 : 0), column = e + j - (held ? 1 : 0);
          if (row < 0 || column < 0) continue;
          k.emplace_back(row, column, (i == j ? 1 : -1) * area_density * c * c / h);
          m.emplace_back(row, column, (i == j ? 2 : 1) * area_density * h / 6);
        }
    const Index size = n + (held ? 0 : 1);
    Sparse stiffness(size, size), mass(size, size);
    stiffness.setFromTriplets(k.begin(), k.end());
    mass.setFromTriplets(m.begin(), m.end());
    const std::vector<Mode> found = modes(stiffness, mass, count);
    ASSERT_EQ(found.size(), static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i) {
      const double angle = (held ? i + 0.5 : i) * pi / n;
      const double sine = std::sin(angle / 2);  // 1 - cos = 2 sine^2, without its cancellation
      const double w = c / h * std::sqrt(12 * sine * sine / (3 - 2 * sine * sine));
      EXPECT_NEAR(2 * pi * found[static_cast<std::size_t>(i)].frequency, w, 1e-6 * w) << i << held;
      if (!held && i == 0) {
        EXPECT_EQ(found[0].frequency, 0);
      }
    }
  }
}

TEST(ModesOfMany, BlockOnSoilAsTheDenseSolution) {
  // the interface is open: the block floats with three rigid motions
  for (const auto kind : {SolidSection::Mass::consistent, SolidSection::Mass::lumped}) {
    TwoBoxesPlan plan;
    plan.soil = {16, 0, 16};
    plan.mass = kind;
    const TwoBoxes boxes = two_boxes(plan);
    ASSERT_GT(boxes.mass.rows(), 500);  // Lanczos
    const int count = 12;
    const std::vector<Mode> found = modes(boxes.stiffness, boxes.mass, count);
    const Vibration dense = vibration(Matrix(boxes.stiffness), Matrix(boxes.mass), count);
    ASSERT_EQ(found.size(), static_cast<std::size_t>(count));
    for (int i = 0; i < count; ++i) {
      const double w = 2 * pi * found[static_cast<std::size_t>(i)].frequency, exact = std::sqrt(dense.omega_squared[i]);
      EXPECT_NEAR(w, exact, 1e-9 * exact) << i;
      EXPECT_EQ(w == 0, i < 3);
    }
    expect_modes(boxes.stiffness, boxes.mass, found);
    // the soil does not move in a rigid motion of the block: true zeros, not 1e-17
    const Index soil = 2 * 17 * 16;
    EXPECT_EQ(found[0].shape.head(soil).cwiseAbs().maxCoeff(), 0);
  }
}

TEST(ModesOfMany, FewMassesOnAManyTimesLongerChain) {
  // masses m every 1000 links: springs k/1000 between them
  const int links = 1000, masses = 5;
  const double k = 4e9, m = 300;
  std::vector<Triplet> entries;
  const int n = links * masses;
  for (int i = 0; i < n; ++i) {
    entries.emplace_back(i, i, k);
    if (i > 0) entries.emplace_back(i - 1, i - 1, k), entries.emplace_back(i, i - 1, -k), entries.emplace_back(i - 1, i, -k);
  }
  Sparse stiffness(n, n), mass(n, n);
  stiffness.setFromTriplets(entries.begin(), entries.end());
  for (int i = 1; i <= masses; ++i) mass.insert(i * links - 1, i * links - 1) = m;
  const std::vector<Mode> found = modes(stiffness, mass, 20);
  ASSERT_EQ(found.size(), static_cast<std::size_t>(masses));
  for (int i = 0; i < masses; ++i) {
    const double w = 2 * std::sqrt(k / links / m) * std::sin((2 * i + 1) * pi / (2 * (2 * masses + 1)));
    EXPECT_NEAR(2 * pi * found[static_cast<std::size_t>(i)].frequency, w, 1e-8 * w);
  }
}

/// A free chain of two masses, and a third one whose stiffness is what round-off has left of terms as large as theirs: two rigid motions
/// and w^2 = 2 k/m, wherever round-off puts the first guess of the shift.
TEST(Modes, OfAFreeStructureWithRoundOffOnADiagonal) {
  constexpr double k = 1e10;
  for (const double left : {0.0, 1e-9, 1e-7, 1e-5}) {
    Matrix stiffness = Matrix::Zero(3, 3);
    stiffness.topLeftCorner(2, 2) << k, -k, -k, k;
    stiffness(2, 2) = left;
    const Vibration found = vibration(stiffness, Matrix::Identity(3, 3), 3);
    ASSERT_EQ(found.omega_squared.size(), 3) << left;
    EXPECT_LT(found.omega_squared[0], 1e-6 * k) << left;
    EXPECT_LT(found.omega_squared[1], 1e-6 * k) << left;
    EXPECT_NEAR(found.omega_squared[2], 2 * k, 1e-6 * k) << left;
  }
}

}  // namespace
}  // namespace uplift::modes_test
