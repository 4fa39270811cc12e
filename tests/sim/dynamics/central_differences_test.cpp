#include "sim/dynamics/central_differences.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include "tests/sim/random_cloth.h"

namespace selvage {

using namespace sim;
using testing::random_cloth;

namespace {

// A mass m on a spring k of rest length 1 m that hangs from a held vertex at the origin along -z.
struct Hanging {
  double m = 0.05, k = 20;
  SpringSystem springs;
  std::vector<double> inverse_mass{0, 1 / m};
  Motion motion;

  explicit Hanging(double length, double damping = 0)
      : springs({Spring{0, 1, SpringKind::kStructural, 1.0, k, damping}}, 2) {
    motion.x.resize(2, 3);
    motion.x << 0, 0, 0, 0, 0, -length;
    motion.v = Positions::Zero(2, 3);
  }
  CentralDifferencesOptions options(double step_s) const {
    CentralDifferencesOptions o;
    o.fields.gravity_m_s2 = {0, 0, -9.81};
    o.strain = {.strain = 0, .strain_rate = 0};
    o.step_s = step_s;
    return o;
  }
  void run(const CentralDifferencesOptions& o, double time_s) {
    CentralDifferences(springs, o).advance(motion, Positions::Zero(2, 3), inverse_mass, time_s);
  }
  [[nodiscard]] double rest() const { return 1 + m * 9.81 / k; }
};

double total_energy(const testing::RandomCloth& cloth, const Motion& motion) {
  double energy = kinetic_energy(cloth, motion.v);
  for (const Spring& spring : cloth.springs.springs()) {
    const double elongation = (motion.x.row(spring.b) - motion.x.row(spring.a)).norm() - spring.rest_length_m;
    energy += spring.stiffness_n_m * elongation * elongation / 2;
  }
  return energy;
}

}  // namespace

TEST(CentralDifferences, OscillatorFollowsItsClosedForm) {
  // z(t) = -(rest + a cos(omega t)), omega^2 = k/m; second order: an eighth of the step, a sixty-fourth of the error.
  double error[2];
  int n = 0;
  for (const double step_s : {4e-3, 5e-4}) {
    Hanging hanging(0);
    const double amplitude = 0.02;
    hanging.motion.x(1, 2) = -(hanging.rest() + amplitude);
    hanging.run(hanging.options(step_s), 1.0);
    const double expected = -(hanging.rest() + amplitude * std::cos(std::sqrt(hanging.k / hanging.m)));
    error[n++] = std::abs(hanging.motion.x(1, 2) - expected);
  }
  EXPECT_LT(error[0], 1e-4);
  EXPECT_GT(error[0] / error[1], 50);
  EXPECT_LT(error[0] / error[1], 80);
}

TEST(CentralDifferences, DampedOscillatorDecaysAsItShould) {
  Hanging hanging(0, 0.4);
  hanging.motion.x(1, 2) = -(hanging.rest() + 0.02);
  hanging.run(hanging.options(2e-4), 0.5);
  const double decay = 0.4 / (2 * hanging.m), omega = std::sqrt(hanging.k / hanging.m - decay * decay), t = 0.5;
  const double expected = 0.02 * std::exp(-decay * t) * (std::cos(omega * t) + decay / omega * std::sin(omega * t));
  EXPECT_NEAR(-hanging.motion.x(1, 2) - hanging.rest(), expected, 2e-6);
}

// v(n+1/2) = v + h/2 a(x, v), x + h v(n+1/2), and v(n+1) = v(n+1/2) + h/2 a(x(n+1), v(n+1)), along the line.
TEST(CentralDifferences, AStepIsThatOfThePaper) {
  const double damping = 0.4, h = 4e-3, speed = 0.7, length = 1.05;
  Hanging hanging(length, damping);
  hanging.motion.v(1, 2) = -speed;
  hanging.run(hanging.options(h), h);
  const double m = hanging.m, k = hanging.k;
  const auto pull = [&](double at) { return 9.81 - k / m * (at - 1); };
  const double mid = speed + h / 2 * (pull(length) - damping / m * speed), end = length + h * mid;
  const double expected = (mid + h / 2 * pull(end)) / (1 + h / 2 * damping / m);
  EXPECT_NEAR(-hanging.motion.x(1, 2), end, 1e-14);
  EXPECT_NEAR(-hanging.motion.v(1, 2), expected, 1e-4 * (mid - expected)) << "as far as it is solved for";
}

// Two masses that part at 2 m/s: without a limit their spring would be 1.2 and 1.4 times as long after one and two
// steps.
TEST(CentralDifferences, LimitsHoldInEveryStep) {
  const SpringSystem springs({Spring{0, 1, SpringKind::kStructural, 0.1, 0.1, 0}}, 2);
  const std::vector<double> inverse_mass{1, 1};
  Motion start{Positions::Zero(2, 3), Positions::Zero(2, 3)};
  start.x(1, 0) = 0.1;
  start.v(0, 0) = -1;
  start.v(1, 0) = 1;
  const auto length_after = [&](const StrainLimits& limits, int steps) {
    CentralDifferencesOptions options;
    options.strain = limits;
    options.step_s = 0.01;
    Motion motion = start;
    CentralDifferences(springs, options).advance(motion, start.x, inverse_mass, 0.01 * steps);
    return motion.x(1, 0) - motion.x(0, 0);
  };
  EXPECT_NEAR(length_after({.strain = 0, .strain_rate = 0}, 2), 0.14, 1e-3);
  EXPECT_NEAR(length_after({.strain = 0.1, .strain_rate = 0}, 2), 0.11, 1e-4);
  EXPECT_NEAR(length_after({.strain = 0, .strain_rate = 0.1}, 1), 0.11, 1e-5);

  CentralDifferencesOptions options;
  options.strain = {.strain = 0, .strain_rate = 0.1};
  options.step_s = 0.01;
  Motion end = start;
  CentralDifferences(springs, options).final_velocity(end, inverse_mass, 0.01);
  EXPECT_NEAR(end.v(1, 0) - end.v(0, 0), 0.1 * 0.1 / 0.01, 1e-3) << "nor may it leave with more";
}

TEST(CentralDifferences, HangsAtRestWhereForcesBalance) {
  Hanging hanging(0);
  hanging.motion.x(1, 2) = -hanging.rest();
  hanging.run(hanging.options(1e-3), 1.0);
  EXPECT_NEAR(hanging.motion.x(1, 2), -hanging.rest(), 1e-13);
}

TEST(CentralDifferences, FreeFallIsExactAndDragIsExponential) {
  SpringSystem none({}, 1);
  const std::vector<double> inverse_mass = {2};
  CentralDifferencesOptions options;
  options.fields.gravity_m_s2 = {0, 0, -9.81};
  options.step_s = 1e-3;
  Motion fall{Positions::Zero(1, 3), Positions::Zero(1, 3)};
  CentralDifferences(none, options).advance(fall, Positions::Zero(1, 3), inverse_mass, 0.5);
  EXPECT_NEAR(fall.x(0, 2), -9.81 * 0.25 / 2, 1e-12);
  EXPECT_NEAR(fall.v(0, 2), -9.81 * 0.5, 1e-12);

  options.fields.gravity_m_s2.setZero();
  options.fields.drag_1_s = 4;
  Motion drift{Positions::Zero(1, 3), Positions::Ones(1, 3)};
  CentralDifferences(none, options).advance(drift, Positions::Zero(1, 3), inverse_mass, 0.5);
  EXPECT_NEAR(drift.v(0, 0), std::exp(-2.0), 1e-6);
}

TEST(CentralDifferences, MomentaAreKeptWithoutGravityAndLimits) {
  // Without stabilisers, with weak ones, and with such as the solution of the velocity must correct.
  for (std::uint32_t seed = 0; seed < 6; ++seed) {
    auto cloth = random_cloth(seed);
    const StabilizerSystem stabilizers(testing::sheet_stabilizers(9, 5, seed % 3 == 1 ? 1e-4 : 0.05), 81);
    CentralDifferencesOptions options;
    options.strain = {.strain = 0, .strain_rate = 0};
    options.step_s = 0.5 * stable_step_s(cloth.springs, cloth.inverse_mass);
    if (seed % 3 > 0) options.stabilizers = &stabilizers;
    Motion motion{cloth.x, cloth.v};
    const Vec3 before = linear_momentum(cloth, cloth.v), angular_before = angular_momentum(cloth, cloth.v);
    CentralDifferences(cloth.springs, options).advance(motion, cloth.x, cloth.inverse_mass, 0.2);
    cloth.x = motion.x;
    EXPECT_LE((linear_momentum(cloth, motion.v) - before).norm(), 1e-13) << "of a sum of magnitudes of about 0.4";
    EXPECT_LE((angular_momentum(cloth, motion.v) - angular_before).norm(), 1e-13);
  }
}

TEST(CentralDifferences, StabilizersDoNotBrakeACurlThatTurns) {
  // A half cylinder that turns once a second about its axis, and about one across it.
  for (const Vec3& spin : {Vec3(0, 6, 0), Vec3(6, 0, 3)}) {
    auto cloth = random_cloth(0, 9, 0);
    for (Eigen::Index i = 0; i < 81; ++i) {
      const double angle = std::numbers::pi * double(i % 9) / 8, along = double(i / 9) / 8;
      cloth.x.row(i) << std::cos(angle) / std::numbers::pi, along - 0.5, std::sin(angle) / std::numbers::pi;
      cloth.v.row(i) = spin.cross(Vec3(cloth.x.row(i))).transpose();
    }
    const StabilizerSystem stabilizers(testing::sheet_stabilizers(9, 5, 0.05), 81);
    CentralDifferencesOptions options;
    options.strain = {.strain = 0, .strain_rate = 0};
    options.step_s = 0.5 * stable_step_s(cloth.springs, cloth.inverse_mass, stabilizers);
    options.stabilizers = &stabilizers;
    Motion motion{cloth.x, cloth.v};
    const Vec3 before = angular_momentum(cloth, cloth.v);
    CentralDifferences(cloth.springs, options).advance(motion, cloth.x, cloth.inverse_mass, 2);
    cloth.x = motion.x;
    EXPECT_LE((angular_momentum(cloth, motion.v) - before).norm(), 1e-12 * before.norm());
  }
}

TEST(CentralDifferences, EnergyNeitherGrowsNorDriftsWithoutDamping) {
  auto cloth = random_cloth(4);
  std::vector<Spring> undamped = cloth.springs.springs();
  for (Spring& spring : undamped) spring.damping_n_s_m = 0;
  cloth.springs = SpringSystem(undamped, cloth.springs.vertex_count());
  CentralDifferencesOptions options;
  options.strain = {.strain = 0, .strain_rate = 0};
  options.step_s = 0.2 * stable_step_s(cloth.springs, cloth.inverse_mass);
  CentralDifferences dynamics(cloth.springs, options);
  Motion motion{cloth.x, cloth.v};
  const double before = total_energy(cloth, motion);
  for (int i = 0; i < 20; ++i) {
    dynamics.advance(motion, cloth.x, cloth.inverse_mass, 0.1);
    EXPECT_NEAR(total_energy(cloth, motion), before, 0.02 * before);
  }
}

TEST(CentralDifferences, DampingAndLimitsOnlyTakeEnergy) {
  const auto cloth = random_cloth(6);
  CentralDifferencesOptions options;
  options.step_s = 0.2 * stable_step_s(cloth.springs, cloth.inverse_mass);
  CentralDifferences dynamics(cloth.springs, options);
  Motion motion{cloth.x, cloth.v};
  double energy = total_energy(cloth, motion);
  for (int i = 0; i < 20; ++i) {
    dynamics.advance(motion, cloth.x, cloth.inverse_mass, 0.05);
    const double now = total_energy(cloth, motion);
    EXPECT_LT(now, energy * 1.001);
    energy = now;
  }
}

TEST(CentralDifferences, HeldVerticesReachTheirScriptExactly) {
  const auto cloth = random_cloth(8);
  std::vector<double> inverse_mass = cloth.inverse_mass;
  inverse_mass[3] = 0;
  Positions script = cloth.x;
  script.row(3) << 0.123456789, 0.7, -0.3;
  CentralDifferencesOptions options;
  options.step_s = 1e-3;
  Motion motion{cloth.x, cloth.v};
  CentralDifferences(cloth.springs, options).advance(motion, script, inverse_mass, 0.0333);
  EXPECT_EQ(Vec3(motion.x.row(3)), Vec3(script.row(3)));
}

TEST(CentralDifferences, StepsThatHoldContactsAreShorterWhereSpringsAreStretched) {
  const auto is_more_than_one = [](double length, double dt_s, double stable_step_s) {
    const Hanging hanging(length);
    CentralDifferencesOptions options = hanging.options(0.009);
    options.stable_step_s = stable_step_s;
    return CentralDifferences(hanging.springs, options).holds_contacts(dt_s, hanging.motion.x);
  };
  EXPECT_TRUE(is_more_than_one(1, 0.0091, 0.01));
  EXPECT_FALSE(is_more_than_one(0.5, 0.0089, 0.01)) << "not where they are shorter";
  EXPECT_FALSE(is_more_than_one(1.29, 0.0089, 0.01));
  EXPECT_TRUE(is_more_than_one(1.31, 0.0089, 0.01));
  EXPECT_FALSE(is_more_than_one(1.5, 0.0059, 0.01));
  EXPECT_TRUE(is_more_than_one(1.5, 0.0061, 0.01));
  EXPECT_FALSE(is_more_than_one(9, 0.0034, 0.01));
  EXPECT_TRUE(is_more_than_one(9, 0.0036, 0.01));
  EXPECT_FALSE(is_more_than_one(9, 0.0089, 0.1)) << "they are short";
  EXPECT_TRUE(is_more_than_one(9, 0.0091, 0.1)) << "and no longer";
}

TEST(CentralDifferences, FinalVelocityIsTheHalfKickForShortSteps) {
  // Section 7.6 for one oscillator: v + dt/2 (g - k/m elongation), plus terms of second order in dt.
  Hanging hanging(1.01);
  hanging.motion.v(1, 2) = 0.3;
  const double dt_s = 1e-5, acceleration = -9.81 + hanging.k / hanging.m * 0.01;
  CentralDifferences(hanging.springs, hanging.options(1e-3)).final_velocity(hanging.motion, hanging.inverse_mass, dt_s);
  EXPECT_NEAR(hanging.motion.v(1, 2), 0.3 + dt_s / 2 * acceleration, 1e-8);
}

// Of what falls, whose half kick does not depend on where it is; the second is held, and goes down by a script.
TEST(CentralDifferences, FinalVelocityAfterSeveralStepsIsTheirsAndWhatContactChanged) {
  const SpringSystem none({}, 2);
  const std::vector<double> inverse_mass{2, 0};
  CentralDifferencesOptions options;
  options.fields.gravity_m_s2 = {0, 0, -9.81};
  options.step_s = 0.11;
  const double dt_s = 0.3;
  CentralDifferences dynamics(none, options);
  Motion motion{Positions::Zero(2, 3), Positions::Zero(2, 3)};
  const Positions script = Positions::Constant(2, 3, -0.07);
  dynamics.advance(motion, script, inverse_mass, dt_s);
  const Eigen::RowVector3d change(0.1, 0.2, 0.5);
  Motion end{motion.x, motion.x / dt_s};
  end.v.rowwise() += change;
  dynamics.final_velocity(end, inverse_mass, dt_s);
  EXPECT_LE((end.v.row(0) - change - Eigen::RowVector3d(0, 0, -9.81 * dt_s)).norm(), 1e-12);
  EXPECT_EQ(end.v.row(1), Eigen::RowVector3d(motion.x.row(1) / dt_s) + change) << "scripted: to the bit";
}

TEST(CentralDifferences, FinalVelocityStaysBoundedForLongSteps) {
  Hanging hanging(1.1);
  const double dt_s = 1.0, omega = std::sqrt(hanging.k / hanging.m);
  CentralDifferences(hanging.springs, hanging.options(1e-3)).final_velocity(hanging.motion, hanging.inverse_mass, dt_s);
  EXPECT_LT(std::abs(hanging.motion.v(1, 2)), 0.1 * omega);
}

TEST(CentralDifferences, SameBitsForAnyThreadCount) {
  const auto cloth = random_cloth(9, 60);
  CentralDifferencesOptions options;
  options.step_s = 0.3 * stable_step_s(cloth.springs, cloth.inverse_mass);
  Motion reference;
  for (const std::size_t threads : {1u, 2u, 4u}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    Motion motion{cloth.x, cloth.v};
    CentralDifferences(cloth.springs, options).advance(motion, cloth.x, cloth.inverse_mass, 0.01);
    if (threads == 1) reference = motion;
    EXPECT_EQ(motion.x, reference.x) << threads << " threads";
    EXPECT_EQ(motion.v, reference.v) << threads << " threads";
  }
}

}  // namespace selvage
