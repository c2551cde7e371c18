// The trial of every factor: lost digits are noted, a wrong factor is refused.
#include <gtest/gtest.h>

#include <cmath>

#include "unit/linear/local_solvers.h"
#include "uplift/base/declare.h"
#include "uplift/dynamics/bulk.h"

namespace uplift::residual_test {
namespace {

/// A chain to ground: every other spring is `contrast` times as stiff as its neighbours.
Sparse chain(int n, double contrast) {
  std::vector<Triplet> entries;
  for (int i = 0; i < n; ++i) {
    const double k = i % 2 == 0 ? 1e4 : 1e4 * contrast;  // below unknown i
    entries.emplace_back(i, i, k);
    if (i > 0) entries.emplace_back(i - 1, i - 1, k), entries.emplace_back(i, i - 1, -k), entries.emplace_back(i - 1, i, -k);
  }
  Sparse a(n, n);
  a.setFromTriplets(entries.begin(), entries.end());
  return a;
}

LinearCounts tried(const Sparse& matrix, const LinearSolver& solver, std::string& why) {
  LinearCounts counts;
  const BulkFactor factor(matrix, nullptr, matrix.rows() <= small_bulk, solver, Model(), counts);
  why = factor.why();
  EXPECT_EQ(counts.back_solves, 0);  // the trial is not one of the run's
  return counts;
}

TEST(Residual, ContrastsThatCostDigitsAreNoted) {
  for (const Entry<LinearSolver>* entry : local_solvers()) {
    const auto solver = entry->make(Values());
    for (const int n : {10, 90}) {  // the kept inverse, and back-solves
      std::string why;
      const LinearCounts mild = tried(chain(n, 1e3), *solver, why), hard = tried(chain(n, 1e12), *solver, why);
      EXPECT_EQ(why, "") << entry->name;
      EXPECT_LE(mild.residual, 1e-9) << entry->name;
      EXPECT_EQ(mild.notice, "") << entry->name;
      // the soft spring's share of the product of a stiff one has 16 - 12 digits
      EXPECT_GT(hard.residual, 1e-9) << entry->name;
      EXPECT_LT(hard.residual, 1) << entry->name;
      EXPECT_TRUE(hard.notice.starts_with("back-solves meet their equations to ")) << entry->name << hard.notice;

      // other units of some unknowns are no contrast
      Vector units = Vector::Ones(n);
      for (Index i = 0; i < n; i += 3) units[i] = 1e6;
      EXPECT_EQ(tried(Sparse(units.asDiagonal() * chain(n, 1e3) * units.asDiagonal()), *solver, why).notice, "") << entry->name;
    }
  }
}

/// A solver whose answers are wrong in one unknown.
class Wrong : public LinearSolver {
 public:
  explicit Wrong(double error) : error_(error) {}
  Factorisation factorise(const Sparse& a) const override {
    struct Off : Factor {
      Off(std::unique_ptr<const Factor> right, double by) : factor(std::move(right)), error(by) {}
      void solve(const Matrix& b, Matrix& x) const override {
        factor->solve(b, x);
        x.row(x.rows() / 2) *= 1 + error;
      }
      double nonzeros() const override { return factor->nonzeros(); }
      std::unique_ptr<const Factor> factor;
      double error;
    };
    return {
        .factor = std::make_unique<Off>(solver_catalog()[0]->make(Values())->factorise(a).factor, error_), .failed_unknown = -1, .why = {}};
  }

 private:
  double error_;
};

TEST(Residual, WrongFactorIsRefused) {
  std::string why;
  EXPECT_EQ(tried(chain(90, 10), Wrong(0), why).notice, "");
  EXPECT_EQ(why, "");
  const LinearCounts little = tried(chain(90, 10), Wrong(1e-11), why);
  EXPECT_EQ(why, "");
  EXPECT_NE(little.notice, "");
  tried(chain(90, 10), Wrong(1e-3), why);
  EXPECT_NE(why, "");
  tried(chain(90, 10), Wrong(std::nan("")), why);
  EXPECT_NE(why, "");
}

}  // namespace
}  // namespace uplift::residual_test
