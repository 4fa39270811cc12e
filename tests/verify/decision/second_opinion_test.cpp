// The two exact deciders of motions agree on every class of queries, and each class has its share of touches, so that
// agreement means something. Millions: agreement_campaign.
#include "verify/decision/second_opinion.h"

#include <cfenv>
#include <cstdlib>
#include <string>

#include <gtest/gtest.h>

#include "tests/verify/agreement.h"
#include "tests/verify/motion_families.h"

namespace selvage::verify {
namespace {

using testbed::Draw;
using testbed::MotionCase;

TEST(SecondOpinion, AgreesOnEveryClassAndOnTheirRelations) {
  const testbed::Agreement agreement = testbed::compare_deciders(1, 60);
  for (const std::string& disagreement : agreement.disagreements) ADD_FAILURE() << disagreement;
  for (const testbed::ClassTally& tally : agreement.classes) {
    // A class that never touches, or always does, compares nothing; nor does one that the filter decides.
    const std::int64_t queries = tally.drawn + tally.related;
    EXPECT_GE(tally.touches * 100, queries) << tally.name;
    EXPECT_LT(tally.touches, queries) << tally.name;
    EXPECT_GE(tally.unfiltered * 50, queries) << tally.name;
    EXPECT_GT(tally.related, 0) << tally.name;
  }
}

TEST(SecondOpinion, SurvivesARationalRootFoundLate) {
  // CGAL 5.5.1's Sign_at_1 threw "precondition violation: low<high" here: while it separates a polynomial from a root,
  // the root turns out to be rational, and its interval has no width any more. First met after 893 motions of
  // "thirds + 1000".
  const MotionCase motion{{{{0x1.f3d5555555555p+9, 0x1.f4p+9, 0x1.f42aaaaaaaaabp+9},
                            {0x1.f4p+9, 0x1.f3d5555555555p+9, 0x1.f4p+9},
                            {0x1.f3aaaaaaaaaabp+9, 0x1.f42aaaaaaaaabp+9, 0x1.f4aaaaaaaaaabp+9},
                            {0x1.f48p+9, 0x1.f355555555555p+9, 0x1.f3p+9}}},
                          {{{0x1.f4p+9, 0x1.f3aaaaaaaaaabp+9, 0x1.f4p+9},
                            {0x1.f3d5555555555p+9, 0x1.f3d5555555555p+9, 0x1.f4p+9},
                            {0x1.f4p+9, 0x1.f3aaaaaaaaaabp+9, 0x1.f3aaaaaaaaaabp+9},
                            {0x1.f38p+9, 0x1.f42aaaaaaaaabp+9, 0x1.f4aaaaaaaaaabp+9}}}};
  EXPECT_EQ(second_opinion_ee(motion.x_t0, motion.x_t1).touches,
            exact_ee_motion(motion.x_t0, motion.x_t1, Detail::kDecision).touches);
}

TEST(SecondOpinion, LeavesTheRoundingMode) {
  Draw draw(5);
  for (const int mode : {FE_TONEAREST, FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO}) {
    std::fesetround(mode);
    const MotionCase motion = testbed::lattice_families()[0].draw(draw, 2);
    const SecondOpinion second = second_opinion_vf(motion.x_t0, motion.x_t1);
    const int after = std::fegetround();
    std::fesetround(FE_TONEAREST);
    EXPECT_EQ(after, mode);
    EXPECT_EQ(second.touches, exact_vf_motion(motion.x_t0, motion.x_t1, Detail::kDecision).touches);
  }
}

// Of a host that links the checker, whether it asks for a second opinion or not: CGAL would end it as it ends itself.
TEST(SecondOpinion, AHostMayEndInAnotherRoundingMode) {
  const auto end_rounding_up = [] {
    std::fesetround(FE_UPWARD);
    std::exit(0);
  };
  EXPECT_EXIT(end_rounding_up(), ::testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace selvage::verify
