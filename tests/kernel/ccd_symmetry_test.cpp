// K5: what a pair is called, and the unit of length, change the answer by nothing else.
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "tests/kernel/random_ccd_queries.h"

namespace selvage {

using testing::ConstructedContact;
using testing::ContactGenerator;
using testing::kKinds;
using testing::placed;
using testing::Points;
using testing::Random;
using testing::random_query;

namespace {

/// The pair in another labelling, and what that does to weights and normal.
struct Relabelling {
  std::array<std::size_t, 4> order;
  double normal_sign;
};

std::vector<Relabelling> relabellings(PairKind kind) {
  if (kind == PairKind::kVf) {
    return {{{0, 1, 3, 2}, 1}, {{0, 2, 1, 3}, 1}, {{0, 2, 3, 1}, 1}, {{0, 3, 1, 2}, 1}, {{0, 3, 2, 1}, 1}};
  }
  if (kind == PairKind::kSelf) return {{{0, 2, 1, 3}, 1}};
  return {{{1, 0, 2, 3}, 1},  {{0, 1, 3, 2}, 1},  {{1, 0, 3, 2}, 1}, {{2, 3, 0, 1}, -1},
          {{3, 2, 0, 1}, -1}, {{2, 3, 1, 0}, -1}, {{3, 2, 1, 0}, -1}};
}

Points relabelled(const Points& x, const std::array<std::size_t, 4>& order) {
  return {x[order[0]], x[order[1]], x[order[2]], x[order[3]]};
}

}  // namespace

TEST(Ccd, RelabellingChangesNoBit) {
  Random random(52);
  ContactGenerator generator(52);
  for (int i = 0; i < 3000; ++i) {
    const PairKind kind = kKinds[i % 3];
    const ConstructedContact query = random_query(random, generator, kind);
    const CcdResult one = pair_ccd(kind, query.x_t0, query.x_t1, CcdOptions{});
    for (const Relabelling& label : relabellings(kind)) {
      const CcdResult other =
          pair_ccd(kind, relabelled(query.x_t0, label.order), relabelled(query.x_t1, label.order), CcdOptions{});
      EXPECT_EQ(other.verdict, one.verdict);
      EXPECT_EQ(other.cause, one.cause);
      EXPECT_EQ(other.toi_lower, one.toi_lower);
      EXPECT_EQ(other.gap_bound, one.gap_bound);
      EXPECT_EQ(other.intervals, one.intervals);
      EXPECT_EQ(other.normal, Vec3(label.normal_sign * one.normal));
      for (std::size_t k = 0; k < 4; ++k) {
        // Points that coincide throughout share their weight in either order.
        const std::size_t from = label.order[k];
        const bool shared =
            query.x_t0[1] == query.x_t0[2] && query.x_t1[1] == query.x_t1[2] && (from == 1 || from == 2);
        if (!shared) {
          EXPECT_EQ(other.weights[k], one.weights[from]);
        }
      }
    }
  }
}

TEST(Ccd, ScalingByAPowerOfTwoScalesTheAnswer) {
  Random random(53);
  ContactGenerator generator(53);
  for (int i = 0; i < 3000; ++i) {
    const PairKind kind = kKinds[i % 3];
    const ConstructedContact query = random_query(random, generator, kind);
    const int exponent = random.integer(-900, 900);
    const double scale = std::ldexp(1.0, exponent);
    const CcdResult one = pair_ccd(kind, query.x_t0, query.x_t1, {1e-6, 4096});
    const CcdResult other = pair_ccd(kind, placed(query.x_t0, scale, Vec3::Zero()),
                                     placed(query.x_t1, scale, Vec3::Zero()), {std::ldexp(1e-6, exponent), 4096});
    EXPECT_EQ(other.verdict, one.verdict);
    EXPECT_EQ(other.toi_lower, one.toi_lower);
    EXPECT_EQ(other.gap_bound, std::ldexp(one.gap_bound, exponent));
    EXPECT_EQ(other.intervals, one.intervals);
    EXPECT_EQ(other.weights, one.weights);
    EXPECT_EQ(other.normal, one.normal);
  }
}

}  // namespace selvage
