#include "kernel/ccd.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/kernel/constructed_contact.h"

namespace selvage {

using testing::ConstructedContact;
using testing::ContactGenerator;
using testing::placed;

namespace {

constexpr CcdOptions kNoTolerance{0, 4096};

void expect_contact(const CcdResult& result, const ConstructedContact& contact, double size) {
  EXPECT_EQ(result.verdict, CcdVerdict::kCollides);
  EXPECT_EQ(result.cause, CcdCause::kMotion);
  EXPECT_LE(result.toi_lower, contact.contact_time);
  EXPECT_LE(result.gap_bound, size * 0x1p-39 + 0x1p-1074);
}

}  // namespace

TEST(VfCcd, FindsConstructedContactsAtEveryScale) {
  ContactGenerator generator(1);
  for (int i = 0; i < 2000; ++i) {
    const ConstructedContact contact = generator.vf(8);
    const double scale = std::ldexp(1.0, generator.integer(-1074, 980));
    const Vec3 zero = Vec3::Zero();
    expect_contact(vf_ccd(placed(contact.x_t0, scale, zero), placed(contact.x_t1, scale, zero), kNoTolerance),
                   contact, 0x1p+14 * scale);
  }
}

TEST(EeCcd, FindsConstructedContactsAtEveryScale) {
  ContactGenerator generator(2);
  for (int i = 0; i < 2000; ++i) {
    const ConstructedContact contact = generator.ee(8);
    const double scale = std::ldexp(1.0, generator.integer(-1074, 980));
    const Vec3 zero = Vec3::Zero();
    expect_contact(ee_ccd(placed(contact.x_t0, scale, zero), placed(contact.x_t1, scale, zero), kNoTolerance),
                   contact, 0x1p+14 * scale);
  }
}

TEST(VfCcd, SeparatedMotionIsSeparated) {
  const std::array<Vec3, 4> x_t0 = {Vec3(0.25, 0.25, 1), Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};
  const std::array<Vec3, 4> x_t1 = {Vec3(0.25, 0.25, 0.125), Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};
  const CcdResult result = vf_ccd(x_t0, x_t1, CcdOptions{});
  EXPECT_EQ(result.verdict, CcdVerdict::kSeparated);
  EXPECT_EQ(result.toi_lower, 1);
}

TEST(VfCcd, NearerThanToleranceAtTheEndIsACollision) {
  const std::array<Vec3, 4> x_t0 = {Vec3(0.25, 0.25, 1), Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};
  const std::array<Vec3, 4> x_t1 = {Vec3(0.25, 0.25, 0x1p-20), Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};
  const CcdResult result = vf_ccd(x_t0, x_t1, CcdOptions{});
  EXPECT_EQ(result.verdict, CcdVerdict::kCollides);
  EXPECT_EQ(result.cause, CcdCause::kEnd);
  EXPECT_EQ(result.toi_lower, 1);
  EXPECT_NEAR(result.gap_bound, 0x1p-20, 0x1p-48);
}

}  // namespace selvage
