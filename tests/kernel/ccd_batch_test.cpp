// The batch against single queries, on every SIMD target that this machine has.
#include "kernel/ccd_batch.h"

#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include <gtest/gtest.h>

#include "kernel/box_hierarchy.h"
#include "kernel/lanes/lane_cull.h"
#include "kernel/query/plane_passage.h"
#include "tests/kernel/constructed_contact.h"
#include "tests/kernel/pair_list.h"
#include "tests/kernel/public_frames.h"
#include "tests/kernel/random_points.h"
#include "tests/property.h"
#include "tests/vector_units.h"
#include "verify/decision/exact_distance.h"

namespace selvage {

using testing::FourPoints;
using testing::PairList;
using testing::Random;

namespace {

bool same_bits(const CcdResult& a, const CcdResult& b) {
  const auto equal = [](double x, double y) { return std::memcmp(&x, &y, sizeof x) == 0; };
  bool same = a.verdict == b.verdict && a.cause == b.cause && a.intervals == b.intervals &&
              equal(a.toi_lower, b.toi_lower) && equal(a.gap_bound, b.gap_bound);
  for (std::size_t k = 0; k < 4; ++k) same = same && equal(a.weights[k], b.weights[k]);
  for (Eigen::Index k = 0; k < 3; ++k) same = same && equal(a.normal[k], b.normal[k]);
  return same;
}

BatchReport ask(const PairList& list, const CcdOptions& options) {
  const Mesh mesh = list.mesh();
  const Positions V_t0 = list.V_t0(), V_t1 = list.V_t1();
  const CcdBatch batch(mesh, V_t0, V_t1, options, 4 * list.size());
  return list.kind() == PairKind::kVf ? batch.ask(list.vf()) : batch.ask(list.ee());
}

CcdResult ask_one(const PairList& list, std::size_t i, const CcdOptions& options) {
  return (list.kind() == PairKind::kVf ? vf_ccd : ee_ccd)(list.x_t0(i), list.x_t1(i), options);
}

/// Exactly free of touch, and beyond the tolerance at the end.
bool is_separated(const PairList& list, std::size_t i, double tolerance) {
  const auto exact = [](const FourPoints& x) {
    std::array<verify::Point, 4> points;
    for (std::size_t k = 0; k < 4; ++k) points[k] = {x[k][0], x[k][1], x[k][2]};
    return points;
  };
  const auto x_t0 = exact(list.x_t0(i)), x_t1 = exact(list.x_t1(i));
  const bool is_vf = list.kind() == PairKind::kVf;
  const auto motion = is_vf ? verify::exact_vf_motion : verify::exact_ee_motion;
  const auto within_at = is_vf ? verify::vf_within_at : verify::ee_within_at;
  return !motion(x_t0, x_t1, verify::Detail::kDecision).touches && !within_at(x_t0, x_t1, 1, tolerance);
}

/// What the batch promises about each pair (ccd_batch.h).
void check(const PairList& list, const BatchReport& report, const CcdOptions& options) {
  std::size_t next = 0;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const CcdResult expected = ask_one(list, i, options);
    if (next < report.answers.size() && report.answers[next].candidate == i) {
      RC_ASSERT(expected.verdict != CcdVerdict::kSeparated);
      RC_ASSERT(same_bits(report.answers[next++].ccd, expected));
    } else if (expected.verdict != CcdVerdict::kSeparated) {
      RC_ASSERT(is_separated(list, i, options.tolerance));
    }
  }
  RC_ASSERT(next == report.answers.size());
  RC_ASSERT(report.searched <= static_cast<std::int64_t>(list.size()));
}

/// A pair of unit size: generic, near, on a lattice, flat, touching by construction, or at rest.
void add_pair(PairList& list, Random& random, testing::ContactGenerator& contacts, double scale) {
  FourPoints x_t0, x_t1;
  const int form = random.integer(0, 5);
  if (form == 5) {
    const auto contact = list.kind() == PairKind::kVf ? contacts.vf(4) : contacts.ee(4);
    x_t0 = testing::placed(contact.x_t0, scale, Vec3::Zero());
    x_t1 = testing::placed(contact.x_t1, scale, Vec3::Zero());
  } else {
    for (FourPoints* x : {&x_t0, &x_t1}) {
      for (Vec3& p : *x) {
        for (int axis = 0; axis < 3; ++axis) {
          const int whole = random.integer(-2, 2);
          const double value = form == 0 ? random.uniform() : form == 1 ? whole + 0x1p-40 * random.uniform() : whole;
          p[axis] = scale * (form == 3 && axis == 2 ? 1.0 : value);
        }
      }
    }
    if (form == 4) x_t1 = x_t0;
  }
  list.add(x_t0, x_t1);
  if (random.chance(3)) list.share_first();
}

PairList random_list(PairKind kind, int size, Random& random, testing::ContactGenerator& contacts) {
  PairList list(kind);
  const double scale = std::ldexp(1.0, random.chance(3) ? random.integer(-1074, 980) : 0);
  const bool mixed = random.chance(8);
  for (int i = 0; i < size; ++i) {
    add_pair(list, random, contacts, mixed ? std::ldexp(1.0, random.integer(-1074, 980)) : scale);
  }
  return list;
}

/// Features at rest, between `lowest` and `highest` roundings apart: the last bit of a projection decides.
PairList knife_edges(PairKind kind, int lowest, int highest, Random& random) {
  PairList list(kind);
  for (int i = 0; i < 70; ++i) {
    const detail::Double3 u = random.point(), v = random.point(), normal = cross(u, v);
    const double height = random.integer(lowest, highest) * 0x1p-53 / std::sqrt(dot(normal, normal));
    const Vec3 along = to_vec3(u), across = to_vec3(v), touch = 0.25 * to_vec3(random.point());
    const Vec3 apart = touch + height * to_vec3(normal);
    const FourPoints x = kind == PairKind::kVf
                             ? FourPoints{apart, touch - along - across, touch + along, touch + across}
                             : FourPoints{apart - along, apart + along, touch - across, touch + across};
    list.add(x, x);
  }
  return list;
}

}  // namespace

