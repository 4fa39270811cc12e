#include "kernel/ccd.h"

#include <array>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "tests/kernel/constructed_contact.h"
#include "tests/kernel/exact_proximity.h"
#include "tests/kernel/random_ccd_queries.h"
#include "tests/kernel/random_points.h"

namespace selvage {

using testing::ConstructedContact;
using testing::contact_of;
using testing::ContactGenerator;
using testing::exact;
using testing::ExactClosest;
using testing::kKinds;
using testing::kNoTolerance;
using testing::placed;
using testing::Points;
using testing::Random;
using testing::random_query;
using testing::Rational;
using testing::squared;

namespace {

/// What an alarm may be off by, relative to the largest difference: kAlarmGap is relative to its next power of two.
constexpr double kAlarmShare = 0x1p-39;

std::array<detail::Double3, 4> points(const Points& x) {
  return {detail::to_double3(x[0]), detail::to_double3(x[1]), detail::to_double3(x[2]), detail::to_double3(x[3])};
}

Rational distance_squared_at(PairKind kind, const Points& x_t0, const Points& x_t1, const Rational& t) {
  return ExactClosest(kind, testing::exact_points(points(x_t0), points(x_t1), t)).distance_squared();
}

double size_of(const Points& x_t0, const Points& x_t1) {
  double size = 0;
  for (const Points* x : {&x_t0, &x_t1}) {
    for (const Vec3& p : *x) {
      for (const Vec3& q : *x) size = std::max(size, (p - q).cwiseAbs().maxCoeff());
    }
  }
  return size;
}

/// K1, K2 and K3 for a pair that is known to touch at `contact_time`.
void expect_contact(PairKind kind, const Points& x_t0, const Points& x_t1, double contact_time) {
  const CcdResult result = pair_ccd(kind, x_t0, x_t1, kNoTolerance);
  EXPECT_EQ(result.verdict, CcdVerdict::kCollides);
  EXPECT_EQ(result.cause, CcdCause::kMotion);
  EXPECT_LE(result.toi_lower, contact_time);
  EXPECT_LE(result.gap_bound, size_of(x_t0, x_t1) * kAlarmShare + std::numeric_limits<double>::denorm_min());
}

/// K3: the exact distance at one of the two ends of the tick that the answer names is within gap_bound.
void expect_gap(PairKind kind, const Points& x_t0, const Points& x_t1, const CcdResult& result) {
  const Rational bound = squared(exact(result.gap_bound));
  const Rational t = exact(result.toi_lower), tick = testing::scaled_exactly(1, -52);
  EXPECT_TRUE(distance_squared_at(kind, x_t0, x_t1, t) <= bound ||
              (result.toi_lower < 1 && distance_squared_at(kind, x_t0, x_t1, t + tick) <= bound))
      << result.gap_bound;
}

/// Those of each feature add up to 1.
void expect_convex(PairKind kind, const std::array<double, 4>& w) {
  const double first = kind == PairKind::kEe ? w[0] + w[1] : w[0], all = w[0] + w[1] + w[2] + w[3];
  EXPECT_NEAR(first, 1, 1e-15);
  EXPECT_NEAR(all, 2, 1e-15);
}

}  // namespace

TEST(Ccd, ConstructedContactsAreFound) {
  ContactGenerator generator(41);
  for (int i = 0; i < 6000; ++i) {
    const PairKind kind = kKinds[i % 3];
    const ConstructedContact contact = contact_of(kind, generator, 8);
    expect_contact(kind, contact.x_t0, contact.x_t1, contact.contact_time);
  }
}

TEST(Ccd, ConstructedContactsAreFoundAtEveryScale) {
  ContactGenerator generator(42);
  for (int i = 0; i < 6000; ++i) {
    const PairKind kind = kKinds[i % 3];
    const ConstructedContact contact = contact_of(kind, generator, 8);
    const double scale = std::ldexp(1.0, generator.integer(-1074, 980));
    expect_contact(kind, placed(contact.x_t0, scale, Vec3::Zero()), placed(contact.x_t1, scale, Vec3::Zero()),
                   contact.contact_time);
  }
}

TEST(Ccd, ConstructedContactsAreFoundAtEveryOffset) {
  ContactGenerator generator(43);
  for (int i = 0; i < 6000; ++i) {
    const PairKind kind = kKinds[i % 3];
    const ConstructedContact contact = contact_of(kind, generator, 5);
    // Coordinates stay below 2^12 and are whole, so an offset below 2^52 adds without rounding.
    const auto offset = [&generator] { return std::ldexp(generator.integer(-1, 1), generator.integer(0, 51)); };
    const Vec3 shift = {offset(), offset(), offset()};
    expect_contact(kind, placed(contact.x_t0, 1, shift), placed(contact.x_t1, 1, shift), contact.contact_time);
  }
}

TEST(Ccd, ContactsOfDegenerateFeaturesAreFound) {
  ContactGenerator generator(44);
  for (int i = 0; i < 4000; ++i) {
    const PairKind kind = kKinds[i % 2];
    ConstructedContact contact = contact_of(kind, generator, 8);
    // The first feature's point becomes a corner of the other, which then shrinks to an edge or to a point.
    const double t = contact.contact_time;
    const Vec3 meeting = (1 - t) * contact.x_t0[3] + t * contact.x_t1[3];
    contact.x_t0[0] = meeting - t * Vec3(8, -16, 24);
    contact.x_t1[0] = meeting + (1 - t) * Vec3(8, -16, 24);
    const std::size_t last = generator.integer(0, 1) == 0 ? 2 : 1;
    for (std::size_t k = 2; k >= last && k >= (kind == PairKind::kVf ? 1U : 2U); --k) {
      contact.x_t0[k] = contact.x_t0[3];
      contact.x_t1[k] = contact.x_t1[3];
    }
    expect_contact(kind, contact.x_t0, contact.x_t1, t);
  }
}

TEST(Ccd, ContactsOfCoplanarMotionAreFound) {
  ContactGenerator generator(45);
  for (int i = 0; i < 3000; ++i) {
    const PairKind kind = kKinds[i % 3];
    ConstructedContact contact = contact_of(kind, generator, 8);
    // A shear of the plane z = 0: coplanar at all times, in a plane that no axis singles out.
    const int slope_x = generator.integer(-3, 3), slope_y = generator.integer(-3, 3);
    for (Points* x : {&contact.x_t0, &contact.x_t1}) {
      for (Vec3& p : *x) p[2] = slope_x * p[0] + slope_y * p[1];
    }
    expect_contact(kind, contact.x_t0, contact.x_t1, contact.contact_time);
  }
}

TEST(Ccd, ContactsWithoutRelativeMotionAreFound) {
  ContactGenerator generator(46);
  for (int i = 0; i < 3000; ++i) {
    const PairKind kind = kKinds[i % 3];
    ConstructedContact contact = contact_of(kind, generator, 8);
    const double t = contact.contact_time;
    const Vec3 velocity = generator.integer(0, 1) == 0 ? Vec3(Vec3::Zero()) : Vec3(8, -24, 40);
    for (std::size_t k = 0; k < 4; ++k) {
      const Vec3 meeting = (1 - t) * contact.x_t0[k] + t * contact.x_t1[k];
      contact.x_t0[k] = meeting;
      contact.x_t1[k] = meeting + velocity;
    }
    const CcdResult result = pair_ccd(kind, contact.x_t0, contact.x_t1, kNoTolerance);
    EXPECT_EQ(result.verdict, CcdVerdict::kCollides);
    EXPECT_EQ(result.toi_lower, 0);
  }
}

TEST(Ccd, TimesOfSimpleContactsAreTight) {
  Random random(47);
  for (int i = 0; i < 3000; ++i) {
    // A point through a still triangle, and an edge through a still edge, both along z: the time is h0 / (h0 - h1).
    const double above = 0.1 + std::fabs(random.uniform()), below = -0.1 - std::fabs(random.uniform());
    const Rational contact = exact(above) / (exact(above) - exact(below));
    const double x = 0.25 * random.uniform(), y = 0.25 * random.uniform();
    const Points face_t0 = {Vec3(x, y, above), Vec3(-1, -1, 0), Vec3(2, -1, 0), Vec3(-1, 2, 0)};
    const Points edge_t0 = {Vec3(x, -1, above), Vec3(y, 1, above), Vec3(-1, 0, 0), Vec3(1, 0, 0)};
    Points face_t1 = face_t0, edge_t1 = edge_t0;
    face_t1[0][2] = edge_t1[0][2] = edge_t1[1][2] = below;
    for (const CcdResult& result : {vf_ccd(face_t0, face_t1, kNoTolerance), ee_ccd(edge_t0, edge_t1, kNoTolerance)}) {
      EXPECT_EQ(result.verdict, CcdVerdict::kCollides);
      EXPECT_TRUE(exact(result.toi_lower) <= contact);
      EXPECT_TRUE(contact - exact(result.toi_lower) <= testing::scaled_exactly(1, -44));
      EXPECT_NEAR(std::fabs(result.normal[2]), 1, 0x1p-20);
    }
    EXPECT_GT(vf_ccd(face_t0, face_t1, kNoTolerance).normal[2], 0);
    EXPECT_GT(ee_ccd(edge_t0, edge_t1, kNoTolerance).normal[2], 0);
  }
}

// The features have no distance there that could tell a direction.
TEST(Ccd, AContactOnABorderHasANormal) {
  const auto normal = [](PairKind kind, const Points& x_t0, const Points& x_t1) {
    const CcdResult result = pair_ccd(kind, x_t0, x_t1, kNoTolerance);
    EXPECT_EQ(result.verdict, CcdVerdict::kCollides);
    EXPECT_NEAR(result.normal.norm(), 1, 1e-15);
    return result.normal;
  };
  const auto down = [](Points x, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) x[i][2] -= 1;
    return x;
  };
  // They touch at the start: a vertex on the border of the face, and the end of an edge on the other.
  const Points face = {Vec3(0.5, 0, 0), Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};
  EXPECT_EQ(std::fabs(normal(PairKind::kVf, face, down(face, 1))[2]), 1);
  const Points edges = {Vec3(0.5, 0, 0), Vec3(0.5, 1, 0), Vec3(0, 0, 0), Vec3(1, 0, 0)};
  EXPECT_EQ(std::fabs(normal(PairKind::kEe, edges, down(edges, 2))[2]), 1);
  // They touch at t = 1 alone, and are an ulp apart till then.
  normal(PairKind::kVf, {Vec3(-1, 0, 2), Vec3(0, -2, -2), Vec3(-2, 0, 3), Vec3(0x1.8000000000001p+1, 0, -2)},
         {Vec3(-1, 0, 2), Vec3(0, -2, -0x1.fffffffffffffp+0), Vec3(-2, 0, 3), Vec3(3, 0, -2)});
}

