#include <gtest/gtest.h>

#include <cstdio>

#include "oracle_models.h"

// The energy ledger: with the average acceleration rule and path-averaged tractions it closes to round-off at every stiffness and step;
// with end-of-step tractions it does not (docs/theory, section 3).
namespace uplift::whole::energy_ledger_test {
namespace {

struct Closing {
  RunResult result;
  double worst = 0;  // largest |residual| of the largest external work
};

Closing run_ledger(Whole& whole) {
  whole.plan.requests = {request(Request::Kind::residual, 0, "residual")};
  whole.plan.created_limit = 1e30;
  Closing closing;
  closing.result = whole.run();
  for (const double residual : closing.result.table.at(1))
    closing.worst = std::max(closing.worst, std::abs(residual) / closing.result.energy_scale);
  return closing;
}

/// Stiffness per area [Pa/m] at which the most flexible point has k F_ii = `ratio` at this step.
double stiffness_for(double ratio, double step, const std::function<Whole(double)>& make_with) {
  const double guess = 1e8;
  Whole whole = make_with(guess);
  choose(whole, {"newton"}, {"none"});
  const std::vector<StiffnessRatio> ratios = stiffness_ratios(whole.model, march(step, 1), *whole.plan.solver);
  return guess * ratio / ratios.front().most;
}

Part sdm(double k, double strength = 0) {
  return {"sdm", {{"K_n", k}, {"F_u", strength}, {"G_f", 50.0}, {"F_c", -1e3}, {"tangential", "none"}}};
}

Whole oscillator_on(const Part& law, double damping = 0) {
  Oscillator data;
  data.behaviour = law;
  data.damping = damping;
  Whole whole = make(data);
  choose(whole, {"newton"}, {"none"});
  return whole;
}

void closes(Whole& whole, const std::string& name, long steps, double limit = 1e-10) {
  SCOPED_TRACE(name);
  const Closing closing = run_ledger(whole);
  EXPECT_EQ(closing.result.status, RunStatus::completed) << closing.result.reason;
  EXPECT_EQ(closing.result.counts.steps, steps);
  if (opens(whole)) EXPECT_GT(closing.result.max_uplifted_ratio.value, 0.2);
  EXPECT_LE(closing.worst, limit);
  std::printf("%-60s residual %.2e of the work, lifted %.2f, %.2f iterations a step, %ld retries\n", name.c_str(), closing.worst,
              closing.result.max_uplifted_ratio.value, static_cast<double>(closing.result.counts.iterations) / static_cast<double>(steps),
              closing.result.counts.retries);
}

TEST(EnergyLedger, StaysClosedAtAnyStiffness) {
  for (const double step : {1e-3, 5e-4})
    for (const double ratio : {0.01, 1.0, 100.0})
      for (const double strength : {0.0, 5e4}) {
        const double k = stiffness_for(ratio, step, [](double guess) { return oscillator_on(sdm(guess)); });
        Whole whole = oscillator_on(sdm(k, strength));
        whole.plan.stages = {settle(), march(step, 10000)};
        closes(whole, "sdm, dt " + std::to_string(step) + ", k F_ii " + std::to_string(ratio) + (strength > 0 ? ", with strength" : ""),
               10000);
      }
}

TEST(EnergyLedger, StaysClosedWithDamping) {
  const double k = stiffness_for(100, 1e-3, [](double guess) { return oscillator_on(sdm(guess)); });
  for (const Part& law : {sdm(k), sdm(k, 5e4), Part{"springs", {{"K_n", k}}}, Part{"springs", {{"K_n", k}, {"c", 1e-4 * k}}}}) {
    Whole whole = oscillator_on(law, 0.02);
    whole.plan.stages = {settle(), march(1e-3, 10000)};
    closes(whole, law.type + ", 2 % damping", 10000);
  }
}

TEST(EnergyLedger, StaysClosedForEveryLaw) {
  const double k = stiffness_for(10, 1e-3, [](double guess) { return oscillator_on(sdm(guess)); });
  std::vector<Part> laws = {{"springs", {{"K_n", k}}},
                            {"springs", {{"K_n", k}, {"c", 1e-4 * k}}},
                            {"elastic", {{"K_n", k}, {"c", 1e-4 * k}}},
                            {"exponential", {{"K_n", k}, {"F_u", 2e4}, {"G_f", 20.0}}},
                            {"bilinear", {{"K_n", k}, {"F_u", 2e4}, {"G_f", 20.0}}},
                            {"sdm", {{"K_n", k}, {"F_u", 2e4}, {"G_f", 20.0}, {"F_c", -1e3}}}};
  for (const std::string tangential : {"bonded", "open_free", "coulomb"})
    for (Part law : laws) {
      law.parameters.emplace_back("tangential", tangential);
      law.parameters.emplace_back("K_t", 0.1 * k);
      if (tangential == "coulomb") law.parameters.emplace_back("friction", 0.25);
      Oscillator data;
      data.behaviour = law;
      data.slides = true;
      Whole whole = make(data);
      choose(whole, {"newton"}, {"none"});
      whole.plan.stages = {settle(), march(1e-3, 2000)};
      closes(whole, law.type + ", " + tangential, 2000);
    }
}

TEST(EnergyLedger, StaysClosedWithTwoInterfaces) {
  const Part left = {"sdm", {{"K_n", 3e9}, {"F_u", 2e4}, {"G_f", 20.0}, {"F_c", -1e3}, {"tangential", "open_free"}}};
  for (const double damping : {0.0, 0.02}) {
    Bridge data;
    data.left = left;
    data.right = {"springs", {{"K_n", 3e10}}};
    data.damping = damping;
    Whole whole = make(data);
    choose(whole, {"newton"}, {"none"});
    whole.plan.stages = {settle(), march(1e-3, 10000)};
    closes(whole, "two interfaces", 10000);
  }
}

/// Few iterations are allowed, so that many steps are halved: the ledger must not notice.
TEST(EnergyLedger, StaysClosedOverHalvedSteps) {
  Oscillator data;
  data.behaviour = sdm(5e9, 5e4);
  Whole whole = make(data);
  choose(whole, {"newton", {{"most_iterations", 4.0}}}, {"none"});
  whole.plan.stages = {settle(), march(5e-3, 2000)};
  const Closing closing = run_ledger(whole);
  EXPECT_EQ(closing.result.status, RunStatus::completed) << closing.result.reason;
  EXPECT_GT(closing.result.counts.retries, 10);
  EXPECT_LE(closing.worst, 1e-10);
}

/// The same model with the traction at the end of the step: nothing is created at k F_ii = 0.013, and energy appears from 0.13 on.
/// Measured by what the push has put in when it ends: the work of the constant load grows with the bouncing that the created
/// energy makes.
TEST(EnergyLedger, EndOfStepTractionCreatesEnergy) {
  const auto created = [](double ratio, bool path) {
    const double k = stiffness_for(ratio, 1e-3, [](double guess) { return oscillator_on(sdm(guess)); });
    Whole whole = oscillator_on(sdm(k));
    whole.plan.stages = {settle(), march(1e-3, 3000, path)};
    whole.plan.requests = {request(Request::Kind::external, 0, "external")};
    whole.plan.created_limit = 1e30;
    const RunResult result = whole.run();
    const double share = result.energy_created / result.table.at(1).at(100);
    std::printf("k F_ii %g, %s: created %.3e of the input, %.3e of the largest external work\n", ratio, path ? "path" : "end", share,
                result.energy_created / result.energy_scale);
    return share;
  };
  EXPECT_LT(created(0.013, false), 0.01);
  EXPECT_GT(created(0.13, false), 0.1);
  EXPECT_GT(created(1.3, false), 10);
  for (const double ratio : {0.013, 0.13, 1.3, 13.0, 130.0}) EXPECT_LT(created(ratio, true), 1e-9);
}

/// A run that creates more than its limit is marked, with its results kept.
TEST(EnergyLedger, LimitMarksTheRun) {
  const double k = stiffness_for(1.3, 1e-3, [](double guess) { return oscillator_on(sdm(guess)); });
  Whole whole = oscillator_on(sdm(k));
  whole.plan.stages = {settle(), march(1e-3, 1000, false)};
  whole.plan.requests = {request(Request::Kind::residual, 0, "residual")};
  const RunResult result = whole.run();
  EXPECT_EQ(result.status, RunStatus::failed);
  EXPECT_NE(result.reason.find("energy was created"), std::string::npos) << result.reason;
  EXPECT_EQ(result.table.at(0).size(), 1001u);
}

/// Without any load the scale is the energy at the beginning: a released oscillator keeps it.
TEST(EnergyLedger, FreeMotionKeepsItsEnergy) {
  Oscillator data;
  data.behaviour = sdm(1e9);
  data.push = 0;
  data.vertical = 0;
  Whole whole = make(data);
  choose(whole, {"newton"}, {"none"});
  whole.plan.initial_velocity = Vector::Zero(whole.model.free());
  for (int i = 0; i < whole.model.free(); ++i)
    if (whole.model.unknown_name(i) == "base.uy") whole.plan.initial_velocity[i] = -0.1;
  whole.plan.stages = {march(1e-3, 1000)};
  const Closing closing = run_ledger(whole);
  EXPECT_EQ(closing.result.status, RunStatus::completed) << closing.result.reason;
  EXPECT_LE(closing.worst, 1e-12);
  EXPECT_NEAR(closing.result.energy_scale, 0.5 * (24317.0841 + 1e4) * 0.01, 1e-6);
}

}  // namespace
}  // namespace uplift::whole::energy_ledger_test