TEST(CcdBatch, PropAnswersAreThoseOfSingleQueries) {
  testing::check_property(300, 21, [] {
    Random random(*rc::gen::arbitrary<std::uint64_t>());
    testing::ContactGenerator contacts(random.bits());
    const PairKind kind = random.chance(2) ? PairKind::kVf : PairKind::kEe;
    const PairList list = random.chance(4) ? knife_edges(kind, -10, 20, random)
                                           : random_list(kind, random.integer(0, 70), random, contacts);
    const double size = list.size() > 0 ? list.V_t0().cwiseAbs().maxCoeff() : 1;
    const double tolerance = random.chance(2) ? 0 : random.chance(2) ? 0x1p-20 * size : 0.25 * size;
    const CcdOptions options{tolerance, random.chance(2) ? random.integer(1, 8) : 4096};
    testing::on_every_vector_unit([&](const char*) { check(list, ask(list, options), options); });
  });
}

/// Exactly touching pairs, whatever else is in the list: none may be left out.
TEST(CcdBatch, PropConstructedContactsAreNeverLeftOut) {
  testing::check_property(300, 22, [] {
    Random random(*rc::gen::arbitrary<std::uint64_t>());
    testing::ContactGenerator contacts(random.bits());
    PairList list(random.chance(2) ? PairKind::kVf : PairKind::kEe);
    const double scale = std::ldexp(1.0, random.integer(-1060, 980));
    const Vec3 offset = scale * Vec3(random.integer(0, 1 << 30), random.integer(0, 1 << 30), 0);
    const int count = random.integer(1, 70);
    for (int i = 0; i < count; ++i) {
      const auto contact = list.kind() == PairKind::kVf ? contacts.vf(8) : contacts.ee(8);
      list.add(testing::placed(contact.x_t0, scale, offset), testing::placed(contact.x_t1, scale, offset));
    }
    testing::on_every_vector_unit([&](const char*) { RC_ASSERT(ask(list, {0, 4096}).answers.size() == list.size()); });
  });
}