TEST(Ccd, AlarmsAreNearContacts) {
  Random random(48);
  ContactGenerator generator(48);
  int alarms = 0;
  for (int i = 0; i < 4000; ++i) {
    const PairKind kind = kKinds[i % 3];
    const ConstructedContact query = random_query(random, generator, kind);
    const CcdResult result = pair_ccd(kind, query.x_t0, query.x_t1, kNoTolerance);
    EXPECT_NE(result.verdict, CcdVerdict::kUnresolved);
    if (result.verdict != CcdVerdict::kCollides) continue;
    ++alarms;
    EXPECT_LE(result.gap_bound, size_of(query.x_t0, query.x_t1) * kAlarmShare);
    expect_gap(kind, query.x_t0, query.x_t1, result);
  }
  EXPECT_GT(alarms, 1000);
}

// "Always collides" has no false negative; this is the test that it fails.
TEST(Ccd, SeparatedMotionsRaiseNoAlarm) {
  Random random(49);
  for (int i = 0; i < 20000; ++i) {
    const PairKind kind = kKinds[i % 3];
    const std::size_t first_feature = kind == PairKind::kEe ? 2 : 1;
    Points x_t0, x_t1;
    for (std::size_t k = 0; k < 4; ++k) {
      x_t0[k] = detail::to_vec3(random.point());
      x_t1[k] = detail::to_vec3(random.point());
    }
    // The two features keep to either side of the plane z = x, closer and closer to it.
    const double gap = std::ldexp(1.0, -random.integer(1, 44));
    for (Points* x : {&x_t0, &x_t1}) {
      for (std::size_t k = 0; k < 4; ++k) {
        const double side = std::fabs((*x)[k][2]) + gap;
        (*x)[k][2] = (*x)[k][0] + (k < first_feature ? side : -side);
      }
    }
    EXPECT_EQ(pair_ccd(kind, x_t0, x_t1, kNoTolerance).verdict, CcdVerdict::kSeparated);
  }
}

