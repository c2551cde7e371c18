#pragma once
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <numbers>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "tests/data_support.h"
#include "uplift/laws/macro_element.h"

// What the tests of the macro-element share: a footing with its memory and paths at a constant vertical force.
namespace uplift::macro_test {

using Numbers = std::vector<double>;

/// Set P1: a square of 10 m on a half-space with G = 80 MPa, nu = 0.3 (stiffness after Pais & Kausel 1988), V_s = 60 MN.
inline MacroParameters square() {
  MacroParameters p;
  p.elasticity = {.shape = 6,
                  .length = {10, 10},
                  .vertical = 80e6 * 5 / 0.7 * 4.7,
                  .horizontal = {80e6 * 5 / 1.7 * 9.2, 80e6 * 5 / 1.7 * 9.2},
                  .rocking = {80e6 * 125 / 0.7 * 4, 80e6 * 125 / 0.7 * 4}};
  p.strength = {.service = 60e6, .friction = std::tan(std::numbers::pi / 6)};
  p.torsion = 8.31e10;
  return p;
}

/// A square for the plane with nothing but uplift.
inline MacroParameters lifting(double shape, double width, double vertical, double rocking) {
  MacroParameters p;
  p.elasticity = {.shape = shape, .length = {width}, .vertical = vertical, .horizontal = {vertical}, .rocking = {rocking}};
  p.strength = {.service = HUGE_VAL, .friction = HUGE_VAL};
  return p;
}

/// One foundation with its memory. Openings and forces in the rows of the law.
class Footing {
 public:
  Footing(const MacroParameters& parameters, int components) : law(parameters), batch{1, components, 0} {
    const auto n = static_cast<std::size_t>(components);
    opening.assign(n, 0.0), force.assign(n, 0.0), end.assign(n, 0.0);
    slope.assign(n * n, 0.0), next.assign(n * n, 0.0);
    memory.assign(static_cast<std::size_t>(law.num_history(components)), 0.0), now = memory;
  }

  const Numbers& respond(const Numbers& to) {
    law.respond(batch, opening.data(), to.data(), memory.data(), {.traction = force.data(), .slope = slope.data(), .now = now.data()});
    return force;
  }
  const Numbers& mean(const Numbers& to) {
    law.mean(batch, opening.data(), to.data(), memory.data(), {force.data(), slope.data(), now.data(), end.data(), next.data()});
    return force;
  }
  void accept(const Numbers& to) { opening = to, memory = now; }
  const Numbers& go(const Numbers& to) {
    respond(to);
    accept(to);
    return force;
  }

  double stored(const Numbers& at, const Numbers& history) const { return energies(at, history).first; }
  double dissipated(const Numbers& history) const { return energies(opening, history).second; }
  MacroState state() const { return law.state(batch.components, opening.data(), memory.data()); }
  double slope_at(int row, int column) const { return slope[static_cast<std::size_t>(row * batch.components + column)]; }

  /// Goes to the rotation theta at the constant vertical force n and H = M/arm, end of step (plane; arm = 0: H = 0).
  void hold(double theta, double n, double arm) {
    Numbers to{opening[0], opening[1], theta};
    for (int iteration = 0; iteration < 100; ++iteration) {
      respond(to);
      const double inverse = arm > 0 ? 1 / arm : 0, r0 = force[0] - inverse * force[2], r1 = force[1] + n;
      if (std::hypot(r0, r1) < 1e-12 * n) break;
      const double a = slope_at(0, 0) - inverse * slope_at(2, 0), b = slope_at(0, 1) - inverse * slope_at(2, 1), c = slope_at(1, 0),
                   d = slope_at(1, 1), det = a * d - b * c;
      to[0] -= (d * r0 - b * r1) / det;
      to[1] -= (a * r1 - c * r0) / det;
    }
    EXPECT_NEAR(-force[1], n, 1e-9 * n) << "theta " << theta;
    accept(to);
  }

  MacroElement law;
  Batch batch;
  Numbers opening, force, end, slope, next, memory, now;