/// Features that pass through each other by a few roundings of float32: a look that forgot its error would see them
/// on one side at both ends.
TEST(CcdBatch, ContactsWithinTheRoundingOfTheFirstLookAreNeverLeftOut) {
  Random random(24);
  for (int round = 0; round < 40; ++round) {
    PairList list(round % 2 == 0 ? PairKind::kVf : PairKind::kEe);
    for (int i = 0; i < 70; ++i) {
      const detail::Double3 u = random.point(), v = random.point(), normal = cross(u, v);
      const Vec3 along = to_vec3(u), across = to_vec3(v), touch = 0.25 * to_vec3(random.point());
      const auto at = [&](double roundings) {
        const Vec3 apart = touch + (roundings * 0x1p-24 / std::sqrt(dot(normal, normal))) * to_vec3(normal);
        return list.kind() == PairKind::kVf ? FourPoints{apart, touch - along - across, touch + along, touch + across}
                                            : FourPoints{apart - along, apart + along, touch - across, touch + across};
      };
      const double side = random.chance(2) ? 1 : -1;
      list.add(at(side * std::fabs(random.uniform())), at(-side * std::fabs(random.uniform())));
    }
    testing::on_every_vector_unit([&](const char* target) {
      EXPECT_EQ(ask(list, {0, 4096}).answers.size(), list.size()) << target;
    });
  }
}

/// A vertex above the middle of a face, at rest, just within or just beyond the tolerance: the cull must know it.
TEST(CcdBatch, ToleranceCountsAtTheEndAlone) {
  for (const double end : {0x1.fp-11, 0x1.1p-10}) {
    PairList list(PairKind::kVf);
    for (int i = 0; i < 11; ++i) {
      const FourPoints near{Vec3(0.25, 0.25, 0x1p-20), Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};
      FourPoints x_t1 = near;
      x_t1[0][2] = end;
      list.add(near, x_t1);
    }
    testing::on_every_vector_unit([&](const char* target) {
      const BatchReport report = ask(list, {0x1p-10, 4096});
      EXPECT_EQ(report.answers.size(), end < 0x1p-10 ? 11U : 0U) << target;
      EXPECT_EQ(report.searched, end < 0x1p-10 ? 11 : 0) << target;
    });
  }
}

/// A pair that no single direction separates, but one for each half does: it turns around.
TEST(CcdBatch, PartsOfTheStepHaveDirectionsOfTheirOwn) {
  PairList list(PairKind::kVf);
  list.add({Vec3(-3, 0.5, 1), Vec3(-1, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)},
           {Vec3(3, 0.5, 1), Vec3(-1, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)});
  list.add({Vec3(-1.5, 0.25, 0.5), Vec3(-1, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)},
           {Vec3(0.5, -1.5, -0.5), Vec3(-1, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)});
  testing::on_every_vector_unit([&](const char* target) { EXPECT_EQ(ask(list, {}).searched, 0) << target; });
}

