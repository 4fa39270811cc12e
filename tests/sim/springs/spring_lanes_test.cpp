#include "sim/springs/spring_lanes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

#include <Eigen/Geometry>
#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include "sim/scene/rigid_path.h"
#include "sim/springs/length_check.h"
#include "tests/sim/dynamics/plain_forces.h"
#include "tests/sim/random_cloth.h"
#include "tests/vector_units.h"

namespace selvage {

using namespace sim;
using testing::random_cloth;

namespace {

constexpr double kRounding = 1e-12;  // relative to the sum of magnitudes: about 500 terms of 2^-53 each, generously

SpringSystem one_spring(double stiffness, double damping) {
  return {{Spring{0, 1, SpringKind::kStructural, 1.0, stiffness, damping}}, 2};
}

Positions damping_force(const testing::RandomCloth& cloth, const Positions& v) {
  return testing::lane_forces(cloth.springs, nullptr, cloth.x, v).damping;
}
Positions elastic_forces(const SpringSystem& springs, const Positions& x) {
  return testing::lane_forces(springs, nullptr, x, x).elastic;
}

void expect_no_net_force_or_torque(const Positions& x, const Positions& force) {
  Vec3 sum = Vec3::Zero(), torque = Vec3::Zero();
  double magnitude = 0;
  for (Eigen::Index i = 0; i < x.rows(); ++i) {
    const Vec3 arm = x.row(i), pull = force.row(i);
    sum += pull;
    torque += arm.cross(pull);
    magnitude += pull.norm();
  }
  EXPECT_GT(magnitude, 0);
  EXPECT_LE(sum.norm(), kRounding * magnitude);
  EXPECT_LE(torque.norm(), kRounding * magnitude);
}

}  // namespace

TEST(SpringLanes, PullsByHookesLaw) {
  Positions x(2, 3), expected(2, 3);
  x << 0, 0, 0, 1.5, 0, 0;
  expected << 4, 0, 0, -4, 0, 0;  // 8 N/m times 0.5 m
  EXPECT_LE((elastic_forces(one_spring(8, 0), x) - expected).norm(), 1e-15);
}

TEST(SpringLanes, OfLengthZeroPullsNowhere) {
  for (const double length : {0.0, std::numeric_limits<double>::denorm_min()}) {
    Positions x = Positions::Zero(2, 3);
    x(1, 1) = length;
    EXPECT_EQ(elastic_forces(one_spring(8, 1), x), Positions::Zero(2, 3)) << length;
  }
}

TEST(SpringLanes, InternalForcesKeepMomenta) {
  for (std::uint32_t seed = 0; seed < 20; ++seed) {
    const auto cloth = random_cloth(seed);
    expect_no_net_force_or_torque(cloth.x, elastic_forces(cloth.springs, cloth.x));
    expect_no_net_force_or_torque(cloth.x, damping_force(cloth, cloth.v));
  }
}

TEST(SpringLanes, ForcesTurnWithTheCloth) {
  for (std::uint32_t seed = 0; seed < 20; ++seed) {
    const auto cloth = random_cloth(seed);
    const Eigen::Matrix3d R = rotation_matrix(Vec3(30.0 + seed, -70, 110));
    const Positions turned = (cloth.x * R.transpose()).rowwise() + Eigen::RowVector3d(0.5, -0.25, 1);
    const Positions force = elastic_forces(cloth.springs, cloth.x);
    const Positions force_turned = elastic_forces(cloth.springs, turned);
    EXPECT_LE((force_turned - force * R.transpose()).norm(), 1e-11 * force.norm());
  }
}

TEST(SpringLanes, DampingIsZeroForRigidMotionAndTakesEnergyOtherwise) {
  const auto cloth = random_cloth(3);
  Positions rigid(cloth.x.rows(), 3);
  for (Eigen::Index i = 0; i < rigid.rows(); ++i) {
    const Vec3 arm = cloth.x.row(i);
    rigid.row(i) = (Vec3(0.3, -2, 1).cross(arm) + Vec3(1, 2, 3)).transpose();
  }
  EXPECT_LE(damping_force(cloth, rigid).norm(), kRounding * damping_force(cloth, cloth.v).norm());
  EXPECT_LT((damping_force(cloth, cloth.v).array() * cloth.v.array()).sum(), 0);
}

/// A cloth whose vertices are numbered at random, so that lanes are read one by one, with a second spring between one
/// pair, stabilisers with and without a spring between their vertices, and two vertices at one place.
struct AnyNumbering {
  testing::RandomCloth cloth;
  std::vector<Stabilizer> stabilizers;

