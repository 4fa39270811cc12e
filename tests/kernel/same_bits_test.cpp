// K7: one hash of the answers to a fixed set of queries, the same for g++ and clang++, every optimisation level and
// instruction set, and whatever floating-point environment the caller has. It changes only when the kernel's answers
// are changed on purpose.
#include <cfenv>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "kernel/ccd.h"
#include "kernel/fp_env.h"
#include "kernel/proximity.h"
#include "tests/fp_control.h"
#include "tests/kernel/random_points.h"
#include "tests/same_bits/hash.h"

namespace selvage {

using testing::Hash;
using testing::Random;
using Points = std::array<Vec3, 4>;

namespace {

constexpr std::uint64_t kGoldenHash = 0x2218451c8e37fee6U;

struct AnyQuery {
  Points x_t0, x_t1;
};

/// Far and near, generic and on the lattice, at all scales: built from integers and powers of two alone.
std::vector<AnyQuery> queries() {
  const FpEnvGuard guard;  // the queries themselves must not depend on the caller's environment
  Random random(61);
  std::vector<AnyQuery> result(3000);
  for (AnyQuery& query : result) {
    const int kind = random.integer(0, 3), exponent = random.chance(4) ? random.integer(-1000, 900) : 0;
    for (Points* x : {&query.x_t0, &query.x_t1}) {
      for (Vec3& p : *x) {
        for (int axis = 0; axis < 3; ++axis) {
          const int whole = random.integer(-2, 2);
          const double noise = random.uniform();
          p[axis] = kind == 0 ? noise : kind == 1 ? whole : whole + std::ldexp(noise, kind == 2 ? -50 : -10);
          p[axis] = std::ldexp(p[axis], exponent);
        }
      }
    }
    if (kind == 3) {
      for (Vec3& p : query.x_t1) p = 0x1p-4 * p;
    }
  }
  return result;
}

std::uint64_t hash_of_answers(const std::vector<AnyQuery>& all) {
  Hash hash;
  for (const AnyQuery& q : all) {
    hash.add(vf_ccd(q.x_t0, q.x_t1, CcdOptions{}));
    hash.add(ee_ccd(q.x_t0, q.x_t1, CcdOptions{}));
    hash.add(self_ccd({q.x_t0[0], q.x_t0[1], q.x_t0[2]}, {q.x_t1[0], q.x_t1[1], q.x_t1[2]}, CcdOptions{}));
    hash.add(vf_proximity(q.x_t0));
    hash.add(ee_proximity(q.x_t1));
  }
  return hash.value();
}

}  // namespace

TEST(SameBits, TheHashOfTheAnswersIsTheGoldenOne) { EXPECT_EQ(hash_of_answers(queries()), kGoldenHash); }

// What tests/same_bits compares between the compilers of one machine, here between processors.
TEST(SameBits, TheHashesOfEveryEntryOfTheKernelAreTheGoldenOnes) {
  const FpEnvGuard guard;  // for the questions, which are asked under a flushing library as well (fast_math_test.cpp)
  Hash of_queries, of_meshes;
  testing::add_query_answers(of_queries);
  testing::add_mesh_answers(of_meshes);
  EXPECT_EQ(of_queries.value(), 0xfba1900a6054b437U);
  EXPECT_EQ(of_meshes.value(), 0xdf84f698c62b48f5U);
}

TEST(SameBits, DirectedRoundingOfTheCallerChangesNothing) {
  const std::vector<AnyQuery> all = queries();
  for (const int direction : {FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO}) {
    std::fesetround(direction);
    const std::uint64_t hash = hash_of_answers(all);
    std::fesetround(FE_TONEAREST);
    EXPECT_EQ(hash, kGoldenHash);
  }
}

TEST(SameBits, FlushingOfTheCallerChangesNothing) {
  const std::vector<AnyQuery> all = queries();
  const unsigned clean = testing::fp_control();
  testing::set_fp_control(clean | testing::kFlushing);
  const std::uint64_t hash = hash_of_answers(all);
  testing::set_fp_control(clean);
  EXPECT_EQ(hash, kGoldenHash);
}

}  // namespace selvage