TEST(CcdBatch, OutsideTheDomainNothingIsCulled) {
  const FourPoints far{Vec3(0, 0, 5), Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
  for (const double bad : {nan, infinity, -infinity, 0x1p+1001}) {
    PairList list(PairKind::kVf);
    list.add(far, far);
    FourPoints x_t1 = far;
    x_t1[2][1] = bad;
    list.add(far, x_t1);
    const BatchReport report = ask(list, {});
    ASSERT_EQ(report.answers.size(), 1U) << bad;
    EXPECT_EQ(report.answers[0].candidate, 1U);
    EXPECT_EQ(report.answers[0].ccd.verdict, CcdVerdict::kUnresolved);
    EXPECT_EQ(report.answers[0].ccd.toi_lower, 0);
  }
  PairList list(PairKind::kVf);
  list.add(far, far);
  for (const CcdOptions& options : {CcdOptions{-1, 4096}, CcdOptions{nan, 4096}, CcdOptions{0, 0}}) {
    EXPECT_EQ(ask(list, options).answers.size(), 1U);
  }
}

/// The decisions of the lanes themselves, in one number for every target, compiler and optimisation level (K7).
TEST(CcdBatch, EveryTargetLeavesTheSamePairs) {
  constexpr std::uint64_t kGoldenHash = 0x8ac4190b54146ad7U;
  const auto hash = [] {
    std::uint64_t value = 0xcbf29ce484222325U;
    const auto add = [&](std::uint64_t word) { value = (value ^ word) * 0x100000001b3U; };
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
      Random random(seed);
      testing::ContactGenerator contacts(seed);
      const PairKind kind = seed % 2 == 0 ? PairKind::kVf : PairKind::kEe;
      const PairList list = seed < 100 ? random_list(kind, 70, random, contacts) : knife_edges(kind, 10, 60, random);
      const Mesh mesh = list.mesh();
      const detail::LaneMotion motion(list.V_t0(), list.V_t1());
      const detail::LanePairs pairs =
          list.kind() == PairKind::kVf ? detail::LanePairs(mesh, list.vf()) : detail::LanePairs(mesh, list.ee());
      const double tolerance = seed % 3 == 0 ? 0.25 : 0;
      detail::PairNumbers left;
      const auto add_left = [&] {
        add(left.count);
        for (std::size_t i = 0; i < left.count; ++i) add(left.place[i]);
      };
      cull_in_lanes(motion, pairs, tolerance, left);
      add_left();
      std::vector<detail::LaneContact> passed;
      if (motion.is_exact()) pass_in_lanes(motion, pairs, tolerance, left, passed);
      add_left();
      for (const detail::LaneContact& contact : passed) {
        add(contact.pair);
        add(contact.passage.tick);
        add(std::bit_cast<std::uint64_t>(contact.passage.gap));
      }
    }
    return value;
  };
  int targets = 0;
  testing::on_every_vector_unit([&](const char* target) {
    EXPECT_EQ(hash(), kGoldenHash) << target;
    ++targets;
  });
  EXPECT_GE(targets, 1);
}

/// The lists that are answered in pieces, or with other pairs around them, are answered alike.
TEST(CcdBatch, TheDivisionOfAListDoesNotMatter) {
  Random random(5);
  testing::ContactGenerator contacts(5);
  const PairList list = random_list(PairKind::kEe, 1500, random, contacts);
  const Mesh mesh = list.mesh();
  const Positions V_t0 = list.V_t0(), V_t1 = list.V_t1();
  const CcdBatch batch(mesh, V_t0, V_t1, {}, 1 << 20);
  const BatchReport whole = batch.ask(list.ee());
  for (const std::size_t size : {1U, 7U, 513U}) {
    std::int64_t searched = 0;
    std::size_t next = 0;
    for (std::size_t first = 0; first < list.size(); first += size) {
      const auto piece = std::span(list.ee()).subspan(first, std::min<std::size_t>(size, list.size() - first));
      const BatchReport report = batch.ask(piece);
      searched += report.searched;
      for (const BatchAnswer& answer : report.answers) {
        ASSERT_LT(next, whole.answers.size());
        EXPECT_EQ(answer.candidate + first, whole.answers[next].candidate);
        EXPECT_TRUE(same_bits(answer.ccd, whole.answers[next++].ccd));
      }
    }
    EXPECT_EQ(next, whole.answers.size());
    EXPECT_EQ(searched, whole.searched);
  }
}

