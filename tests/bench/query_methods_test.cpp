// The rivals of `bench methods` must be good ones: what they promise holds on every hard class, and what their rounding
// may miss shows where their headers say so.
#include "bench/query_methods.h"

#include <gtest/gtest.h>

#include "bench/additive_ccd.h"
#include "bench/inclusion_ccd.h"
#include "bench/plain_distance.h"
#include "fuzz/draw/generators.h"
#include "kernel/proximity.h"

namespace selvage::bench {
namespace {

using fuzz::ChoiceSource;

/// Calls visit(query, exact answer) for `cases` queries of a class, of each kind that the class makes.
template <typename Visit>
void for_queries(const fuzz::QueryClass& of_class, int cases, Visit visit) {
  for (const PairKind kind : {PairKind::kVf, PairKind::kEe}) {
    for (int i = 0; of_class.band(kind) && i < cases; ++i) {
      ChoiceSource source = ChoiceSource::from_seed(fuzz::mix(7, static_cast<std::uint64_t>(i)));
      const fuzz::MotionQuery query = fuzz::make_query(of_class, kind, source);
      visit(method_query(kind, query.x_t0, query.x_t1), fuzz::exact_motion(query, verify::Detail::kDecision).touches);
    }
  }
}

const fuzz::QueryClass& class_named(const std::string& name) {
  for (const fuzz::QueryClass& of_class : fuzz::query_classes()) {
    if (of_class.name == name) return of_class;
  }
  throw std::logic_error("no class " + name);
}

InclusionAnswer inclusion(const MethodQuery& query, const InclusionOptions& options) {
  return (query.kind == PairKind::kVf ? inclusion_vf : inclusion_ee)(query.x_t0, query.x_t1, options);
}
AdditiveAnswer additive(const MethodQuery& query, double rescaling) {
  AdditiveOptions options;
  options.rescaling = rescaling;
  return (query.kind == PairKind::kVf ? additive_vf : additive_ee)(query.x_t0, query.x_t1, options);
}

TEST(InclusionCcd, NeverMissesAndIsNeverLateOnAnyHardClass) {
  InclusionOptions options;
  options.max_boxes = 256;
  std::int64_t touching = 0;
  for (const fuzz::QueryClass& of_class : fuzz::query_classes()) {
    for_queries(of_class, of_class.dilution > 1 ? 2 : 40, [&](const MethodQuery& query, bool touches) {
      const InclusionAnswer answer = inclusion(query, options);
      if (!touches) return;
      ++touching;
      ASSERT_TRUE(answer.collides) << of_class.name;
      ASSERT_GE(verify::compare_first_touch(query.point_t0, query.point_t1, query.kind == PairKind::kVf, answer.toi), 0)
          << of_class.name;
    });
  }
  EXPECT_GT(touching, 2000);
}

// All in the plane z = c: the difference along z is 0, but what is computed of it is rounding alone.
TEST(InclusionCcd, KeepsContactsThatRoundingHides) {
  InclusionOptions options;
  options.tolerance = 1e-9;
  ChoiceSource source = ChoiceSource::from_seed(3);
  for (int i = 0; i < 200; ++i) {
    const double c = 1 + source.unit_real();
    const auto in_plane = [&](double x, double y) {
      return Vec3{x + 0.1 * source.unit_real(), y + 0.1 * source.unit_real(), c};
    };
    const auto corners = [&] {
      return std::array<Vec3, 4>{in_plane(0.3, 0.3), in_plane(0, 0), in_plane(1, 0), in_plane(0, 1)};
    };
    const auto cross = [&] {
      return std::array<Vec3, 4>{in_plane(0, 0), in_plane(1, 1), in_plane(0, 1), in_plane(1, 0)};
    };
    const std::array<Vec3, 4> vf_t0 = corners(), vf_t1 = corners(), ee_t0 = cross(), ee_t1 = cross();
    const InclusionAnswer vf = inclusion_vf(vf_t0, vf_t1, options), ee = inclusion_ee(ee_t0, ee_t1, options);
    ASSERT_TRUE(vf.collides && vf.toi == 0) << i;
    ASSERT_TRUE(ee.collides && ee.toi == 0) << i;
  }
}

TEST(InclusionCcd, IsAsEarlyAsItsToleranceAllowsOnUniformQueries) {
  int touching = 0;
  for_queries(class_named("uniform"), 300, [&](const MethodQuery& query, bool touches) {
    InclusionOptions options;
    options.max_boxes = 1 << 16;
    const InclusionAnswer answer = inclusion(query, options);
    EXPECT_EQ(answer.collides, touches);  // nothing in this class comes within a millionth without touching
    EXPECT_FALSE(answer.gave_up);
    if (!touches) return;
    ++touching;
    const double first = exact_answer(query, verify::Detail::kFirstTime).first.lower_approx;
    EXPECT_LE(first - answer.toi, 1e-4);
  });
  EXPECT_GT(touching, 30);
}

TEST(InclusionCcd, LimitIsAnAlarmNotASeparation) {
  for_queries(class_named("uniform"), 100, [&](const MethodQuery& query, bool touches) {
    InclusionOptions options;
    options.max_boxes = 2;
    const InclusionAnswer answer = inclusion(query, options);
    EXPECT_TRUE(!touches || (answer.collides && answer.gave_up));
  });
  std::array<Vec3, 4> x{Vec3(0, 0, 1), Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};
  const std::array<Vec3, 4> start = x;
  x[0].z() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(inclusion_vf(start, x, {}).collides);
}

TEST(AdditiveCcd, MissesNothingAndIsEarlyOnUniformQueries) {
  for (const double rescaling : {0.5, 0.9, 0.99}) {
    int touching = 0, alarms = 0;
    for_queries(class_named("uniform"), 500, [&](const MethodQuery& query, bool touches) {
      const AdditiveAnswer answer = additive(query, rescaling);
      alarms += answer.collides;
      if (!touches) return;
      ++touching;
      EXPECT_TRUE(answer.collides);
      EXPECT_GE(verify::compare_first_touch(query.point_t0, query.point_t1, query.kind == PairKind::kVf, answer.toi),
                0);
    });
    EXPECT_GT(touching, 50);
    EXPECT_LT(alarms, 800) << rescaling;  // it does not call everything a contact
  }
}

// What its header says that rounding takes away.
TEST(AdditiveCcd, StepsOverContactsOfShortMotions) {
  int touching = 0, missed = 0;
  for_queries(class_named("short-motion"), 200, [&](const MethodQuery& query, bool touches) {
    touching += touches;
    missed += touches && !additive(query, 0.999).collides;
  });
  EXPECT_GT(missed, touching / 4);
  EXPECT_LT(missed, touching);
}

TEST(AdditiveCcd, OverflowIsAnAlarmNotASeparation) {
  for_queries(class_named("huge"), 200,
              [&](const MethodQuery& query, bool) { EXPECT_FALSE(std::isnan(additive(query, 0.9).toi)); });
}

TEST(PlainDistance, LiesInTheKernelsProvedBracket) {
  for_queries(class_named("uniform"), 300, [&](const MethodQuery& query, bool) {
    const bool is_vf = query.kind == PairKind::kVf;
    const Proximity proved = (is_vf ? vf_proximity : ee_proximity)(query.x_t0);
    const double plain = (is_vf ? plain_vf_distance : plain_ee_distance)(query.x_t0);
    EXPECT_GE(plain, proved.distance_lower * (1 - 1e-9));
    EXPECT_LE(plain, proved.distance_upper * (1 + 1e-9));
  });
  const Vec3 a(0, 0, 0), b(1, 0, 0), c(0, 1, 0);
  EXPECT_EQ(plain_vf_distance({Vec3(3, 0, 4), a, a, a}), 5);                // a face that is a point
  EXPECT_EQ(plain_vf_distance({Vec3(4, 3, 0), a, b, b}), std::sqrt(18.0));  // a face that is an edge
  EXPECT_EQ(plain_ee_distance({a, b, Vec3(0, 0, 2), Vec3(1, 0, 2)}), 2);    // parallel
  EXPECT_EQ(plain_ee_distance({a, a, c, c}), 1);                            // two points
}

TEST(MethodSettings, NamesAreUniqueAndTheBaselineIsAmongThem) {
  std::vector<std::string> names;
  for (const MethodSetting& setting : method_settings()) names.push_back(setting.method + " " + setting.setting);
  EXPECT_EQ(std::count(names.begin(), names.end(), std::string(kBaselineMethod) + " " + kBaselineSetting), 1);
  std::sort(names.begin(), names.end());
  EXPECT_EQ(std::unique(names.begin(), names.end()), names.end());
}

}  // namespace
}  // namespace selvage::bench
