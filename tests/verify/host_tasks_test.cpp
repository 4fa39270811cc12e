// A host may ask for a check from within tasks of its own: where it cancels these, nothing is called clean for that.
#include "tests/host_tasks.h"

#include <gtest/gtest.h>

#include "tests/verify/sheet.h"
#include "verify/smallest_gap.h"

namespace selvage::verify {

TEST(HostTasks, ThatAreCancelledLoseNoViolation) {
  const io::MeshData mesh = selvage::testing::sheet(40);
  std::vector<Point> folded = mesh.points;
  for (Point& p : folded) p[0] = std::abs(p[0] - 20.25);
  const Surface surface = selvage::testing::surface(mesh);
  const auto of_frame = [&] { return check_frame(surface, folded, {}).violations_total.total(); };
  const auto of_motion = [&] { return check_motion(surface, mesh.points, folded, {}).violations_total.total(); };
  const auto gap = [&] { return smallest_gap(make_topology(surface, mesh.points.size()), mesh.points, {})->upper; };
  ASSERT_GT(of_frame(), 100);
  EXPECT_EQ(selvage::testing::in_cancelled_task(of_frame), of_frame());
  ASSERT_GT(of_motion(), 100);
  EXPECT_EQ(selvage::testing::in_cancelled_task(of_motion), of_motion());
  EXPECT_EQ(selvage::testing::in_cancelled_task(gap), gap());
}

}  // namespace selvage::verify
