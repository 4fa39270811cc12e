#include "sim/step_clock.h"

#include <random>

#include <gtest/gtest.h>

namespace selvage {

using sim::StepClock;

TEST(StepClock, StartsWithTheLongestStep) {
  EXPECT_EQ(StepClock(25, 1e-3, 0.04).dt_s(), 1.0 / 25);
  EXPECT_EQ(StepClock(25, 1e-3, 0.02).dt_s(), 1.0 / 50);
  EXPECT_EQ(StepClock(30, 1e-3, 0.0166667).dt_s(), 1.0 / 60) << "decimals of a sixtieth";
  EXPECT_EQ(StepClock(25, 0.015, 0.015).dt_s(), 1.0 / 100) << "never above the longest";
}

TEST(StepClock, HalvesDownToTheShortest) {
  StepClock clock(25, 0.0025, 0.04);
  int halvings = 0;
  for (; clock.can_halve(); ++halvings) clock.halve();
  EXPECT_EQ(halvings, 4);
  EXPECT_EQ(clock.halvings(), 4);
  EXPECT_EQ(clock.dt_s(), 0.04 / 16);
}

TEST(StepClock, HalvesToNoLessThanIsAskedFor) {
  const StepClock clock(25, 0.0025, 0.04);
  EXPECT_TRUE(clock.can_halve(0.02));
  EXPECT_TRUE(clock.can_halve(0.020001)) << "in decimals";
  EXPECT_FALSE(clock.can_halve(0.021));
}

TEST(StepClock, DoublesAfterThreeGoodStepsInARow) {
  StepClock clock(25, 0.0025, 0.04);
  for (int i = 0; i < 3; ++i) clock.halve();
  const double dt_s = clock.dt_s();
  clock.advance(true);
  clock.advance(true);
  clock.advance(false);  // breaks the row
  clock.advance(true);
  clock.advance(true);
  EXPECT_EQ(clock.dt_s(), dt_s);
  clock.advance(true);  // the third; six small steps are done, so the doubled step is aligned
  EXPECT_EQ(clock.dt_s(), 2 * dt_s);
}

TEST(StepClock, AStepThatIsShortenedIsNoFailure) {
  StepClock clock(25, 0.0025, 0.04);
  clock.halve();
  for (int i = 0; i < 4; ++i) clock.advance(true);
  ASSERT_EQ(clock.halvings(), 0);  // on trial
  clock.shorten();
  EXPECT_EQ(clock.halvings(), 1);
  EXPECT_EQ(clock.state().good_steps_asked, 3);
}

/// Good steps until the step is doubled.
int steps_to_double(StepClock& clock) {
  const double dt_s = clock.dt_s();
  int steps = 0;
  for (; clock.dt_s() == dt_s; ++steps) clock.advance(true);
  return steps;
}

TEST(StepClock, TriesLongStepsThatFailLessAndLessOften) {
  StepClock clock(25, 0.0025, 0.04);
  clock.halve();
  for (const int asked : {4, 6, 12, 24, 48}) {  // three, and one to be aligned
    EXPECT_EQ(steps_to_double(clock), asked);
    clock.halve();
  }
  // One that lasts for four steps is forgiven all that.
  EXPECT_EQ(steps_to_double(clock), 96);
  for (int i = 0; i < 3; ++i) clock.advance(false);
  clock.halve();
  EXPECT_EQ(steps_to_double(clock), 192);
  for (int i = 0; i < 4; ++i) clock.advance(false);
  clock.halve();
  EXPECT_EQ(steps_to_double(clock), 4);
}

TEST(StepClock, TriesLongStepsAgainHoweverOftenTheyFailed) {
  StepClock clock(25, 0.0025, 0.04);
  clock.halve();
  for (int failure = 0; failure < 12; ++failure) {
    steps_to_double(clock);
    clock.halve();
  }
  EXPECT_EQ(clock.state().good_steps_asked, 3072);
}

TEST(StepClock, CountsOneFailureHoweverOftenItHalves) {
  StepClock clock(25, 0.0025, 0.04);
  clock.halve();
  steps_to_double(clock);
  for (int i = 0; i < 3; ++i) clock.halve();
  EXPECT_EQ(steps_to_double(clock), 6);
}

TEST(StepClock, WaitsUntilTheDoubledStepFitsTheFrame) {
  StepClock clock(25, 0.0025, 0.04);
  clock.halve();
  clock.halve();  // quarters
  const double dt_s = clock.dt_s();
  for (int i = 0; i < 3; ++i) clock.advance(true);
  EXPECT_EQ(clock.dt_s(), dt_s) << "three quarters are done: a half would cross the frame";
  clock.advance(true);
  EXPECT_TRUE(clock.at_frame());
  EXPECT_EQ(clock.dt_s(), 2 * dt_s);
}

TEST(StepClock, MeetsEveryFrameExactlyUnderAnyHistory) {
  for (std::uint32_t seed = 0; seed < 50; ++seed) {
    std::mt19937 generator(seed);
    StepClock clock(30, 5e-4, 1.0 / 30);
    std::int64_t frames = 0;
    for (int i = 0; i < 2000; ++i) {
      if (generator() % 4 == 0 && clock.can_halve()) clock.halve();
      const double end_s = clock.end_s(), start_s = clock.time_s();
      EXPECT_NEAR(end_s - start_s, clock.dt_s(), 1e-12);
      clock.advance(generator() % 3 != 0);
      EXPECT_EQ(clock.time_s(), end_s);
      if (clock.at_frame()) {
        ++frames;
        EXPECT_EQ(clock.time_s(), double(frames) / 30);
        EXPECT_EQ(clock.state().frame, frames);
      } else {
        EXPECT_LT(clock.time_s(), double(frames + 1) / 30);
      }
    }
    EXPECT_GT(frames, 10);
  }
}

TEST(StepClock, GoesOnFromItsStateAlone) {
  StepClock clock(30, 1e-3, 1.0 / 30), copy(30, 1e-3, 1.0 / 30);
  clock.halve();
  clock.halve();
  clock.advance(true);
  copy.restore(clock.state());
  for (int i = 0; i < 40; ++i) {
    EXPECT_EQ(copy.end_s(), clock.end_s());
    clock.advance(i % 5 != 0);
    copy.advance(i % 5 != 0);
  }
}

}  // namespace selvage
