// Steps of the macro-element without yielding, and that answers do not depend on what was asked before.
#include <memory>

#include "macro_element_support.h"

namespace uplift::macro_test::macro_element_elastic_test {
namespace {

/// A square of 10 m that lifts and does nothing else.
MacroParameters elastic_square(double shape) {
  MacroParameters p = square();
  p.elasticity.shape = shape;
  p.strength = {.service = HUGE_VAL, .friction = HUGE_VAL};
  return p;
}

/// Openings of a footing under 13 to 54 MN that rocks and slides and is twisted; with `size` 3 mrad its edges lift.
Numbers rocking(int step, double size) {
  const double phase = 0.7 * step;
  return {4e-3 * std::sin(phase),       3e-3 * std::cos(1.3 * phase), -0.0125 + 0.0075 * std::sin(2.1 * phase),
          size * std::sin(1.7 * phase), size * std::cos(phase),       2e-3 * std::sin(0.9 * phase)};
}

/// Every entry of the slope beside central differences, the torsion among them, of the end of a step, of the path average, and of the path
/// average with a joint filter.
TEST(MacroElementElastic, SlopesHaveAllRows) {
  for (const double shape : {4.0, 6.0, 8.0}) {
    Footing footing(elastic_square(shape), 6);
    Numbers scale(6), lag{1e4, -2e4, 3e4, 4e4, -5e4, 6e4}, acts(6, 1.0), plain(6);
    footing.law.closed_stiffness(6, scale.data());
    Batch filtered = footing.batch;
    filtered.coefficient = acts.data(), filtered.lag = lag.data(), filtered.gain = 1.0 / 30;
    const auto answer = [&](int kind, const Numbers& to) {
      const LawResponse response{footing.force.data(), footing.slope.data(), footing.now.data(),
                                 footing.end.data(),   footing.next.data(),  plain.data()};
      if (kind == 0) return footing.respond(to);
      footing.law.mean(kind == 1 ? footing.batch : filtered, footing.opening.data(), to.data(), footing.memory.data(), response);
      return footing.force;
    };
    footing.go(rocking(0, 3e-4));
    for (int step = 1; step < 8; ++step)
      for (int kind = 0; kind < 3; ++kind) {
        const Numbers to = rocking(step, step < 4 ? 3e-4 : 3e-3);
        answer(kind, to);
        const Numbers slope = footing.slope;
        for (std::size_t c = 0; c < 6; ++c) {
          const double h = 1e-8;
          Numbers up = to, down = to;
          up[c] += h, down[c] -= h;
          const Numbers above = answer(kind, up), below = answer(kind, down);
          for (std::size_t r = 0; r < 6; ++r)
            EXPECT_NEAR((above[r] - below[r]) / (2 * h), slope[r * 6 + c], 1e-5 * std::sqrt(scale[r] * scale[c])) << kind << r << c;
        }
        if (kind == 2) footing.go(to);
      }
  }
}

/// A dozen foundations in turns, asked for displacements of each other, for the same ones again and for those of steps before: bit for bit
/// what a foundation answers that is asked nothing else.
TEST(MacroElementElastic, AnswersDoNotDependOnWhatWasAskedBefore) {
  std::vector<MacroParameters> parameters;
  std::vector<std::unique_ptr<Footing>> footings;
  for (int k = 0; k < 12; ++k) {
    parameters.push_back(elastic_square(4 + 2 * (k % 3)));
    parameters.back().elasticity.disc = k % 4 == 1;
    parameters.back().elasticity.vertical *= 1 + k / 3;
    footings.push_back(std::make_unique<Footing>(parameters.back(), k % 2 == 0 ? 6 : 3));
  }
  int lifted = 0;
  for (int turn = 0; turn < 60; ++turn)
    for (std::size_t k = 0; k < footings.size(); ++k) {
      const int components = footings[k]->batch.components;
      Numbers from = rocking(turn % 7, 3e-3), to = rocking(turn % 5, 3e-3);
      if (components == 3) from = {from[0], from[2], from[3]}, to = {to[0], to[2], to[3]};
      Footing alone(parameters[k], components);
      for (Footing* footing : {footings[k].get(), &alone}) footing->opening = from;
      EXPECT_EQ(footings[k]->mean(to), alone.mean(to));
      EXPECT_EQ(footings[k]->slope, alone.slope);
      EXPECT_EQ(footings[k]->stored(from, alone.memory), alone.stored(from, alone.memory));
      lifted += alone.state().uplifted_share > 0;
    }
  EXPECT_GT(lifted, 200);
}

}  // namespace
}  // namespace uplift::macro_test::macro_element_elastic_test
