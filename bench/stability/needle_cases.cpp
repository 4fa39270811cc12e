#include <cmath>
#include <random>

#include <Eigen/Geometry>

#include "bench/stability/cases.h"
#include "bench/stability/hard_shapes.h"
#include "bench/stability/stage.h"

namespace selvage::bench {
namespace {

constexpr double kRatio = 1e6;  // length to width

sim::Shape triangle(const Vec3& a, const Vec3& b, const Vec3& c) {
  sim::Shape shape;
  shape.x.resize(3, 3);
  shape.x << a.transpose(), b.transpose(), c.transpose();
  shape.triangles = {{0, 1, 2}};
  return shape;
}

void needle_through_cloth(Trial& trial) {
  // Flying along itself at the inside of a face, at an edge, and at a vertex; a thousand edge lengths a step.
  const int side = trial.pick(5, 9, 17);
  const double edge = 1.0 / (side - 1);
  for (const Vec3& aim : {Vec3(0.3 * edge, 0.2 * edge, 0), Vec3(0.5 * edge, 0, 0), Vec3(0, 0, 0)}) {
    StageSetup setup;
    setup.add_cloth(sim::make_sheet(side, side, 1, 1), Vec3::Zero());
    const sim::Shape needle = triangle({0, 0, 0}, {1e-4, 0, 0.3}, {0, 1e-4, 0.3});
    setup.add_cloth(needle, aim + Vec3(0, 0, 0.01), {0.1}, Vec3(0, 0, -1'000 * edge / setup.dt_s));
    Stage stage(trial, setup);
    for (int step = 0; step < trial.steps(6, 2); ++step) stage.step();
    stage.require_balances();
  }
  trial.at_least("steps with collisions", double(trial.report().steps_with_collisions), 3);
}

/// Strips of triangles a million times longer than wide, in layers.
sim::Shape sliver_strip(int count) {
  sim::Shape strip;
  strip.x.resize(count + 2, 3);
  for (int i = 0; i < count + 2; ++i) strip.x.row(i) << (i % 2 == 0 ? 0 : 1), i / kRatio, 0;
  for (int i = 0; i < count; ++i) strip.triangles.push_back({i, i + 1, i + 2});
  return strip;
}

void slivers(Trial& trial) {
  StageSetup setup;
  setup.collision.thickness_m = 1e-4;
  const sim::Shape strip = sliver_strip(trial.pick(4, 16, 48));
  setup.add_cloth(strip, Vec3::Zero());
  setup.add_cloth(strip, Vec3(0.01, 2e-7, 0.004), {}, Vec3(0, 0, -3));
  setup.add_cloth(turned(strip, Vec3(0, 0, 90)), Vec3(0.5, -0.5, 0.008), {}, Vec3(0, 0, -6));
  Stage stage(trial, setup);
  for (int step = 0; step < trial.steps(12, 2); ++step) stage.step();
  stage.require_balances();
  trial.at_least("steps with collisions", double(trial.report().steps_with_collisions), 1);
}

void needle_heap(Trial& trial) {
  // Needles in all directions, thrown at one point.
  std::mt19937_64 engine(7);
  const auto unit = [&engine] { return std::ldexp(static_cast<double>(engine() >> 11), -52) - 1; };
  StageSetup setup;
  const int count = trial.pick(8, 24, 64);
  for (int i = 0; i < count; ++i) {
    const Vec3 direction = Vec3(unit(), unit(), unit()).normalized();
    const Vec3 across = direction.unitOrthogonal() / kRatio;
    const Vec3 place(0.2 * (i % 4), 0.2 * (i / 4 % 4), 0.2 * (i / 16));
    const Vec3 inwards = 20 * (Vec3(0.3, 0.3, 0.02 * count / 2) - place);
    setup.add_cloth(triangle(-0.2 * direction, 0.2 * direction, 0.2 * direction + across), place, {}, inwards);
  }
  Stage stage(trial, setup);
  for (int step = 0; step < trial.steps(12, 3); ++step) stage.step();
  stage.require_balances();
}

}  // namespace

std::vector<StabilityCase> needle_cases() {
  return {
      {"needle-through-cloth", "a tip flies at a face, an edge and a vertex, a thousand edges a step",
       "contact found each time; momentum and energy kept", needle_through_cloth},
      {"slivers", "layers of triangles 1 : 1,000,000, parallel and across", "contact found; momentum and energy kept",
       slivers},
      {"needle-heap", "needles 1 : 400,000 in all directions meet at one place", "momentum and energy kept",
       needle_heap},
  };
}

}  // namespace selvage::bench
