// The baseline must be a good textbook method: right where doubles suffice, and wrong only where its fixed tolerance
// is.
#include "bench/textbook.h"

#include <gtest/gtest.h>

#include "fuzz/draw/generators.h"

namespace selvage::bench {
namespace {

using fuzz::ChoiceSource;

struct Errors {
  int cases = 0, touches = 0, missed = 0, false_alarms = 0;
};

Errors errors_on(const std::string& name, PairKind kind, int cases) {
  Errors errors;
  for (const fuzz::QueryClass& query_class : fuzz::query_classes()) {
    if (query_class.name != name) continue;
    for (int i = 0; i < cases; ++i) {
      ChoiceSource source = ChoiceSource::from_seed(fuzz::mix(1, static_cast<std::uint64_t>(i)));
      const fuzz::MotionQuery query = fuzz::make_query(query_class, kind, source);
      const bool touches = fuzz::exact_motion(query, verify::Detail::kDecision).touches;
      const TextbookAnswer answer =
          kind == PairKind::kVf ? textbook_vf(query.x_t0, query.x_t1) : textbook_ee(query.x_t0, query.x_t1);
      ++errors.cases;
      errors.touches += touches;
      errors.missed += touches && !answer.collides;
      errors.false_alarms += !touches && answer.collides;
    }
  }
  return errors;
}

const std::array<Vec3, 3> kTriangle{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};

std::array<Vec3, 4> with_point(const Vec3& p) { return {p, kTriangle[0], kTriangle[1], kTriangle[2]}; }

TEST(Textbook, PointThroughTriangle) {
  const TextbookAnswer hit = textbook_vf(with_point({0.25, 0.25, 1}), with_point({0.25, 0.25, -3}));
  EXPECT_TRUE(hit.collides);
  EXPECT_NEAR(hit.toi, 0.25, 1e-15);
  EXPECT_FALSE(textbook_vf(with_point({2, 2, 1}), with_point({2, 2, -3})).collides);
  EXPECT_FALSE(textbook_vf(with_point({0.25, 0.25, 1}), with_point({0.25, 0.25, 0.5})).collides);
}

TEST(Textbook, TouchAtEitherEnd) {
  EXPECT_EQ(textbook_vf(with_point({0.25, 0.25, 0}), with_point({0.25, 0.25, 1})).toi, 0);
  const TextbookAnswer end = textbook_vf(with_point({0.25, 0.25, 1}), with_point({0.25, 0.25, 0}));
  EXPECT_TRUE(end.collides);
  EXPECT_EQ(end.toi, 1);
}

TEST(Textbook, EdgeThroughEdge) {
  const std::array<Vec3, 4> above{Vec3(-1, 0, 1), Vec3(1, 0, 1), Vec3(0, -1, 0), Vec3(0, 1, 0)};
  const std::array<Vec3, 4> below{Vec3(-1, 0, -1), Vec3(1, 0, -1), Vec3(0, -1, 0), Vec3(0, 1, 0)};
  const TextbookAnswer hit = textbook_ee(above, below);
  EXPECT_TRUE(hit.collides);
  EXPECT_NEAR(hit.toi, 0.5, 1e-15);
  const std::array<Vec3, 4> beside{Vec3(3, 0, -1), Vec3(5, 0, -1), Vec3(0, -1, 0), Vec3(0, 1, 0)};
  EXPECT_FALSE(textbook_ee({Vec3(3, 0, 1), Vec3(5, 0, 1), Vec3(0, -1, 0), Vec3(0, 1, 0)}, beside).collides);
}

TEST(Textbook, ParallelEdgesThatMeet) {
  const std::array<Vec3, 4> apart{Vec3(0, 0, 1), Vec3(2, 0, 1), Vec3(1, 0, 0), Vec3(3, 0, 0)};
  const std::array<Vec3, 4> touching{Vec3(0, 0, 0), Vec3(2, 0, 0), Vec3(1, 0, 0), Vec3(3, 0, 0)};
  EXPECT_TRUE(textbook_ee(apart, touching).collides);
  EXPECT_FALSE(textbook_ee(apart, apart).collides);
}

// Double roots apart, random coordinates of one size never show what is wrong with it: no miss in 20,000.
TEST(Textbook, UniformQueriesAgreeWithExactArithmetic) {
  for (const PairKind kind : {PairKind::kVf, PairKind::kEe}) {
    const Errors errors = errors_on("uniform", kind, 10000);
    EXPECT_GT(errors.touches, 500);
    EXPECT_EQ(errors.missed, 0);
    EXPECT_LE(errors.false_alarms, 2);  // within 1e-6 of a touch
  }
}

// What the proof is for: contacts with 24-bit coordinates at an offset up to 2^48, and contacts of tiny size.
TEST(Textbook, MissesContactsFarFromTheOrigin) {
  for (const PairKind kind : {PairKind::kVf, PairKind::kEe}) {
    const Errors errors = errors_on("contact-middle-interior-uniform", kind, 2000);
    EXPECT_EQ(errors.touches, errors.cases);
    EXPECT_GT(errors.missed, errors.cases / 20) << fuzz::name_of(kind);
  }
}

}  // namespace
}  // namespace selvage::bench
