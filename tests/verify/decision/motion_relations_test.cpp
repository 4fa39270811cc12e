// Relations that an exact decision must satisfy, whatever the answer is (motion_relations.h).
#include "tests/verify/motion_relations.h"

#include <gtest/gtest.h>

namespace selvage::verify::testbed {
namespace {

/// Calls broken(motion) on every lattice family, and on planted hits, which the families hold too few of.
template <class Broken>
void for_all(std::uint64_t seed, int count, const Broken& broken) {
  Draw draw(seed);
  for (const Family& family : lattice_families()) {
    for (int i = 0; i < count; ++i) {
      const MotionCase motion = family.draw(draw, 1 + i % 5);
      ASSERT_EQ(broken(motion), "") << family.name << ", case " << i << motion;
    }
  }
  for (int i = 0; i < count; ++i) {
    for (const MotionCase& motion : {planted_vf_hit(draw, 1 + i % 5).motion, planted_ee_hit(draw, 1 + i % 5).motion}) {
      ASSERT_EQ(broken(motion), "") << "planted, case " << i << motion;
    }
  }
}

TEST(MotionRelations, TimeReversal) { for_all(31, 300, broken_by_time_reversal); }
TEST(MotionRelations, OrderOfCornersEndsAndEdges) { for_all(32, 100, broken_by_order); }
TEST(MotionRelations, ExactMapsOfSpace) { for_all(33, 100, broken_by_maps); }
TEST(MotionRelations, CommonMotionIsInvisible) {
  Draw shifts(36);
  for_all(34, 100, [&shifts](const MotionCase& motion) { return broken_by_common_motion(motion, shifts); });
}
TEST(MotionRelations, SplitInHalves) { for_all(35, 300, broken_by_split); }

}  // namespace
}  // namespace selvage::verify::testbed
