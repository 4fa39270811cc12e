#include "verify/decision/exact_overlap.h"

#include <cfenv>
#include <cmath>
#include <limits>
#include <map>
#include <random>

#include <gtest/gtest.h>

#include "tests/verify/overlap_families.h"
#include "tests/verify/overlap_reference.h"
#include "verify/filter/overlap_filter.h"

namespace selvage::verify {
namespace {

using testbed::draw;
using testbed::from_points;
using testbed::kOverlapFamilies;
using testbed::OverlapFamily;
using testbed::TwoTriangles;

OverlapKind decide(const TwoTriangles& c) { return exact_overlap(c.face_a, c.a, c.face_b, c.b).kind; }
OverlapKind refer(const TwoTriangles& c) { return reference::overlap(c.face_a, c.a, c.face_b, c.b); }

std::string text(const TwoTriangles& c) {
  std::string s;
  char buffer[96];
  for (const auto& [face, corners] : {std::pair{c.face_a, c.a}, std::pair{c.face_b, c.b}}) {
    for (std::size_t i = 0; i < 3; ++i) {
      std::snprintf(buffer, sizeof buffer, "  %d (%a %a %a)", face[i], corners[i][0], corners[i][1], corners[i][2]);
      s += buffer;
    }
    s += "\n";
  }
  return s;
}

}  // namespace

// The cases of the comparison of programs in the reference notes, by their numbers there.
TEST(ExactOverlap, TwoTriangleCasesOfTheLiterature) {
  constexpr double kTiny = 4e-308;
  const struct {
    const char* why;
    OverlapKind kind;
    TwoTriangles c;
  } cases[] = {
      {"01 share a vertex, disjoint",
       OverlapKind::kNone,
       {{0, 1, 2}, {0, 3, 4}, {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}}, {{{0, 0, 0}, {-1, 0, 1}, {0, -1, 1}}}}},
      {"02 share an edge, bent",
       OverlapKind::kNone,
       {{0, 1, 2}, {0, 1, 3}, {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}}, {{{0, 0, 0}, {1, 0, 0}, {0, 0, 1}}}}},
      {"03 share an edge, coplanar and opposite",
       OverlapKind::kNone,
       {{0, 1, 2}, {0, 1, 3}, {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}}, {{{0, 0, 0}, {1, 0, 0}, {0, -1, 0}}}}},
      {"04 share an edge, folded over",
       OverlapKind::kFold,
       {{0, 1, 2}, {0, 1, 3}, {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}}, {{{0, 0, 0}, {1, 0, 0}, {1, 2, 0}}}}},
      {"05 duplicate vertex",
       OverlapKind::kTouch,
       {{0, 1, 2}, {3, 4, 5}, {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}}, {{{0, 0, 0}, {-1, 0, 1}, {0, -1, 1}}}}},
      {"06 duplicate edge",
       OverlapKind::kTouch,
       {{0, 1, 2}, {3, 4, 5}, {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}}, {{{0, 0, 0}, {1, 0, 0}, {0, 0, 1}}}}},
      {"07 vertex touches the interior of a face",
       OverlapKind::kTouch,
       {{0, 1, 2}, {3, 4, 5}, {{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}}, {{{1, 1, 0}, {1, 1, 1}, {2, 1, 1}}}}},
      {"08 edges touch at a point",
       OverlapKind::kTouch,
       {{0, 1, 2}, {3, 4, 5}, {{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}}, {{{1, 0, -1}, {1, 0, 1}, {1, -1, 0}}}}},
      {"09 coplanar, overlapping",
       OverlapKind::kCoplanar,
       {{0, 1, 2}, {3, 4, 5}, {{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}}, {{{1, 1, 0}, {5, 1, 0}, {1, 5, 0}}}}},
      {"10 coplanar, disjoint",
       OverlapKind::kNone,
       {{0, 1, 2}, {3, 4, 5}, {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}}, {{{1, 1, 0}, {2, 1, 0}, {1, 2, 0}}}}},
      {"11 share a vertex, coplanar overlap",
       OverlapKind::kCoplanar,
       {{0, 1, 2}, {0, 3, 4}, {{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}}, {{{0, 0, 0}, {4, 1, 0}, {1, 4, 0}}}}},
      {"12 share a vertex, coplanar, disjoint",
       OverlapKind::kNone,
       {{0, 1, 2}, {0, 3, 4}, {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}}, {{{0, 0, 0}, {-1, 0, 0}, {0, -1, 0}}}}},
      {"13 share a vertex, edges collinear and overlapping",
       OverlapKind::kTouch,
       {{0, 1, 2}, {0, 3, 4}, {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}}, {{{0, 0, 0}, {2, 0, 0}, {0, 0, 1}}}}},
      {"14 share a vertex, pierce",
       OverlapKind::kPierce,
       {{0, 1, 2}, {0, 3, 4}, {{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}}, {{{0, 0, 0}, {2, 1, 1}, {1, 2, -1}}}}},
      {"15 pierce",
       OverlapKind::kPierce,
       {{0, 1, 2}, {3, 4, 5}, {{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}}, {{{1, 1, -1}, {1, 1, 1}, {5, 5, 1}}}}},
      {"17 a zero-area triangle pierces another",
       OverlapKind::kPierce,
       {{0, 1, 2}, {3, 4, 5}, {{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}}, {{{1, 1, -1}, {1, 1, 1}, {1, 1, 2}}}}},
      {"18 the same face twice",
       OverlapKind::kSame,
       {{0, 1, 2}, {2, 0, 1}, {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}}, {{{0, 1, 0}, {0, 0, 0}, {1, 0, 0}}}}},
      {"19 a gap of 4e-308",
       OverlapKind::kNone,
       {{0, 1, 2}, {3, 4, 5}, {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}}, {{{0, 0, kTiny}, {1, 0, kTiny}, {0, 1, kTiny}}}}},
      {"20 share an edge, folded with a lift of 1e-10",
       OverlapKind::kNone,
       {{0, 1, 2}, {0, 1, 3}, {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}}, {{{0, 0, 0}, {1, 0, 0}, {0, 1, 1e-10}}}}},
      {"21 share a vertex, gap of 1e-12",
       OverlapKind::kNone,
       {{0, 1, 2}, {0, 3, 4}, {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}}, {{{0, 0, 0}, {1, 0, 1e-12}, {0, 1, 1e-12}}}}},
  };
  for (const auto& c : cases) {
    EXPECT_EQ(decide(c.c), c.kind) << c.why;
    EXPECT_EQ(refer(c.c), c.kind) << "reference: " << c.why;
  }
}

