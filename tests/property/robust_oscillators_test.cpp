#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <map>
#include <random>

#include "oracle_models.h"

// The long part: random oscillators on random joints. Each ends completed, overturned or separated, or failed with a reason; nothing
// crashes, hangs, holds a NaN, or passes with wrong energy.
namespace uplift::whole::robust_oscillators_test {
namespace {

class Dice {
 public:
  explicit Dice(std::uint64_t seed) : engine_(seed) {}
  double uniform(double least, double most) { return std::uniform_real_distribution<double>(least, most)(engine_); }
  double decades(double least, double most) { return std::pow(10.0, uniform(std::log10(least), std::log10(most))); }
  bool chance(double p) { return uniform(0, 1) < p; }
  template <class T>
  const T& of(const std::vector<T>& list) {
    return list[std::uniform_int_distribution<std::size_t>(0, list.size() - 1)(engine_)];
  }

 private:
  std::mt19937_64 engine_;
};

struct Drawn {
  Whole whole;
  std::string text, method;
  long steps = 0;
  bool sound = false;  // a combination that must not create energy
};

Part random_law(Dice& dice, double k, double pressure) {
  Part law{dice.of<std::string>({"sdm", "sdm", "springs", "springs", "exponential", "bilinear", "elastic"})};
  law.parameters = {{"K_n", k}};
  const double strength = pressure * dice.decades(0.01, 1);
  const bool tension = law.type == "exponential" || law.type == "bilinear" || (law.type == "sdm" && dice.chance(0.5));
  if (tension || law.type == "sdm") {
    law.parameters.emplace_back("F_u", tension ? strength : 0.0);
    law.parameters.emplace_back("G_f", tension ? strength * strength / k * dice.decades(1.5, 1e4) : 100.0);
  }
  if (law.type == "sdm") law.parameters.emplace_back("F_c", -pressure * dice.decades(1e-3, 1e-1));
  if (law.type == "springs" && dice.chance(0.3)) law.parameters.emplace_back("c", k * dice.decades(1e-6, 1e-3));
  const std::string shear = dice.of<std::string>({"none", "none", "bonded", "open_free", "coulomb"});
  law.parameters.emplace_back("tangential", shear);
  if (shear != "none" && dice.chance(0.5)) law.parameters.emplace_back("K_t", k * dice.decades(0.01, 1));
  if (shear == "coulomb") law.parameters.emplace_back("friction", dice.uniform(0.05, 0.9));
  return law;
}

Drawn draw(std::uint64_t seed) {
  Dice dice(seed);
  Oscillator data;
  data.height = dice.uniform(0.5, 20);
  data.half_width = data.height * dice.decades(0.1, 1);
  data.mass = dice.decades(1e2, 1e6);
  data.base_mass = data.mass * dice.decades(0.05, 2);
  data.base_inertia = data.base_mass * data.half_width * data.half_width * dice.decades(0.1, 1);
  const double frequency = dice.decades(1, 30);
  data.bending = data.mass * std::pow(2 * std::numbers::pi * frequency, 2) * std::pow(data.height, 3) / 3;
  data.vertical = (data.mass + data.base_mass) * 9.81 * dice.uniform(0.5, 2);
  data.points = std::vector<int>{2, 3, 5, 11, 40}[static_cast<std::size_t>(dice.uniform(0, 5))];
  data.duration = dice.decades(0.02, 1);
  // from none through uplift to overturning: M_u = V b
  data.push = dice.chance(0.08) ? 0 : data.vertical * data.half_width / data.height * dice.decades(0.02, 20);
  data.damping = dice.chance(0.5) ? dice.decades(1e-3, 0.1) : 0;

  Drawn drawn;
  drawn.method = dice.of<std::string>({"newton", "newton", "penalty", "augmented_lagrangian", "lagrange"});
  const Part impact{dice.of<std::string>({"none", "project", "project_hold", "project_hold", "reflect", "propagate"})};
  Part rule{dice.of<std::string>({"average_acceleration", "average_acceleration", "newmark", "hht", "generalised_alpha"})};
  if (rule.type == "newmark") rule.parameters.emplace_back("gamma", dice.uniform(0.5, 0.8));
  const bool path = dice.chance(0.75);
  const double pressure = data.vertical / (2 * data.half_width),
               k = pressure / dice.decades(1e-7, 1e-1);  // six decades of settlement, 0.1 um to 0.1 m
  if (drawn.method == "newton")
    data.behaviour = random_law(dice, k, pressure);
  else if (dice.chance(0.7))
    data.behaviour = {"unilateral"};
  else
    data.behaviour = {"coulomb", {{"friction", dice.uniform(0.05, 0.9)}}};
  bool shear = data.behaviour.type == "coulomb";
  for (const auto& [key, value] : data.behaviour.parameters)
    if (key == "tangential") shear = std::get<std::string>(value) != "none";
  data.slides = shear && dice.chance(0.7);
  drawn.whole = make(data);
  Part method{drawn.method};
  if (drawn.method == "penalty") method.parameters.emplace_back("factor", dice.decades(0.01, 1e4));
  choose(drawn.whole, method, impact);
  const double step = dice.decades(2e-5, 2e-2);
  drawn.steps = std::clamp(std::lround(2 / step), 100L, 1500L);
  if (dice.chance(0.8)) drawn.whole.plan.stages.push_back(settle(1 + static_cast<int>(dice.uniform(0, 5))));
  drawn.whole.plan.stages.push_back(march(step, drawn.steps, path, rule));
  watch_all(drawn.whole);
  drawn.whole.plan.requests.push_back(request(Request::Kind::acceleration, 3, "top"));
  drawn.text = data.behaviour.type + ", " + drawn.method + ", " + impact.type + ", " + rule.type + (path ? ", path" : ", end") + ", dt " +
               std::to_string(step) + ", points " + std::to_string(data.points) + (data.slides ? ", slides" : "");
  const bool constrains = drawn.method == "lagrange" || drawn.method == "augmented_lagrangian";
  drawn.sound = !constrains && path && rule.type == "average_acceleration";
  return drawn;
}

TEST(Robust, RandomOscillatorsEndWell) {
  struct Tally {
    int completed = 0, overturned = 0, energy = 0, interface = 0, other = 0;
    long steps = 0, retries = 0, iterations = 0;
    double seconds = 0;
  };
  std::map<std::string, Tally> table;
  int interface_failures = 0;
  constexpr std::uint64_t first_seed = 20260101;
  for (std::uint64_t seed = first_seed; seed < first_seed + 1000; ++seed) {
    Drawn drawn = draw(seed);
    SCOPED_TRACE("seed " + std::to_string(seed) + ": " + drawn.text);
    const auto start = std::chrono::steady_clock::now();
    const RunResult result = drawn.whole.run();
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    Tally& tally = table[drawn.method];
    tally.seconds += seconds;
    tally.steps += result.counts.steps;
    tally.retries += result.counts.retries;
    tally.iterations += result.counts.iterations;
    EXPECT_LE(seconds, 20);
    EXPECT_LE(result.counts.steps, drawn.steps);
    bool finite = true;
    for (const std::vector<double>& column : result.table)
      for (const double value : column) finite = finite && std::isfinite(value);
    EXPECT_TRUE(finite);
    switch (result.status) {
      case RunStatus::completed:
        ++tally.completed;
        EXPECT_EQ(result.counts.steps, drawn.steps);
        EXPECT_LE(result.energy_created, drawn.whole.plan.created_limit * result.energy_scale);
        break;
      case RunStatus::overturned:
      case RunStatus::separated:
        ++tally.overturned;
        EXPECT_FALSE(result.reason.empty());
        break;
      case RunStatus::failed:
        EXPECT_FALSE(result.reason.empty());
        if (result.reason.find("energy") != std::string::npos) {
          ++tally.energy;
          EXPECT_FALSE(drawn.sound) << "created " << result.created_percent() << ": " << result.reason;
        } else if (result.reason.find("failed down to") != std::string::npos) {
          ++tally.interface, ++interface_failures;
          EXPECT_FALSE(result.problem.empty());
          std::printf("  seed %llu: %s: %s (%ld steps)\n", static_cast<unsigned long long>(seed), drawn.text.c_str(), result.reason.c_str(),
                      result.counts.steps);
        } else {
          ++tally.other;
          std::printf("  seed %llu: %s: %s\n", static_cast<unsigned long long>(seed), drawn.text.c_str(), result.reason.c_str());
        }
        break;
      case RunStatus::interrupted:
        ADD_FAILURE() << "nobody interrupted this run";
    }
    if (seconds > 2)
      std::printf("  seed %llu: %s: %.1f s, %ld retries, %ld iterations\n", static_cast<unsigned long long>(seed), drawn.text.c_str(),
                  seconds, result.counts.retries, result.counts.iterations);
  }
  std::printf("%-22s %9s %10s %14s %10s %6s %10s %8s %11s %8s\n", "method", "completed", "overturned", "energy created", "interface",
              "other", "steps", "retries", "iterations", "seconds");
  for (const auto& [method, tally] : table)
    std::printf("%-22s %9d %10d %14d %10d %6d %10ld %8ld %11ld %8.1f\n", method.c_str(), tally.completed, tally.overturned, tally.energy,
                tally.interface, tally.other, tally.steps, tally.retries, tally.iterations, tally.seconds);
  EXPECT_LE(interface_failures, 10) << "of 1000";
}

}  // namespace
}  // namespace uplift::whole::robust_oscillators_test
