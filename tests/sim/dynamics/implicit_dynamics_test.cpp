#include "sim/dynamics/implicit_dynamics.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include "sim/record/run_totals.h"
#include "sim/scene/scene_reader.h"
#include "tests/sim/dynamics/plain_forces.h"
#include "tests/sim/random_cloth.h"

namespace selvage {

using namespace sim;
using testing::random_cloth;

namespace {

constexpr double kFrame = 1.0 / 60;

ImplicitDynamicsOptions options(double step_s) {
  ImplicitDynamicsOptions o;
  o.strain = {.strain = 0, .strain_rate = 0};
  o.step_s = step_s;
  return o;
}

SpringSystem stiffer(const SpringSystem& springs, double factor) {
  std::vector<Spring> scaled = springs.springs();
  for (Spring& spring : scaled) spring.stiffness_n_m *= factor;
  return {scaled, springs.vertex_count()};
}

double total_energy(const testing::RandomCloth& cloth, const SpringSystem& springs, const Motion& motion) {
  double energy = testing::kinetic_energy(cloth, motion.v);
  for (const Spring& spring : springs.springs()) {
    const double elongation = (motion.x.row(spring.b) - motion.x.row(spring.a)).norm() - spring.rest_length_m;
    energy += spring.stiffness_n_m * elongation * elongation / 2;
  }
  return energy;
}

}  // namespace

TEST(ImplicitStage, SolutionIsWhereTheForcesOfTheSpringsPutIt) {
  const auto cloth = random_cloth(3);
  std::vector<Stabilizer> flat = testing::sheet_stabilizers(9, 3, 0.02);
  for (std::size_t n = 0; n < flat.size(); ++n) {
    flat[n].stiffness_n_m *= 1 + 0.5 * double(n % 3);
    flat[n].damping_n_s_m *= 1 + 0.5 * double(n % 4);
    flat[n].straight_m = 0.02;
  }
  const StabilizerSystem stabilizers(flat, 81);
  const FieldForces fields{{0.3, 0, -9.81}, 0.7, 1.1};
  std::vector<double> w = cloth.inverse_mass;
  w[5] = 0;
  for (const double h : {1e-3, kFrame}) {
    ImplicitStage stage(cloth.springs, &stabilizers, fields);
    const StageEquations equations{cloth.x, cloth.v, w, h};
    Positions x = cloth.x, acceleration;
    const StageReport report = stage.solve(equations, x, acceleration);
    ASSERT_TRUE(report.converged);
    EXPECT_GT(report.newton_rounds, 1);
    EXPECT_LE(report.residual_m, ImplicitStage::kResidual_m);
    const Positions v = (x - cloth.x) / h;
    const auto plain = testing::plain_forces(cloth.springs, flat, x, v, cloth.x + h * cloth.v);
    const Positions force = plain.elastic + plain.damping;
    EXPECT_EQ(Vec3(x.row(5)), Vec3(cloth.x.row(5))) << "held";
    for (Eigen::Index i = 0; i < x.rows(); ++i) {
      if (i == 5) continue;
      const Eigen::RowVector3d a = fields.gravity_m_s2.transpose() - 0.7 * v.row(i) - 1.1 * v.row(i).norm() * v.row(i) +
                                   w[static_cast<std::size_t>(i)] * force.row(i);
      ASSERT_LE((v.row(i) - cloth.v.row(i) - h * a).norm() * h, 1.01e-9) << "vertex " << i << ", h = " << h;
      ASSERT_LE((acceleration.row(i) - a).norm(), 1e-9 * (a.norm() + w[static_cast<std::size_t>(i)]));
    }
  }
}

TEST(ImplicitStage, SaysThatItDidNotConverge) {
  // Forces beyond the largest double.
  const SpringSystem springs({Spring{0, 1, SpringKind::kStructural, 1, 1e300, 0}}, 2);
  const std::vector<double> inverse_mass = {1e10, 1e10};
  Positions x(2, 3), v = Positions::Zero(2, 3), acceleration;
  x << 0, 0, 0, 3, 0, 0;
  const Positions origin = x;
  ImplicitStage stage(springs, nullptr, {});
  EXPECT_FALSE(stage.solve({origin, v, inverse_mass, 1}, x, acceleration).converged);

  StepResult step;
  step.dynamics.unconverged = 2;
  step.dynamics.residual_m = 3e-5;
  step.most_strained = {0.4, {3, 5}};
  step.end_s = 2;
  RunTotals totals;
  totals.add(step);
  EXPECT_NE(totals.shortfalls().find("2 implicit solves did not converge"), std::string::npos);
  EXPECT_EQ(totals.largest_residual_m, 3e-5);
  step.most_strained = {0.3, {1, 2}};
  step.end_s = 3;
  totals.add(step);
  EXPECT_EQ(totals.largest_strain, 0.4);
  EXPECT_EQ(totals.largest_strain_at_s, 2);
  EXPECT_EQ(totals.largest_strain_from, 3);
  EXPECT_EQ(totals.largest_strain_to, 5);
}

// The forces on the middle one are no number; the last one, which is held, must not hide it.
TEST(ImplicitStage, WhatIsNoNumberIsNoSolution) {
  const SpringSystem springs(
      {Spring{0, 1, SpringKind::kStructural, 1, 1e300, 0}, Spring{1, 2, SpringKind::kStructural, 1, 1e300, 0}}, 3);
  const std::vector<double> inverse_mass = {0, 1, 0};
  Positions x(3, 3), v = Positions::Zero(3, 3), acceleration;
  x << -1e10, 0, 0, 0, 0, 0, 1e10, 0, 0;
  const Positions origin = x;
  EXPECT_FALSE(ImplicitStage(springs, nullptr, {}).solve({origin, v, inverse_mass, 1}, x, acceleration).converged);
}

TEST(ImplicitStage, ASpringOfLengthZeroPullsAtNeitherEnd) {
  const SpringSystem springs({Spring{0, 1, SpringKind::kStructural, 1, 20, 0.5}}, 2);
  const std::vector<double> inverse_mass = {2, 2};  // alike, or what rounding parts the spring would push away
  const Positions at = Positions::Constant(2, 3, 0.5), v = Positions::Zero(2, 3);
  Positions x = at, acceleration;
  ASSERT_TRUE(
      ImplicitStage(springs, nullptr, {{0, 0, -9.81}}).solve({at, v, inverse_mass, kFrame}, x, acceleration).converged);
  EXPECT_LE((x.col(2).array() - 0.5 + 9.81 * kFrame * kFrame).abs().maxCoeff(), 1e-9);
}

// What the stiffest springs round away must hide neither that cloth falls, nor that nothing was solved.
TEST(ImplicitStage, RoundingOfStiffSpringsIsNoSolution) {
  const auto cloth = random_cloth(11);
  const SpringSystem springs = stiffer(cloth.springs, 1e28);
  const Positions still = Positions::Zero(cloth.x.rows(), 3);
  Positions acceleration;
  for (const bool is_stretched : {false, true}) {
    std::vector<Spring> at_rest = springs.springs();
    for (Spring& spring : at_rest) {
      spring.rest_length_m = (is_stretched ? 0.9 : 1) * (cloth.x.row(spring.b) - cloth.x.row(spring.a)).norm();
    }
    const SpringSystem stiff(at_rest, springs.vertex_count());
    ImplicitStage stage(stiff, nullptr, {{0, 0, -9.81}});
    Positions x = cloth.x;
    const StageReport report = stage.solve({cloth.x, still, cloth.inverse_mass, kFrame}, x, acceleration);
    const double fall_m = (cloth.x - x).col(2).mean();
    if (is_stretched) {
      EXPECT_FALSE(report.converged);
    } else {
      EXPECT_TRUE(!report.converged || std::abs(fall_m - 9.81 * kFrame * kFrame) < 1e-6) << fall_m;
    }
  }
}

TEST(ImplicitDynamics, DampedOscillatorConvergesAtSecondOrder) {
  // An eighth of the step, a sixty-fourth of the error.
  const double m = 0.05, k = 20, c = 0.4, length = 1 + m * 9.81 / k, t = 0.5;
  const SpringSystem springs({Spring{0, 1, SpringKind::kStructural, 1.0, k, c}}, 2);
  const std::vector<double> inverse_mass = {0, 1 / m};
  const double decay = c / (2 * m), omega = std::sqrt(k / m - decay * decay);
  const double expected =
      length + 0.02 * std::exp(-decay * t) * (std::cos(omega * t) + decay / omega * std::sin(omega * t));
  double error[2];
  int n = 0;
  for (const double step_s : {4e-3, 5e-4}) {
    ImplicitDynamicsOptions o = options(step_s);
    o.fields.gravity_m_s2 = {0, 0, -9.81};
    Motion motion{Positions::Zero(2, 3), Positions::Zero(2, 3)};
    motion.x(1, 2) = -(length + 0.02);
    ImplicitDynamics(springs, o).advance(motion, Positions::Zero(2, 3), inverse_mass, t);
    error[n++] = std::abs(-motion.x(1, 2) - expected);
  }
  EXPECT_LT(error[0], 2e-5);
  EXPECT_GT(error[0] / error[1], 50);
  EXPECT_LT(error[0] / error[1], 80);
}

TEST(ImplicitDynamics, StiffSpringsAreStableAtFrameSizeSteps) {
  const auto cloth = random_cloth(7, 9, 0.05);
  for (const double factor : {1e2, 1e4}) {
    const SpringSystem springs = stiffer(cloth.springs, factor);
    EXPECT_GT(kFrame / stable_step_s(springs, cloth.inverse_mass), factor > 1e3 ? 100 : 10) << "explicit steps in one";
    ImplicitDynamics dynamics(springs, options(kFrame));
    Motion motion{cloth.x, cloth.v};
    double energy = total_energy(cloth, springs, motion);
    for (int frame = 0; frame < 30; ++frame) {
      EXPECT_EQ(dynamics.advance(motion, cloth.x, cloth.inverse_mass, kFrame).unconverged, 0);
      const double after = total_energy(cloth, springs, motion);
      EXPECT_LE(after, energy) << "frame " << frame << ", stiffness times " << factor;
      energy = after;
    }
  }
}

TEST(ImplicitDynamics, LinearMomentumIsKeptToRoundingAngularToTheOrderOfTheMethod) {
  const StabilizerSystem stabilizers(testing::sheet_stabilizers(9, 5, 0.05), 81);
  double lost[2];
  int n = 0;
  for (const double step_s : {1e-3, 2.5e-4}) {
    auto cloth = random_cloth(2);
    ImplicitDynamicsOptions with_stabilizers = options(step_s);
    with_stabilizers.stabilizers = &stabilizers;
    const Vec3 linear = linear_momentum(cloth, cloth.v), angular = angular_momentum(cloth, cloth.v);
    Motion motion{cloth.x, cloth.v};
    ImplicitDynamics(cloth.springs, with_stabilizers).advance(motion, cloth.x, cloth.inverse_mass, 0.02);
    // Contact and strain limits take their velocities from positions.
    const Positions mean_v = (motion.x - cloth.x) / 0.02;
    EXPECT_LE((linear_momentum(cloth, mean_v) - linear).norm(), 1e-13);
    cloth.x = motion.x;
    EXPECT_LE((linear_momentum(cloth, motion.v) - linear).norm(), 1e-13) << "of a sum of magnitudes of about 0.4";
    lost[n++] = (angular_momentum(cloth, motion.v) - angular).norm();
  }
  EXPECT_LT(lost[0], 1e-4);
  EXPECT_GT(lost[0] / lost[1], 11) << "second order: sixteen";
}

TEST(ImplicitDynamics, HeldVerticesFollowTheirScripts) {
  const auto cloth = random_cloth(5, 9, 0);
  std::vector<double> w = cloth.inverse_mass;
  Positions script = cloth.x;
  for (std::size_t i = 0; i < 9; ++i) {
    w[i] = 0;
    script.row(static_cast<Eigen::Index>(i)) += Eigen::RowVector3d(0.003, -0.007, 0.01);
  }
  Motion motion{cloth.x, cloth.v};
  ImplicitDynamics(cloth.springs, options(kFrame / 3)).advance(motion, script, w, kFrame);
  EXPECT_EQ(Positions(motion.x.topRows(9)), Positions(script.topRows(9))) << "to the bit";
  EXPECT_LE((motion.v.topRows(9).rowwise() - Eigen::RowVector3d(0.18, -0.42, 0.6)).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(ImplicitDynamics, FinalVelocityIsThatOfTheLastStepAndWhatContactChanged) {
  const auto cloth = random_cloth(4);
  std::vector<double> w = cloth.inverse_mass;
  w[5] = 0;
  ImplicitDynamicsOptions o = options(kFrame / 3);
  o.fields.gravity_m_s2 = {0, 0, -9.81};
  ImplicitDynamics dynamics(cloth.springs, o);
  Motion motion{cloth.x, cloth.v};
  dynamics.advance(motion, cloth.x, w, kFrame);
  const Positions mean_v = (motion.x - cloth.x) / kFrame, change = 0.1 * cloth.v;
  EXPECT_GT((motion.v - mean_v).norm(), 0.1);
  Motion end{motion.x, mean_v + change};
  dynamics.final_velocity(end, w, kFrame);
  for (Eigen::Index i = 0; i < cloth.x.rows(); ++i) {
    if (i == 5) {
      EXPECT_EQ(end.v.row(i), mean_v.row(i) + change.row(i)) << "scripted: to the bit";
    } else {
      EXPECT_LE((end.v.row(i) - motion.v.row(i) - change.row(i)).norm(), 1e-13) << i;
    }
  }
  EXPECT_EQ(end.x, motion.x);
}

TEST(ImplicitDynamics, SameBitsForAnyThreadCount) {
  const auto cloth = random_cloth(1, 40, 0.2);  // more than one grain of vertices
  Motion reference;
  for (const std::size_t threads : {1u, 3u}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    Motion motion{cloth.x, cloth.v};
    ImplicitDynamics(cloth.springs, options(2e-3)).advance(motion, cloth.x, cloth.inverse_mass, 4e-3);
    if (threads == 1) reference = motion;
    EXPECT_EQ(motion.x, reference.x);
    EXPECT_EQ(motion.v, reference.v);
  }
}

TEST(ImplicitDynamics, APinThatMovesOnDoesAsOneAtRest) {
  const auto cloth = random_cloth(6);
  std::vector<double> w = cloth.inverse_mass;
  w[0] = w[40] = 0;
  const Eigen::RowVector3d drift_m(0.3, -0.2, 0.1);
  Motion at_rest{cloth.x, cloth.v}, drifts{cloth.x, cloth.v.rowwise() + drift_m / kFrame};
  ImplicitDynamics(cloth.springs, options(kFrame / 2)).advance(at_rest, cloth.x, w, kFrame);
  ImplicitDynamics(cloth.springs, options(kFrame / 2)).advance(drifts, cloth.x.rowwise() + drift_m, w, kFrame);
  EXPECT_LE(((drifts.x.rowwise() - drift_m) - at_rest.x).norm(), 1e-8);
  EXPECT_LE(((drifts.v.rowwise() - drift_m / kFrame) - at_rest.v).norm(), 1e-6);
}

TEST(ImplicitDynamics, ReportsAllThatItSolvedFor) {
  const auto cloth = random_cloth(3);
  const double step_s = 1.0 / 128;
  ImplicitDynamics dynamics(cloth.springs, options(step_s));
  Motion one_by_one{cloth.x, cloth.v}, at_once = one_by_one;
  const DynamicsReport first = dynamics.advance(one_by_one, cloth.x, cloth.inverse_mass, step_s);
  const DynamicsReport second = dynamics.advance(one_by_one, cloth.x, cloth.inverse_mass, step_s);
  const DynamicsReport both = dynamics.advance(at_once, cloth.x, cloth.inverse_mass, 2 * step_s);
  EXPECT_EQ(at_once.x, one_by_one.x);
  EXPECT_EQ(both.solves, 4) << "two stages each";
  EXPECT_EQ(both.newton_rounds, first.newton_rounds + second.newton_rounds);
  EXPECT_EQ(both.cg_iterations, first.cg_iterations + second.cg_iterations);
  EXPECT_EQ(both.residual_m, std::max(first.residual_m, second.residual_m));
  EXPECT_GE(first.newton_rounds, 4);
  EXPECT_GE(first.cg_iterations, first.newton_rounds);

  const SpringSystem too_stiff({Spring{0, 1, SpringKind::kStructural, 1, 1e300, 0}}, 2);
  Motion lost{Positions::Zero(2, 3), Positions::Zero(2, 3)};
  lost.x(1, 0) = 3;
  const DynamicsReport none =
      ImplicitDynamics(too_stiff, options(1)).advance(lost, lost.x, std::vector<double>{1e10, 1e10}, 2);
  EXPECT_EQ(none.unconverged, none.solves);
}

TEST(ImplicitDynamics, StrainLimitHolds) {
  // Two masses that part at 1 m/s against a weak spring: without the limit it would be a third longer after the step.
  const SpringSystem springs({Spring{0, 1, SpringKind::kStructural, 0.1, 0.1, 0}}, 2);
  ImplicitDynamicsOptions o = options(kFrame);
  o.strain.strain = 0.1;
  Motion motion{Positions::Zero(2, 3), Positions::Zero(2, 3)};
  motion.x(1, 0) = 0.1;
  motion.v(0, 0) = -1;
  motion.v(1, 0) = 1;
  Motion free = motion;
  ImplicitDynamics(springs, o).advance(motion, motion.x, std::vector<double>{1, 1}, kFrame);
  EXPECT_NEAR(motion.x(1, 0) - motion.x(0, 0), 0.11, 1e-4 * 0.03);  // of what would be too much
  ImplicitDynamics(springs, options(kFrame)).advance(free, free.x, std::vector<double>{1, 1}, kFrame);
  EXPECT_LE(((motion.v - free.v) - (motion.x - free.x) / kFrame).norm(), 1e-12) << "as the mean velocity";
}

// Once a spring was limited anywhere, all cloth went on with its mean velocity: it fell with half of gravity.
TEST(ImplicitDynamics, StrainLimitTakesNoMomentumFromOneNorAnyOther) {
  const SpringSystem springs({Spring{0, 1, SpringKind::kStructural, 0.1, 0.1, 0}}, 3);
  ImplicitDynamicsOptions o = options(kFrame);
  const Eigen::RowVector3d gravity(0, 0, -9.81);
  o.fields = {gravity.transpose(), 0, 0};
  Motion start{Positions::Zero(3, 3), Positions::Zero(3, 3)};
  start.x(1, 0) = 0.1;
  start.v(0, 0) = -1;
  start.v(1, 0) = 1;
  Motion free = start, limited = start;
  const std::vector<double> w{1, 2, 1};
  ImplicitDynamics without(springs, o);
  o.strain.strain = 0.1;
  ImplicitDynamics with(springs, o);
  for (int n = 1; n <= 10; ++n) {
    without.advance(free, start.x, w, kFrame);
    with.advance(limited, start.x, w, kFrame);
    EXPECT_EQ(limited.x.row(2), free.x.row(2)) << "to the bit";
    EXPECT_EQ(limited.v.row(2), free.v.row(2)) << "to the bit";
    const Eigen::RowVector3d momentum = limited.v.row(0) + limited.v.row(1) / 2;
    const Eigen::RowVector3d expected = start.v.row(0) + start.v.row(1) / 2 + 1.5 * n * kFrame * gravity;
    EXPECT_LE((momentum - expected).norm(), 1e-12);
  }
  EXPECT_NE(limited.x.row(0), free.x.row(0)) << "the limit acted";
}

}  // namespace selvage