TEST(ExactOverlap, DegenerateIsExactlyCollinear) {
  EXPECT_TRUE(exact_degenerate({{{0, 0, 0}, {1, 1, 1}, {3, 3, 3}}}).is_degenerate);  // case 16
  EXPECT_TRUE(exact_degenerate({{{5, 5, 5}, {5, 5, 5}, {1, 2, 3}}}).is_degenerate);
  EXPECT_TRUE(exact_degenerate({{{5, 5, 5}, {5, 5, 5}, {5, 5, 5}}}).is_degenerate);
  EXPECT_FALSE(exact_degenerate({{{0, 0, 0}, {1, 1, 1}, {3, 3, std::nextafter(3.0, 4.0)}}}).is_degenerate);
  EXPECT_FALSE(exact_degenerate({{{0, 0, 0}, {0x1p-1074, 0, 0}, {0, 0x1p-1074, 0}}}).is_degenerate);
  EXPECT_FALSE(exact_degenerate({{{-1e308, 0, 0}, {1e308, 0, 0}, {0, 0x1p-1074, 0}}}).is_degenerate);
}

TEST(ExactOverlap, RefusesWhatIsNotFinite) {
  constexpr std::array<std::int32_t, 3> kA = {0, 1, 2}, kB = {3, 4, 5};
  const std::array<Point, 3> unit = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}};
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    for (std::size_t corner = 0; corner < 3; ++corner) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        std::array<Point, 3> other = {{{0, 0, 5}, {1, 0, 5}, {0, 1, 5}}};
        other[corner][axis] = bad;
        EXPECT_THROW(static_cast<void>(exact_overlap(kA, other, kB, unit)), std::invalid_argument);
        EXPECT_THROW(static_cast<void>(exact_overlap(kA, unit, kB, other)), std::invalid_argument);
        EXPECT_THROW(static_cast<void>(exact_degenerate(other)), std::invalid_argument);
      }
    }
  }
}

