// The filter never contradicts the exact decision, and decides what it is there to decide.
#include "verify/filter/motion_filter.h"

#include <utility>

#include <gtest/gtest.h>

#include "tests/verify/motion_families.h"
#include "verify/arithmetic/fp_guard.h"
#include "verify/decision/contact.h"

namespace selvage::verify {
namespace {

using testbed::Draw;
using testbed::Family;
using testbed::MotionCase;

struct Tally {
  long cases = 0, apart = 0, crosses = 0, wrong = 0;
};

void check(MotionTriage triage, const std::optional<FirstTouch>& exact, const MotionCase& motion, const char* what,
           Tally& tally) {
  ++tally.cases;
  if (triage == MotionTriage::kApart) ++tally.apart;
  if (triage == MotionTriage::kCrosses) ++tally.crosses;
  const bool right =
      triage == MotionTriage::kUnresolved || (triage == MotionTriage::kApart ? !exact : exact && exact->is_cross);
  if (right) return;
  ++tally.wrong;
  ADD_FAILURE() << what << ", case " << tally.cases << ": filter " << static_cast<int>(triage) << ", exact touch "
                << exact.has_value() << motion;
}

void check_all(const MotionCase& motion, Tally& tally) {
  const auto& [x_t0, x_t1] = motion;
  check(triage_vf_motion(x_t0, x_t1), first_vf_touch(moving_points(x_t0, x_t1)), motion, "vertex-face", tally);
  check(triage_ee_motion(x_t0, x_t1), first_ee_touch(moving_points(x_t0, x_t1)), motion, "edge-edge", tally);
  const auto three_t0 = motion.three_t0(), three_t1 = motion.three_t1();
  check(triage_self_motion(three_t0, three_t1), first_self_touch(moving_points(three_t0, three_t1)), motion, "self",
        tally);
}

TEST(MotionFilter, NeverContradictsTheExactDecision) {
  const FpGuard guard;
  for (const auto& [families, count] : {std::pair{testbed::lattice_families(), 1000},
                                        {testbed::double_families(), 1000},
                                        {testbed::whole_range_families(), 100}}) {
    for (const Family& family : families) {
      SCOPED_TRACE(family.name);
      Draw draw(11);
      Tally tally;
      for (int i = 0; i < count && tally.wrong == 0; ++i) check_all(family.draw(draw, 1 + i % 5), tally);
    }
  }
}

/// Uniform points: nothing is degenerate, so little is left for exact arithmetic, although the motions are violent.
TEST(MotionFilter, DecidesOrdinaryMotions) {
  const FpGuard guard;
  Draw draw(12);
  Tally tally;
  constexpr int kCases = 5000;
  for (int i = 0; i < kCases; ++i) {
    MotionCase motion;
    for (auto* points : {&motion.x_t0, &motion.x_t1}) {
      for (Point& point : *points) {
        for (double& coordinate : point) coordinate = static_cast<double>(draw.bits() >> 11) * 0x1p-53;
      }
    }
    check_all(motion, tally);
  }
  EXPECT_EQ(tally.wrong, 0);
  EXPECT_GT(tally.apart + tally.crosses, 0.99 * static_cast<double>(tally.cases));  // 0.9974
  EXPECT_GT(tally.crosses, kCases / 50);
}

}  // namespace
}  // namespace selvage::verify
