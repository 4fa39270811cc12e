// The published exact answers on handcrafted degenerate queries.
#include <algorithm>
#include <filesystem>
#include <vector>

#include <gtest/gtest.h>

#include "io/mesh_reader.h"
#include "io/query_csv.h"
#include "tests/public_data.h"
#include "verify/check.h"
#include "verify/second_opinion.h"

namespace selvage::verify {
namespace {

namespace fs = std::filesystem;

TEST(PublicTruths, AgreeOnEveryErlebenQuery) {
  const auto data = selvage::testing::public_data();
  if (!data) GTEST_SKIP() << "no public data: set SELVAGE_DATA";
  const fs::path folder = *data / "ccd/sample-queries";
  if (!fs::is_directory(folder)) GTEST_SKIP() << "no sample queries in " << folder;

  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.path().extension() == ".csv") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  long queries = 0, positives = 0;
  for (const fs::path& file : files) {
    const bool is_vf = file.parent_path().filename() == "vertex-face";
    ASSERT_TRUE(is_vf || file.parent_path().filename() == "edge-edge") << file;
    long row = 0;
    for (const io::CcdQuery& query : io::read_query_csv(file)) {
      std::array<Point, 4> x_t0{}, x_t1{};
      std::copy_n(query.points.begin(), 4, x_t0.begin());
      std::copy_n(query.points.begin() + 4, 4, x_t1.begin());
      ASSERT_TRUE(query.truth.has_value()) << file;
      const MotionAnswer answer =
          is_vf ? exact_vf_motion(x_t0, x_t1, Detail::kFirstTime) : exact_ee_motion(x_t0, x_t1, Detail::kFirstTime);
      EXPECT_EQ(answer.touches, *query.truth) << file << ", query " << row;
      const SecondOpinion second = is_vf ? second_opinion_vf(x_t0, x_t1) : second_opinion_ee(x_t0, x_t1);
      EXPECT_EQ(second.touches, *query.truth) << file << ", query " << row;
      if (answer.touches && second.touches) {
        EXPECT_LE(answer.first.lower_approx, second.first_upper) << file << ", query " << row;
        EXPECT_GE(answer.first.upper_approx, second.first_lower) << file << ", query " << row;
      }
      ++queries;
      positives += answer.touches ? 1 : 0;
      ++row;
    }
  }
  EXPECT_EQ(queries, 2500);
  EXPECT_GT(positives, 0);
}

/// Candidate pairs (boxes of the whole motion overlap, no common vertex) and those that touch, as published.
struct RealMotion {
  const char *folder, *first, *last;
  PairCounts pairs;
  std::int64_t vf_touches, ee_touches;
};

TEST(PublicTruths, AgreeOnRealFramePairs) {
  const auto data = selvage::testing::public_data();
  if (!data) GTEST_SKIP() << "no public data: set SELVAGE_DATA";
  const std::vector<RealMotion> motions = {
      {"cloth-ball", "cloth_ball92.ply", "cloth_ball93.ply", {1'655'541, 5'197'332, 0, 0, 0}, 19'032, 94'822},
      {"rod-twist", "3036.ply", "3037.ply", {448'270, 2'041'334, 0, 0, 0}, 765, 4'179},
  };
  for (const RealMotion& motion : motions) {
    SCOPED_TRACE(motion.folder);
    const fs::path folder = *data / "ccd/scalable-ccd" / motion.folder / "frames";
    if (!fs::is_directory(folder)) GTEST_SKIP() << "no frames in " << folder;
    const io::MeshData first = io::read_mesh(folder / motion.first), last = io::read_mesh(folder / motion.last);
    CheckOptions options;
    options.max_violations = 10;
    const CheckResult result = check_motion(Surface{first.triangles, {}}, first.points, last.points, options);
    EXPECT_EQ(result.pairs.vf, motion.pairs.vf);
    EXPECT_EQ(result.pairs.ee, motion.pairs.ee);
    EXPECT_EQ(result.violations_total.vf, motion.vf_touches);
    EXPECT_EQ(result.violations_total.ee, motion.ee_touches);
    EXPECT_EQ(result.violations_total.self, 0);
    // The filter is there to keep exact arithmetic off real motions.
    EXPECT_LT(result.pairs.exact * 1000, result.pairs.vf + result.pairs.ee);
  }
}

}  // namespace
}  // namespace selvage::verify