TEST(Ccd, SlidingPastWithinThePlaneRaisesNoAlarm) {
  Random random(50);
  for (int i = 0; i < 2000; ++i) {
    // A square's corner slides along an edge of a coplanar triangle, and along a coplanar edge.
    const double gap = std::ldexp(1.0, -random.integer(1, 48)), y = random.uniform();
    const Points x_t0 = {Vec3(gap, -2, y), Vec3(0, -1, 2 * y), Vec3(0, 1, 0), Vec3(-1, 0, y)};
    Points x_t1 = x_t0;
    x_t1[0] = Vec3(gap, 2, -y);
    EXPECT_EQ(vf_ccd(x_t0, x_t1, kNoTolerance).verdict, CcdVerdict::kSeparated);
    const Points e_t0 = {Vec3(gap, -2, 0), Vec3(gap, -1, 0), Vec3(0, -1, 0), Vec3(0, 1, 0)};
    Points e_t1 = e_t0;
    e_t1[0][1] += 5;
    e_t1[1][1] += 3;
    EXPECT_EQ(ee_ccd(e_t0, e_t1, kNoTolerance).verdict, CcdVerdict::kSeparated);
  }
}

// Where all corners pass through one point, or miss each other there by an ulp, features move apart as fast as they
// came together. Searched piece by piece on the way out too, one in 500 of these ran out of intervals.
TEST(Ccd, CornersThatPassThroughOnePointAreDecided) {
  Random random(67);
  int separated = 0;
  for (int i = 0; i < 9000; ++i) {
    const PairKind kind = kKinds[i % 3];
    const auto small_vector = [&] {
      const double x = random.integer(-3, 3), y = random.integer(-3, 3);
      return Vec3(x, y, random.integer(-3, 3));
    };
    const Vec3 meeting = small_vector();
    const int before = random.integer(1, 3), after = random.integer(1, 3);
    Points x_t0, x_t1;
    for (std::size_t k = 0; k < 4; ++k) {
      const Vec3 direction = small_vector();
      x_t0[k] = meeting + before * direction;
      x_t1[k] = meeting - after * direction;
    }
    for (int moves = random.integer(1, 3); moves > 0; --moves) {
      Points& x = random.chance(2) ? x_t0 : x_t1;
      double& coordinate = x[static_cast<std::size_t>(random.integer(0, 3))][random.integer(0, 2)];
      coordinate = std::nextafter(coordinate, random.chance(2) ? 100.0 : -100.0);
    }
    const CcdResult result = pair_ccd(kind, x_t0, x_t1, kNoTolerance);
    EXPECT_NE(result.verdict, CcdVerdict::kUnresolved) << i << " stops at " << result.toi_lower;
    separated += result.verdict == CcdVerdict::kSeparated;
    if (result.verdict == CcdVerdict::kCollides) expect_gap(kind, x_t0, x_t1, result);
  }
  EXPECT_GT(separated, 1500);
}

