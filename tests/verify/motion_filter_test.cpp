// The filter never contradicts the exact decision, and decides what it is there to decide.
#include "verify/motion_filter.h"

#include <string>

#include <gtest/gtest.h>

#include "tests/verify/motion_families.h"
#include "verify/contact.h"
#include "verify/fp_guard.h"

namespace selvage::verify {
namespace {

using testing::Draw;
using testing::Family;
using testing::MotionCase;

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
  for (const auto& families : {testing::lattice_families(), testing::double_families()}) {
    for (const Family& family : families) {
      SCOPED_TRACE(family.name);
      Draw draw(11);
      Tally tally;
      for (int i = 0; i < 1000 && tally.wrong == 0; ++i) check_all(family.draw(draw, 1 + i % 5), tally);
    }
  }
}

}  // namespace
}  // namespace selvage::verify
