// What rests, and which way the rest moves, is checked here by the positions alone, without the exact checker.
#include <array>

#include <gtest/gtest.h>

#include "fuzz/draw/query_makers.h"

namespace selvage::fuzz {
namespace {

constexpr std::uint64_t kQueries = 4000;

/// The corners that move, as bits.
unsigned moving_corners(const MotionQuery& query) {
  unsigned moving = 0;
  for (int i = 0; i < point_count(query.kind); ++i) {
    const auto corner = static_cast<std::size_t>(i);
    if (query.x_t0[corner] != query.x_t1[corner]) moving |= 1U << i;
  }
  return moving;
}

/// The axis along which all that moves does, -1 for none.
Eigen::Index axis_of(const MotionQuery& query) {
  Vec3 moved = Vec3::Zero();
  for (int i = 0; i < point_count(query.kind); ++i) {
    const auto corner = static_cast<std::size_t>(i);
    moved += (query.x_t1[corner] - query.x_t0[corner]).cwiseAbs();
  }
  if ((moved.array() > 0).count() != 1) return -1;
  Eigen::Index axis = 0;
  moved.maxCoeff(&axis);
  return axis;
}

bool is_level(const MotionQuery& query, unsigned corners, Eigen::Index axis) {
  const Vec3* first = nullptr;
  for (std::size_t i = 0; i < 4; ++i) {
    if ((corners >> i & 1U) == 0) continue;
    if (first == nullptr) first = &query.x_t0[i];
    if (query.x_t0[i][axis] != (*first)[axis]) return false;
  }
  return true;
}

}  // namespace

TEST(RestingMakers, OneFeatureRestsOrAllCornersButOne) {
  for (const PairKind kind : kPairKinds) {
    const unsigned all = (1U << point_count(kind)) - 1, first = kind == PairKind::kEe ? 3 : 1, second = all & ~first;
    std::array<std::uint64_t, 16> moving{};
    for (std::uint64_t seed = 0; seed < kQueries; ++seed) {
      ChoiceSource source = ChoiceSource::from_seed(seed);
      const unsigned corners = moving_corners(make::resting(source, kind));
      ++moving[corners];
      ASSERT_TRUE((corners & first) == 0 || (corners & second) == 0) << seed;
    }
    EXPECT_LT(moving[0], kQueries / 4) << "nothing moves";
    EXPECT_GT(moving[first], kQueries / 5) << name_of(kind);
    EXPECT_GT(moving[second], kQueries / 5) << name_of(kind);
    for (int corner = 0; corner < point_count(kind); ++corner) {
      EXPECT_GT(moving[1U << corner], kQueries / 20) << name_of(kind) << " " << corner;
    }
  }
}

// The commonest scene there is: a level face at rest, and a point that falls on it.
TEST(RestingMakers, LevelFeaturesAreMetAlongTheAxisTheyAreLevelIn) {
  for (const PairKind kind : kPairKinds) {
    const unsigned first = kind == PairKind::kEe ? 3 : 1, second = ((1U << point_count(kind)) - 1) & ~first;
    std::uint64_t level = 0, along_an_axis = 0, free = 0;
    for (std::uint64_t seed = 0; seed < kQueries; ++seed) {
      ChoiceSource source = ChoiceSource::from_seed(seed);
      const MotionQuery query = make::resting(source, kind);
      const Eigen::Index axis = axis_of(query);
      along_an_axis += axis >= 0 ? 1 : 0;
      free += axis < 0 ? 1 : 0;
      level += axis >= 0 && is_level(query, first, axis) && is_level(query, second, axis) ? 1 : 0;
    }
    EXPECT_GT(along_an_axis, kQueries / 3) << name_of(kind);
    EXPECT_GT(free, kQueries / 5) << name_of(kind);
    EXPECT_GT(level, kQueries / 6) << name_of(kind);
  }
}

}  // namespace selvage::fuzz
