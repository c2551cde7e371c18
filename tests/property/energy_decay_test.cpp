#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <string>

#include "oracle_models.h"

// The scheme of filtered energy decay (docs/theory, section 3): the ledger closes with storage and dissipation of the filters as terms of
// their own, dissipation never falls, and the linear part has the eigenvalues that the spectral radius at infinite frequency asks for.
namespace uplift::whole::energy_decay_test {
namespace {

Scheme decay(double rho) {
  Scheme scheme;
  scheme.pole = (1 - 3 * rho) / (3 - rho);
  scheme.gain = (1 - rho) * (1 - rho) / (2 * (3 - rho) * (1 + rho));
  return scheme;
}

Stage marching(double step, int steps, double rho = 0.5) {
  Stage stage = march(step, steps);
  stage.scheme = decay(rho);
  return stage;
}

/// What the external work has become; the program's residual begins anew with every stage, their sum does not.
constexpr Request::Kind became[] = {
    Request::Kind::kinetic, Request::Kind::strain,  Request::Kind::stored, Request::Kind::interface_dissipated,
    Request::Kind::plastic, Request::Kind::damping, Request::Kind::impact, Request::Kind::algorithmic,
    Request::Kind::filter,  Request::Kind::stop};

RunResult run_decay(Whole& whole) {
  whole.plan.requests = {request(Request::Kind::residual, 0, "residual"), request(Request::Kind::algorithmic, 0, "algorithmic"),
                         request(Request::Kind::filter, 0, "filter"), request(Request::Kind::moment, 0, "moment"),
                         request(Request::Kind::external, 0, "external")};
  for (const Request::Kind kind : became) whole.plan.requests.push_back(request(kind, 0, "part " + std::to_string(static_cast<int>(kind))));
  whole.plan.created_limit = 1e30;
  return whole.run();
}

void closes(Whole& whole, const std::string& name, double limit = 1e-10) {
  SCOPED_TRACE(name);
  const RunResult result = run_decay(whole);
  EXPECT_EQ(result.status, RunStatus::completed) << result.reason;
  if (opens(whole)) EXPECT_GT(result.max_uplifted_ratio.value, 0.2);
  double worst = 0, least = 0, storage = 0, first = 0, missing = 0;
  const std::vector<double>&residual = result.table.at(1), &lost = result.table.at(2), &stored = result.table.at(3);
  for (std::size_t i = 0; i < residual.size(); ++i) {
    worst = std::max(worst, std::abs(residual[i]));
    if (i > 0) least = std::min(least, lost[i] - lost[i - 1]);
    storage = std::min(storage, stored[i]);
    double sum = -result.table.at(5)[i];
    for (std::size_t k = 0; k < std::size(became); ++k) sum += result.table.at(6 + k)[i];
    if (i == 0) first = sum;
    missing = std::max(missing, std::abs(sum - first));
  }
  EXPECT_LE(worst, limit * result.energy_scale);
  EXPECT_LE(missing, limit * result.energy_scale) << "from stage to stage, too";
  EXPECT_GE(least, -1e-13 * result.energy_scale) << "the filters only dissipate";
  EXPECT_GE(storage, 0);
  std::printf("%-60s residual %.1e of the work, %.2e dissipated, %.2f iterations a step, %ld retries\n", name.c_str(),
              worst / result.energy_scale, lost.back() / result.energy_scale,
              static_cast<double>(result.counts.iterations) / static_cast<double>(result.counts.steps), result.counts.retries);
}

double stiffness_for(double ratio, double step) {
  Oscillator data;
  data.behaviour = {"springs", {{"K_n", 1e8}}};
  Whole whole = make(data);
  choose(whole, {"newton"}, {"none"});
  return 1e8 * ratio / stiffness_ratios(whole.model, march(step, 1), *whole.plan.solver).front().most;
}

TEST(EnergyDecay, LedgerClosesAtAnyStiffness) {
  for (const double ratio : {0.01, 1.0, 1000.0})
    for (const double strength : {-1.0, 0.0, 5e4}) {  // springs, SDM without and with strength
      const double k = stiffness_for(ratio, 1e-3);
      Oscillator data;
      data.behaviour = strength < 0 ? Part{"springs", {{"K_n", k}}}
                                    : Part{"sdm", {{"K_n", k}, {"F_u", strength}, {"G_f", 50.0}, {"F_c", -1e3}, {"tangential", "none"}}};
      Whole whole = make(data);
      choose(whole, {"newton"}, {"none"});
      whole.plan.stages = {settle(), marching(1e-3, 10000)};
      closes(whole, data.behaviour.type + ", k F_ii " + std::to_string(ratio) + (strength > 0 ? ", with strength" : ""));
    }
}

/// A stage with another spectral radius, or with the trapezoidal rule, forgets what the filters hold: it counts as dissipated.
TEST(EnergyDecay, LedgerClosesFromOneSchemeToAnother) {
  Oscillator data;
  data.behaviour = {"springs", {{"K_n", stiffness_for(10, 1e-3)}}};
  Whole whole = make(data);
  choose(whole, {"newton"}, {"none"});
  whole.plan.stages = {settle(),         marching(1e-3, 777, 0.5), marching(1e-3, 777, 0.2), marching(5e-4, 1555, 0.2),
                       march(1e-3, 333), marching(1e-3, 777, 0.8)};
  closes(whole, "springs, from one scheme to another");
}

TEST(EnergyDecay, LedgerClosesForEveryLaw) {
  const double k = stiffness_for(10, 1e-3);
  const std::vector<Part> laws = {{"springs", {{"K_n", k}}},
                                  {"springs", {{"K_n", k}, {"c", 1e-4 * k}}},
                                  {"elastic", {{"K_n", k}, {"c", 1e-4 * k}}},
                                  {"exponential", {{"K_n", k}, {"F_u", 2e4}, {"G_f", 20.0}}},
                                  {"bilinear", {{"K_n", k}, {"F_u", 2e4}, {"G_f", 20.0}}},
                                  {"sdm", {{"K_n", k}, {"F_u", 2e4}, {"G_f", 20.0}, {"F_c", -1e3}}}};
  for (const double rho : {0.0, 0.5, 0.8})
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
        whole.plan.stages = {settle(), marching(1e-3, 1000, rho)};
        closes(whole, law.type + ", " + tangential + ", rho " + std::to_string(rho));
      }
}

/// Few iterations are allowed, so that many steps are halved; and the second stage has another step.
TEST(EnergyDecay, LedgerClosesOverHalvedStepsAndStages) {
  Oscillator data;
  data.behaviour = {"sdm", {{"K_n", 5e9}, {"F_u", 5e4}, {"G_f", 50.0}, {"F_c", -1e3}, {"tangential", "none"}}};
  Whole whole = make(data);
  choose(whole, {"newton", {{"most_iterations", 4.0}}}, {"none"});
  whole.plan.stages = {settle(), marching(5e-3, 400), marching(2e-3, 500), marching(4e-3, 300)};
  closes(whole, "halved steps, three stages");
}

/// The condensed step against Newton's method on all unknowns, friction included.
TEST(EnergyDecay, CondensedStepIsTheMonolithicStep) {
  for (const std::string type : {"springs", "sdm"}) {
    Part law{type, {{"K_n", 5e9}, {"tangential", "coulomb"}, {"K_t", 1e9}, {"friction", 0.3}}};
    if (type == "sdm") law.parameters.insert(law.parameters.end(), {{"F_u", 2e4}, {"G_f", 20.0}, {"F_c", -1e3}});
    Oscillator data;
    data.behaviour = law;
    data.slides = true;
    Whole whole = make(data);
    choose(whole, {"newton"}, {"none"});
    whole.plan.stages = {settle(), marching(1e-3, 300)};
    whole.plan.oracle_tolerance = 1e-8;
    const RunResult result = run_decay(whole);
    EXPECT_EQ(result.status, RunStatus::completed) << type << ": " << result.reason;
    EXPECT_GT(result.max_uplifted_ratio.value, 0.2);
  }
}

/// rho = 1 has no filters: the trapezoidal rule to the last bit.
TEST(EnergyDecay, WithoutDecayItIsTheTrapezoidalRule) {
  const auto moment = [](const Scheme& scheme) {
    Oscillator data;
    data.behaviour = {"springs", {{"K_n", 5e9}}};
    Whole whole = make(data);
    choose(whole, {"newton"}, {"none"});
    whole.plan.stages = {settle(), march(1e-3, 500)};
    whole.plan.stages.back().scheme = scheme;
    return run_decay(whole).table.at(4);
  };
  EXPECT_EQ(moment(decay(1)), moment(Scheme{}));
}

/// The first swing of the reference oscillator that uplifts (semi-analytic: 3.584171e-2 m within 1 s), of second order in
/// the step.
TEST(EnergyDecay, FirstSwingOfTheReferenceOscillator) {
  const auto swing = [](double step) {
    Oscillator data;
    data.points = 200;
    data.behaviour = {"springs", {{"K_n", 2e8}}};
    Whole whole = make(data);
    choose(whole, {"newton"}, {"none"});
    whole.plan.stages = {settle(), marching(step, static_cast<int>(std::lround(1 / step)))};
    whole.plan.requests = {request(Request::Kind::displacement, 3, "top")};
    return std::abs(whole.run().peaks.front().value);
  };
  const double exact = 3.584171e-2, coarse = std::abs(swing(4e-3) / exact - 1), fine = std::abs(swing(1e-3) / exact - 1);
  EXPECT_LT(fine, 1e-3);
  EXPECT_LT(fine, 0.25 * coarse + 1e-4) << coarse;  // what the points leave: 1e-4
}

}  // namespace
}  // namespace uplift::whole::energy_decay_test
