#include "kernel/box_hierarchy.h"

#include <gtest/gtest.h>

#include "tests/kernel/public_frames.h"
#include "tests/kernel/random_motion.h"
#include "tests/kernel/with_threads.h"
#include "tests/property.h"

namespace selvage {

namespace {

void expect_counts(const char* scene, const char* frame_t0, const char* frame_t1, std::size_t vf, std::size_t ee) {
  const auto frames = testing::public_frames(scene, frame_t0, frame_t1);
  if (!frames) GTEST_SKIP() << "the public frames of " << scene << " are not here (SELVAGE_DATA)";
  BoxHierarchy hierarchy(frames->mesh);
  hierarchy.refit(frames->V_t0, frames->V_t1, {});
  const Candidates found = hierarchy.candidates();
  EXPECT_EQ(found.vf.size(), vf);
  EXPECT_EQ(found.ee.size(), ee);
}

}  // namespace

/// K6 and K7: the hierarchy answers like brute force after every refit, with any number of threads.
TEST(BoxHierarchy, PropEqualsBruteForce) {
  testing::check_property(2000, 6, [] {
    const auto shape = testing::random_shape();
    RC_LOG() << shape << '\n';
    const Mesh mesh = make_mesh(shape.vertex_count, shape.F);
    BoxHierarchy hierarchy(mesh);
    const int thread_count = *rc::gen::element(1, 2, 3, 8);
    const int refit_count = *rc::gen::inRange(1, 4);
    for (int refit = 0; refit < refit_count; ++refit) {
      const auto motion = testing::random_motion(shape.vertex_count);
      RC_LOG() << motion << '\n';
      Candidates found;
      testing::with_threads(thread_count, [&] {
        hierarchy.refit(motion.V_t0, motion.V_t1, motion.options());
        found = hierarchy.candidates();
      });
      RC_ASSERT(found == find_candidates_brute_force(mesh, motion.V_t0, motion.V_t1, motion.options()));
    }
  });
}

TEST(BoxHierarchy, ClothBallHasThePublishedNumberOfCandidates) {
  expect_counts("cloth-ball", "cloth_ball92.ply", "cloth_ball93.ply", 1'655'541, 5'197'332);
}

TEST(BoxHierarchy, RodTwistHasThePublishedNumberOfCandidates) {
  expect_counts("rod-twist", "3036.ply", "3037.ply", 448'270, 2'041'334);
}

}  // namespace selvage
