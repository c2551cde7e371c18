#include <cmath>
#include <memory>
#include <utility>

#include "property/oracle_models.h"
#include "unit/contact/contact_support.h"
#include "uplift/contact/law_force.h"

// A method that knows no other one: what a run needs of a path-averaging method are its results alone, and its work space stays its own.
namespace uplift::contact_test::own_method_test {
namespace {

/// Repeats z = -C^T p(opening), which contracts where the joint is soft compared with the compliance of the step.
class Repetition final : public ContactMethod {
 public:
  std::unique_ptr<MethodWork> make_work() const override { return std::make_unique<Work>(); }
  bool constrains() const override { return false; }
  Outcome solve(const InterfaceProblem& problem, MethodWork& kept, InterfaceSolution& solution) const override {
    Work& work = static_cast<Work&>(kept);
    size(problem, work, solution);
    Outcome outcome;
    for (outcome.iterations = 1; outcome.iterations <= 100; ++outcome.iterations) {
      respond(problem, work, solution);
      work.change = -problem.model->factor.transpose() * solution.force - solution.z;
      solution.z += work.change;
      outcome.converged = work.change.norm() <= 1e-14 * solution.z.norm();
      if (outcome.converged) return outcome;
    }
    outcome.why = "the repetition did not converge";
    return outcome;
  }

 private:
  struct Work final : MethodWork {
    Vector slope, change;
  };

  static void size(const InterfaceProblem& problem, Work& work, InterfaceSolution& solution) {
    const Index rows = problem.rows();
    int slopes = 0;
    for (const Block& block : problem.model->blocks) slopes += block.slopes();
    if (solution.z.size() != problem.model->factor.cols()) solution.z.setZero(problem.model->factor.cols());
    for (Vector* v : {&solution.opening, &solution.force, &solution.end_traction, &solution.plain}) v->resize(rows);
    for (Vector* v : {&solution.next_slope, &work.slope}) v->resize(slopes);
    solution.now.resize(problem.old.size());
  }

  static void respond(const InterfaceProblem& problem, Work& work, InterfaceSolution& solution) {
    solution.opening = problem.free_opening + problem.model->factor * solution.z;
    int first_slope = 0;
    for (const Block& block : problem.model->blocks) {
      LawResponse response{solution.force.data() + block.first, work.slope.data() + first_slope, solution.now.data() + block.first_history};
      if (problem.model->average) {
        response.end = solution.end_traction.data() + block.first;
        response.next = solution.next_slope.data() + first_slope;
      }
      if (problem.filter.acts()) response.plain = solution.plain.data() + block.first;
      law_force(problem, block, solution.opening.data(), response);
      first_slope += block.slopes();
    }
  }
};

// Claim: a run with this method is the run with Newton's, path-averaged with and without the filters of energy decay, and without the
// average; uplift and softening occur.
TEST(OwnMethod, RunsAsNewtonDoes) {
  const whole::Part springs{"springs", {{"K_n", 2e8}}},
      sdm{"sdm", {{"K_n", 2e8}, {"F_u", 2e4}, {"G_f", 20.0}, {"F_c", -1e3}, {"tangential", std::string("none")}}};
  for (const whole::Part& law : {springs, sdm})
    for (const std::string rule : {"average_acceleration", "energy_decay", "hht"}) {
      RunResult results[2];
      for (const int k : {0, 1}) {
        whole::Oscillator data;
        data.behaviour = law;
        data.damping = 0.02;
        whole::Whole whole = make(data);
        choose(whole, {"newton"}, {"none"});
        if (k == 1) whole.plan.method = std::make_unique<const Repetition>();
        watch_all(whole);
        whole.plan.created_limit = 1e30;
        whole.plan.stages = {whole::march(1e-3, 400, true, {rule})};
        results[k] = whole.run();
        ASSERT_EQ(results[k].status, RunStatus::completed) << law.type << ", " << rule << ": " << results[k].reason;
      }
      EXPECT_GT(results[0].max_uplifted_ratio.value, 0.2) << law.type << ", " << rule;
      for (std::size_t column = 1; column < results[0].table.size(); ++column) {
        const std::vector<double>&newton = results[0].table[column], &own = results[1].table[column];
        if (results[0].columns[column - 1].kind == Request::Kind::residual) continue;  // round-off
        ASSERT_EQ(newton.size(), own.size());
        double size = 0, difference = 0;
        for (std::size_t i = 0; i < newton.size(); ++i) {
          size = std::max(size, std::abs(newton[i]));
          difference = std::max(difference, std::abs(newton[i] - own[i]));
        }
        EXPECT_LE(difference, 1e-8 * size) << law.type << ", " << rule << ", column " << results[0].columns[column - 1].name;
      }
    }
}

// Claim: every model has a version of its own, copies too, also where a new model stands in the place of an old one.
TEST(ContactModel, HasAVersionOfItsOwn) {
  SeenModel seen;
  ContactModel one;
  EXPECT_FALSE(seen.is(one));
  seen.take(one);
  EXPECT_TRUE(seen.is(one));
  const ContactModel copy = one;
  EXPECT_FALSE(seen.is(copy));
  ContactModel moved = std::move(one);
  EXPECT_TRUE(seen.is(moved));
  moved = copy;
  EXPECT_FALSE(seen.is(moved) || seen.is(copy));
  seen.take(moved);
  auto place = std::make_unique<ContactModel>();
  for (int round = 0; round < 100; ++round) {
    seen.take(*place);
    place.reset();
    place = std::make_unique<ContactModel>();  // often in the same memory
    ASSERT_FALSE(seen.is(*place));
  }
}

}  // namespace
}  // namespace uplift::contact_test::own_method_test