TEST(ExactOverlap, AgreesWithClippingOnSmallIntegers) {
  std::mt19937 random(2002);
  std::map<std::pair<int, OverlapKind>, int> seen;
  for (int shared = 0; shared <= 2; ++shared) {
    for (const OverlapFamily family : kOverlapFamilies) {
      for (int i = 0; i < 1500; ++i) {
        const TwoTriangles c = from_points(draw(random, family, 1 + i % 4), shared);
        const OverlapKind kind = decide(c);
        ++seen[{shared, kind}];
        ASSERT_EQ(kind, refer(c)) << "family " << static_cast<int>(family) << "\n" << text(c);
      }
    }
  }
  // The draw is alive: every kind that can occur does, often.
  using enum OverlapKind;
  for (const auto& [shared, kind] : {std::pair{0, kNone},
                                     {0, kTouch},
                                     {0, kPierce},
                                     {0, kCoplanar},
                                     {1, kNone},
                                     {1, kTouch},
                                     {1, kPierce},
                                     {1, kCoplanar},
                                     {2, kNone},
                                     {2, kTouch},
                                     {2, kFold}}) {
    EXPECT_GE((seen[{shared, kind}]), 200) << shared << " shared, kind " << static_cast<int>(kind);
  }
}

TEST(ExactOverlap, AgreesWithClippingOneUlpFromDegenerate) {
  std::mt19937 random(1989);
  int exact_used = 0, changed = 0;
  for (int i = 0; i < 6000; ++i) {
    // At the smaller scales products of two or of three differences are subnormal: what underflows is counted too.
    const double scale = std::array{1.0, 0x1p-537, 0x1p-358, 0x1p+300}[random() % 4];
    std::array<Point, 6> x = draw(random, kOverlapFamilies[i % 6], 2);
    for (Point& p : x) {
      for (double& coordinate : p) coordinate = (coordinate / 3 + 100) * scale;
    }
    const TwoTriangles rounded = from_points(x, i % 3);
    double& nudged = x[random() % 6][random() % 3];
    nudged = std::nextafter(nudged, random() % 2 == 0 ? 200 * scale : 0.0);
    const TwoTriangles c = from_points(x, i % 3);
    const OverlapAnswer answer = exact_overlap(c.face_a, c.a, c.face_b, c.b);
    ASSERT_EQ(answer.kind, refer(c)) << text(c);
    exact_used += answer.exact_used ? 1 : 0;
    changed += answer.kind != decide(rounded) ? 1 : 0;
  }
  EXPECT_GE(exact_used, 1000);
  EXPECT_GE(changed, 100);  // one ulp matters
}

