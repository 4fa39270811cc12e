// The published exact answers on handcrafted degenerate queries.
#include <algorithm>
#include <filesystem>
#include <vector>

#include <gtest/gtest.h>

#include "io/query_csv.h"
#include "tests/public_data.h"
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

}  // namespace
}  // namespace selvage::verify
