// K2 with a number: the time of impact is never late, and early by no more than rounding where the root is simple.
// Judged by the exact checker.
#include <algorithm>
#include <cmath>
#include <sstream>
#include <vector>

#include <gtest/gtest.h>

#include "io/query_csv.h"
#include "tests/kernel/exact_answer.h"
#include "tests/kernel/random_points.h"
#include "tests/public_data.h"

namespace selvage {

using testing::Random;
using Points = std::array<Vec3, 4>;

namespace {

/// How early toi_lower is over many contacts, as shares of the step.
class Earliness {
 public:
  void note(PairKind kind, const Points& x_t0, const Points& x_t1) {
    const bool is_vf = kind == PairKind::kVf;
    const verify::MotionAnswer truth = testing::exact_answer(kind, x_t0, x_t1, verify::Detail::kFirstTime);
    const CcdResult result = testing::kernel_answer(kind, x_t0, x_t1);
    EXPECT_EQ(result.verdict, truth.touches ? CcdVerdict::kCollides : CcdVerdict::kSeparated);
    if (!truth.touches) return;
    EXPECT_GE(verify::compare_first_touch(testing::raw(x_t0), testing::raw(x_t1), is_vf, result.toi_lower), 0)
        << "late";
    early_.push_back(truth.first.upper_approx - result.toi_lower);
  }

  [[nodiscard]] std::size_t count() const { return early_.size(); }
  [[nodiscard]] double quantile(double share) {
    std::sort(early_.begin(), early_.end());
    return early_[static_cast<std::size_t>(share * static_cast<double>(early_.size() - 1))];
  }
  void expect_tight() {
    ::testing::Test::RecordProperty("contacts", std::to_string(count()));
    for (const auto& [name, share] : {std::pair{"median", 0.5}, {"p99", 0.99}, {"most", 1.0}}) {
      std::ostringstream text;
      text << quantile(share);
      ::testing::Test::RecordProperty(name, text.str());
    }
    EXPECT_LE(quantile(0.5), 1e-12);
    EXPECT_LE(quantile(0.99), 1e-9);
  }

 private:
  std::vector<double> early_;
};

}  // namespace

TEST(TimeOfImpact, OfConstructedSimpleRootsIsTight) {
  Random random(81);
  Earliness earliness;
  for (int i = 0; i < 3000; ++i) {
    // Two features that meet inside both at a random time, small or large beside their motion.
    const PairKind kind = i % 2 == 0 ? PairKind::kVf : PairKind::kEe;
    const double size = std::ldexp(1.0, -random.integer(0, 6));
    Points x;
    for (Vec3& p : x) p = size * detail::to_vec3(random.point());
    const auto weight = [&random] { return 0.1 + 0.4 * std::fabs(random.uniform()); };
    const double wa = weight(), wb = weight();
    if (kind == PairKind::kVf) {
      x[0] = (1 - wa - wb) * x[1] + wa * x[2] + wb * x[3];
    } else {
      const Vec3 shift = (1 - wa) * x[0] + wa * x[1] - (1 - wb) * x[2] - wb * x[3];
      for (const std::size_t k : {2U, 3U}) x[k] += shift;
    }
    const double t = std::fabs(random.uniform()), speed = std::ldexp(1.0, -random.integer(0, 12));
    Points x_t0 = x, x_t1 = x;
    for (std::size_t k = 0; k < 4; ++k) {
      const Vec3 velocity = speed * detail::to_vec3(random.point());
      x_t0[k] -= t * velocity;
      x_t1[k] += (1 - t) * velocity;
    }
    earliness.note(kind, x_t0, x_t1);
  }
  EXPECT_GT(earliness.count(), 2900U);
  earliness.expect_tight();
}

TEST(TimeOfImpact, OfPublicContactsIsTight) {
  const auto data = testing::public_data();
  if (!data) GTEST_SKIP() << "no public data: set SELVAGE_DATA";
  Earliness earliness;
  const auto add = [&earliness](const std::filesystem::path& file, PairKind kind) {
    for (const io::CcdQuery& query : io::read_query_csv(file)) {
      Points x_t0, x_t1;
      for (std::size_t i = 0; i < 4; ++i) {
        x_t0[i] = Vec3(query.points[i].data());
        x_t1[i] = Vec3(query.points[i + 4].data());
      }
      earliness.note(kind, x_t0, x_t1);
    }
  };
  const auto handcrafted = *data / "ccd" / "sample-queries";
  for (const auto& scene : std::filesystem::directory_iterator(handcrafted)) {
    if (!scene.is_directory()) continue;
    for (const char* file : {"data_0_0.csv", "data_0_1.csv"}) {
      add(scene.path() / "vertex-face" / file, PairKind::kVf);
      add(scene.path() / "edge-edge" / file, PairKind::kEe);
    }
  }
  add(*data / "ccd" / "scalable-ccd" / "rod-twist" / "queries" / "3036vf.csv", PairKind::kVf);
  EXPECT_GT(earliness.count(), 800U);
  earliness.expect_tight();
}

}  // namespace selvage