/// Where all corners meet, an edge may be shorter than the rounding of its ends, and they disagree with it: feet of
/// perpendiculars then seem to lie on it that do not. The fuzzer found these two.
TEST(Ccd, WeightsOnAnEdgeThatVanishesAreConvex) {
  const Points edges_t0 = {Vec3(-0x1.20971p-1, 0x1.3370cp-3, 0x1.ba56a4p+0), Vec3(0, 0, 0x1.776d24p+0),
                           Vec3(-0x1.d400f8p-1, -0x1.3bbe2p-3, 0), Vec3(0, 0, 0)};
  const Points edges_t1 = {Vec3(-0x1.d85c38p-3, 0x1.d89dep-5, 0x1.0b02ep-5),
                           Vec3(-0x1.4e885ap-1, 0x1.5cbc08p-3, 0x1.d439b8p-3),
                           Vec3(0x1.0786p-5, 0x1.24c55p-2, 0x1.541912p+0), Vec3(0, 0, 0)};
  const Points face_t0 = {Vec3(0, 0, 0), Vec3(1.25, 1, 0), Vec3(1, 1.25, 0)};
  const Points face_t1 = {Vec3(1.3125, 0.875, 1.3125), Vec3(0.375, 0.125, 1.3125), Vec3(0.5625, -0.0625, 1.3125)};
  const CcdResult edges = pair_ccd(PairKind::kEe, edges_t0, edges_t1, kNoTolerance);
  const CcdResult face = pair_ccd(PairKind::kSelf, face_t0, face_t1, kNoTolerance);
  for (const CcdResult& result : {edges, face}) {
    EXPECT_EQ(result.verdict, CcdVerdict::kCollides);
    for (const double weight : result.weights) EXPECT_TRUE(weight >= 0 && weight <= 1) << weight;
  }
}

