#include "sim/contact_energy.h"

#include <gtest/gtest.h>

namespace selvage::sim {

TEST(ContactEnergy, IsOfEachPartByItself) {
  // Springs of 1 m in a row from 0 to 3, and one in a second part; contact moves vertex 1 by half a meter to vertex 0.
  const SpringSystem springs({{0, 1, SpringKind::kStructural, 1, 8, 0},
                              {1, 2, SpringKind::kShear, 1, 8, 0},
                              {2, 3, SpringKind::kBending, 1, 8, 0},
                              {4, 5, SpringKind::kStructural, 1, 8, 0}},
                             6);
  Motion end{Positions::Zero(6, 3), Positions::Zero(6, 3)};
  for (Eigen::Index i = 0; i < 6; ++i) end.x(i, 0) = 1.25 * double(i);
  end.v.col(2).setConstant(3);
  Positions x_t1 = end.x;
  x_t1(1, 0) -= 0.5;
  Mesh mesh;
  mesh.vertex_count = 6;
  mesh.edges = {{0, 1}, {1, 2}, {2, 3}, {4, 5}};
  const std::vector<double> inverse_mass = {0.5, 0.5, 0, 0.5, 0.5, 0.25};  // vertex 2 is held
  const std::vector<ContactEnergy> found = contact_energies(springs, SurfaceParts(mesh), inverse_mass, end, x_t1, 4);
  // 8/2 N/m times 0.25^2 each before, 0.25^2 and 0.75^2 after; 2 or 4 kg/2 times 3^2 + 4^2 a vertex.
  EXPECT_DOUBLE_EQ(found[0].gain_j, 4 * (0.0625 + 0.5625 - 2 * 0.0625));
  EXPECT_DOUBLE_EQ(found[0].before_j, 4 * 3 * 0.0625 + 3 * 25);
  EXPECT_EQ(found[4].gain_j, 0);
  EXPECT_DOUBLE_EQ(found[4].before_j, 4 * 0.0625 + 25 + 50);
}

}  // namespace selvage::sim
