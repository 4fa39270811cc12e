// The judge of a mesh's collisions can be told from one that always agrees: it finds out what is left out, late or made
// up.
#include "fuzz/oracle/collisions_oracle.h"

#include <functional>
#include <limits>

#include <gtest/gtest.h>

#include "fuzz/draw/step_world.h"
#include "fuzz/kept/collisions_case.h"

namespace selvage::fuzz {
namespace {

constexpr std::uint64_t kWorlds = 60;

/// In how many worlds, of those whose report `spoil` changes, the judge says `failure`; and in how many it has to.
struct Heard {
  int named = 0, spoilt = 0;
};
Heard hear(const std::function<bool(CollisionReport&)>& spoil, const std::string& failure) {
  Heard heard;
  for (std::uint64_t seed = 0; seed < kWorlds; ++seed) {
    ChoiceSource source = ChoiceSource::from_seed(seed);
    const StepWorld world = make_step_world(source);
    std::string_view candidate_class;
    const Positions x_t1 = choose_candidate(source, world, world.x, candidate_class);
    if (!(x_t1.cwiseAbs().maxCoeff() <= kMaxCoordinate)) continue;
    BoxHierarchy hierarchy(world.mesh);
    const CcdOptions options{.tolerance = choose_length(source, world)};
    CollisionReport report = find_collisions(world.mesh, hierarchy, world.x, x_t1, options);
    if (!spoil(report)) continue;
    ++heard.spoilt;
    const std::vector<std::uint8_t> all;
    heard.named += judge(AnsweredMotion{world.mesh, world.x, x_t1, options, all, report}).failure == failure ? 1 : 0;
  }
  return heard;
}

TEST(CollisionsOracle, AgreesWithTheKernel) {
  const Heard heard = hear([](CollisionReport& report) { return !report.collisions.empty(); }, "");
  EXPECT_GT(heard.spoilt, 20);
  EXPECT_EQ(heard.named, heard.spoilt);
}

TEST(CollisionsOracle, HearsOfATouchThatIsLeftOut) {
  // The exact touch is the last that may be left out: an alarm may be of a pair that only comes near.
  const Heard heard = hear(
      [](CollisionReport& report) {
        if (report.collisions.empty()) return false;
        report.collisions.clear();
        report.toi_lower = 0;
        return true;
      },
      "missed");
  EXPECT_GT(heard.named, 20);
}

TEST(CollisionsOracle, HearsOfATimeForAllThatIsLate) {
  const Heard heard = hear(
      [](CollisionReport& report) {
        if (report.toi_lower == 1) return false;
        report.toi_lower = 1;
        return true;
      },
      "late-toi");
  EXPECT_GT(heard.spoilt, 20);
  EXPECT_EQ(heard.named, heard.spoilt);
}

TEST(CollisionsOracle, HearsOfWhatIsNoPairOfTheMesh) {
  const Heard heard = hear(
      [](CollisionReport& report) {
        report.collisions.push_back({PairKind::kSelf, 0, std::numeric_limits<std::int32_t>::max(), {}});
        report.toi_lower = 0;
        return true;
      },
      "malformed");
  EXPECT_GT(heard.spoilt, 20);
  EXPECT_EQ(heard.named, heard.spoilt);
}

TEST(CollisionsOracle, KeptCasesOfTheKernelHold) {
  for (std::uint64_t seed = 0; seed < kWorlds; ++seed) {
    ChoiceSource source = ChoiceSource::from_seed(seed);
    const StepWorld world = make_step_world(source);
    std::string_view candidate_class;
    const Positions x_t1 = choose_candidate(source, world, world.x, candidate_class);
    const double tolerance = choose_length(source, world);
    const CollisionsTrial trial =
        try_collisions(collisions_case(world.mesh, world.x, x_t1, tolerance, choose_active(source, world)));
    EXPECT_EQ(trial.retrial.failure, "") << seed;
  }
}

}  // namespace
}  // namespace selvage::fuzz
