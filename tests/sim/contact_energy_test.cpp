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
  Positions x = Positions::Zero(6, 3), v = Positions::Zero(6, 3);
  for (Eigen::Index i = 0; i < 6; ++i) x(i, 0) = 1.25 * double(i);
  v.col(2).setConstant(3);
  Positions pushed = x;
  pushed(1, 0) -= 0.5;
  Mesh mesh;
  mesh.vertex_count = 6;
  mesh.edges = {{0, 1}, {1, 2}, {2, 3}, {4, 5}};
  const std::vector<double> inverse_mass = {0.5, 0.5, 0, 0.5, 0.5, 0.25};  // vertex 2 is held
  const std::vector<ContactEnergy> found =
      contact_energies(springs, SurfaceParts(mesh), inverse_mass, {x, pushed, v, {}, {}}, 4);
  // 8/2 N/m times 0.25^2 each before, 0.25^2 and 0.75^2 after; 2 or 4 kg/2 times 3^2 + 4^2 a vertex.
  EXPECT_DOUBLE_EQ(found[0].gain_j, 4 * (0.0625 + 0.5625 - 2 * 0.0625));
  EXPECT_DOUBLE_EQ(found[0].before_j, 4 * 3 * 0.0625 + 3 * 25);
  EXPECT_EQ(found[4].gain_j, 0);
  EXPECT_DOUBLE_EQ(found[4].before_j, 4 * 0.0625 + 25 + 50);
}

TEST(ContactEnergy, WhatSpringsLoseCountsAgainstWhatOthersGain) {
  const SpringSystem springs({{0, 1, SpringKind::kStructural, 1, 8, 0}, {1, 2, SpringKind::kStructural, 1, 8, 0}}, 3);
  Positions x = Positions::Zero(3, 3), moved = x;
  x.col(0) << 0, 1.5, 3;
  moved.col(0) << 0, 1, 3;  // the first at rest, the second stretched twice as far
  Mesh mesh;
  mesh.vertex_count = 3;
  mesh.edges = {{0, 1}, {1, 2}};
  const std::vector<double> inverse_mass(3, 1.0);
  const auto found =
      contact_energies(springs, SurfaceParts(mesh), inverse_mass, {x, moved, Positions::Zero(3, 3), {}, {}}, 0);
  EXPECT_DOUBLE_EQ(found[0].gain_j, 4 * (1 - 0.25) - 4 * 0.25);
}

// A sheet of one face, another of twice its mass, and a body; what moves moves along z.
TEST(ContactEnergy, CountsMotionBesideWhatAPartMeets) {
  const SpringSystem springs({{0, 1, SpringKind::kStructural, 1, 8, 0}}, 6);
  Mesh mesh;
  mesh.vertex_count = 9;
  mesh.edges = {{0, 1}, {1, 2}, {2, 0}, {3, 4}, {4, 5}, {5, 3}, {6, 7}, {7, 8}, {8, 6}};
  const std::vector<double> inverse_mass = {1, 1, 1, 0.5, 0.5, 0.5, 0, 0, 0};
  const Positions x = Positions::Zero(9, 3);
  const auto contact = [&](const std::array<VertexId, 4>& vertices) {
    RepulsionContact result;
    result.interaction = make_interaction(PairKind::kVf, vertices, {1, 1, 0, 0}, inverse_mass);
    return result;
  };
  const auto energies = [&](double common_m_s, const std::vector<RepulsionContact>& met) {
    Positions v = Positions::Zero(9, 3);
    v.col(2) << 2, 2, 2, -1, -1, -1, 5, 5, 5;
    v.col(2).array() += common_m_s;
    return contact_energies(springs, SurfaceParts(mesh), inverse_mass, {x, x, v, {}, met}, 0);
  };
  const double elastic_j = 4;
  for (const double common_m_s : {0.0, 1024.0}) {
    // The first beside the body, at 3 m/s; beside the second, whose centre of mass with it stands still; beside itself.
    const auto on_body = energies(common_m_s, {contact({0, 6, 7, 8})});
    EXPECT_DOUBLE_EQ(on_body[0].before_j, elastic_j + 3 * 9.0 / 2) << common_m_s;
    const auto on_cloth = energies(common_m_s, {contact({0, 3, 4, 5})});
    EXPECT_DOUBLE_EQ(on_cloth[0].before_j, elastic_j + 3 * 4.0 / 2) << common_m_s;
    EXPECT_DOUBLE_EQ(on_cloth[3].before_j, 3 * 2 * 1.0 / 2) << common_m_s;
    const auto on_itself = energies(common_m_s, {contact({0, 0, 1, 2})});
    EXPECT_DOUBLE_EQ(on_itself[0].before_j, elastic_j) << common_m_s;
    // Of both, the mean: 5 and 0 m/s.
    const auto on_both = energies(common_m_s, {contact({0, 3, 4, 5}), contact({0, 6, 7, 8})});
    EXPECT_DOUBLE_EQ(on_both[0].before_j, elastic_j + 3 * 0.25 / 2) << common_m_s;
  }
}

}  // namespace selvage::sim