TEST(CcdBatch, PublicContactsAreFoundAndFewPairsAreSearched) {
  const auto frames = testing::public_frames("cloth-ball", "cloth_ball92.ply", "cloth_ball93.ply");
  if (!frames) GTEST_SKIP() << "no public data: set SELVAGE_DATA";
  BoxHierarchy hierarchy(frames->mesh);
  hierarchy.refit(frames->V_t0, frames->V_t1, {0, {}});
  const Candidates candidates = hierarchy.candidates();
  const CcdBatch batch(frames->mesh, frames->V_t0, frames->V_t1, {0, 4096}, candidates.ee.size());
  const BatchReport vf = batch.ask(candidates.vf), ee = batch.ask(candidates.ee);
  EXPECT_EQ(vf.answers.size(), 19'032U);
  EXPECT_EQ(ee.answers.size(), 94'822U);
  EXPECT_LT(static_cast<double>(vf.searched), 0.0003 * static_cast<double>(candidates.vf.size()));
  EXPECT_LT(static_cast<double>(ee.searched), 0.0003 * static_cast<double>(candidates.ee.size()));
}

/// A Ref of column-major positions, or of an expression, refers to a copy that ends with the call.
TEST(CcdBatch, KeepsPositionsOfAnyStorage) {
  Faces F(2, 3);
  F << 0, 1, 2, 3, 4, 5;
  const Mesh mesh = make_mesh(6, F);
  Eigen::MatrixXd V_t0(6, 3);
  V_t0 << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0.2, 0.2, 1, 0.3, 0.2, 1, 0.2, 0.3, 1;
  const VfCandidate pair{3, 0};
  for (const std::size_t query_count : {std::size_t{0}, std::size_t{1'000}}) {
    const Eigen::RowVector3d down(0, 0, -2);
    Eigen::MatrixXd V_t1 = V_t0;
    V_t1.bottomRows(3).rowwise() += down;
    const CcdBatch batch(mesh, V_t0, V_t1, {0, 4096}, query_count);
    Eigen::MatrixXd apart = V_t0;
    apart.bottomRows(3).rowwise() -= 5 * down;
    const std::vector<Eigen::MatrixXd> elsewhere(8, apart);  // where the copies were
    EXPECT_EQ(batch.ask(std::span(&pair, 1)).answers.size(), 1U) << query_count;
  }
  static_assert(
      !std::is_constructible_v<CcdBatch, Mesh, const Positions&, const Positions&, const CcdOptions&, std::size_t>);
}

TEST(CcdBatch, AMeshWithoutVerticesHasNoAnswers) {
  const Positions V(0, 3);
  const Mesh mesh = make_mesh(0, Faces(0, 3));
  EXPECT_TRUE(CcdBatch(mesh, V, V, {}, 1).ask(std::span<const EeCandidate>{}).answers.empty());
}

/// An infinite tolerance is no tolerance: nothing is separated, as single queries say.
TEST(CcdBatch, AnInfiniteToleranceIsAnsweredAsBySingleQueries) {
  Faces F(2, 3);
  F << 0, 1, 2, 3, 4, 5;
  const Mesh mesh = make_mesh(6, F);
  Positions V(6, 3);
  V << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 9, 1, 0, 9, 0, 1, 9;
  const CcdOptions options = {std::numeric_limits<double>::infinity(), 64};
  const std::vector<VfCandidate> pairs = {{3, 0}};
  const BatchReport report = CcdBatch(mesh, V, V, options, 1000).ask(pairs);
  const std::array<Vec3, 4> x = {V.row(3), V.row(0), V.row(1), V.row(2)};
  const CcdResult single = vf_ccd(x, x, options);
  ASSERT_EQ(report.answers.size(), single.verdict == CcdVerdict::kSeparated ? 0U : 1U);
  EXPECT_TRUE(same_bits(report.answers.front().ccd, single));
}

}  // namespace selvage
