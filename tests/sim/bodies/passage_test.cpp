// How a step sees what a body does within it.
#include "sim/bodies/passage.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include <gtest/gtest.h>

namespace selvage::sim {
namespace {

/// Of one vertex, looked at in quarters, and at `more`.
Passage passage_of(const std::function<Vec3(double)>& at, std::vector<double> more = {}) {
  const auto placed = [&](double share) { return Positions(at(share).transpose()); };
  Passage passage(placed(0), placed(0.5), placed(1));
  more.insert(more.end(), {0.25, 0.75});
  for (const double share : more) passage.add(share, placed(share));
  return passage;
}

/// Along x, still until `start` and after `end`.
auto stroke(double start, double end) {
  return [=](double share) { return Vec3((std::clamp(share, start, end) - start) / (end - start), 0, 0); };
}

}  // namespace

TEST(Passage, WhatSpeedsUpEvenlyIsSeenToDoSo) {
  const Passage passage = passage_of([](double s) { return Vec3(s, 3 * s * s, 0); });
  EXPECT_LT((passage.bow_m() - Eigen::RowVector3d(0, 3, 0)).norm(), 1e-14);
  EXPECT_EQ(passage.off_by_m(), 0);
  EXPECT_NEAR(passage.leaves_line_by_m(), 0.75 / std::sqrt(10), 1e-14);  // halfway; the way is (1, 3)
}

TEST(Passage, WhatTurnsIsSeenToTurn) {
  const double turn = std::acos(-1) / 2;
  const Passage passage = passage_of([&](double s) { return Vec3(std::cos(turn * s), std::sin(turn * s), 0); });
  EXPECT_GT(passage.bow_m().norm(), 1.1);
  EXPECT_LT(passage.off_by_m(), 0.03);
}

TEST(Passage, WhatStartsOrStopsWithinAStepIsSeenToGoEvenly) {
  for (double start = 1.0 / 64; start < 1; start += 1.0 / 64) {
    for (const auto& motion : {stroke(start, 1), stroke(0, start), stroke(start - 1.0 / 64, start)}) {
      const Passage passage = passage_of(motion, {start});
      EXPECT_EQ(passage.bow_m().norm(), 0) << start;
      const double late_m = std::abs(motion(start).x() - start);
      EXPECT_GE(passage.off_by_m(), late_m * (1 - 1e-12)) << start;
      EXPECT_EQ(passage.leaves_line_by_m(), 0) << start;
    }
  }
}

TEST(Passage, WhatStartsAndStopsWithinAStepIsSeenToGoEvenly) {
  constexpr double kPart = 1.0 / 32;
  for (double start = kPart; start < 1; start += kPart) {
    for (double end = start + kPart; end < 1; end += kPart) {
      const Passage passage = passage_of(stroke(start, end), {start, end});
      EXPECT_EQ(passage.bow_m().norm(), 0) << start << " " << end;
      EXPECT_GE(passage.off_by_m(), std::max(start, 1 - end) * (1 - 1e-12)) << start << " " << end;
    }
  }
}

// What passage.cpp says of cubic keys and of turns: as of these steps and angles on they are seen as they move.
TEST(Passage, WhatComesSmoothlyFromRestToRestIsSeenToDoSo) {
  for (const double steps : {2.5, 3.0, 10.0, 100.0}) {
    const auto key = [&](double share) {
      const double u = share / steps;
      return Vec3(u * u * (3 - 2 * u), 0, 0);
    };
    EXPECT_GT(passage_of(key).bow_m().norm(), 0) << steps;
  }
  for (const double turn : {0.01, 0.1, 1.0, 1.9}) {
    const auto round = [&](double share) { return Vec3(std::cos(turn * share), std::sin(turn * share), 0); };
    EXPECT_GT(passage_of(round).bow_m().norm(), 0) << turn;
  }
}

}  // namespace selvage::sim
