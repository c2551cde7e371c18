#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

#include "oracle_models.h"

// The condensed step against Newton on all unknowns at once: the same displacements, resultants and energies to 1e-8 of their largest value
// over 1000 steps with uplift, for every law, method, impact rule and scheme (issue: "condensed = monolithic"). The pressures of redundant
// points under a rigid footing are not compared one by one; their resultants are.
namespace uplift::whole::oracle_test {
namespace {

struct Difference {
  double worst = 0;
  std::string column;
  double time = 0;
};

/// Largest difference of two tables, each column relative to the largest value of its kind.
Difference compare(const RunResult& a, const RunResult& b) {
  Difference found;
  double energy = 0;
  std::array<double, 64> scale{};
  for (std::size_t k = 1; k < a.table.size(); ++k)
    for (const double value : a.table[k]) {
      double& largest = scale[static_cast<std::size_t>(a.columns[k - 1].kind)];
      largest = std::max(largest, std::abs(value));
      if (a.columns[k - 1].kind >= Request::Kind::kinetic) energy = std::max(energy, std::abs(value));
    }
  for (std::size_t k = 1; k < a.table.size(); ++k) {
    const Request::Kind kind = a.columns[k - 1].kind;
    if (kind == Request::Kind::uplifted_ratio) continue;
    const double largest = kind >= Request::Kind::kinetic ? energy : scale[static_cast<std::size_t>(kind)];
    for (std::size_t i = 0; i < std::min(a.table[k].size(), b.table[k].size()); ++i) {
      const double error = std::abs(a.table[k][i] - b.table[k][i]) / (largest > 0 ? largest : 1);
      if (!(error <= found.worst)) found = {error, a.columns[k - 1].name, a.table[0][i]};
    }
  }
  return found;
}

void check(Whole& whole, const std::string& name, bool must_lift = true) {
  SCOPED_TRACE(name);
  watch_all(whole);
  whole.plan.created_limit = 1e30;  // unsound combinations are compared too
  whole.plan.rotation_limit = 1e30;
  const RunResult condensed = whole.run();
  whole.plan.monolithic = true;
  const RunResult oracle = whole.run();
  ASSERT_EQ(condensed.status, RunStatus::completed) << condensed.reason;
  ASSERT_EQ(oracle.status, RunStatus::completed) << oracle.reason;
  if (must_lift) {
    EXPECT_GT(condensed.max_opening.value, 1e-6);
  }
  ASSERT_EQ(condensed.table[0].size(), oracle.table[0].size());
  const Difference difference = compare(condensed, oracle);
  EXPECT_LE(difference.worst, 1e-8) << difference.column << " at t = " << difference.time << " s";
  std::printf("%-70s %9.2e  lifted %.3f  retries %ld/%ld  %.2f s/%.2f s\n", name.c_str(), difference.worst,
              condensed.max_uplifted_ratio.value, condensed.counts.retries, oracle.counts.retries, condensed.wall, oracle.wall);
}

/// Every step from the same beginning: for marches that amplify round-off (an impact rule that pumps energy, hard contact of a rocking
/// body). `retries`: so many steps may be halved, where the step itself may have no solution (or more than one).
void check_steps(Whole& whole, const std::string& name, long retries = 0) {
  SCOPED_TRACE(name);
  whole.plan.created_limit = 1e30;
  whole.plan.rotation_limit = 1e30;
  whole.plan.oracle_tolerance = 1e-8;
  for (Stage& stage : whole.plan.stages) stage.halvings = retries > 0 ? 8 : 0;
  const RunResult result = whole.run();
  EXPECT_EQ(result.status, RunStatus::completed) << result.reason;
  EXPECT_LE(result.counts.retries, retries);
  if (opens(whole))
    EXPECT_GT(result.max_opening.value, 1e-6);
  else
    EXPECT_EQ(result.max_opening.value, 0);  // bonded, with a dashpot too
  std::printf("%-70s each step    lifted %.3f  retries %ld %s\n", name.c_str(), result.max_uplifted_ratio.value, result.counts.retries,
              result.reason.c_str());
}

std::vector<Part> traction_laws(double k, const std::string& tangential) {
  std::vector<Part> laws = {{"sdm", {{"K_n", k}, {"F_u", 0.0}, {"G_f", 1000.0}, {"F_c", -1e3}}},
                            {"sdm", {{"K_n", k}, {"F_u", 2e4}, {"G_f", 20.0}, {"F_c", -1e3}}},
                            {"springs", {{"K_n", k}}},
                            {"springs", {{"K_n", k}, {"c", k * 1e-4}}},
                            {"elastic", {{"K_n", k}}},
                            {"elastic", {{"K_n", k}, {"c", k * 1e-4}}},
                            {"exponential", {{"K_n", k}, {"F_u", 2e4}, {"G_f", 20.0}}},
                            {"bilinear", {{"K_n", k}, {"F_u", 2e4}, {"G_f", 20.0}}}};
  for (Part& law : laws) {
    law.parameters.emplace_back("tangential", tangential);
    if (tangential != "none") law.parameters.emplace_back("K_t", k);
    if (tangential == "coulomb") law.parameters.emplace_back("friction", 0.3);
  }
  return laws;
}

std::string name_of(const Part& part) {
  std::string name = part.type;
  for (const auto& [key, value] : part.parameters)
    if (const double* number = std::get_if<double>(&value)) {
      if (key == "F_u" && *number > 0) name += " with strength";
      if (key == "c") name += " viscous";
    } else {
      name += " " + std::get<std::string>(value);
    }
  return name;
}

TEST(Oracle, RigidFootingOnTractionLaws) {
  for (const std::string tangential : {"none", "bonded", "open_free", "coulomb"})
    for (const Part& law : traction_laws(2e8, tangential))
      for (const bool path : {true, false}) {
        Oscillator data;
        data.behaviour = law;
        data.slides = tangential != "none";
        Whole whole = make(data);
        choose(whole, {"newton"}, {"none"});
        whole.plan.stages = {settle(), march(1e-3, 1000, path)};
        check(whole, "footing, " + name_of(law) + (path ? ", path" : ", end"), law.type != "elastic");
      }
}

/// The comparison is made at all: nothing is equal to 1e-19.
TEST(Oracle, ComparisonCanFail) {
  Oscillator data;
  data.behaviour = {"springs", {{"K_n", 2e8}}};
  Whole whole = make(data);
  choose(whole, {"newton"}, {"none"});
  whole.plan.stages = {settle(), march(1e-3, 200)};
  whole.plan.stages.back().halvings = 0;
  whole.plan.oracle_tolerance = 1e-19;
  const RunResult result = whole.run();
  EXPECT_EQ(result.status, RunStatus::failed);
  EXPECT_NE(result.reason.find("the oracle's step differs"), std::string::npos) << result.reason;
}

const std::vector<Part> schemes_of_newmark = {
    {"average_acceleration"}, {"newmark", {{"gamma", 0.6}}}, {"hht", {{"alpha", -0.1}}}, {"generalised_alpha", {{"rho", 0.8}}}};
const std::vector<Part> rules = {{"none"}, {"project"}, {"project_hold"}, {"reflect"}, {"propagate"}};

/// The case a traction law is marched with every scheme: only the first can take the path average.
TEST(Oracle, EverySchemeWithATractionLaw) {
  for (const Part& rule : schemes_of_newmark) {
    Oscillator data;
    data.behaviour = {"sdm", {{"K_n", 2e8}, {"F_u", 2e4}, {"G_f", 20.0}, {"F_c", -1e3}, {"tangential", "coulomb"}, {"friction", 0.2}}};
    data.slides = true;
    data.damping = 0.02;
    Whole whole = make(data);
    choose(whole, {"newton"}, {"project"});
    whole.plan.stages = {settle(), march(1e-3, 1000, false, rule)};
    check(whole, "footing, damped sdm, " + rule.type);
  }
}

TEST(Oracle, RigidFootingOnConstraints) {
  for (const std::string method : {"lagrange", "augmented_lagrangian"})
    for (const Part& impact : rules)
      for (const Part& rule : schemes_of_newmark) {
        Oscillator data;
        data.behaviour = {"unilateral"};
        Whole whole = make(data);
        choose(whole, {method}, impact);
        whole.plan.stages = {settle(), march(1e-3, 1000, true, rule)};
        check_steps(whole, "footing, " + method + ", " + impact.type + ", " + rule.type);
      }
}

TEST(Oracle, RigidFootingWithPenalty) {
  for (const std::string cone : {"unilateral", "coulomb"})
    for (const Part& rule : schemes_of_newmark)
      for (const double factor : {0.1, 10.0}) {
        Oscillator data;
        data.behaviour = {cone};
        if (cone == "coulomb") data.behaviour.parameters.emplace_back("friction", 0.2), data.slides = true;
        Whole whole = make(data);
        choose(whole, {"penalty", {{"factor", factor}}}, {"project_hold"});
        whole.plan.stages = {settle(), march(1e-3, 1000, true, rule)};
        check_steps(whole, "footing, penalty " + std::to_string(factor) + ", " + cone + ", " + rule.type);
      }
}

TEST(Oracle, SlidingFootingOnConstraints) {
  for (const std::string method : {"lagrange", "augmented_lagrangian"})
    for (const Part& impact : rules)
      for (const Part& rule : schemes_of_newmark) {
        Oscillator data;
        data.behaviour = {"coulomb", {{"friction", 0.2}}};
        data.slides = true;
        Whole whole = make(data);
        choose(whole, {method}, impact);
        whole.plan.stages = {settle(), march(1e-3, 1000, true, rule)};
        check_steps(whole, "footing, coulomb, " + method + ", " + impact.type + ", " + rule.type, 5);
      }
}

TEST(Oracle, BeamOnTwoInterfaces) {
  const Part law{"sdm", {{"K_n", 3e8}, {"F_u", 2e4}, {"G_f", 20.0}, {"F_c", -1e3}, {"tangential", "open_free"}}};
  for (const std::string cone : {"unilateral", "coulomb"})
    for (const std::string method : {"lagrange", "augmented_lagrangian", "penalty"})
      for (const Part& impact : rules)
        for (const Part& rule : schemes_of_newmark) {
          if (method == "penalty" && impact.type != "project_hold") continue;  // the same law forces with each
          Bridge data;
          data.left = law;
          data.right = {cone};
          if (cone == "coulomb") data.right.parameters.emplace_back("friction", 0.3);
          Whole whole = make(data);
          choose(whole, {method}, impact);
          whole.plan.stages = {settle(), march(1e-3, 1000, true, rule)};
          check_steps(whole, "bridge, " + cone + ", " + method + ", " + impact.type + ", " + rule.type, cone == "coulomb" ? 5 : 0);
        }
}

/// The dashpot of the viscous springs sets in with a jump: at the end of a step in which contact begins there may be no solution until it
/// is halved.
TEST(Oracle, LeavesOnEveryLaw) {
  for (const std::string tangential : {"none", "bonded", "open_free", "coulomb"})
    for (const Part& law : traction_laws(3e8, tangential))
      for (const bool path : {true, false}) {
        Leaves data;
        data.behaviour = law;
        Whole whole = make(data);
        choose(whole, {"newton"}, {"none"});
        whole.plan.stages = {settle(), march(1e-3, 1000, path)};
        check_steps(whole, "leaves, " + name_of(law) + (path ? ", path" : ", end"),
                    name_of(law).find("viscous") != std::string::npos ? 5 : 0);
      }
}

TEST(Oracle, LeavesOnConstraints) {
  for (const std::string cone : {"unilateral", "coulomb"})
    for (const std::string method : {"lagrange", "augmented_lagrangian"})
      for (const Part& impact : rules)
        for (const Part& rule : schemes_of_newmark) {
          Leaves data;
          data.behaviour = {cone};
          if (cone == "coulomb") data.behaviour.parameters.emplace_back("friction", 0.3);
          Whole whole = make(data);
          choose(whole, {method}, impact);
          whole.plan.stages = {settle(), march(1e-3, 1000, true, rule)};
          check_steps(whole, "leaves, " + cone + ", " + method + ", " + impact.type + ", " + rule.type, cone == "coulomb" ? 5 : 0);
        }
}

}  // namespace
}  // namespace uplift::whole::oracle_test