  AnyNumbering(std::uint32_t seed, std::int32_t side, bool scrambled) : cloth(testing::random_cloth(seed, side)) {
    const std::int32_t count = side * side;
    std::vector<VertexId> number(static_cast<std::size_t>(count));
    std::iota(number.begin(), number.end(), 0);
    std::mt19937 generator(seed);
    for (std::size_t i = number.size() - 1; scrambled && i > 0; --i)
      std::swap(number[i], number[generator() % (i + 1)]);
    std::vector<Spring> springs = cloth.springs.springs();
    springs.push_back(springs.front());
    for (Spring& spring : springs) {
      spring.a = number[static_cast<std::size_t>(spring.a)];
      spring.b = number[static_cast<std::size_t>(spring.b)];
    }
    cloth.springs = SpringSystem(springs, count);
    cloth.x.row(springs.back().a) = cloth.x.row(springs.back().b);
    if (side >= 3) stabilizers = testing::sheet_stabilizers(side, 3, 0.02);
    for (Stabilizer& s : stabilizers) {
      s.straight_m = 0.01;
      for (std::size_t k = 0; k < 3; ++k) s.vertices[k] = number[static_cast<std::size_t>(s.vertices[k])];
    }
    for (VertexId i = 0; i + 2 < count; i += 2)
      stabilizers.push_back({{i + 1, i, i + 2, 0}, {1, -0.5, -0.5, 0}, 3, 0.02, 0});
    // One of four points, as on a mesh, without a spring between any two of them.
    if (side >= 9) stabilizers.push_back({{0, 5, 40, 77}, {0.25, 0.75, -0.5, -0.5}, 2, 0.03, 0});
  }
};

// Every term is a product of a few roundings, and each of the about 16 additions at a vertex rounds once more. The
// pull k L - k L_0 is found as (k - k L_0 / L) L, so its roundings are relative to k L, not to the difference: 30 times
// the elongation where a spring is stretched by 3 %.
TEST(SpringLanes, AgreesWithOneSpringAfterTheOther) {
  for (const bool scrambled : {false, true}) {
    for (const std::int32_t side : {2, 3, 9, 40}) {
      const AnyNumbering any(static_cast<std::uint32_t>(side), side, scrambled);
      const testing::RandomCloth& cloth = any.cloth;
      const StabilizerSystem stabilizers(any.stabilizers, side * side);
      const auto plain = testing::plain_forces(cloth.springs, any.stabilizers, cloth.x, cloth.v);
      const auto lanes = testing::lane_forces(cloth.springs, &stabilizers, cloth.x, cloth.v);
      for (Eigen::Index i = 0; i < cloth.x.rows(); ++i) {
        double slack_pull = 0;
        for (const SpringSystem::End& end : cloth.springs.ends_at(static_cast<VertexId>(i))) {
          const Spring& spring = cloth.springs.springs()[end.spring];
          slack_pull += spring.stiffness_n_m * spring.rest_length_m;
        }
        const auto row = static_cast<std::size_t>(i);
        ASSERT_LE((lanes.elastic.row(i) - plain.elastic.row(i)).norm(),
                  32 * 0x1p-53 * (plain.elastic_magnitude[row] + slack_pull))
            << "vertex " << i << " of " << side << " by " << side << (scrambled ? ", scrambled" : "");
        ASSERT_LE((lanes.damping.row(i) - plain.damping.row(i)).norm(),
                  32 * 0x1p-53 * plain.damping_magnitude[row] + 1e-15)
            << "vertex " << i << " of " << side << " by " << side << (scrambled ? ", scrambled" : "");
      }
    }
  }
}

TEST(SpringLanes, DiagonalAndRowSumAreThoseOfTheMatrix) {
  const AnyNumbering any(4, 5, true);
  const StabilizerSystem stabilizers(any.stabilizers, 25);
  SpringLanes lanes(any.cloth.springs, &stabilizers);
  const LaneVectors x = testing::to_lanes(any.cloth.x);
  LaneVectors force, product;
  const std::vector<double> light(25, 1e9);
  lanes.set_shares({0.3, 0.05}, light);
  lanes.look(x, force);
  for (Eigen::Index i = 0; i < 25; ++i) {
    double strongest = 0;
    for (Eigen::Index k = 0; k < 3; ++k) {
      Positions unit = Positions::Zero(25, 3);
      unit(i, k) = 1;
      lanes.multiply(x, testing::to_lanes(unit), product);
      EXPECT_NEAR(lanes.diagonal().row(i)(k), product.row(i)(k), 1e-13);
      strongest = std::max(strongest, testing::from_lanes(product).cwiseAbs().sum());
    }
    EXPECT_GE(3 * lanes.row_sum(static_cast<VertexId>(i)), strongest) << "a column has 3 entries of a neighbour";
  }
}

TEST(SpringLanes, StiffnessOpposesAsDampingOfItsShareDoes) {
  AnyNumbering any(6, 9, true);
  for (std::size_t n = 0; n < any.stabilizers.size(); ++n) any.stabilizers[n].stiffness_n_m *= 1 + double(n % 5);
  const ImpulseShares shares{0.3, 0.05};
  const auto product = [&](const std::vector<Spring>& springs, const std::vector<Stabilizer>& stabilizers,
                           const ImpulseShares& of) {
    const StabilizerSystem system(stabilizers, 81);
    SpringLanes lanes(SpringSystem(springs, 81), &system);
    const LaneVectors x = testing::to_lanes(any.cloth.x);
    LaneVectors force, result;
    lanes.set_shares(of, std::vector<double>(81, 1e9));
    lanes.look(x, force);
    lanes.multiply(x, testing::to_lanes(any.cloth.v), result);
    return testing::from_lanes(result);
  };
  std::vector<Spring> springs = any.cloth.springs.springs();
  std::vector<Stabilizer> stabilizers = any.stabilizers;
  const auto put_into_damping = [&](auto& all) {
    for (auto& one : all)
      one.damping_n_s_m = shares.damping_s * one.damping_n_s_m + shares.stiffness_s2 * one.stiffness_n_m;
  };
  put_into_damping(springs);
  put_into_damping(stabilizers);
  const Positions by_damping = product(springs, stabilizers, {1, 0});
  EXPECT_LE((product(any.cloth.springs.springs(), any.stabilizers, shares) - by_damping).norm(),
            1e-14 * by_damping.norm());
}

TEST(LengthCheck, FindsTheSpringsThatOneByOneAreOutside) {
  for (const bool scrambled : {false, true}) {
    const AnyNumbering any(7, 30, scrambled);
    const testing::RandomCloth& cloth = any.cloth;
    const double dt_s = 0.01, share = 0.2;
    const Positions end = cloth.x + dt_s * cloth.v;
    LengthCheck check(cloth.springs);
    std::vector<std::uint8_t> is_outside(cloth.springs.springs().size(), 1);
    for (const auto reference : {LengthCheck::Reference::kRestLength, LengthCheck::Reference::kLengthNow}) {
      check.find_outside(testing::to_lanes(cloth.x), testing::to_lanes(end), reference, share, is_outside);
      std::size_t found = 0;
      for (std::size_t s = 0; s < is_outside.size(); ++s) {
        const Spring& spring = cloth.springs.springs()[s];
        const double now = (cloth.x.row(spring.b) - cloth.x.row(spring.a)).norm();
        const double wanted = reference == LengthCheck::Reference::kRestLength ? spring.rest_length_m : now;
        const double length = (end.row(spring.b) - end.row(spring.a)).norm();
        const bool expected = spring.kind != SpringKind::kBending && std::abs(length / wanted - 1) > share;
        ASSERT_EQ(is_outside[s] != 0, expected) << "spring " << s << ", length / reference " << length / wanted;
        found += is_outside[s];
      }
      EXPECT_GT(found, 10U);
      EXPECT_LT(found, is_outside.size() - 10);
    }
  }
}

TEST(SpringLanes, SameBitsForAnyThreadCountAndVectorUnit) {
  const AnyNumbering any(5, 70, false);
  const StabilizerSystem stabilizers(any.stabilizers, 4900);
  testing::LaneForces reference;
  const auto compare = [&](const char* what) {
    const auto forces = testing::lane_forces(any.cloth.springs, &stabilizers, any.cloth.x, any.cloth.v);
    if (reference.elastic.size() == 0) reference = forces;
    EXPECT_EQ(forces.elastic, reference.elastic) << what;
    EXPECT_EQ(forces.damping, reference.damping) << what;
  };
  for (const std::size_t threads : {1u, 2u, 4u}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    compare("threads");
  }
  testing::on_every_vector_unit(compare);
}

}  // namespace selvage
