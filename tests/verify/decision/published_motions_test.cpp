#include <gtest/gtest.h>

#include "io/mesh_reader.h"
#include "tests/public_data.h"
#include "verify/check.h"

namespace selvage::verify {

// Frames of real simulations, with the numbers of candidates and of exact contacts that their publishers state.
TEST(PublishedMotions, CountsThePublishedContacts) {
  const auto data = testing::public_data();
  if (!data) GTEST_SKIP() << "public data not found: set SELVAGE_DATA";
  const struct {
    const char *from, *to;
    std::int64_t vf_pairs, ee_pairs, vf, ee;
  } scenes[] = {
      {"cloth-ball/frames/cloth_ball92.ply", "cloth-ball/frames/cloth_ball93.ply", 1655541, 5197332, 19032, 94822},
      {"rod-twist/frames/3036.ply", "rod-twist/frames/3037.ply", 448270, 2041334, 765, 4179},
  };
  for (const auto& scene : scenes) {
    const io::MeshData from = io::read_mesh(*data / "ccd/scalable-ccd" / scene.from);
    const io::MeshData to = io::read_mesh(*data / "ccd/scalable-ccd" / scene.to);
    ASSERT_EQ(from.triangles, to.triangles);
    const CheckResult result = check_motion(Surface{from.triangles, {}}, from.points, to.points, {});
    EXPECT_EQ(result.pairs.vf, scene.vf_pairs) << scene.from;
    EXPECT_EQ(result.pairs.ee, scene.ee_pairs) << scene.from;
    EXPECT_EQ(result.violations_total.vf, scene.vf) << scene.from;
    EXPECT_EQ(result.violations_total.ee, scene.ee) << scene.from;
    EXPECT_EQ(result.violations_total.self, 0) << scene.from;
  }
}

}  // namespace selvage::verify
