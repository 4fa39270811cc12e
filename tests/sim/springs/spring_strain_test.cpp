#include "sim/springs/spring_strain.h"

#include <gtest/gtest.h>

namespace selvage::sim {

TEST(SpringStrain, CountsSpringsThatEndBeyondTheLimitAndGrewThere) {
  // Along x, rest length 1: kept, pressed, pulled, strained before, and a bending spring.
  const SpringSystem springs({{0, 1, SpringKind::kStructural, 1, 10, 0},
                              {2, 3, SpringKind::kStructural, 1, 10, 0},
                              {4, 5, SpringKind::kShear, 1, 10, 0},
                              {6, 7, SpringKind::kStructural, 1, 10, 0},
                              {8, 9, SpringKind::kBending, 1, 10, 0}},
                             10);
  Positions x_t0 = Positions::Zero(10, 3), x_t1 = x_t0;
  const auto place = [](Positions& x, std::initializer_list<double> lengths) {
    Eigen::Index row = 1;
    for (const double length : lengths) x(row, 0) = length, row += 2;
  };
  place(x_t0, {1, 1, 1, 1.4, 1});
  place(x_t1, {1.14, 0.84, 1.16, 1.415, 2});
  const auto overstrained = [&](double limit, const Positions& candidate) {
    return springs_overstrained(springs, limit, {x_t0, candidate, x_t1});
  };
  EXPECT_EQ(overstrained(0.1, x_t0), 2);
  EXPECT_EQ(overstrained(0.09, x_t0), 3);
  EXPECT_EQ(overstrained(0, x_t0), 0) << "no limit";
  Positions candidate = x_t0;
  place(candidate, {1, 0.85, 1, 1, 1});
  EXPECT_EQ(overstrained(0.1, candidate), 1) << "one was strained by the dynamics";
  EXPECT_EQ(overstrained(0.05, candidate), 4) << "beyond three limits that does not matter";
}

TEST(SpringStrain, TheLargestIsOfStructuralAndShearSpringsStretchedOrPressed) {
  Positions x = Positions::Zero(6, 3);
  x(1, 0) = 2.2;  // of 2
  x(3, 1) = 0.8;  // of 1
  x(5, 2) = 9;    // of 1, bending
  const std::vector<Spring> springs{{0, 1, SpringKind::kStructural, 2, 10, 0},
                                    {2, 3, SpringKind::kShear, 1, 10, 0},
                                    {4, 5, SpringKind::kBending, 1, 10, 0}};
  const Strained most = most_strained(SpringSystem(springs, 6), x);
  EXPECT_NEAR(most.strain, 0.2, 1e-15);
  EXPECT_EQ(most.ends, (std::array<VertexId, 2>{springs[1].a, springs[1].b}));
  EXPECT_NEAR(most_strained(SpringSystem({springs[0]}, 6), x).strain, 0.1, 1e-15);
  EXPECT_EQ(most_strained(SpringSystem({springs[2]}, 6), x).strain, 0);
  EXPECT_EQ(most_strained(SpringSystem({springs[2]}, 6), x).ends[0], -1) << "it bends";
  EXPECT_NEAR(largest_elongation(SpringSystem(springs, 6), x), 0.1, 1e-15);
  EXPECT_EQ(largest_elongation(SpringSystem({springs[1], springs[2]}, 6), x), 0);
}

}  // namespace selvage::sim
