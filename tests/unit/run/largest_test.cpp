#include "uplift/run/largest.h"

#include <gtest/gtest.h>

#include <random>

// The instant of the largest energy that was created: of steps that tie up to round-off the first one.
namespace uplift::largest_test {
namespace {

TEST(LargestOfALedger, TiesKeepTheFirstInstantWhateverRoundOffSays) {
  std::mt19937 engine(1);
  std::uniform_real_distribution<double> round_off(-1e-12, 1e-12);
  for (int trial = 0; trial < 100; ++trial) {
    double largest = 0, time = 0;
    const double values[] = {0, 0.8, 1, 1, 0.3, 1};
    for (int step = 0; step < 6; ++step) note_largest(36.5 * values[step] * (1 + round_off(engine)), 0.166 + 2e-3 * step, largest, time);
    EXPECT_EQ(time, 0.166 + 2e-3 * 2) << trial;
    EXPECT_NEAR(largest, 36.5, 1e-10);
  }
}

TEST(LargestOfALedger, MovesToWhatIsReallyLarger) {
  double largest = 0, time = 0;
  note_largest(-1, 1, largest, time);
  EXPECT_EQ(time, 0) << "nothing was created";
  note_largest(1e-30, 2, largest, time);
  EXPECT_EQ(time, 2);
  note_largest(1, 3, largest, time);
  note_largest(1 + 1e-8, 4, largest, time);
  EXPECT_EQ(time, 4);
  EXPECT_EQ(largest, 1 + 1e-8);
}

}  // namespace
}  // namespace uplift::largest_test