/// Their touch is approached in the times between doubles: by halving from where doubles stop, 57 intervals each.
TEST(Ccd, TouchesWithinAPlaneTakeFewIntervals) {
  Random random(58);
  std::int64_t touches = 0, intervals = 0;
  for (int i = 0; i < 1000; ++i) {
    const auto x = [&] { return random.uniform() / 2; };
    const Points x_t0 = {Vec3(-1, 0, 0), Vec3(1, 0, 0), Vec3(x(), 1 + x(), 0), Vec3(x(), 2 + x(), 0)};
    Points x_t1 = x_t0;
    const Vec3 move(x(), -2, 0);
    for (const std::size_t corner : {2U, 3U}) x_t1[corner] += move;
    const CcdResult result = ee_ccd(x_t0, x_t1, kNoTolerance);
    if (result.verdict == CcdVerdict::kSeparated) continue;
    EXPECT_EQ(result.verdict, CcdVerdict::kCollides);
    ++touches;
    intervals += result.intervals;
  }
  EXPECT_GT(touches, 500);
  EXPECT_LT(intervals, 40 * touches);
}

// Sheets that lie exactly over one another have many such pairs: edges in one line, and one behind the other.
TEST(Ccd, EdgesThatComeTogetherInALineTakeFewIntervals) {
  const auto height = [](int i) { return 1e-3 * std::sin(3.0 * i); };
  for (int i = 0; i < 50; ++i) {
    const auto at = [&](int k, double above) { return Vec3(0.1 * k, 0.7, above + height(k)); };
    for (const int behind : {0, 1}) {
      const Points x_t0 = {at(i, 0.05), at(i + 1, 0.05), at(i + behind, 0), at(i + behind + 1, 0)};
      Points x_t1 = x_t0;
      for (const std::size_t k : {0U, 1U}) x_t1[k][2] -= 0.2;
      const CcdResult result = ee_ccd(x_t0, x_t1, kNoTolerance);
      EXPECT_EQ(result.verdict, CcdVerdict::kCollides);
      EXPECT_NEAR(result.toi_lower, 0.25, 1e-15);
      EXPECT_LE(result.intervals, 14) << i;
    }
  }
}

TEST(Ccd, TheEndIsJudgedByTheTolerance) {
  Random random(51);
  int near = 0;
  for (int i = 0; i < 4000; ++i) {
    const PairKind kind = kKinds[i % 3];
    const std::size_t first_feature = kind == PairKind::kEe ? 2 : 1;
    Points x_t0, x_t1;
    for (std::size_t k = 0; k < 4; ++k) {
      x_t0[k] = detail::to_vec3(random.point());
      x_t1[k] = detail::to_vec3(random.point());
      for (Points* x : {&x_t0, &x_t1}) {
        const double side = std::fabs((*x)[k][2]) + 0x1p-20;
        (*x)[k][2] = k < first_feature ? side : -side;
      }
    }
    const double tolerance = std::ldexp(1 + std::fabs(random.uniform()), -random.integer(0, 12));
    const CcdResult result = pair_ccd(kind, x_t0, x_t1, {tolerance, 4096});
    const Rational end_squared = distance_squared_at(kind, x_t0, x_t1, 1);
    if (result.verdict == CcdVerdict::kSeparated) {
      EXPECT_TRUE(end_squared > squared(exact(tolerance)));
      continue;
    }
    ++near;
    EXPECT_EQ(result.cause, CcdCause::kEnd);
    EXPECT_EQ(result.toi_lower, 1);
    EXPECT_TRUE(end_squared <= squared(exact(result.gap_bound)));
    EXPECT_LE(result.gap_bound, tolerance * (1 + 0x1p-40) + 0x1p-40);
  }
  EXPECT_GT(near, 200);
}

