// Corners that meet are checked here by their positions alone, without the exact checker.
#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "fuzz/draw/query_makers.h"

namespace selvage::fuzz {
namespace {

constexpr std::uint64_t kMeetings = 1000;
/// A coordinate moves nine ulps at most, three times three, in one of the ends.
constexpr double kMoved = 9 * 0x1p-52;

std::vector<Vec3> corners(const std::array<Vec3, 4>& x, PairKind kind) {
  return {x.begin(), x.begin() + point_count(kind)};
}

/// In how many places, moved ones counted as one, the corners are at time n / d.
std::size_t places_at(const MotionQuery& query, int n, int d) {
  const double near = 2 * kMoved * max_coordinate(query);
  std::vector<Vec3> places;
  for (std::size_t i = 0; i < corners(query.x_t0, query.kind).size(); ++i) {
    const Vec3 x = ((d - n) * query.x_t0[i] + n * query.x_t1[i]) / d;
    const auto is_near = [&](const Vec3& place) { return (place - x).cwiseAbs().maxCoeff() <= near; };
    if (std::ranges::none_of(places, is_near)) places.push_back(x);
  }
  return places.size();
}

std::size_t fewest_places(const MotionQuery& query) {
  std::size_t fewest = 4;
  for (const int d : {2, 4, 8, 16, 32, 3, 5, 7}) {
    for (int n = 1; n < d; ++n) fewest = std::min(fewest, places_at(query, n, d));
  }
  return fewest;
}

/// Made of integers; whatever is none has been moved by ulps.
bool is_nudged(const MotionQuery& query) {
  const auto is_whole = [](const Vec3& x) { return x == x.array().round().matrix(); };
  return !std::ranges::all_of(query.x_t0, is_whole) || !std::ranges::all_of(query.x_t1, is_whole);
}

TEST(MeetingMakers, CornersOfOnePointMeetInItOrInTwo) {
  for (const PairKind kind : kPairKinds) {
    std::array<std::uint64_t, 5> in_places{};
    std::uint64_t nudged = 0;
    for (std::uint64_t seed = 0; seed < kMeetings; ++seed) {
      ChoiceSource source = ChoiceSource::from_seed(seed);
      const MotionQuery query = make::one_point(source, kind);
      ++in_places[fewest_places(query)];
      nudged += is_nudged(query);
    }
    EXPECT_EQ(in_places[3] + in_places[4], 0U) << name_of(kind);
    EXPECT_GT(in_places[1], kMeetings * 3 / 4) << name_of(kind);
    EXPECT_GT(in_places[2], kMeetings / 8) << name_of(kind);
    EXPECT_GT(nudged, kMeetings / 2) << name_of(kind);
    EXPECT_LT(nudged, kMeetings * 3 / 4) << name_of(kind);
  }
}

TEST(MeetingMakers, ExchangedCornersEndWhereOthersStart) {
  for (const PairKind kind : kPairKinds) {
    std::uint64_t moving = 0, nudged = 0;
    for (std::uint64_t seed = 0; seed < kMeetings; ++seed) {
      ChoiceSource source = ChoiceSource::from_seed(seed);
      const MotionQuery query = make::exchange(source, kind);
      const double near = 2 * kMoved * max_coordinate(query);
      const auto is_near = [&](const Vec3& a, const Vec3& b) { return (a - b).cwiseAbs().maxCoeff() <= near; };
      EXPECT_TRUE(std::ranges::is_permutation(corners(query.x_t0, kind), corners(query.x_t1, kind), is_near)) << seed;
      moving += !is_near(query.x_t0[0], query.x_t1[0]);
      nudged += is_nudged(query);
    }
    EXPECT_GT(moving, kMeetings / 2) << name_of(kind);
    EXPECT_GT(nudged, kMeetings / 2) << name_of(kind);
    EXPECT_LT(nudged, kMeetings * 3 / 4) << name_of(kind);
  }
}

}  // namespace
}  // namespace selvage::fuzz
