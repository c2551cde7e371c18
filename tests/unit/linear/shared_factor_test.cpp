// One factor of the bulk, used by several threads at the same time: each has work of its own, and gets what one thread alone gets.
#include <gtest/gtest.h>

#include <cmath>
#include <thread>
#include <vector>

#include "uplift/dynamics/bulk.h"

namespace uplift::shared_factor_test {
namespace {

/// Springs along a line of unknowns, with one to ground at every unknown, and a row of B at every tenth.
struct Line {
  Sparse matrix, b;
  explicit Line(int unknowns) : matrix(unknowns, unknowns), b((unknowns + 9) / 10, unknowns) {
    std::vector<Triplet> entries, rows;
    for (int i = 0; i < unknowns; ++i) {
      entries.emplace_back(i, i, 2.01 + 0.1 * std::sin(i));
      if (i > 0) entries.emplace_back(i, i - 1, -1.0), entries.emplace_back(i - 1, i, -1.0);
      if (i > 6) entries.emplace_back(i, i - 7, -1e-3), entries.emplace_back(i - 7, i, -1e-3);
      if (i % 10 == 0) rows.emplace_back(i / 10, i, 1.0);
    }
    matrix.setFromTriplets(entries.begin(), entries.end());
    b.setFromTriplets(rows.begin(), rows.end());
  }
};

/// Solutions of a row of loads, one after another.
std::vector<Vector> solutions(const BulkFactor& factor, int unknowns, LinearCounts& counts) {
  BulkWork work(counts);
  std::vector<Vector> all;
  Vector load(unknowns), x(unknowns);
  for (int k = 0; k < 300; ++k) {
    for (int i = 0; i < unknowns; ++i) load[i] = std::sin(0.7 * (k + 1) * (i + 1));
    factor.solve(load, x, work);
    all.push_back(x);
  }
  return all;
}

TEST(SharedFactor, ThreadsGetWhatOneThreadGets) {
  const auto solver = solver_catalog()[0]->make(Values());
  for (const int unknowns : {20, 900})
    for (const bool split : {false, true}) {
      const Line line(unknowns);
      LinearCounts made;
      const BulkFactor factor(line.matrix, split ? &line.b : nullptr, unknowns <= small_bulk, *solver, Model(), made);
      ASSERT_TRUE(factor.ok()) << factor.why();
      EXPECT_EQ(factor.split() != nullptr, split && unknowns > small_bulk);
      LinearCounts alone, first, second;
      const std::vector<Vector> expected = solutions(factor, unknowns, alone);
      std::vector<Vector> one, two;
      std::thread thread([&] { one = solutions(factor, unknowns, first); });
      two = solutions(factor, unknowns, second);
      thread.join();
      EXPECT_TRUE(one == expected && two == expected) << unknowns << split;
      for (const LinearCounts* counts : {&alone, &first, &second}) EXPECT_EQ(counts->back_solves, unknowns > small_bulk ? 300 : 0);
      Vector load(unknowns);  // and it is the solution
      for (int i = 0; i < unknowns; ++i) load[i] = std::sin(0.7 * 8 * (i + 1));
      EXPECT_LE((line.matrix * expected[7] - load).norm(), 1e-11 * load.norm()) << unknowns;
    }
}

/// The seven-point star on a box of n x n x n unknowns: large enough for nested dissection to draw random numbers.
Sparse star(int n) {
  Sparse matrix(n * n * n, n * n * n);
  std::vector<Triplet> entries;
  const auto at = [n](int i, int j, int k) { return (i * n + j) * n + k; };
  const auto join = [&](int a, int b) { entries.emplace_back(a, b, -1.0), entries.emplace_back(b, a, -1.0); };
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      for (int k = 0; k < n; ++k) {
        entries.emplace_back(at(i, j, k), at(i, j, k), 6.5);
        if (i + 1 < n) join(at(i, j, k), at(i + 1, j, k));
        if (j + 1 < n) join(at(i, j, k), at(i, j + 1, k));
        if (k + 1 < n) join(at(i, j, k), at(i, j, k + 1));
      }
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

// The order of elimination comes from random numbers of the process: threads that analyse at the same time must not mix them.
TEST(SharedFactor, AnalysesSideBySideGiveTheSameBits) {
  const auto solver = solver_catalog()[0]->make(Values());
  const Sparse matrix = star(14);
  const Vector load = Vector::LinSpaced(matrix.rows(), 1, 2);
  const auto solution = [&] {
    LinearCounts counts;
    const BulkFactor factor(matrix, nullptr, false, *solver, Model(), counts);
    BulkWork work(counts);
    Vector x(matrix.rows());
    factor.solve(load, x, work);
    return x;
  };
  const Vector expected = solution();
  std::vector<std::thread> threads;
  std::vector<int> same(3, 0);
  for (int& count : same)
    threads.emplace_back([&count, &solution, &expected] {
      for (int k = 0; k < 15; ++k) count += solution() == expected ? 1 : 0;
    });
  for (std::thread& thread : threads) thread.join();
  for (const int count : same) EXPECT_EQ(count, 15);
}

}  // namespace
}  // namespace uplift::shared_factor_test
