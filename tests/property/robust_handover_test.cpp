#include <gtest/gtest.h>

#include <cstdio>

#include "oracle_models.h"

// From stage to stage: a settled structure does not move, the first acceleration follows from the balance, and a march may be cut in two.
namespace uplift::whole::robust_handover_test {
namespace {

using Kind = Request::Kind;

Part sdm(double k) {
  return {"sdm", {{"K_n", k}, {"F_u", 1e4}, {"G_f", 50.0}, {"F_c", -1e3}, {"tangential", "none"}}};
}

struct Choice {
  Part behaviour, method, impact;
  Part scheme = {"average_acceleration"};
};

const std::vector<Choice> choices = {
    {sdm(2e8), {"newton"}, {"none"}},
    {sdm(2e11), {"newton"}, {"none"}},
    {sdm(2e8), {"newton"}, {"none"}, {"hht"}},
    {sdm(2e8), {"newton"}, {"none"}, {"energy_decay"}},
    {sdm(2e11), {"newton"}, {"none"}, {"energy_decay"}},
    {{"springs", {{"K_n", 2e9}, {"tangential", "coulomb"}, {"friction", 0.4}}}, {"newton"}, {"none"}, {"energy_decay"}},
    {{"springs", {{"K_n", 2e9}, {"c", 2e5}}}, {"newton"}, {"none"}},
    {{"springs", {{"K_n", 2e9}, {"tangential", "coulomb"}, {"friction", 0.4}}}, {"newton"}, {"none"}},
    {{"unilateral"}, {"penalty"}, {"none"}},
    {{"unilateral"}, {"lagrange"}, {"none"}},
    {{"unilateral"}, {"lagrange"}, {"project"}},
    {{"unilateral"}, {"lagrange"}, {"project_hold"}},
    {{"unilateral"}, {"lagrange"}, {"reflect"}},
    {{"unilateral"}, {"lagrange"}, {"propagate"}},
    {{"unilateral"}, {"lagrange"}, {"project_hold"}, {"generalised_alpha"}},
    {{"unilateral"}, {"augmented_lagrangian"}, {"project_hold"}},
    {{"coulomb", {{"friction", 0.4}}}, {"lagrange"}, {"project_hold"}}};

Whole footing(const Choice& choice, double push = 0) {
  Oscillator data;
  data.behaviour = choice.behaviour;
  data.push = push;
  data.damping = 0.02;
  Whole whole = make(data);
  choose(whole, choice.method, choice.impact);
  whole.plan.created_limit = 1e30;
  return whole;
}

std::string name_of(const Choice& choice) {
  return choice.behaviour.type + ", " + choice.method.type + ", " + choice.impact.type + ", " + choice.scheme.type;
}

TEST(HandOver, SettledStructureDoesNotMove) {
  for (const Choice& choice : choices)
    for (const bool bridge : {false, true}) {
      SCOPED_TRACE(name_of(choice) + (bridge ? ", beam" : ", footing"));
      Whole whole;
      if (bridge) {
        Bridge data;
        data.left = data.right = choice.behaviour;
        data.push = 0;
        whole = make(data);
        choose(whole, choice.method, choice.impact);
      } else {
        whole = footing(choice);
      }
      for (int i = 0; i < whole.model.full_unknowns(); ++i) whole.plan.requests.push_back(request(Kind::displacement, i, "u"));
      whole.plan.requests.push_back(request(Kind::kinetic, 0, "kinetic"));
      whole.plan.requests.push_back(request(Kind::strain, 0, "strain"));
      whole.plan.requests.push_back(request(Kind::stored, 0, "stored"));
      whole.plan.stages = {settle(), march(1e-3, 1000, true, choice.scheme)};
      const RunResult result = whole.run();
      ASSERT_EQ(result.status, RunStatus::completed) << result.reason;
      const std::size_t unknowns = static_cast<std::size_t>(whole.model.full_unknowns());
      double size = 0, moved = 0, kinetic = 0;
      for (std::size_t k = 1; k <= unknowns; ++k)
        for (const double u : result.table[k])
          size = std::max(size, std::abs(u)), moved = std::max(moved, std::abs(u - result.table[k][0]));
      for (const double e : result.table[unknowns + 1]) kinetic = std::max(kinetic, e);
      if (size == 0) size = 1e-3;  // a rigid structure on rigid ground: 1 mm
      // of the beam, 1e-11: its soft modes are a thousand times softer than the axial stiffness whose round-off pushes them
      EXPECT_LE(moved, (bridge ? 1e-11 : 1e-12) * size + 1e-17) << "static displacement " << size;
      std::printf("%-75s moved %.1e of %.1e m, kinetic %.1e J\n", (name_of(choice) + (bridge ? ", beam" : ", footing")).c_str(), moved,
                  size, kinetic);
    }
}

/// A load that is there at once: the top's first acceleration is force over mass; nothing else moves it.
TEST(HandOver, FirstAccelerationFollowsFromTheBalance) {
  for (const Choice& choice : choices) {
    SCOPED_TRACE(name_of(choice));
    Whole whole = footing(choice);
    TimeLoad time_load;
    time_load.name = "sudden";
    time_load.shape = Vector::Zero(whole.model.free());
    for (int i = 0; i < whole.model.free(); ++i)
      if (whole.model.unknown_name(i) == "top.ux") time_load.shape[i] = 5e4;
    time_load.function = function({"constant"});
    whole.model.time_loads.push_back(std::move(time_load));
    whole.plan.requests = {request(Kind::acceleration, 3, "top"), request(Kind::acceleration, 1, "base")};
    whole.plan.stages = {settle(), march(1e-4, 10, true, choice.scheme)};
    const RunResult result = whole.run();
    ASSERT_EQ(result.status, RunStatus::completed) << result.reason;
    EXPECT_NEAR(result.table[1][0], 5e4 / 24317.0841, 1e-9);
    EXPECT_NEAR(result.table[2][0], 0, 1e-9);
    EXPECT_NEAR(result.table[1][1], 5e4 / 24317.0841, 1e-2);  // and goes on smoothly
  }
}

/// A load that jumps onto a body that rests on constraints does not move it: the contact takes it at once. With the forces of the static
/// stage the body would get half a step of the load's acceleration as a velocity, 1e5/34317/2 * 1e-4 = 1.5e-4 m/s, or 3.7e-4 J.
TEST(HandOver, ALoadThatJumpsOntoAClosedContactMovesNothing) {
  for (const Choice& choice : choices) {
    if (choice.method.type != "lagrange" && choice.method.type != "augmented_lagrangian") continue;
    SCOPED_TRACE(name_of(choice));
    Whole whole = footing(choice);
    TimeLoad time_load;
    time_load.name = "sudden";
    time_load.shape = Vector::Zero(whole.model.free());
    for (int i = 0; i < whole.model.free(); ++i)
      if (whole.model.unknown_name(i) == "base.uy") time_load.shape[i] = -1e5;
    ASSERT_EQ(time_load.shape.sum(), -1e5);
    time_load.function = function({"constant"});
    whole.model.time_loads.push_back(std::move(time_load));
    whole.plan.requests = {request(Kind::axial, 0, "axial"), request(Kind::kinetic, 0, "kinetic")};
    whole.plan.stages = {settle(), march(1e-4, 2, true, choice.scheme)};
    const RunResult result = whole.run();
    ASSERT_EQ(result.status, RunStatus::completed) << result.reason;
    EXPECT_NEAR(result.table[1][0], -1.1e6, 1e-3) << "weight and load, from the first instant";
    for (const double kinetic : result.table[2]) EXPECT_LT(kinetic, 1e-12);
  }
}

/// Two stages in a row are one, the energy ledger included.
TEST(HandOver, AMarchMayBeCutInTwo) {
  for (const Choice& choice : choices) {
    SCOPED_TRACE(name_of(choice));
    Whole whole = footing(choice, 3e5);
    watch_all(whole);
    whole.plan.stages = {settle(), march(1e-3, 300, true, choice.scheme)};
    const RunResult one = whole.run();
    whole.plan.stages = {settle(), march(1e-3, 130, true, choice.scheme), march(1e-3, 170, true, choice.scheme)};
    const RunResult two = whole.run();
    ASSERT_EQ(one.status, RunStatus::completed) << one.reason;
    ASSERT_EQ(two.status, RunStatus::completed) << two.reason;
    EXPECT_EQ(two.counts.steps, 300);
    EXPECT_NEAR(two.energy_scale, one.energy_scale, 1e-6 * one.energy_scale);
    ASSERT_EQ(one.table[0].size(), two.table[0].size());
    double worst = 0;
    for (std::size_t k = 0; k < one.table.size(); ++k) {
      double size = 1e-300;
      for (const double value : one.table[k]) size = std::max(size, std::abs(value));
      const bool energy = k > 0 && one.columns[k - 1].kind >= Kind::kinetic;
      if (energy) size = one.energy_scale;
      for (std::size_t i = 0; i < one.table[k].size(); ++i) worst = std::max(worst, std::abs(one.table[k][i] - two.table[k][i]) / size);
    }
    // `none` amplifies round-off; everything else is the same march
    EXPECT_LE(worst, choice.impact.type == "none" && choice.method.type == "lagrange" ? 1e-3 : 1e-8);
  }
}

/// The static load in one stage or in three, in few steps or in many: the same state, for laws without memory of the way.
TEST(HandOver, StaticStagesMayBeSplit) {
  for (const Choice& choice : choices) {
    SCOPED_TRACE(name_of(choice));
    const auto end = [&](const std::vector<Stage>& stages) {
      Whole whole = footing(choice);
      for (int i = 0; i < whole.model.full_unknowns(); ++i) whole.plan.requests.push_back(request(Kind::displacement, i, "u"));
      whole.plan.stages = stages;
      whole.plan.stages.push_back(march(1e-3, 1, true, choice.scheme));
      const RunResult result = whole.run();
      EXPECT_EQ(result.status, RunStatus::completed) << result.reason;
      std::vector<double> u;
      for (std::size_t k = 1; k < result.table.size(); ++k) u.push_back(result.table[k][0]);
      return u;
    };
    const std::vector<double> once = end({settle(1)}), often = end({settle(20)}), split = end({settle(5), settle(1), settle(3)});
    for (std::size_t i = 0; i < once.size(); ++i) {
      EXPECT_NEAR(once[i], often[i], 1e-12);
      EXPECT_NEAR(once[i], split[i], 1e-12);
    }
  }
}

}  // namespace
}  // namespace uplift::whole::robust_handover_test
