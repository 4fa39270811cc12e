#include "sim/step_lengths.h"

#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "sim/scene/scene_reader.h"

namespace selvage {

using namespace sim;

namespace {

/// Of a sheet of edges of 0.1 m; `time` goes to its table, `more` to the top.
StepLengths lengths(const std::string& time = "", const std::string& more = "") {
  const Scene scene = parse_scene(more + "[time]\nframes_per_s = 30\nframes = 1\n" + time +
                                      "[[cloth]]\nsheet = {nx = 4, ny = 4, width_m = 0.3, height_m = 0.3}\n"
                                      "density_kg_m2 = 0.2\nstretch_n_m = 40\n",
                                  "lengths.toml");
  return {scene, build_world(scene)};
}

}  // namespace

TEST(StepLengths, TheShortestIsTheDynamicsStepWhereNothingIsFast) {
  const StepLengths explicit_steps = lengths();
  EXPECT_GT(explicit_steps.dynamics_s(), 0);
  EXPECT_LT(explicit_steps.dynamics_s(), 1.0 / 30);
  EXPECT_EQ(explicit_steps.shortest_s(0), explicit_steps.dynamics_s());
  EXPECT_EQ(explicit_steps.shortest_s(1e-3), explicit_steps.dynamics_s());
  const StepLengths implicit = lengths("max_step_s = 0.02\n", "solver = \"implicit\"\n");
  EXPECT_EQ(implicit.dynamics_s(), 0.02);
  EXPECT_EQ(implicit.shortest_s(0), 0.02 / 8);
}

TEST(StepLengths, WhatMeetsGoesASixteenthOfASpringInTheShortest) {
  // Springs along the edges alone: all are 0.1 m.
  const StepLengths steps = lengths();
  const double slow_s = steps.dynamics_s();
  for (const double share : {1.0, 2.0, 8.0, 60.0}) {
    const double fast_m_s = share * 0.1 / 16 / slow_s;
    EXPECT_NEAR(steps.shortest_s(fast_m_s), slow_s / share, 1e-12) << share;
  }
  EXPECT_EQ(steps.shortest_s(1e6), slow_s / 64) << "and no further";
  EXPECT_EQ(steps.shortest_s(std::numeric_limits<double>::infinity()), slow_s / 64);
  StepClock clock = steps.clock();
  while (clock.can_halve(steps.shortest_s(1e6))) clock.halve();
  EXPECT_LE(clock.dt_s(), 2 * slow_s / 64);
  StepClock calm = steps.clock();
  while (calm.can_halve(steps.shortest_s(0))) calm.halve();
  EXPECT_GE(calm.dt_s(), slow_s * (1 - 1e-3));
  EXPECT_LT(calm.dt_s(), 2 * slow_s);
}

TEST(StepLengths, AShortestStepOfTheSceneHoldsAtAnySpeed) {
  const StepLengths steps = lengths("min_step_s = 0.003\n");
  EXPECT_EQ(steps.shortest_s(0), 0.003);
  EXPECT_EQ(steps.shortest_s(1e6), 0.003);
}

}  // namespace selvage
