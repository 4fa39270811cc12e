// The collision step under random worlds and hostile candidates (S1 to S4), every step judged by exact arithmetic; and
// the proof that each check can fail, by steps that are known to be bad.
#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>
#include <rapidcheck.h>

#include "fuzz/draw/surface_makers.h"
#include "fuzz/oracle/step_oracle.h"
#include "tests/fuzz/nothing_done.h"
#include "tests/property.h"

namespace selvage::fuzz {
namespace {

constexpr std::uint64_t kStepSeed = 20020721;

/// The words behind a world and its steps.
struct DrawnSteps {
  std::vector<std::uint32_t> words;
};

StepObservation observe(const DrawnSteps& drawn, const StepFunction& step) {
  ChoiceSource source = ChoiceSource::from_words(drawn.words);
  return run_steps(source, step);
}

void showValue(const DrawnSteps& drawn, std::ostream& os) {
  const StepObservation seen = observe(drawn, selvage_step);
  os << seen.surface << ", " << seen.candidate << ", step " << seen.steps << ": " << name_of(seen.defect)
     << std::hexfloat;
  for (Eigen::Index i = 0; i < seen.x_t0.rows(); ++i) {
    os << "\n" << seen.x_t0.row(i) << "   candidate " << seen.x_candidate.row(i) << "   answer " << seen.x_t1.row(i);
  }
}

/// A world takes at most about 100 words; exhausted ones answer 0, which is simple.
rc::Gen<DrawnSteps> any_steps() {
  return rc::gen::map(
      rc::gen::resize(100, rc::gen::container<std::vector<std::uint32_t>>(128, rc::gen::arbitrary<std::uint32_t>())),
      [](std::vector<std::uint32_t> words) { return DrawnSteps{std::move(words)}; });
}

TEST(StepPromises, prop_step_stays_free) {
  testing::check_property(80, kStepSeed, [] {
    const StepObservation seen = observe(*any_steps(), selvage_step);
    RC_ASSERT(name_of(seen.defect) == name_of(StepDefect::kNone));
  });
}

// Equal bits for one thread and for more than there are cores (K7).
TEST(StepPromises, prop_step_is_reproducible) {
  testing::check_property(15, kStepSeed + 1, [] {
    const DrawnSteps drawn = *any_steps();
    const auto run_with = [&drawn](std::size_t threads) {
      const oneapi::tbb::global_control control(oneapi::tbb::global_control::max_allowed_parallelism, threads);
      return observe(drawn, selvage_step);
    };
    const StepObservation one = run_with(1);
    const StepObservation many = run_with(7);
    RC_ASSERT(one.steps == many.steps);
    RC_ASSERT(one.x_t1 == many.x_t1);
  });
}

TEST(StepWorlds, EverySurfaceAndCandidateOccursAndEveryStageHasWork) {
  std::map<std::string_view, int> surfaces;
  std::map<std::string_view, int> candidates;
  StepObservation sum;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    ChoiceSource source = ChoiceSource::from_seed(seed);
    const StepObservation seen = run_steps(source, selvage_step);
    ++surfaces[seen.surface];
    ++candidates[seen.candidate];
    sum.steps += seen.steps;
    sum.with_collisions += seen.with_collisions;
    sum.with_zones += seen.with_zones;
    sum.with_fail_safe += seen.with_fail_safe;
    sum.stopped += seen.stopped;
  }
  EXPECT_EQ(surfaces.size(), surface_classes().size());
  EXPECT_EQ(candidates.size(), kCandidateClassCount);
  EXPECT_GT(sum.with_collisions, sum.steps / 2);
  EXPECT_GT(sum.with_zones, sum.steps / 5);
  EXPECT_GT(sum.with_fail_safe, sum.steps / 20);
  EXPECT_GT(sum.stopped, 0);
}

/// Safe, always, and useless.
sim::CollisionStepResult frozen(const StepWorld& world, const Positions& x_t0, const Positions& candidate) {
  sim::CollisionStepResult result = nothing_done(world, x_t0, candidate);
  result.x = x_t0;
  return result;
}
sim::CollisionStepResult always_stops(const StepWorld& /*world*/, const Positions& x_t0, const Positions& /*target*/) {
  sim::CollisionStepResult result;
  result.report.status = sim::StepStatus::kStopped;
  result.report.witness.emplace();
  result.x = x_t0;
  return result;
}
sim::CollisionStepResult hides_near_pairs(const StepWorld& world, const Positions& x_t0, const Positions& candidate) {
  sim::CollisionStepResult result = selvage_step(world, x_t0, candidate);
  result.report.below_tolerance.clear();
  return result;
}
sim::CollisionStepResult off_lattice(const StepWorld& world, const Positions& x_t0, const Positions& candidate) {
  StepWorld other = world;
  other.options.precision = sim::CollisionOptions::Precision::kFloat64;
  return selvage_step(other, x_t0, candidate);
}
sim::CollisionStepResult reports_the_wish(const StepWorld& world, const Positions& x_t0, const Positions& candidate) {
  sim::CollisionStepResult result = selvage_step(world, x_t0, candidate);
  result.velocity = nothing_done(world, x_t0, candidate).velocity;
  return result;
}
sim::CollisionStepResult loses_momentum(const StepWorld& world, const Positions& x_t0, const Positions& candidate) {
  sim::CollisionStepResult result = selvage_step(world, x_t0, candidate);
  result.velocity.row(0) *= 1 - 0x1p-20;
  return result;
}
sim::CollisionStepResult gains_energy(const StepWorld& world, const Positions& x_t0, const Positions& candidate) {
  sim::CollisionStepResult result = selvage_step(world, x_t0, candidate);
  const Eigen::RowVector3d push = 0x1p-10 * (result.velocity.row(0) - result.velocity.row(1));
  const double share = world.inverse_mass[1] / world.inverse_mass[0];  // infinite where something is scripted: unused
  result.velocity.row(0) += push;
  result.velocity.row(1) -= push * share;
  return result;
}
sim::CollisionStepResult holds_scripts(const StepWorld& world, const Positions& x_t0, const Positions& candidate) {
  Positions held = candidate;
  for (Eigen::Index i = 0; i < x_t0.rows(); ++i) {
    if (world.is_scripted(static_cast<std::int32_t>(i))) held.row(i) = x_t0.row(i);
  }
  return selvage_step(world, x_t0, held);
}

struct BadStep {
  const char* name;
  StepFunction step;
  StepDefect defect;
  int limit;  ///< cases within which it must be found
};

TEST(StepPromises, EveryCheckFindsItsBadStep) {
  const BadStep bad[] = {
      {"nothing done", nothing_done, StepDefect::kTouches, 20},
      {"frozen", frozen, StepDefect::kInterferes, 100},
      {"always stops", always_stops, StepDefect::kStoppedFreely, 20},
      {"hides near pairs", hides_near_pairs, StepDefect::kUnnamedNear, 60},
      {"off lattice", off_lattice, StepDefect::kOffLattice, 60},
      {"reports the wish", reports_the_wish, StepDefect::kBadVelocity, 60},
      {"loses momentum", loses_momentum, StepDefect::kMomentum, 60},
      {"gains energy", gains_energy, StepDefect::kEnergy, 150},
      {"holds scripts", holds_scripts, StepDefect::kOffScript, 150},
  };
  for (const BadStep& one : bad) {
    int found = -1;
    for (int seed = 0; seed < one.limit && found < 0; ++seed) {
      ChoiceSource source = ChoiceSource::from_seed(mix(1, static_cast<std::uint64_t>(seed)));
      if (run_steps(source, one.step).defect == one.defect) found = seed;
    }
    EXPECT_GE(found, 0) << one.name;
    RecordProperty(one.name, found + 1);
  }
}

}  // namespace
}  // namespace selvage::fuzz
