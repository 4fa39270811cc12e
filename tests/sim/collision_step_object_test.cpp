// The step as an object: it is moved, outlives what it was made of, and is used by one thread at a time.
#include <atomic>
#include <thread>
#include <type_traits>
#include <utility>

#include "sim/collision_step.h"
#include "tests/sim/step_scene.h"

namespace selvage::sim::testbed {

// An object that two threads use would answer one of them with what the other has found.
TEST(CollisionStep, RefusesASecondCallWhileOneRuns) {
  StepScene scene;
  scene.add(sheet(12), Vec3::Zero());
  scene.push(scene.add(sheet(12), Vec3(0.003, 0.002, 0.0015)), Vec3(0, 0, -0.02));
  const Mesh mesh = scene.mesh();
  const CollisionBodies bodies = scene.bodies();
  CollisionStep step(mesh, scene.options);
  const auto call = [&] { return step(scene.V_t0, scene.V_candidate, bodies, scene.dt_s); };
  const CollisionStepResult alone = call();
  std::atomic<bool> was_refused = false;
  std::atomic<int> wrong = 0;
  const auto call_until_refused = [&] {
    for (int i = 0; i < 200000 && !was_refused && wrong == 0; ++i) {  // as threads take turns on one core
      const CollisionStepResult result = call();
      if (result.report.input_error == InputError::kInUse) {
        was_refused = true;
        wrong += result.report.status != StepStatus::kInvalidInput || result.x != scene.V_t0;
      } else {
        wrong += result.report.status != StepStatus::kSafe || result.x != alone.x;
      }
    }
  };
  std::thread other(call_until_refused);
  call_until_refused();
  other.join();
  EXPECT_TRUE(was_refused);
  EXPECT_EQ(wrong, 0);
  EXPECT_EQ(call().x, alone.x) << "and is free again";

  // Nor while contacts are looked for, of which there are some, nor those while a step runs.
  const auto search = [&] { return step.find_contacts(scene.V_t0, scene.V_candidate, bodies); };
  ASSERT_FALSE(search().empty());
  for (int again = 0; again < 20; ++again) {
    was_refused = false;
    std::atomic<bool> has_ended = false;
    std::thread searching([&] {
      while (!has_ended) {
        if (search().empty()) was_refused = true;
      }
    });
    call_until_refused();
    has_ended = true;
    searching.join();
    ASSERT_TRUE(was_refused);
    ASSERT_EQ(wrong, 0);
  }
}

TEST(CollisionStep, IsMovedWithItsMesh) {
  StepScene one, other;
  one.add(sheet(3), Vec3::Zero());
  other.add(sheet(5), Vec3::Zero());
  const Mesh of_one = one.mesh(), of_other = other.mesh();
  CollisionStep step(of_one, one.options);
  EXPECT_EQ(step(other.V_t0, other.V_t0, other.bodies(), other.dt_s).report.status, StepStatus::kInvalidInput);
  step = CollisionStep(of_other, other.options);
  EXPECT_EQ(step(other.V_t0, other.V_t0, other.bodies(), other.dt_s).report.status, StepStatus::kSafe);
}

TEST(CollisionStep, WhatWasMovedFromSaysThatItCannotStep) {
  StepScene scene;
  scene.add(sheet(3), Vec3::Zero());
  const Mesh mesh = scene.mesh();
  CollisionStep step(mesh, scene.options);
  const CollisionStep taken = std::move(step);
  const auto use = [&](const auto& call) { static_cast<void>(call()); };
  EXPECT_DEATH(use([&] { return step(scene.V_t0, scene.V_t0, scene.bodies(), scene.dt_s); }), "called without");
  EXPECT_DEATH(use([&] { return step.find_contacts(scene.V_t0, scene.V_t0, scene.bodies()); }), "called without");
  EXPECT_DEATH(use([&] { return &step.contact_table(); }), "called without");
}

TEST(CollisionStep, KeepsNoReferenceToATemporaryMesh) {
  static_assert(!std::is_constructible_v<CollisionStep, Mesh, CollisionOptions>);
  static_assert(std::is_constructible_v<CollisionStep, const Mesh&, CollisionOptions>);
}

}  // namespace selvage::sim::testbed