 private:
  std::pair<double, double> energies(const Numbers& at, const Numbers& history) const {
    double kept = 0, lost = 0;
    law.energy(batch, at.data(), history.data(), &kept, &lost);
    return {kept, lost};
  }
};

/// A state of `path_of_legs`: rotation, M, settlement, H, u, accumulated settlement, dissipated energy: with the forces at the end of each
/// step, and with their means over the step.
struct Leg {
  double theta, m, w, h, u, accumulated, dissipated, by_means;
};

/// At rest, then at the end of each step of the legs 0 -> turn -> -turn -> turn at the vertical force n and H = M/arm, `steps` of equal
/// size in each (plane; arm = 0: H = 0).
inline std::vector<Leg> path_of_legs(const MacroParameters& p, double n, int steps, double arm, double turn) {
  Footing footing(p, 3);
  footing.go({0, -n / p.elasticity.vertical, 0});
  std::vector<Leg> out;
  double by_means = 0;
  const auto note = [&] {
    const MacroState state = footing.state();
    out.push_back({footing.opening[2], footing.force[2], -footing.opening[1], footing.force[0], footing.opening[0], state.accumulated,
                   state.dissipated, by_means});
  };
  note();
  for (const double target : {turn, -turn, turn}) {
    const double from = footing.opening[2];
    for (int i = 1; i <= steps; ++i) {
      Footing before = footing;
      footing.hold(from + (target - from) * i / steps, n, arm);
      before.mean(footing.opening);
      by_means += before.dissipated(before.now) - before.dissipated(before.memory);
      note();
    }
  }
  return out;
}

/// The ends of the legs.
inline std::vector<Leg> legs(const MacroParameters& p, double n, int steps, double arm, double turn) {
  const std::vector<Leg> path = path_of_legs(p, n, steps, arm, turn);
  const auto count = static_cast<std::size_t>(steps);
  return {path[count], path[2 * count], path[3 * count]};
}

/// Random openings about the plastic ones: N from none to above V_s, shear and rotation up to `size` times those of set P1 at uplift.
class RandomPath {
 public:
  RandomPath(int components, double size, unsigned seed) : components_(components), size_(size), random_(seed) {}

  Numbers next(const Numbers& plastic) {
    const double w = 20e6 / square().elasticity.vertical, theta = 20e6 * 10 / 6 / square().elasticity.rocking[0];
    const auto normal = components_ == 3 ? 1u : 2u;
    Numbers to(static_cast<std::size_t>(components_));
    for (std::size_t r = 0; r < to.size(); ++r) {
      const double offset = r < to.size() - (components_ == 6 ? 1 : 0) ? plastic[r] : 0;
      to[r] = offset + (r < normal    ? size_ * w * any()
                        : r == normal ? -w * (1 + std::min(1.3 * size_, 2.0) * any())
                                      : size_ * theta * any());
    }
    return to;
  }

 private:
  double any() { return std::uniform_real_distribution<double>(-1, 1)(random_); }
  int components_;
  double size_;
  std::mt19937 random_;
};

inline bool finite(const Numbers& values) {
  return std::ranges::all_of(values, [](double value) { return std::isfinite(value); });
}

/// The slope beside central differences at the end of 12 steps of a path and in their mean: errors relative to the closed stiffnesses,
/// ascending.
inline Numbers slope_errors(Footing& footing, RandomPath& path) {
  const int components = footing.batch.components;
  Numbers scale(static_cast<std::size_t>(components)), errors;
  footing.law.closed_stiffness(components, scale.data());
  const std::size_t n = scale.size(), normal = components == 3 ? 1 : 2;
  for (int i = 0; i < 12; ++i) {
    const Numbers to = path.next(footing.memory);
    for (const bool average : {false, true}) {
      const auto at = [&](const Numbers& where) { return average ? footing.mean(where) : footing.respond(where); };
      if (!finite(at(to))) continue;
      const Numbers slope = footing.slope;
      double error = 0;
      for (std::size_t c = 0; c < n; ++c) {
        const double h = c <= normal ? 1e-8 : 1e-9;
        Numbers moved = to;
        moved[c] += h;
        const Numbers up = at(moved);
        moved[c] -= 2 * h;
        const Numbers down = at(moved);
        for (std::size_t r = 0; r < n; ++r)
          error = std::max(error, std::abs((up[r] - down[r]) / (2 * h) - slope[r * n + c]) / std::sqrt(scale[r] * scale[c]));
      }
      errors.push_back(std::isfinite(error) ? error : 1);
    }
    if (finite(footing.mean(to))) footing.accept(to);
  }
  std::ranges::sort(errors);
  return errors;
}

/// Rows of a table of tests/data/reference by column name; the values that are no numbers as they are.
inline std::vector<std::map<std::string, std::string>> table(const std::string& name) {
  std::ifstream file(support::data_file("reference/" + name));
  std::string line, cell;
  std::vector<std::string> head;
  std::vector<std::map<std::string, std::string>> rows;
  while (std::getline(file, line)) {
    std::stringstream cells(line);
    std::vector<std::string> values;
    while (std::getline(cells, cell, ',')) values.push_back(cell);
    if (head.empty()) {
      head = values;
      continue;
    }
    rows.emplace_back();
    for (std::size_t i = 0; i < values.size() && i < head.size(); ++i) rows.back()[head[i]] = values[i];
  }
  return rows;
}

}  // namespace uplift::macro_test
