// The kernel's promises K1 to K5 against exact arithmetic, on every class of queries; and the proof that each property
// can fail, by kernels that are known to be bad. RC_PARAMS="seed=S max_success=N" makes longer runs.
#include <algorithm>

#include <gtest/gtest.h>

#include "fuzz/campaign/query_campaign.h"
#include "fuzz/oracle/proximity_oracle.h"
#include "fuzz/oracle/query_oracle.h"
#include "fuzz/oracle/query_property.h"
#include "tests/fuzz/bad_kernels.h"
#include "tests/fuzz/drawn_query.h"
#include "tests/fuzz/query_cases.h"
#include "tests/property.h"

namespace selvage::fuzz {
namespace {

using testing::check_property;

constexpr int kQueryCases = 4000;
constexpr std::uint64_t kQuerySeed = 20020721;

/// What the kernel answered and what is true, for one drawn query.
struct Judged {
  CcdResult answer;
  Judgement judgement;
};

Judged judge_drawn(const DrawnQuery& drawn) {
  ChoiceSource source = ChoiceSource::from_words(drawn.words);
  const MotionQuery query = drawn.query(source);
  const CcdResult answer = selvage_kernel(query);
  return {answer, judge(query, answer)};
}

TEST(KernelPromises, prop_ccd_no_miss) {
  check_property(kQueryCases, kQuerySeed, [] {
    const auto [answer, judgement] = judge_drawn(*any_query());
    RC_ASSERT(judgement.disagreement != Disagreement::kMissed);
    RC_ASSERT(judgement.disagreement != Disagreement::kEndMissed);
    RC_ASSERT(judgement.disagreement != Disagreement::kMalformed);
  });
}

TEST(KernelPromises, prop_toi_is_early) {
  check_property(kQueryCases, kQuerySeed + 1,
                 [] { RC_ASSERT(judge_drawn(*any_query()).judgement.disagreement != Disagreement::kLateToi); });
}

TEST(KernelPromises, prop_alarm_is_bounded) {
  check_property(kQueryCases, kQuerySeed + 2, [] {
    const auto [answer, judgement] = judge_drawn(*any_query());
    RC_ASSERT(judgement.disagreement != Disagreement::kFalseAlarmTooFar);
    RC_ASSERT(judgement.disagreement != Disagreement::kGapTooLoose);
    RC_ASSERT(!judgement.gap_unknown);
  });
}

TEST(KernelPromises, prop_proximity_bracket) {
  check_property(kQueryCases, kQuerySeed + 3, [] {
    const DrawnQuery drawn = *any_query();
    RC_PRE(drawn.kind != PairKind::kSelf);
    ChoiceSource source = ChoiceSource::from_words(drawn.words);
    const MotionQuery query = drawn.query(source);
    RC_ASSERT(judge_proximity(query.kind, query.x_t0).defect == ProximityDefect::kNone);
    RC_ASSERT(judge_proximity(query.kind, query.x_t1).defect == ProximityDefect::kNone);
  });
}

void check_metamorphic(std::string_view name, std::uint64_t seed) {
  for (const QueryProperty& property : query_properties()) {
    if (property.name != name) continue;
    check_property(kQueryCases, seed, [&property] {
      const DrawnQuery drawn = *any_query();
      ChoiceSource source = ChoiceSource::from_words(drawn.words);
      const MotionQuery query = drawn.query(source);
      RC_ASSERT(property.check(query, selvage_kernel, source).failure.empty());
    });
    return;
  }
  FAIL() << "no property " << name;
}

TEST(KernelPromises, prop_symmetry) { check_metamorphic("symmetry", kQuerySeed + 4); }
TEST(KernelPromises, prop_scale) { check_metamorphic("scale", kQuerySeed + 5); }

// Outside the domain there is one answer, and it claims nothing.
TEST(KernelPromises, OutsideTheDomainIsUnresolved) {
  const double kBad[] = {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
                         -std::numeric_limits<double>::infinity(), std::nextafter(kMaxCoordinate, 1e308)};
  for (const PairKind kind : kPairKinds) {
    for (const double bad : kBad) {
      for (int place = 0; place < 6 * point_count(kind); ++place) {
        MotionQuery query;
        query.kind = kind;
        auto& x = place % 2 == 0 ? query.x_t0 : query.x_t1;
        x[static_cast<std::size_t>(place / 6)][place / 2 % 3] = bad;
        const CcdResult answer = selvage_kernel(query);
        EXPECT_EQ(answer.verdict, CcdVerdict::kUnresolved);
        EXPECT_EQ(answer.toi_lower, 0);
      }
    }
    for (const double bad : {-1.0, kBad[0], kBad[1]}) {
      MotionQuery query;
      query.kind = kind;
      query.x_t0[0] = query.x_t1[0] = Vec3(0, 0, 1);
      query.options.tolerance = bad;
      EXPECT_EQ(selvage_kernel(query).verdict, CcdVerdict::kUnresolved);
    }
  }
}

// As a kernel may answer beyond the domain, where the difference of two coordinates overflows.
TEST(KernelPromises, ANearMissIsMeasuredWhereTheQueryHasASize) {
  CcdResult alarm;
  alarm.verdict = CcdVerdict::kCollides;
  alarm.cause = CcdCause::kMotion;
  alarm.toi_lower = 0;
  alarm.gap_bound = 1;
  alarm.weights = {1, 1, 0, 0};
  MotionQuery query;
  for (const double x : {0x1p+10, 0x1.8p+1023}) {
    for (std::size_t i = 0; i < 4; ++i) query.x_t0[i] = query.x_t1[i] = Vec3::Constant(i == 0 ? x : -x);
    const Judgement judgement = judge(query, alarm);
    EXPECT_FALSE(judgement.touches);
    EXPECT_EQ(judgement.near_miss_bits, 0) << "beyond the allowance, or without a size";
  }
  query.x_t0[0] = query.x_t1[0] = Vec3::Zero();
  for (std::size_t i = 1; i < 4; ++i) query.x_t0[i] = query.x_t1[i] = {0, 0, 0x1p+50};
  EXPECT_EQ(judge(query, alarm).near_miss_bits, 50);
}

const QueryProperty& property_named(std::string_view name) {
  return *std::ranges::find(query_properties(), name, &QueryProperty::name);
}

/// Cases of the property until the kernel fails, one of each class and kind after another; -1 if that takes more than
/// `limit`.
std::int64_t cases_until_failure(std::string_view name, CcdKernel kernel, std::int64_t limit, std::string& what) {
  const auto campaign = make_query_campaign(property_named(name), kernel);
  std::int64_t cases = 0;
  for_cases_in_turn(campaign->streams(), [&](const Stream& stream, std::int64_t number) {
    if (cases == limit) return false;
    ++cases;
    what = campaign->run(stream, source_of_case(kQuerySeed, stream, number)).failure;
    return what.empty();
  });
  return what.empty() ? -1 : cases;
}

/// Whether some class is left unresolved too often.
bool leaves_too_much_open(CcdKernel kernel) {
  const auto campaign = make_query_campaign(property_named("ccd"), kernel);
  for (const Stream& stream : campaign->streams()) {
    Counts counts;
    for (std::int64_t number = 0; number < diluted(stream, 100); ++number) {
      counts += campaign->run(stream, source_of_case(kQuerySeed, stream, number)).counts;
    }
    if (is_unresolved_too_often(query_stream(stream).kind, counts)) return true;
  }
  return false;
}

TEST(KernelPromises, FewAnswersAreUnresolved) {
  EXPECT_FALSE(leaves_too_much_open(selvage_kernel));
  EXPECT_TRUE(leaves_too_much_open(always_unresolved));
}

struct BadKernel {
  const char* property;
  CcdKernel kernel;
  const char* failure;
  std::int64_t limit;
};

TEST(KernelPromises, EveryPropertyFindsItsBadKernels) {
  const BadKernel bad[] = {
      {"ccd", always_separated, "missed", 1},
      {"ccd", always_collides, "false-alarm-too-far", 200},
      {"ccd", always_collides_somewhere, "gap-too-loose", 1},
      {"ccd", late, "late-toi", 200},
      {"ccd", forgets_end, "end-missed", 400},
      {"symmetry", biased, "asymmetric", 2000},
      {"symmetry", forgets_labels, "asymmetric", 2000},
      {"scale", biased, "scale-dependent", 2000},
  };
  for (const BadKernel& one : bad) {
    std::string what;
    const std::int64_t cases = cases_until_failure(one.property, one.kernel, one.limit, what);
    EXPECT_GT(cases, 0) << one.property << " lets pass what it should call " << one.failure;
    EXPECT_EQ(what, one.failure) << one.property;
  }
}

}  // namespace
}  // namespace selvage::fuzz
