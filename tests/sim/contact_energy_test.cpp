#include "sim/contact_energy.h"

#include <gtest/gtest.h>

namespace selvage::sim {

TEST(ContactEnergy, IsOfTheSpringsAtVerticesThatContactMoved) {
  // Springs of 1 m in a row from 0 to 4; contact moves vertex 1 by half a meter towards vertex 0.
  std::vector<Spring> springs;
  for (VertexId i = 0; i + 1 < 5; ++i) springs.push_back({i, i + 1, SpringKind::kStructural, 1, 8, 0});
  const SpringSystem system(springs, 5);
  Motion end{Positions::Zero(5, 3), Positions::Zero(5, 3)};
  for (Eigen::Index i = 0; i < 5; ++i) end.x(i, 0) = 1.25 * double(i);
  end.v.col(2).setConstant(3);
  Positions x_t1 = end.x;
  x_t1(1, 0) -= 0.5;
  const std::vector<double> inverse_mass = {0.5, 0.5, 0, 0.5, 0.5};  // vertex 2 is held
  const ContactEnergy found = contact_energy(system, inverse_mass, end, x_t1, 4);
  // 8/2 N/m times 0.25^2 twice before, 0.25^2 and 0.75^2 after; 2 kg/2 times 3^2 + 4^2 at vertices 0 and 1.
  EXPECT_DOUBLE_EQ(found.gain_j, 4 * (0.0625 + 0.5625 - 2 * 0.0625));
  EXPECT_DOUBLE_EQ(found.before_j, 4 * 2 * 0.0625 + 2 * 25);
}

TEST(ContactEnergy, IsNoneWhereNothingWasMoved) {
  const SpringSystem system({{0, 1, SpringKind::kStructural, 1, 8, 0}}, 2);
  const Motion end{Positions::Zero(2, 3), Positions::Ones(2, 3)};
  const ContactEnergy found = contact_energy(system, std::vector<double>(2, 1), end, end.x, 4);
  EXPECT_EQ(found.gain_j, 0);
  EXPECT_EQ(found.before_j, 0);
}

}  // namespace selvage::sim
