#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <cmath>
#include <limits>
#include <random>

#include "unit/contact/contact_support.h"

// Random interfaces of surfaces, small and large, for every method: an answer that the common residual confirms, or a reason.
namespace uplift::contact_test::contact_many_test {
namespace {

std::unique_ptr<const InterfaceLaw> rubbing(const std::string& type, double stiffness, double friction) {
  auto table = std::make_shared<RawTable>();
  const auto put = [&](const char* key, auto value) { table->entries.emplace_back(key, Raw{value, {}, key}); };
  put("type", type);
  put("K_n", stiffness);
  if (type == "sdm") put("F_u", 1e-4 * stiffness * 1e-2), put("G_f", 1e-4 * stiffness * 1e-4), put("F_c", -1e-6 * stiffness * 1e-2);
  put("tangential", std::string("coulomb"));
  put("K_t", 0.5 * stiffness);
  put("friction", friction);
  return make_part(law_catalog(), check_part(Raw{table, {}, "test"}, interface_behaviours()));
}

struct Draw {
  int points;
  bool rigid;       // six coordinates for all rows: redundant
  double contrast;  // of the compliance of rows
  double friction, load, push;
  unsigned seed;
};

Draw draw_problem() {
  Draw draw;
  const bool large = *rc::gen::inRange(0, 6) == 0;
  draw.points = large ? *rc::gen::inRange(20, 101) : *rc::gen::inRange(1, 12);
  draw.rigid = *rc::gen::arbitrary<bool>();
  draw.contrast = std::pow(10.0, *rc::gen::inRange(0, 7));
  draw.friction = *rc::gen::element(0.0, 0.2, 0.5, 0.9);
  draw.load = *rc::gen::element(0.0, 1.0, -1.0, 1e-6, 100.0);
  draw.push = *rc::gen::element(0.0, 0.1, 1.0, 30.0);
  draw.seed = static_cast<unsigned>(*rc::gen::inRange(0, 1 << 30));
  return draw;
}

/// Rows of a half-space (compliance as 1/distance) between points of a plate, or of a rigid body; lengths of 1e-3 m.
void fill(const Draw& draw, Own& own) {
  std::mt19937 engine(draw.seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const int n = draw.points;
  const Index rows = 3 * n;
  Matrix factor;
  std::vector<double> x(static_cast<std::size_t>(n)), y(x);
  for (int i = 0; i < n; ++i) x[static_cast<std::size_t>(i)] = 10 * uniform(engine), y[static_cast<std::size_t>(i)] = 10 * uniform(engine);
  if (draw.rigid) {
    factor = Matrix::Zero(rows, 6);
    for (int i = 0; i < n; ++i) {
      factor.row(i) << 1, 0, 0, 0, 0, -y[static_cast<std::size_t>(i)];
      factor.row(n + i) << 0, 1, 0, 0, 0, x[static_cast<std::size_t>(i)];
      factor.row(2 * n + i) << 0, 0, 1, y[static_cast<std::size_t>(i)], -x[static_cast<std::size_t>(i)], 0;
    }
    for (Index j = 0; j < 6; ++j) factor.col(j) *= std::pow(draw.contrast, 0.25 * uniform(engine));
  } else {
    Matrix compliance(rows, rows);
    for (Index a = 0; a < rows; ++a)
      for (Index b = 0; b < rows; ++b) {
        const std::size_t i = static_cast<std::size_t>(a % n), j = static_cast<std::size_t>(b % n);
        const double distance = std::hypot(x[i] - x[j], y[i] - y[j]);
        compliance(a, b) = a / n == b / n ? std::exp(-0.3 * distance) : 0.0;
      }
    compliance.diagonal().array() += 0.05;
    Matrix mix = Matrix::NullaryExpr(rows, rows, [&] { return 0.1 * uniform(engine) / std::sqrt(static_cast<double>(rows)); });
    compliance += mix * mix.transpose();
    // stiff and soft ground: rows of one point share their scale
    Vector scale(rows);
    for (int i = 0; i < n; ++i) {
      const double here = std::pow(draw.contrast, 0.25 * uniform(engine));
      for (int c = 0; c < 3; ++c) scale[c * n + i] = here;
    }
    factor = scale.asDiagonal() * Matrix(Cholesky(compliance)->matrixL());
  }
  factor *= 1e-4;
  const Vector shape = Vector::NullaryExpr(factor.cols(), [&] { return uniform(engine); });
  Vector free_opening = draw.push * (factor * shape);
  free_opening.tail(n).array() -= 1e-4 * draw.load;
  own.set(factor, free_opening);
  for (Index i = 0; i < 2 * n; ++i) own.problem.from[i] = 1e-5 * uniform(engine);
}

/// What the residual may be: a point counts as closed when it penetrates by more than 1e-12 m (gap_tolerance), and where the interface
/// moves and pushes by round-off only, relative residuals mean nothing.
double allowed(const InterfaceProblem& problem, const InterfaceSolution& solution) {
  const double moved = (problem.model->factor * solution.z).cwiseAbs().maxCoeff();
  const double pushed = (problem.model->factor * (problem.model->factor.transpose() * solution.force)).cwiseAbs().maxCoeff();
  if (std::max(moved, pushed) <= 1e-13 * problem.free_opening.cwiseAbs().maxCoeff()) return std::numeric_limits<double>::infinity();
  return 1e-7 + 4e-12 / std::max(moved, 1e-300);
}

/// The problem that penalty solves: the law in the place of the cone, with an empty memory.
InterfaceProblem with_penalty(const Own& own, const ContactMethod& penalty, std::unique_ptr<const InterfaceLaw>& law) {
  InterfaceProblem replaced = own.problem;
  auto model = std::make_shared<ContactModel>(*own.problem.model);
  replaced.model = model;
  Block& block = model->blocks.front();
  law = penalty.substitute(*block.cone, flexibility(*model, block));
  block.law = law.get();
  block.cone = nullptr;
  block.first_history = static_cast<int>(replaced.old.size());
  replaced.old.conservativeResizeLike(Vector::Zero(replaced.old.size() + law->num_history(block.batch.components) * block.batch.points));
  return replaced;
}

// Claim: every method ends every problem with an answer whose common residual is small (p, opening and z together satisfy balance, law or
// cone) or with a reason; nothing is "converged" that the residual does not confirm. Penalty is asked for the law that it puts in the
// cone's place. The exact methods solve 95 % of all problems, rigid ones with redundant rows included.
TEST(ManyPoints, every_end_is_honest) {
  int asked = 0, exact = 0, solved = 0;
  const bool honest = rc::check("honest end", [&] {
    const Draw draw = draw_problem();
    for (const std::string name : {"lagrange", "augmented_lagrangian", "penalty", "newton", "sdm"}) {
      Own own;
      const bool law = name == "newton" || name == "sdm";
      if (law) {
        own.laws.push_back(rubbing(name == "sdm" ? "sdm" : "springs", 1e7, draw.friction));
        Block& block = own.add("surface", draw.points, 3, std::vector<double>(static_cast<std::size_t>(draw.points), 1.0));
        block.law = own.laws.back().get();
        own.problem.old.setZero(block.law->num_history(3) * draw.points);
        own.change().average = draw.seed % 2 == 0;
        own.change().scale = own.problem.model->average ? 2 : 1;
      } else {
        own.add_cone("surface", draw.points, 3, draw.friction);
      }
      fill(draw, own);
      InterfaceSolution solution;
      const auto chosen = method(law ? "newton" : name);
      const auto work = chosen->make_work();
      for (int step = 0; step < 3; ++step) {
        const Outcome outcome = chosen->solve(own.problem, *work, solution);
        const bool all = name == "lagrange" || name == "augmented_lagrangian";
        ++asked, exact += all, solved += all && outcome.converged;
        if (!outcome.converged) {
          RC_ASSERT(!outcome.why.empty());
        } else {
          std::unique_ptr<const InterfaceLaw> soft;
          const double residual = contact_residual(name == "penalty" ? with_penalty(own, *chosen, soft) : own.problem, solution);
          if (!(residual <= allowed(own.problem, solution)))
            RC_FAIL(name + " says that it converged, residual " + std::to_string(std::log10(residual)) + ", " +
                    std::to_string(draw.points) + " points, rigid " + std::to_string(draw.rigid) + ", seed " + std::to_string(draw.seed));
        }
        own.problem.free_opening.head(2 * draw.points).array() += 2e-5;  // goes on from there
        own.problem.free_opening.tail(draw.points).array() += 3e-5;
      }
    }
  });
  EXPECT_TRUE(honest);
  EXPECT_GE(solved, exact * 95 / 100) << exact << " problems of " << asked;
}

// Claim: in the plane the path average of Coulomb's shear never has a negative slope, as the mean of a traction that only grows along the
// way. (In space the mean of a traction that turns on the bound may have one.)
TEST(PathAveragedFriction, slope_is_not_negative_in_the_plane) {
  const auto law = rubbing("springs", 1, 0.5);  // K_t = 0.5 Pa/m
  std::mt19937 engine(1);
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::vector<double> old(static_cast<std::size_t>(law->num_history(2))), now(old);
  double least = 0, largest = 0;
  for (int draw = 0; draw < 20000; ++draw) {
    double from[2], to[2], traction[2], end[2], slope[4] = {};
    for (int c = 0; c < 2; ++c) from[c] = uniform(engine), to[c] = from[c] + uniform(engine) * std::pow(10, 1.5 * uniform(engine));
    old[old.size() - 2] = from[0] - 2 * uniform(engine);  // slip, then energy
    LawResponse response;
    response.traction = traction, response.slope = slope, response.now = now.data(), response.end = end;
    law->mean(Batch{1, 2, 0.01}, from, to, old.data(), response);
    least = std::min(least, slope[0]), largest = std::max(largest, slope[0]);
  }
  EXPECT_GE(least, -1e-12);
  EXPECT_GT(largest, 0.2);  // sticking: half of K_t
}

// Claim: in the plane and in space Newton's method solves every problem of such steps up to k F = 10, k the stiffness of the joint and F of
// order 1 the compliance of the step.
TEST(PathAveragedFriction, newton_solves_every_step_of_moderate_stiffness) {
  std::mt19937 engine(7);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (const int components : {2, 3})
    for (const double friction : {0.3, 0.9})
      for (const double stiffness : {0.1, 1.0, 10.0})
        for (int draw = 0; draw < 200; ++draw) {
          const int n = 1 + static_cast<int>(4 * std::abs(uniform(engine)));
          Own own;
          own.laws.push_back(rubbing("springs", stiffness, friction));
          Block& block = own.add("surface", n, components, std::vector<double>(static_cast<std::size_t>(n), 1.0));
          block.law = own.laws.back().get();
          own.problem.old.setZero(block.law->num_history(components) * n);
          const Index rows = n * components;
          const Matrix mix = Matrix::NullaryExpr(rows, rows, [&] { return uniform(engine) / std::sqrt(static_cast<double>(rows)); });
          Matrix compliance = mix * mix.transpose();  // of order 1
          compliance.diagonal().array() += 0.1;
          own.set(Matrix(Cholesky(compliance)->matrixL()),
                  Vector::NullaryExpr(rows, [&] { return uniform(engine) * std::pow(10, uniform(engine)); }));
          own.problem.from = Vector::NullaryExpr(rows, [&] { return 0.3 * uniform(engine); });
          own.change().average = true;
          own.change().scale = 2;
          InterfaceSolution solution;
          const Outcome outcome = method("newton")->solve(own.problem, solution);
          ASSERT_TRUE(outcome.converged) << components << " components, k F " << stiffness << ": " << outcome.why;
          EXPECT_LE(contact_residual(own.problem, solution), 1e-9);
        }
}

// Claim: where rows are independent, the two exact methods give one answer, friction included, over a path of many steps with changes of
// status (moderate friction: Coulomb's problem then has one solution).
TEST(ManyPoints, exact_methods_agree_along_a_path) {
  for (const unsigned seed : {1u, 2u, 3u}) {
    const Draw draw{60, false, 1e2, 0.3, 1.0, 0.5, seed};
    Own own;
    own.add_cone("surface", draw.points, 3, draw.friction);
    fill(draw, own);
    const Vector start = own.problem.free_opening;
    InterfaceSolution first, second;
    const auto lagrange = method("lagrange"), augmented = method("augmented_lagrangian");
    const auto first_work = lagrange->make_work(), second_work = augmented->make_work();
    int changes = 0;
    for (int step = 0; step < 40; ++step) {
      const double phase = 0.15 * step;
      for (int i = 0; i < draw.points; ++i) {
        own.problem.free_opening[i] = start[i] + 6e-5 * std::sin(phase);
        own.problem.free_opening[draw.points + i] = start[draw.points + i] + 4e-5 * std::sin(1.3 * phase);
        own.problem.free_opening[2 * draw.points + i] = start[2 * draw.points + i] + 1.5e-4 * (i % 7) / 7.0 * std::sin(0.7 * phase);
      }
      const std::vector<Status> before = first.status;
      const Outcome one = lagrange->solve(own.problem, *first_work, first), other = augmented->solve(own.problem, *second_work, second);
      ASSERT_TRUE(one.converged) << seed << step << one.why;
      ASSERT_TRUE(other.converged) << seed << step << other.why;
      EXPECT_LE(contact_residual(own.problem, first), 1e-10) << seed << step;
      EXPECT_LE(contact_residual(own.problem, second), 1e-9) << seed << step;
      EXPECT_LE((first.z - second.z).norm(), 1e-6 * first.z.norm()) << seed << step;
      changes += before != first.status;
      own.problem.from = first.opening;
    }
    EXPECT_GT(changes, 10) << seed;
  }
}

}  // namespace
}  // namespace uplift::contact_test::contact_many_test
