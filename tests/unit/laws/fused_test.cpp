#include "uplift/laws/fused.h"

#include <gtest/gtest.h>

#include <random>

#include "unit/contact/contact_support.h"
#include "unit/laws/laws_support.h"
#include "uplift/contact/newton/newton.h"

// The pass that makes an iteration of Newton's method, against the separate passes over the same points; and steps solved with it and
// without it.
namespace uplift::law_test::fused_test {
namespace {

struct Named {
  std::string name;
  std::shared_ptr<const InterfaceLaw> law;
};

std::vector<Named> swept_laws() {
  return {{"springs", make_law("springs", {{"K_n", 2e8}})},
          {"sdm", make_law("sdm", {{"K_n", 2e8}, {"F_u", 1e4}, {"G_f", 10.0}, {"F_c", -1e3}})},
          {"sdm without strength", make_law("sdm", {{"K_n", 2e8}, {"F_u", 0.0}, {"G_f", 10.0}, {"F_c", -1e4}})}};
}

/// What one pass is asked, and all that it makes.
struct Asked {
  Index n, r;
  Vector z, free, from, old, area, opening, force, slope, now, end, next, pull, end_pull;
  Matrix factor, stiffness;
  double stored = 0;
  FusedEvaluation evaluation;

  Asked(Index points, Index columns, Index memory, std::mt19937& engine) : n(points), r(columns) {
    std::uniform_real_distribution<double> uniform(-1, 1);
    const auto random = [&](Index size, double scale) {
      return Vector(Vector::NullaryExpr(size, [&] { return scale * uniform(engine); }));
    };
    z = random(r, 1e-2);
    factor = Matrix::NullaryExpr(n, r, [&] { return 1e-3 * uniform(engine); });
    from = random(n, 5e-5);
    free = from + random(n, 2e-5);
    old = random(n * memory, 4e-5).cwiseMax(0);
    area = random(n, 0.5).array() + 0.6;
    for (Vector* v : {&opening, &force, &slope, &end, &next}) v->setConstant(n, 7);
    now.setConstant(n * memory, 7);
    pull.setZero(r), end_pull.setZero(r), stiffness.setZero(r, r);
    evaluation = {.points = n,
                  .columns = r,
                  .z = z.data(),
                  .factor = factor.data(),
                  .stride = n,
                  .free = free.data(),
                  .from = from.data(),
                  .old = old.data(),
                  .area = area.data(),
                  .scale = 2,
                  .opening = opening.data(),
                  .force = force.data(),
                  .slope = slope.data(),
                  .now = now.data(),
                  .end = end.data(),
                  .next = next.data(),
                  .pull = pull.data(),
                  .stiffness = stiffness.data(),
                  .end_pull = end_pull.data(),
                  .stored = &stored};
  }
};

void near(const Vector& a, const Vector& b, const std::string& what) {
  EXPECT_LE((a - b).lpNorm<Eigen::Infinity>(), 2e-13 * (b.lpNorm<Eigen::Infinity>() + 1e-300)) << what;
}

// Claim: one pass gives what the law's mean and energy, the openings and the sums give one after another, for any number of points; and it
// refuses wherever the memory changes.
TEST(FusedEvaluation, EqualsTheSeparatePasses) {
  std::mt19937 engine(5);
  for (const Named& law : swept_laws()) {
    int made = 0, changed = 0;
    for (int draw = 0; draw < 40; ++draw)
      for (const Index n : {1, 2, 7, 8, 9, 16, 39, 40, 41, 130})
        for (const Index r : {1, 2, 3}) {
          Asked asked(n, r, law.law->num_history(1), engine);
          if (draw % 2 == 0) asked.old.array() += 1e-3;  // jumps that nobody reaches: the memory stays
          const bool done = law.law->fused(asked.evaluation);
          const Vector opening = asked.free + asked.factor * asked.z;
          const Batch batch{static_cast<int>(n), 1, 0.01};
          Vector mean(n), slope(n), end(n), next(n), now(asked.old.size()), density(n);
          law.law->mean(batch, asked.from.data(), opening.data(), asked.old.data(),
                        {mean.data(), slope.data(), now.data(), end.data(), next.data()});
          if (now != asked.old) {
            ++changed;
            EXPECT_FALSE(done) << law.name << ": a memory changed";
          }
          if (!done) continue;
          ++made;
          law.law->energy(batch, opening.data(), now.data(), density.data(), nullptr);
          const Vector weight = 2 * asked.area, force = weight.cwiseProduct(mean), stiff = weight.cwiseProduct(slope);
          const std::string what = law.name + ", " + std::to_string(n) + " points, " + std::to_string(r) + " columns";
          near(asked.opening, opening, what + ": opening");
          near(asked.force, force, what + ": force");
          near(asked.slope, stiff, what + ": slope");
          near(asked.end, end, what + ": end");
          near(asked.next, next, what + ": next");
          EXPECT_EQ(asked.now, now) << what;
          const double size = asked.factor.lpNorm<Eigen::Infinity>() * static_cast<double>(n);
          EXPECT_LE((asked.pull - asked.factor.transpose() * force).norm(), 1e-12 * size * force.norm()) << what;
          EXPECT_LE((asked.end_pull - asked.factor.transpose() * weight.cwiseProduct(end)).norm(), 1e-12 * size * force.norm()) << what;
          EXPECT_LE((asked.stiffness - asked.factor.transpose() * stiff.asDiagonal() * asked.factor).norm(),
                    1e-12 * size * size * stiff.norm())
              << what;
          EXPECT_NEAR(asked.stored, density.dot(asked.area), 1e-12 * (density.cwiseAbs().dot(asked.area) + std::abs(mean.dot(opening))))
              << what;
        }
    EXPECT_GT(made, 500) << law.name;
    if (law.name != "springs") EXPECT_GT(changed, 100) << law.name;
  }
}

TEST(FusedEvaluation, IsNotOfferedWhereItDoesNotSuit) {
  std::mt19937 engine(1);
  Asked many(8, 4, 1, engine), few(8, 2, 4, engine);
  for (const Named& law : swept_laws()) EXPECT_FALSE(law.law->fused(many.evaluation)) << law.name;
  EXPECT_FALSE(make_law("springs", {{"K_n", 2e8}, {"c", 1e5}})->fused(few.evaluation));
  EXPECT_FALSE(make_law("exponential", {{"K_n", 1e9}, {"F_u", 1e4}, {"G_f", 10.0}})->fused(few.evaluation));
}

// Claim: a path of steps is the same with the passes (the problem says how the opening comes about, as condensed steps do) and by the
// general method, through opening, softening and closing.
TEST(FusedEvaluation, StepsAreThoseOfTheGeneralMethod) {
  for (const Named& law : swept_laws())
    for (const Index n : {5, 40}) {
      contact_test::Own own;
      Block& block =
          own.add("joint", static_cast<int>(n), 1, std::vector<double>(static_cast<std::size_t>(n), 3.0 / static_cast<double>(n)));
      block.law = law.law.get();
      Matrix factor(n, 2);
      for (Index i = 0; i < n; ++i) factor.row(i) << 1e-5, 1e-5 * (2 * static_cast<double>(i) / static_cast<double>(n - 1) - 1);
      own.set(factor, Vector::Zero(n));
      own.change().average = true;
      own.change().scale = 2;
      own.problem.old.setZero(law.law->num_history(1) * n);
      InterfaceProblem plain = own.problem;
      InterfaceSolution swept, general;
      NewtonWork swept_work, general_work;
      int passes = 0;
      for (int step = 0; step < 400; ++step) {
        const double phase = 0.05 * step;
        const Vector way = (Vector(2) << 0.3 * std::sin(2 * phase) - 0.5, std::sin(phase)).finished();
        own.problem.free_opening_increment = way;
        own.problem.free_opening = plain.free_opening = own.problem.from + factor * way;
        const Outcome one = solve_by_newton(own.problem, {}, {}, swept_work, swept),
                      other = solve_by_newton(plain, {}, {}, general_work, general);
        ASSERT_TRUE(one.converged) << law.name << ", step " << step << ": " << one.why;
        ASSERT_TRUE(other.converged) << law.name << ", step " << step << ": " << other.why;
        ASSERT_LE((swept.z - general.z).norm(), 1e-9 * (1 + general.z.norm())) << law.name << ", step " << step;
        // where nearly all is open, round-off of the openings is much of the little force that is left, in either
        ASSERT_LE(contact_residual(own.problem, swept), 1e-11 + 3 * contact_residual(plain, general)) << law.name << ", step " << step;
        passes += swept.fused ? 1 : 0;
        EXPECT_FALSE(general.fused);
        own.problem.from = plain.from = general.opening;
        own.problem.old = plain.old = general.now;
      }
      EXPECT_GT(passes, 200) << law.name;
    }
}

}  // namespace
}  // namespace uplift::law_test::fused_test
