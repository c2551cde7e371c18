#include <algorithm>
#include <bit>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>

#include "data_support.h"
#include "text_support.h"
#include "unit/contact/contact_support.h"

// The interface problem as a plain object: the contact_residual, the file, and every method on every stored problem.
namespace uplift::contact_test::problem_test {
namespace {

// ---- the contact_residual ----

/// A spring against a wall (k = 4e6, free penetration 0.04) with any z and force.
double measured(double z, double force, double opening_error = 0) {
  Own own;
  own.add_cone("wall", 1, 1, 0);
  own.set(Matrix::Constant(1, 1, 5e-4), Vector::Constant(1, -0.04));
  InterfaceSolution solution;
  solution.z = Vector::Constant(1, z);
  solution.force = Vector::Constant(1, force);
  solution.opening = Vector::Constant(1, -0.04 + 5e-4 * z + opening_error);
  return contact_residual(own.problem, solution);
}

TEST(ContactResidual, sees_each_kind_of_error) {
  EXPECT_LE(measured(80, -1.6e5), 1e-15);                                           // the solution
  EXPECT_NEAR(measured(80, -1.6e5 * 1.01), 80 * 0.01 / (80 * 2.01), 1e-12);         // balance
  EXPECT_NEAR(measured(40, -8e4), 0.02 / 0.02, 1e-12);                              // balanced, but penetrates by as much as it moved
  EXPECT_NEAR(measured(80 * 1.001, -1.6e5 * 1.001), 4e-5 / (0.04 * 1.001), 1e-12);  // pushes across a gap
  EXPECT_NEAR(measured(-20, 4e4), 5, 1e-12);                                        // pulls, and penetrates by 0.05 having moved 0.01
  EXPECT_NEAR(measured(0, 0), 1, 1e-12);                                            // nothing done: relative to the free penetration
  EXPECT_NEAR(measured(80, -1.6e5, 1e-3), 1e-3 / 0.04, 1e-12);                      // an opening that does not belong to z
  EXPECT_TRUE(std::isinf(measured(std::numeric_limits<double>::quiet_NaN(), 0)));
}

TEST(ContactResidual, friction_bound_and_direction) {
  const double mu = 0.5;
  const auto error = [&](double tangential, double slip) {  // one point, unit scales: p_n = -1, moved 1
    Own own;
    own.add_cone("base", 1, 2, mu);
    own.set(Matrix::Identity(2, 2), (Vector(2) << slip + tangential, -1.0).finished());
    InterfaceSolution solution;
    solution.z = (Vector(2) << -tangential, 1.0).finished();
    solution.force = (Vector(2) << tangential, -1.0).finished();
    solution.opening = own.problem.free_opening + solution.z;
    return contact_residual(own.problem, solution);
  };
  EXPECT_LE(error(0.5, 0.3), 1e-15);          // slips at the bound
  EXPECT_LE(error(0.2, 0), 1e-15);            // sticks
  EXPECT_NEAR(error(0.7, 0), 0.2, 1e-12);     // beyond the bound
  EXPECT_NEAR(error(-0.5, 0.3), 0.3, 1e-12);  // pushed along by its own friction
  EXPECT_NEAR(error(0.2, 0.1), 0.1, 1e-12);   // moves inside the cone
}

TEST(ContactResidual, law_blocks_and_shift) {
  Own own;
  own.add_springs("springs", 1, 4e6);
  own.set(Matrix::Constant(1, 1, 5e-4), Vector::Constant(1, -0.02));  // k F = 1: half of the free opening remains
  InterfaceSolution solution;
  solution.z = Vector::Constant(1, 20);
  solution.force = Vector::Constant(1, -4e4);
  solution.opening = Vector::Constant(1, -0.01);
  EXPECT_LE(contact_residual(own.problem, solution), 1e-15);
  own.change().scale = 2;
  EXPECT_NEAR(contact_residual(own.problem, solution), 1, 1e-12);  // |p - 2 k o| / |p|
  own.change().scale = 1;
  own.change().shift = Vector::Constant(1, 1e6);  // z + C (p - D o) = 20 - 20 + 5
  EXPECT_NEAR(contact_residual(own.problem, solution), 5.0 / 40, 1e-12);
}

// ---- the file ----

struct Sample {
  Own own;
  std::vector<Values> values;
  std::vector<const Values*> behaviours;
  Sample() {
    values.push_back(values_of("coulomb", {{"friction", 1.0 / 3}}, interface_behaviours()));
    values.push_back(values_of("sdm", {{"K_n", 1e9}, {"F_u", 1e5}, {"G_f", 100.1}, {"F_c", -2e4}}, interface_behaviours()));
    own.add_cone("base \"quoted\"", 3, 2, 1.0 / 3, {0.1, 0.2, 0.3});
    own.laws.push_back(make_part(law_catalog(), values[1]));
    Block& joint = own.add("joint", 2, 1, {1e-300, 1e300});
    joint.law = own.laws.back().get();
    own.problem.old.resize(joint.law->num_history(1) * 2);
    for (Index i = 0; i < own.problem.old.size(); ++i) own.problem.old[i] = 0.1 / static_cast<double>(3 + i);
    Matrix factor(8, 3);
    for (Index i = 0; i < factor.size(); ++i) factor.data()[i] = std::pow(-1.1, static_cast<double>(i)) * 1e-4 / 3;
    own.set(factor, Vector::LinSpaced(8, -1.0 / 3, 1e-17));
    own.problem.from = Vector::LinSpaced(8, 5e-324, 1.7976931348623157e308);
    own.change().shift = Vector::LinSpaced(8, 0, 1e9 / 7);
    own.change().average = true;
    own.change().scale = 2;
    own.change().step = 1e-3 / 3;
    for (const Values& one : values) behaviours.push_back(&one);
  }
};

void expect_same_bits(const double* a, const double* b, Index n) {
  for (Index i = 0; i < n; ++i) EXPECT_EQ(std::bit_cast<std::uint64_t>(a[i]), std::bit_cast<std::uint64_t>(b[i])) << i;
}

TEST(ProblemFile, round_trip_to_the_last_bit) {
  const Sample sample;
  const InterfaceProblem& problem = sample.own.problem;
  const std::string text = save_problem(problem, sample.behaviours, "a \"reason\"\nin two lines");
  const StoredProblem stored = load_problem(text, "sample.json");
  EXPECT_EQ(stored.reason, "a \"reason\"\nin two lines");
  const InterfaceProblem& back = stored.problem;
  ASSERT_EQ(back.model->blocks.size(), 2u);
  for (std::size_t b = 0; b < 2; ++b) {
    EXPECT_EQ(back.model->blocks[b].name, problem.model->blocks[b].name);
    EXPECT_EQ(back.model->blocks[b].first, problem.model->blocks[b].first);
    EXPECT_EQ(back.model->blocks[b].first_history, problem.model->blocks[b].first_history);
    EXPECT_EQ(back.model->blocks[b].batch.points, problem.model->blocks[b].batch.points);
    EXPECT_EQ(back.model->blocks[b].batch.components, problem.model->blocks[b].batch.components);
    expect_same_bits(back.model->blocks[b].area.data(), problem.model->blocks[b].area.data(), problem.model->blocks[b].area.size());
  }
  EXPECT_EQ(back.model->average, true);
  EXPECT_EQ(back.model->scale, 2);
  EXPECT_EQ(back.model->step, problem.model->step);
  ASSERT_EQ(back.model->factor.rows(), 8);
  ASSERT_EQ(back.model->factor.cols(), 3);
  expect_same_bits(back.model->factor.data(), problem.model->factor.data(), 24);
  expect_same_bits(back.free_opening.data(), problem.free_opening.data(), 8);
  expect_same_bits(back.from.data(), problem.from.data(), 8);
  expect_same_bits(back.model->shift.data(), problem.model->shift.data(), 8);
  ASSERT_EQ(back.old.size(), problem.old.size());
  expect_same_bits(back.old.data(), problem.old.data(), static_cast<Index>(problem.old.size()));
  ASSERT_NE(back.model->blocks[0].cone, nullptr);
  EXPECT_EQ(back.model->blocks[0].cone->friction(), 1.0 / 3);
  ASSERT_NE(back.model->blocks[1].law, nullptr);
  double stiffness = 0;
  back.model->blocks[1].law->closed_stiffness(1, &stiffness);
  EXPECT_EQ(stiffness, 1e9);
}

TEST(ProblemFile, numbers_that_are_not_finite) {
  Sample sample;
  sample.own.problem.free_opening[0] = std::numeric_limits<double>::quiet_NaN();
  sample.own.problem.free_opening[1] = -std::numeric_limits<double>::infinity();
  sample.own.problem.free_opening[2] = std::numeric_limits<double>::infinity();
  const StoredProblem stored = load_problem(save_problem(sample.own.problem, sample.behaviours, ""), "sample.json");
  EXPECT_TRUE(std::isnan(stored.problem.free_opening[0]));
  EXPECT_EQ(stored.problem.free_opening[1], -std::numeric_limits<double>::infinity());
  EXPECT_EQ(stored.problem.free_opening[2], std::numeric_limits<double>::infinity());
}

// A method that regularises put a law in the cone's place: the file holds the cone, without that law's memory.
TEST(ProblemFile, substituted_law_is_stored_as_its_cone) {
  Sample sample;
  InterfaceProblem& problem = sample.own.problem;
  const auto spring = springs(1e9);
  ContactModel& model = sample.own.change();
  model.blocks[0].cone = nullptr;
  model.blocks[0].law = spring.get();
  const int memory = spring->num_history(2) * 3;
  const Vector own = problem.old;
  problem.old.resize(memory + own.size());
  problem.old << Vector::Constant(memory, 0.7), own;
  model.blocks[1].first_history += memory;
  const StoredProblem stored = load_problem(save_problem(problem, sample.behaviours, ""), "sample.json");
  EXPECT_NE(stored.problem.model->blocks[0].cone, nullptr);
  ASSERT_EQ(stored.problem.old.size(), problem.old.size() - memory);
  EXPECT_EQ(stored.problem.old[0], 0.1 / 3);
}

// Claim: a penalty problem from a run (its law, scaled in another step size, and the memory of its friction) gives the same solution when
// it is read back and solved by the penalty method with its standard parameters.
TEST(ProblemFile, penalty_problem_replays_to_the_same_solution) {
  const double mu = 0.4;
  Own own;
  own.add_cone("base", 5, 2, mu, {0.5, 1, 1, 1, 0.5});
  const Footing plan = footing(5, 1.0);
  Matrix b = Matrix::Zero(10, 3);
  for (int i = 0; i < 5; ++i) b(i, 0) = 1, b.row(5 + i) << 0, plan.b(i, 0), plan.b(i, 1);
  own.set(1e-4 * b, Vector::Zero(10));
  InterfaceProblem& problem = own.problem;
  const auto law = method("penalty", {{"factor", 3.0}})->substitute(*own.cones[0], 0.7 * flexibility(*own.model, own.model->blocks[0]));
  own.change().blocks[0].law = law.get();
  own.model->blocks[0].cone = nullptr;
  problem.old.setZero(law->num_history(2) * 5);
  InterfaceSolution solution;
  Outcome outcome;
  for (const double share : {0.4, 1.0, 0.7}) {  // slides, then comes back: the memory matters
    problem.free_opening.head(5).setConstant(share * 4e-5);
    for (int i = 0; i < 5; ++i) problem.free_opening[5 + i] = -6e-5 + 2e-5 * plan.x[static_cast<std::size_t>(i)];
    if (share != 0.4) {
      problem.from = solution.opening;
      problem.old = solution.now;
    }
    outcome = method("penalty")->solve(problem, solution);
    ASSERT_TRUE(outcome.converged) << outcome.why;
  }
  const Values cone_values = values_of("coulomb", {{"friction", mu}}, interface_behaviours());
  const StoredProblem stored = load_problem(save_problem(problem, {&cone_values}, ""), "penalty.json");
  ASSERT_NE(stored.problem.model->blocks[0].cone, nullptr);
  InterfaceSolution replayed;
  ASSERT_TRUE(method("penalty")->solve(stored.problem, replayed).converged);
  EXPECT_LE((replayed.z - solution.z).norm(), 1e-12 * solution.z.norm());
  EXPECT_LE((replayed.force - solution.force).norm(), 1e-12 * solution.force.norm());
  StoredProblem afresh = load_problem(save_problem(problem, {&cone_values}, ""), "penalty.json");  // the memory is what makes it so
  auto forgetful = std::make_shared<ContactModel>(*afresh.problem.model);
  forgetful->blocks[0].substitute_memory.clear();
  afresh.problem.model = forgetful;
  ASSERT_TRUE(method("penalty")->solve(afresh.problem, replayed).converged);
  EXPECT_GE((replayed.force - solution.force).norm(), 1e-3 * solution.force.norm());
}

std::string refusal(const std::string& text) {
  return support::refusal_of([&] { load_problem(text, "bad.json"); });
}
TEST(ProblemFile, bad_files_are_refused_with_position) {
  const Sample sample;
  const std::string good = save_problem(sample.own.problem, sample.behaviours, "r");
  ASSERT_EQ(refusal(good), "accepted");
  const auto expect = [&](const std::string& text, const std::string& part) {
    EXPECT_NE(refusal(text).find(part), std::string::npos) << refusal(text) << " has no " << part;
    EXPECT_NE(refusal(text).find("bad.json"), std::string::npos);
  };
  expect("{\n\"format\": ,\n}", "bad.json:2");
  expect("[1, 2]", "a JSON object");
  expect("{\"format\": 1e999}", "at most 1e308");
  expect(std::string(100000, '[') + std::string(100000, ']'), "at most 20 levels");
  expect("", "a JSON file");
  expect(support::replaced(good, "problem 1", "problem 9"), "format");
  expect(support::replaced(good, "\"reason\"", "\"reasn\""), "did you mean \"reason\"?");
  expect(support::replaced(good, "\"factor\"", "\"faktor\""), "did you mean \"factor\"?");
  expect(support::replaced(good, "\"points\":3", "\"points\":0"), "blocks[0].points");
  expect(support::replaced(good, "\"components\":2", "\"components\":4"), "blocks[0].components");
  expect(support::replaced(good, "\"type\":\"coulomb\"", "\"type\":\"colomb\""), "coulomb");
  expect(support::replaced(good, "\"type\":\"coulomb\",\"friction\"", "\"type\":\"coulomb\",\"frictions\""), "friction");
  expect(support::replaced(good, "[0.1,0.2,0.3]", "[0.1,0.2]"), "blocks[0].area");
  expect(support::replaced(good, "[0.1,0.2,0.3]", "[0.1,-0.2,0.3]"), "areas > 0");
  expect(support::replaced(good, "\"average\": true", "\"average\": 1"), "average");
  expect(support::replaced(good, "\"scale\": 2.0", "\"scale\": \"two\""), "scale");
  expect(support::replaced(good, "\"from\": [", "\"from\": [0.0, "), "8 numbers");
  expect(support::replaced(good, "\"factor\": [\n    [", "\"factor\": [\n    [7.0, "), "factor[1]");
}

// ---- every method on every stored problem ----

std::vector<std::filesystem::path> stored_problems() {
  std::vector<std::filesystem::path> paths;
  for (const auto& entry : std::filesystem::directory_iterator(support::source_folder() + "/tests/problems")) paths.push_back(entry.path());
  std::sort(paths.begin(), paths.end());
  return paths;
}
StoredProblem load(const std::filesystem::path& path) {
  std::stringstream text;
  text << std::ifstream(path).rdbuf();
  return load_problem(text.str(), path.string());
}

TEST(StoredProblems, every_method_by_one_yardstick) {
  const auto paths = stored_problems();
  ASSERT_GE(paths.size(), 5u);
  for (const auto& path : paths) {
    const StoredProblem stored = load(path);
    const bool cones = !stored.cones.empty();
    InterfaceSolution reference;
    const Outcome outcome = method("lagrange")->solve(stored.problem, reference);
    ASSERT_TRUE(outcome.converged) << path << outcome.why;
    EXPECT_LE(contact_residual(stored.problem, reference), 1e-10) << path;
    EXPECT_LE(outcome.residual, 1e-10);
    for (const PartInfo* info : contact_methods()) {
      const std::string name(info->name);
      if (name == "lagrange" || (name == "newton" && cones)) continue;  // Newton takes traction laws only
      InterfaceSolution solution;
      const Outcome other = method(name)->solve(stored.problem, solution);
      ASSERT_TRUE(other.converged) << path << name << other.why;
      if (name == "penalty" && cones) continue;  // another problem: the constraint is a spring
      EXPECT_LE(contact_residual(stored.problem, solution), 1e-9) << path << name;
      EXPECT_LE((solution.z - reference.z).norm(), 1e-8 * reference.z.norm()) << path << name;
    }
  }
}

// Under a rigid base two points that stick leave a third the round-off of the openings for a slip. It must not turn the friction.
TEST(StoredProblems, RoundOffIsNoSlip) {
  const StoredProblem stored = load(support::source_folder() + "/tests/data/problems/slip_of_round_off.json");
  const InterfaceProblem& problem = stored.problem;
  const Block& block = problem.model->blocks.front();
  const int n = block.batch.points;
  InterfaceSolution solution;
  const Outcome outcome = method("lagrange")->solve(problem, solution);
  ASSERT_TRUE(outcome.converged) << outcome.why;
  EXPECT_LE(outcome.iterations, 20);
  EXPECT_LE(contact_residual(problem, solution), 1e-12);
  for (int i = 0; i < n; ++i) {
    const double bound = -block.cone->friction() * solution.force[2 * n + i];
    if (!(bound > 0)) continue;
    EXPECT_LE(std::hypot(solution.opening[i] - problem.from[i], solution.opening[n + i] - problem.from[n + i]), 1e-16) << i;
    EXPECT_LE(std::hypot(solution.force[i], solution.force[n + i]), bound * (1 + 1e-12)) << i;
  }
}

// The status of this one repeats in the primal-dual active set: it must be noticed, treated and reported.
TEST(StoredProblems, repeating_status_is_reported) {
  const StoredProblem stored = load(support::source_folder() + "/tests/problems/repeating_status.json");
  InterfaceSolution solution;
  const Outcome outcome = method("lagrange")->solve(stored.problem, solution);
  ASSERT_TRUE(outcome.converged) << outcome.why;
  EXPECT_GE(outcome.cycles, 1);
  EXPECT_LE(contact_residual(stored.problem, solution), 1e-12);
  const Outcome again = method("lagrange")->solve(stored.problem, solution);  // from the right status: nothing repeats
  EXPECT_EQ(again.cycles, 0);
  EXPECT_EQ(again.iterations, 1);
}

}  // namespace
}  // namespace uplift::contact_test::problem_test