TEST(Ccd, AReachedLimitIsUnresolvedAndItsTimeIsSafe) {
  Random random(54);
  ContactGenerator generator(54);
  int limited = 0;
  for (int i = 0; i < 3000; ++i) {
    const PairKind kind = kKinds[i % 3];
    const ConstructedContact query = random_query(random, generator, kind);
    const CcdResult full = pair_ccd(kind, query.x_t0, query.x_t1, kNoTolerance);
    const int limit = random.integer(1, 40);
    const CcdResult result = pair_ccd(kind, query.x_t0, query.x_t1, {0, limit});
    EXPECT_LE(result.intervals, limit);
    EXPECT_LE(full.intervals, 4096);
    if (result.verdict != CcdVerdict::kSeparated) expect_convex(kind, result.weights);
    if (full.intervals <= limit) {
      EXPECT_EQ(result.verdict, full.verdict);
    } else if (result.verdict == CcdVerdict::kUnresolved) {
      ++limited;
      if (full.verdict == CcdVerdict::kCollides) {
        EXPECT_LE(result.toi_lower, full.toi_lower);
      }
    } else {
      // Fewer intervals can also end in an earlier, coarser alarm, never in a proof.
      EXPECT_EQ(result.verdict, CcdVerdict::kCollides);
      expect_gap(kind, query.x_t0, query.x_t1, result);
    }
  }
  EXPECT_GT(limited, 30);
  EXPECT_EQ(vf_ccd(generator.vf(4).x_t0, generator.vf(4).x_t1, {0, 0}).verdict, CcdVerdict::kUnresolved);
}

TEST(Ccd, OutsideTheDomainIsUnresolved) {
  ContactGenerator generator(55);
  const double infinity = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();
  const auto expect_unresolved = [](const CcdResult& result) {
    EXPECT_EQ(result.verdict, CcdVerdict::kUnresolved);
    EXPECT_EQ(result.toi_lower, 0);
  };
  for (const PairKind kind : kKinds) {
    const ConstructedContact contact = contact_of(kind, generator, 8);
    for (const double bad : {nan, infinity, -infinity, std::nextafter(kMaxCoordinate, infinity)}) {
      for (std::size_t i = 0; i < (kind == PairKind::kSelf ? 3U : 4U); ++i) {
        Points x = contact.x_t0;
        x[i][static_cast<int>(i) % 3] = bad;
        expect_unresolved(pair_ccd(kind, x, contact.x_t1, kNoTolerance));
        expect_unresolved(pair_ccd(kind, contact.x_t0, x, kNoTolerance));
      }
    }
    for (const double bad : {nan, infinity, -1.0}) {
      expect_unresolved(pair_ccd(kind, contact.x_t0, contact.x_t1, {bad, 4096}));
    }
  }
}

TEST(Ccd, TheLargestCoordinatesAreInTheDomain) {
  const double m = kMaxCoordinate;
  const Points x_t0 = {Vec3(0, 0, m), Vec3(-m, -m, -m), Vec3(m, -m, -m), Vec3(0, m, -m)};
  Points x_t1 = x_t0;
  x_t1[0][2] = -m;
  EXPECT_EQ(vf_ccd(x_t0, x_t1, kNoTolerance).verdict, CcdVerdict::kCollides);
  x_t1[0][2] = 0;
  EXPECT_EQ(vf_ccd(x_t0, x_t1, kNoTolerance).verdict, CcdVerdict::kSeparated);
}

}  // namespace selvage
