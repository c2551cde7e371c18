#include "uplift/contact/kernel/kernel.h"

#include <limits>

#include "unit/contact/contact_support.h"

// The small quadratic problem of contact and impact: rank, sets, fallback.
namespace uplift::contact_test::kernel_test {
namespace {

struct Solved {
  KernelReply reply;
  Vector held, z, opening, force;
};
using Solver = KernelReply (*)(const Rows&, double*, double*, double*, double*, KernelScratch&);
Solved solve(Solver solver, const Matrix& c, const Vector& target, const Vector& limit, const Vector* fixed = nullptr, Vector held = {}) {
  Solved s;
  s.held = held.size() > 0 ? held : Vector::Zero(c.rows());
  s.z.setZero(c.cols());
  s.opening.setZero(c.rows());
  s.force.setZero(c.rows());
  KernelScratch scratch;
  const Rows rows{c.rows(), c.cols(), c.rows(), c.data(), target.data(), limit.data(), fixed != nullptr ? fixed->data() : nullptr};
  s.reply = solver(rows, s.held.data(), s.z.data(), s.opening.data(), s.force.data(), scratch);
  return s;
}

// Moore and Penrose's four conditions, for every rank, scaled over twelve decades.
template <int R>
void check_pseudo_inverse(const Matrix& a, int rank) {
  for (const double scale : {1e-6, 1.0, 1e6}) {
    const Matrix g = scale * a.transpose() * a;
    double packed[6], inverse[6];
    int entry = 0;
    for (int s = 0; s < R; ++s)
      for (int r = s; r < R; ++r) packed[entry++] = g(r, s);
    EXPECT_EQ(pseudo_inverse<R>(packed, inverse), rank);
    Matrix x(R, R);
    entry = 0;
    for (int s = 0; s < R; ++s)
      for (int r = s; r < R; ++r) x(r, s) = x(s, r) = inverse[entry++];
    const double size = g.norm(), back = x.norm();
    EXPECT_LE((g * x * g - g).norm(), 1e-12 * size);
    EXPECT_LE((x * g * x - x).norm(), 1e-12 * back);
    EXPECT_LE((g * x - (g * x).transpose()).norm(), 1e-12 * size * back);
  }
}
TEST(Kernel, pseudo_inverse_of_every_rank) {
  const Matrix rows = (Matrix(4, 3) << 1, 2, -1, 0.5, -1, 3, 2, 0.1, 1, -1, 1, 1).finished();
  check_pseudo_inverse<3>(rows, 3);
  for (int hidden = 0; hidden < 3; ++hidden) {  // one column made of the others, in every position
    Matrix c = rows;
    c.col(hidden) = 0.3 * rows.col((hidden + 1) % 3) - 2 * rows.col((hidden + 2) % 3);
    check_pseudo_inverse<3>(c, 2);
    Matrix line = Matrix::Zero(4, 3);
    line.col(hidden) = rows.col(0);
    check_pseudo_inverse<3>(line, 1);
  }
  check_pseudo_inverse<3>(rows.col(0) * rows.row(1), 1);
  check_pseudo_inverse<3>(Matrix::Zero(2, 3), 0);
  check_pseudo_inverse<2>(rows.leftCols(2), 2);
  check_pseudo_inverse<2>(rows.col(0) * rows.row(1).leftCols(2), 1);
  check_pseudo_inverse<2>(Matrix::Zero(2, 2), 0);
  check_pseudo_inverse<1>(rows.leftCols(1), 1);
  check_pseudo_inverse<1>(Matrix::Zero(2, 1), 0);
}

// The three solvers give one answer: minimum z, forces of least norm. Rank of the rows 2, in two, three and five coordinates.
TEST(Kernel, three_solvers_agree_on_redundant_rows) {
  const Footing base = footing(21, 2.0);
  for (const int r : {2, 3, 5}) {
    Matrix turn = Matrix::Zero(2, r);
    for (int k = 0; k < r; ++k) turn(0, k) = 1e-4 * std::cos(1.0 + k), turn(1, k) = 7e-5 * std::sin(2.0 + 3 * k);
    const Matrix c = base.b * turn;
    const Vector area = ConstMap(base.area.data(), 21);
    for (const double slope : {0.0, 3e-4, 8e-4, 2e-3}) {
      const Vector target = base.b * (Vector(2) << -1e-3, slope).finished();
      const Solved exact = solve(dual_active_set, c, target, area);
      ASSERT_TRUE(exact.reply.solved());
      EXPECT_LE((exact.z + c.transpose() * exact.force).norm(), 1e-12 * exact.z.norm());
      EXPECT_GE(exact.opening.minCoeff(), -1e-12);
      EXPECT_LE(exact.force.maxCoeff(), 0);
      const Solved general = solve(general_active_set, c, target, area);
      ASSERT_TRUE(general.reply.solved());
      EXPECT_LE((general.z - exact.z).norm(), 1e-10 * exact.z.norm());
      EXPECT_LE((general.force - exact.force).norm(), 1e-8 * exact.force.norm());
      if (r > 3) continue;
      const Solved small = solve(small_active_set, c, target, area);
      ASSERT_TRUE(small.reply.solved());
      EXPECT_LE((small.z - exact.z).norm(), 1e-10 * exact.z.norm());
      EXPECT_LE((small.force - exact.force).norm(), 1e-8 * exact.force.norm());
    }
  }
}

// Rows held both ways beside rows that may open: KKT conditions written out.
TEST(Kernel, fixed_rows) {
  const Matrix c = (Matrix(3, 3) << 1, 0.2, 0.1, 0.1, 1, 0.3, -0.2, 0.1, 1).finished();
  const Vector target = (Vector(3) << 0.5, -1.0, 0.4).finished(), limit = (Vector(3) << 0, 1, 1).finished(),
               fixed = (Vector(3) << 1, 0, 0).finished();
  for (const Solver solver : {&solve_rows, &dual_active_set}) {
    const Solved s = solve(solver, c, target, limit, &fixed);
    ASSERT_TRUE(s.reply.solved());
    EXPECT_NEAR(s.opening[0], 0, 1e-12);
    EXPECT_NEAR(s.opening[1], 0, 1e-12);
    EXPECT_GT(s.opening[2], 0);
    EXPECT_GT(s.force[0], 0);  // pulls: it is held both ways
    EXPECT_LT(s.force[1], 0);
    EXPECT_EQ(s.force[2], 0);
    EXPECT_LE((s.z + c.transpose() * s.force).norm(), 1e-14);
  }
}

TEST(Kernel, contradictions_and_not_finite) {
  const Vector two = Vector::Ones(2);
  const Matrix opposed = (Matrix(2, 1) << 1, -1).finished();
  const Solved clamped = solve(solve_rows, opposed, (Vector(2) << -1.0, -1.0).finished(), two);
  EXPECT_EQ(clamped.reply.end, KernelEnd::inconsistent);
  EXPECT_GE(clamped.reply.worst, 0);
  const Solved just = solve(solve_rows, opposed, (Vector(2) << -1.0, 1.0).finished(), two);  // the slot is exactly as wide as the body
  EXPECT_TRUE(just.reply.solved());
  EXPECT_NEAR(just.z[0], 1, 1e-12);
  const Solved nothing = solve(solve_rows, Matrix::Zero(2, 1), (Vector(2) << 1.0, -1.0).finished(), two);
  EXPECT_EQ(nothing.reply.end, KernelEnd::inconsistent);
  EXPECT_EQ(nothing.reply.worst, 1);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const int columns : {1, 5})
    EXPECT_EQ(solve(solve_rows, Matrix::Ones(2, columns), (Vector(2) << nan, -1.0).finished(), two).reply.end, KernelEnd::not_finite);
  // two fixed rows that ask for different things
  const Vector none = Vector::Zero(2);
  EXPECT_EQ(solve(solve_rows, Matrix::Ones(2, 1), (Vector(2) << 1.0, 2.0).finished(), none, &two).reply.end, KernelEnd::inconsistent);
}

TEST(Kernel, nothing_to_move) {
  const Vector one = Vector::Ones(1);
  EXPECT_TRUE(solve(solve_rows, Matrix(1, 0), Vector::Constant(1, 0.2), one).reply.solved());
  EXPECT_EQ(solve(solve_rows, Matrix(1, 0), Vector::Constant(1, -0.2), one).reply.end, KernelEnd::inconsistent);
  for (const int columns : {0, 2, 7}) {
    const Solved empty = solve(solve_rows, Matrix(0, columns), Vector(0), Vector(0));
    EXPECT_TRUE(empty.reply.solved());
    EXPECT_EQ(empty.z.norm(), 0);
  }
}

// A set that is noted twice is recognised, and no more than 64 are kept.
TEST(Kernel, visited_sets) {
  Visited visited;
  Vector held = Vector::Zero(70);
  EXPECT_TRUE(visited.note(70, held.data()));
  EXPECT_FALSE(visited.note(70, held.data()));
  for (int i = 0; i < 63; ++i) {
    held[i] = 0.5;
    EXPECT_TRUE(visited.note(70, held.data())) << i;
  }
  held[65] = 0.5;
  EXPECT_FALSE(visited.note(70, held.data()));
}

}  // namespace
}  // namespace uplift::contact_test::kernel_test
