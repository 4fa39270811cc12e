// Relations that an exact decision must satisfy, whatever the answer is. Asked of the integer decision itself, without
// the filter, which would hide it on simple motions.
#include <algorithm>
#include <string>

#include <gtest/gtest.h>

#include "tests/verify/motion_families.h"
#include "verify/contact.h"

namespace selvage::verify {
namespace {

using testing::Draw;
using testing::MotionCase;
using Four = std::array<Point, 4>;

enum class Question { kVf, kEe };
constexpr std::array<Question, 2> kBoth = {Question::kVf, Question::kEe};

std::optional<FirstTouch> ask(Question question, const MotionCase& motion) {
  const auto points = moving_points(motion.x_t0, motion.x_t1);
  return question == Question::kVf ? first_vf_touch(points) : first_ee_touch(points);
}

/// The same touches at the same time.
void expect_same(Question question, const MotionCase& a, const MotionCase& b, const char* relation) {
  auto first = ask(question, a), second = ask(question, b);
  ASSERT_EQ(first.has_value(), second.has_value()) << relation << (question == Question::kVf ? ", vf" : ", ee") << a;
  if (!first) return;
  ASSERT_EQ(compare(first->instant, second->instant), 0)
      << relation << (question == Question::kVf ? ", vf" : ", ee") << a;
  ASSERT_EQ(first->is_cross, second->is_cross) << relation << (question == Question::kVf ? ", vf" : ", ee") << a;
}

template <class Change>
MotionCase mapped(MotionCase motion, const Change& change) {
  for (auto* points : {&motion.x_t0, &motion.x_t1}) {
    for (Point& point : *points) point = change(point);
  }
  return motion;
}

MotionCase reordered(const MotionCase& motion, const std::array<std::size_t, 4>& order) {
  MotionCase result;
  for (std::size_t i = 0; i < 4; ++i) {
    result.x_t0[i] = motion.x_t0[order[i]];
    result.x_t1[i] = motion.x_t1[order[i]];
  }
  return result;
}

/// Calls check(motion) on every lattice family, and on planted hits, which the families hold too few of.
template <class Check>
void for_all(std::uint64_t seed, int count, const Check& check) {
  Draw draw(seed);
  for (const testing::Family& family : testing::lattice_families()) {
    SCOPED_TRACE(family.name);
    for (int i = 0; i < count; ++i) {
      ASSERT_NO_FATAL_FAILURE(check(family.draw(draw, 1 + i % 5))) << "case " << i;
    }
  }
  for (int i = 0; i < count; ++i) {
    ASSERT_NO_FATAL_FAILURE(check(testing::planted_vf_hit(draw, 1 + i % 5).motion)) << "planted case " << i;
    ASSERT_NO_FATAL_FAILURE(check(testing::planted_ee_hit(draw, 1 + i % 5).motion)) << "planted case " << i;
  }
}

TEST(MotionRelations, TimeReversal) {
  for_all(31, 300, [](const MotionCase& motion) {
    for (const Question question : kBoth) {
      ASSERT_EQ(ask(question, motion).has_value(), ask(question, {motion.x_t1, motion.x_t0}).has_value()) << motion;
    }
  });
}

TEST(MotionRelations, OrderOfCornersEndsAndEdges) {
  for_all(32, 100, [](const MotionCase& motion) {
    for (const auto& order :
         {std::array<std::size_t, 4>{0, 2, 1, 3}, {0, 1, 3, 2}, {0, 3, 2, 1}, {0, 2, 3, 1}, {0, 3, 1, 2}}) {
      ASSERT_NO_FATAL_FAILURE(expect_same(Question::kVf, motion, reordered(motion, order), "corners"));
    }
    for (const auto& order : {std::array<std::size_t, 4>{1, 0, 2, 3}, {0, 1, 3, 2}, {2, 3, 0, 1}, {3, 2, 1, 0}}) {
      ASSERT_NO_FATAL_FAILURE(expect_same(Question::kEe, motion, reordered(motion, order), "ends and edges"));
    }
  });
}

TEST(MotionRelations, ExactMapsOfSpace) {
  for_all(33, 100, [](const MotionCase& motion) {
    for (const Question question : kBoth) {
      const auto same = [&](const char* relation, const auto& map) {
        ASSERT_NO_FATAL_FAILURE(expect_same(question, motion, mapped(motion, map), relation));
      };
      same("axis cycle", [](const Point& p) { return Point{p[1], p[2], p[0]}; });
      same("scale by 8", [](const Point& p) { return Point{8 * p[0], 8 * p[1], 8 * p[2]}; });
      same("reflection", [](const Point& p) { return Point{-p[0], p[1], p[2]}; });
      same("3-4-5 rotation, times 5", [](const Point& p) {
        return Point{3 * p[0] - 4 * p[1], 4 * p[0] + 3 * p[1], 5 * p[2]};
      });
      same("shear", [](const Point& p) { return Point{p[0] + 2 * p[1], p[1], p[2] - p[0]}; });
    }
  });
}

TEST(MotionRelations, CommonMotionIsInvisible) {
  Draw shifts(36);
  for_all(34, 100, [&shifts](const MotionCase& motion) {
    MotionCase moved = motion;
    const Point first = shifts.point(1000), last = shifts.point(1000);
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        moved.x_t0[i][k] += first[k];
        moved.x_t1[i][k] += last[k];
      }
    }
    for (const Question question : kBoth) {
      ASSERT_NO_FATAL_FAILURE(expect_same(question, motion, moved, "common motion"));
    }
  });
}

/// The first half of the motion, or the second; its times are twice the whole one's, or twice minus one.
MotionCase half(const MotionCase& motion, bool second) {
  MotionCase result = motion;
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      (second ? result.x_t0 : result.x_t1)[i][k] = (motion.x_t0[i][k] + motion.x_t1[i][k]) / 2;
    }
  }
  return result;
}

TEST(MotionRelations, SplitInHalves) {
  for_all(35, 300, [](const MotionCase& drawn) {
    const MotionCase motion = mapped(drawn, [](const Point& p) { return Point{2 * p[0], 2 * p[1], 2 * p[2]}; });
    for (const Question question : kBoth) {
      const auto whole = ask(question, motion);
      auto first = ask(question, half(motion, false)), second = ask(question, half(motion, true));
      ASSERT_EQ(whole.has_value(), first || second) << (question == Question::kVf ? "vf" : "ee") << motion;
      if (!whole) continue;
      // The whole one's first time, against the middle.
      Instant middle = Instant::dyadic(1, 1), time = whole->instant;
      ASSERT_EQ(compare(time, middle) <= 0, first.has_value()) << motion;
      // No crossing is lost or invented where the halves do not cut it.
      if (first && compare(time, middle) < 0) {
        ASSERT_EQ(whole->is_cross, first->is_cross) << motion;
      }
      if (!first && compare(time, middle) > 0) {
        ASSERT_EQ(whole->is_cross, second->is_cross) << motion;
      }
    }
  });
}

}  // namespace
}  // namespace selvage::verify
