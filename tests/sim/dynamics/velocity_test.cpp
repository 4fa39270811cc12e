#include "sim/dynamics/velocity.h"

#include <algorithm>
#include <utility>

#include <Eigen/Dense>
#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include "sim/dynamics/central_differences.h"
#include "sim/dynamics/velocity_march.h"
#include "tests/sim/dynamics/plain_forces.h"
#include "tests/sim/random_cloth.h"
#include "tests/vector_units.h"

namespace selvage {

using namespace sim;
using testing::random_cloth;

namespace {

/// Adds c n n^T between points at which vertices have these weights.
void add_outer(const std::vector<std::pair<VertexId, double>>& weights, double c, const Vec3& n, Eigen::MatrixXd& A) {
  for (const auto& [i, weight_i] : weights) {
    for (const auto& [j, weight_j] : weights)
      A.block<3, 3>(3 * i, 3 * j) += c * weight_i * weight_j * n * n.transpose();
  }
}

// The matrix of VelocitySolver written down element by element, with B of a share of the springs' stiffness and of the
// stabilisers' damping.
Eigen::MatrixXd dense_matrix(const testing::RandomCloth& cloth, const std::vector<Stabilizer>& stabilizers,
                             const ImpulseShares& shares, double shift) {
  const Eigen::Index size = 3 * cloth.x.rows();
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(size, size);
  for (Eigen::Index i = 0; i < cloth.x.rows(); ++i) {
    const double mass = 1 / cloth.inverse_mass[static_cast<std::size_t>(i)];
    A.block<3, 3>(3 * i, 3 * i) += shift * mass * Eigen::Matrix3d::Identity();
  }
  for (const Spring& spring : cloth.springs.springs()) {
    const Vec3 n = (cloth.x.row(spring.b) - cloth.x.row(spring.a)).transpose().normalized();
    const double c = shares.damping_s * spring.damping_n_s_m + shares.stiffness_s2 * spring.stiffness_n_m;
    add_outer({{spring.a, 1}, {spring.b, -1}}, c, n, A);
  }
  for (const Stabilizer& s : stabilizers) {
    std::vector<std::pair<VertexId, double>> weights;
    for (std::size_t k = 0; k < 4; ++k) weights.emplace_back(s.vertices[k], s.weights[k]);
    const double c = shares.damping_s * s.damping_n_s_m + shares.stiffness_s2 * s.stiffness_n_m;
    add_outer(weights, c, bow_of(s, cloth.x).normalized(), A);
  }
  return A;
}

/// Solves with B = `shares` of the cloth's matrices, from a guess of no impulses.
Positions solve(const testing::RandomCloth& cloth, const ImpulseShares& shares, double drag_1_s, double dt_s,
                const std::vector<Stabilizer>& stabilizers = {}, double residual = kVelocityResidual) {
  const StabilizerSystem system(stabilizers, static_cast<std::int32_t>(cloth.x.rows()));
  SpringLanes springs(cloth.springs, &system);
  const LaneVectors x = testing::to_lanes(cloth.x), rhs = testing::to_lanes(cloth.v);
  LaneVectors force, impulses, v = rhs;
  springs.set_shares(shares, cloth.inverse_mass);
  springs.look(x, force);
  const LaneScalars inverse_mass = testing::to_lanes(cloth.inverse_mass);
  EXPECT_LT(VelocitySolver().solve({springs, x, inverse_mass, drag_1_s}, rhs, dt_s, impulses, v, residual), 200);
  return testing::from_lanes(v);
}

/// The error of a solution, and how far the guess is away, in the norm of energies.
struct SolutionError {
  double error, way;
};
SolutionError error_of(const testing::RandomCloth& cloth, const ImpulseShares& shares,
                       const std::vector<Stabilizer>& stabilizers, double residual, double drag) {
  const double dt_s = 0.01;
  Eigen::VectorXd mass(3 * cloth.x.rows()), rhs = mass, solved = mass;
  const Positions v = solve(cloth, shares, drag, dt_s, stabilizers, residual);
  for (Eigen::Index i = 0; i < cloth.x.rows(); ++i) {
    mass.segment<3>(3 * i).setConstant(1 / cloth.inverse_mass[static_cast<std::size_t>(i)]);
    rhs.segment<3>(3 * i) = cloth.v.row(i).transpose();
    solved.segment<3>(3 * i) = v.row(i).transpose();
  }
  const Eigen::VectorXd expected =
      dense_matrix(cloth, stabilizers, shares, 1 + dt_s * drag).ldlt().solve(mass.cwiseProduct(rhs));
  const auto energy_norm = [&](const Eigen::VectorXd& u) { return std::sqrt(u.dot(mass.cwiseProduct(u))); };
  return {energy_norm(solved - expected), energy_norm(rhs / (1 + dt_s * drag) - expected)};
}

}  // namespace

TEST(Velocity, SolvesTheSystemThatItStates) {
  for (const double share_s2 : {1e-5, 1e-3, 0.1}) {
    for (const bool stabilized : {false, true}) {
      const auto stabilizers = stabilized ? testing::sheet_stabilizers(6, 30, 0) : std::vector<Stabilizer>();
      for (const auto& [residual, drag] : {std::pair{kVelocityResidual, 3.0}, std::pair{1e-9, 70.0}}) {
        const SolutionError found = error_of(random_cloth(1, 6), {0, share_s2}, stabilizers, residual, drag);
        EXPECT_LE(found.error, 2 * residual * found.way) << share_s2 << (stabilized ? ", stabilised" : "");
      }
    }
  }
}

// Those that oppose less than a 32nd of the momentum there is answer to the guess alone: they neglect a 32nd of their
// impulses at most. Stronger ones are solved for.
TEST(Velocity, WeakStabilizersAnswerToTheGuess) {
  auto cloth = random_cloth(6, 12);
  std::vector<Spring> undamped = cloth.springs.springs();
  for (Spring& spring : undamped) spring.damping_n_s_m = 0;
  cloth.springs = SpringSystem(undamped, cloth.springs.vertex_count());
  for (const double strength : {0.1, 0.99, 1.5, 1000.0}) {
    const double lightest = *std::max_element(cloth.inverse_mass.begin(), cloth.inverse_mass.end());
    const double damping_n_s_m = strength / 32 / (8 * lightest);  // 8: sum of magnitudes of an inner row
    const SolutionError found = error_of(cloth, {1, 0}, testing::sheet_stabilizers(12, 30, damping_n_s_m), 1e-9, 3);
    const double neglected = strength <= 1 ? strength / 32 : 1e-8;
    EXPECT_GT(found.way, 0);
    EXPECT_LE(found.error, neglected * found.way) << strength;
  }
}

TEST(Velocity, HeldVerticesKeepTheirVelocity) {
  auto cloth = random_cloth(2, 6);
  cloth.inverse_mass[7] = 0;
  const Positions v = solve(cloth, {1, 0}, 0, 0.01);
  EXPECT_EQ(Vec3(v.row(7)), Vec3(cloth.v.row(7)));
  EXPECT_NE(Vec3(v.row(8)), Vec3(cloth.v.row(8)));
}

TEST(Velocity, KeepsMomentaToRoundingWhateverConjugateGradientsLeave) {
  const auto cloth = random_cloth(3, 12);
  const Positions v = solve(cloth, {5, 0.02}, 0, 0.01);
  EXPECT_GT((v - cloth.v).norm(), 0.1 * cloth.v.norm());
  EXPECT_LE((linear_momentum(cloth, v) - linear_momentum(cloth, cloth.v)).norm(), 1e-14);
  EXPECT_LE((angular_momentum(cloth, v) - angular_momentum(cloth, cloth.v)).norm(), 1e-14);
}

TEST(Velocity, AGoodGuessAtTheImpulsesIsWorthIterations) {
  const auto cloth = random_cloth(4, 12);
  SpringLanes springs(cloth.springs, nullptr);
  const LaneVectors x = testing::to_lanes(cloth.x), rhs = testing::to_lanes(cloth.v);
  LaneVectors force, impulses, v = rhs;
  springs.set_shares({0.02, 0}, cloth.inverse_mass);
  springs.look(x, force);
  const LaneScalars inverse_mass = testing::to_lanes(cloth.inverse_mass);
  const VelocitySystem system{springs, x, inverse_mass, 0};
  VelocitySolver solver;
  const std::int32_t from_nothing = solver.solve(system, rhs, 0.01, impulses, v);
  EXPECT_GE(from_nothing, 2);
  EXPECT_LT(solver.solve(system, rhs, 0.01, impulses, v), from_nothing);
}

TEST(Velocity, IsThatOfItsImpulsesHoweverFewIterationsItTakes) {
  const auto cloth = random_cloth(7, 12);
  SpringLanes springs(cloth.springs, nullptr);
  springs.set_shares({0.02, 0}, cloth.inverse_mass);
  const LaneVectors x = testing::to_lanes(cloth.x), rhs = testing::to_lanes(cloth.v);
  const LaneScalars inverse_mass = testing::to_lanes(cloth.inverse_mass);
  LaneVectors force, impulses, v = rhs;
  springs.look(x, force);
  const double dt_s = 0.01, drag_1_s = 3;
  std::int32_t iterations = 200;
  for (int time = 0; time < 5 && iterations > 0; ++time) {  // from nothing, and from what was found before
    iterations = VelocitySolver().solve({springs, x, inverse_mass, drag_1_s}, rhs, dt_s, impulses, v);
    const Positions found = testing::from_lanes(v), impulse = testing::from_lanes(impulses);
    for (Eigen::Index i = 0; i < found.rows(); ++i) {
      const Eigen::RowVector3d kicked = cloth.v.row(i) - inverse_mass[i] * impulse.row(i);
      EXPECT_EQ(Eigen::RowVector3d(found.row(i)), Eigen::RowVector3d(kicked / (1 + dt_s * drag_1_s))) << i;
    }
  }
  EXPECT_EQ(iterations, 0);
}

TEST(Velocity, SameBitsForAnyThreadCountAndVectorUnit) {
  const auto cloth = random_cloth(8, 70);  // several blocks of a parallel loop, and no whole number of lanes
  const auto stabilizers = testing::sheet_stabilizers(70, 30, 0.05);
  Positions reference;
  const auto compare = [&](const char* what) {
    const Positions v = solve(cloth, {5, 0.02}, 3, 0.01, stabilizers);
    if (reference.size() == 0) reference = v;
    EXPECT_EQ(v, reference) << what;
  };
  for (const std::size_t threads : {1u, 2u, 4u}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    compare("threads");
  }
  testing::on_every_vector_unit(compare);
}

const RowDrag kNoDrag{Eigen::ArrayXd::Zero(1), Eigen::ArrayXd::Zero(1)};

TEST(VelocityMarch, LinearDampingDecaysExponentiallyAtFirstOrder) {
  // a = -c v: exactly exp(-c t) v. Ten times the steps, a tenth of the error.
  const double c = 3, time_s = 0.7;
  double error[2];
  int n = 0;
  for (const int finer : {10, 100}) {
    Positions v = Positions::Ones(1, 3);
    int asked = 0;
    const auto damping = [&](const Positions& u, Positions& a) {
      ++asked;
      a = -c * u;
    };
    march_velocity(damping, kNoDrag, finer * c, time_s, v);
    EXPECT_EQ(asked, std::ceil(finer * c * time_s / kMarchContraction) * kFixedPointIterations);
    error[n++] = std::abs(v(0, 0) - std::exp(-c * time_s));
  }
  EXPECT_NEAR(error[0] / error[1], 10, 1);
  EXPECT_LT(error[1], 1e-3);
}

TEST(VelocityMarch, QuadraticDragFollowsItsClosedForm) {
  // a = -c |v| v: exactly v / (1 + c |v| t), which no linear solve gives.
  const double c = 2, speed = 3, time_s = 0.5;
  Positions v(1, 3);
  v << speed, 0, 0;
  const auto no_force = [](const Positions& u, Positions& a) { a = Positions::Zero(u.rows(), 3); };
  march_velocity(no_force, {Eigen::ArrayXd{{0}}, Eigen::ArrayXd{{c}}}, 200 * 2 * c * speed, time_s, v);
  EXPECT_NEAR(v(0, 0), speed / (1 + c * speed * time_s), 1e-3);
}

TEST(VelocityMarch, NoDragIsTooStrong) {
  // In one step beside no other force, v / (1 + d t); and what has no drag keeps its velocity, to the bit.
  for (const double drag_1_s : {1.0, 1e6, 1e12}) {
    Positions v(2, 3);
    v << 3, 0, 0, 0.1, 0.2, 0.3;
    const auto no_force = [](const Positions& u, Positions& a) { a = Positions::Zero(u.rows(), 3); };
    march_velocity(no_force, {Eigen::ArrayXd{{drag_1_s, 0}}, Eigen::ArrayXd::Zero(2)}, 0, 0.1, v);
    EXPECT_NEAR(v(0, 0) * (1 + 0.1 * drag_1_s), 3, 1e-14);
    EXPECT_EQ(v.row(1), Eigen::RowVector3d(0.1, 0.2, 0.3));
  }
  // Ten thousand times what the longest march is for: of a sequence that alternates round the solution, no number is
  // larger than the first.
  for (const double quadratic_1_m : {1e6, 1e30, 1e300}) {
    Positions v(1, 3);
    v << 3, 0, 0;
    const auto pull = [](const Positions& u, Positions& a) { a = Positions::Constant(u.rows(), 3, 1e6); };
    march_velocity(pull, {Eigen::ArrayXd{{0}}, Eigen::ArrayXd{{quadratic_1_m}}}, 0, 0.1, v);
    EXPECT_GE(v.minCoeff(), 0) << quadratic_1_m;
    EXPECT_LE(v.maxCoeff(), 1e5 + 3) << quadratic_1_m;
  }
}

// Section 7.6 has two ways; they must agree where both apply, the more the shorter the step.
TEST(VelocityMarch, AgreesWithConjugateGradientsAsTheStepShrinks) {
  const auto cloth = random_cloth(5, 8);
  CentralDifferencesOptions options;
  options.strain = {.strain = 0, .strain_rate = 0};
  options.step_s = 0.5 * stable_step_s(cloth.springs, cloth.inverse_mass);
  CentralDifferencesOptions marching = options;
  marching.fields.quadratic_drag_1_m = 1e-300;  // marches, and drags nothing
  double difference[2];
  int n = 0;
  for (const double dt_s : {1e-3, 1e-4}) {
    Motion solved{cloth.x, cloth.v}, marched = solved;
    CentralDifferences(cloth.springs, options).final_velocity(solved, cloth.inverse_mass, dt_s);
    CentralDifferences(cloth.springs, marching).final_velocity(marched, cloth.inverse_mass, dt_s);
    difference[n++] = (solved.v - marched.v).norm() / (solved.v - cloth.v).norm();
  }
  EXPECT_LT(difference[0], 0.1);
  EXPECT_LT(difference[1], 0.2 * difference[0]);
}

}  // namespace selvage