TEST(ExactOverlap, IgnoresOrderOfCornersAndFaces) {
  std::mt19937 random(7);
  const std::size_t orders[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
  for (int i = 0; i < 900; ++i) {
    const TwoTriangles c = from_points(draw(random, kOverlapFamilies[i % 6], 2), i % 3);
    const OverlapKind kind = decide(c);
    for (const auto& o : orders) {
      for (const auto& p : orders) {
        const TwoTriangles d{{c.face_a[o[0]], c.face_a[o[1]], c.face_a[o[2]]},
                             {c.face_b[p[0]], c.face_b[p[1]], c.face_b[p[2]]},
                             {c.a[o[0]], c.a[o[1]], c.a[o[2]]},
                             {c.b[p[0]], c.b[p[1]], c.b[p[2]]}};
        ASSERT_EQ(decide(d), kind) << text(d);
        ASSERT_EQ(decide({d.face_b, d.face_a, d.b, d.a}), kind) << text(d);
      }
    }
  }
}

TEST(ExactOverlap, FollowsExactScalingAndTranslationOverTheWholeRange) {
  std::mt19937 random(11);
  for (int i = 0; i < 3000; ++i) {
    const std::array<Point, 6> x = draw(random, kOverlapFamilies[i % 6], 2);  // coordinates up to 10
    const OverlapKind kind = decide(from_points(x, i % 3));
    const auto moved = [&](double scale, double shift) {
      std::array<Point, 6> y = x;
      for (Point& p : y) {
        for (double& coordinate : p) coordinate = coordinate * scale + shift;
      }
      return from_points(y, i % 3);
    };
    for (const double scale : {0x1p-1074, 0x1p-600, 0x1p-350, 0x1p-20, 0x1p60, 0x1p400, 0x1p1019}) {
      ASSERT_EQ(decide(moved(scale, 0)), kind) << scale << "\n" << text(from_points(x, i % 3));
    }
    for (const double shift : {1024.0, 0x1p+30, 0x1p+48}) {
      ASSERT_EQ(decide(moved(1, shift)), kind) << shift << "\n" << text(from_points(x, i % 3));
    }
  }
}

TEST(ExactOverlap, MixedMagnitudesAgreeWithClipping) {
  std::mt19937 random(13);
  const double scales[] = {0x1p-1070, 0x1p-500, 1, 0x1p+500, 0x1p+1000};
  for (int i = 0; i < 1200; ++i) {
    std::array<Point, 6> x = draw(random, kOverlapFamilies[i % 6], 2);
    for (Point& p : x) {
      for (double& coordinate : p) coordinate *= scales[random() % 5];
    }
    const TwoTriangles c = from_points(x, i % 3);
    ASSERT_EQ(decide(c), refer(c)) << text(c);
  }
}

TEST(ExactOverlap, RepairsTheRoundingMode) {
  std::mt19937 random(17);
  for (int i = 0; i < 600; ++i) {
    std::array<Point, 6> x = draw(random, kOverlapFamilies[i % 6], 2);
    for (Point& p : x) {
      for (double& coordinate : p) coordinate /= 3;
    }
    const TwoTriangles c = from_points(x, i % 3);
    const OverlapKind kind = decide(c);
    for (const int mode : {FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO}) {
      std::fesetround(mode);
      const OverlapKind same = decide(c);
      const int left = std::fegetround();
      std::fesetround(FE_TONEAREST);
      ASSERT_EQ(same, kind) << text(c);
      ASSERT_EQ(left, mode);
    }
  }
}

// Two cones that touch along one ray, perpendicular to the direction between them: the computed sides of the ray's two
// points are rounding noise, and only the filter's margin keeps it from calling the cones apart.
TEST(ExactOverlap, ConesThatTouchAlongARayAreNotApart) {
  std::mt19937 random(41);
  std::uniform_int_distribution<std::int64_t> long_number(-(1 << 23), 1 << 23), short_number(-(1 << 11), 1 << 11);
  for (int i = 0; i < 3000; ++i) {
    const std::array<std::int64_t, 3> e = {long_number(random), long_number(random), long_number(random)};
    const std::array<std::int64_t, 3> r = {short_number(random), short_number(random), short_number(random)};
    TwoTriangles c{{0, 1, 2}, {0, 3, 4}, {}, {}};
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t x = (k + 1) % 3, y = (k + 2) % 3;
      const std::int64_t w = e[x] * r[y] - e[y] * r[x];  // perpendicular to e; every number here is exactly a double
      c.a[1][k] = static_cast<double>(3 * e[k]);
      c.a[2][k] = static_cast<double>(w - 3 * e[k]);
      c.b[1][k] = static_cast<double>(e[k]);
      c.b[2][k] = static_cast<double>(-w - e[k]);
    }
    ASSERT_EQ(decide(c), OverlapKind::kTouch) << text(c);
  }
}

// What the filter is for: ordinary neighbours and near misses must not need integers.
TEST(ExactOverlap, FilterDecidesOrdinaryPairs) {
  const auto used = [](const TwoTriangles& c) {
    const OverlapAnswer answer = exact_overlap(c.face_a, c.a, c.face_b, c.b);
    EXPECT_EQ(answer.kind, OverlapKind::kNone) << text(c);
    return answer.exact_used;
  };
  const auto at = [](double u, double v) { return Point{u / 3, v / 7, (u + 2 * v) / 11}; };  // a tilted plane, rounded
  EXPECT_FALSE(used({{0, 1, 2}, {0, 1, 3}, {at(0, 0), at(1, 0), at(0, 1)}, {at(0, 0), at(1, 0), at(1, -1)}}));
  EXPECT_FALSE(used({{0, 1, 2}, {0, 3, 4}, {at(0, 0), at(1, 0), at(0, 1)}, {at(0, 0), at(-1, 1), at(-1, 0)}}));
  EXPECT_FALSE(used({{0, 1, 2}, {0, 3, 4}, {at(0, 0), at(1, 0), at(1, 1)}, {at(0, 0), at(-1, 0), at(-1, -1)}}));
  EXPECT_FALSE(used({{0, 1, 2}, {3, 4, 5}, {at(0, 0), at(1, 0), at(1, 1)}, {at(2, 0), at(3, 0), at(2, 2)}}));
}

}  // namespace selvage::verify
