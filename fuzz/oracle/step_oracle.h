// The judge of the collision step: what S1 to S3 promise about one step, by exact arithmetic where it is about
// touching.
#pragma once

#include <cstdint>
#include <functional>
#include <string_view>

#include "fuzz/draw/step_world.h"

namespace selvage::fuzz {

enum class StepDefect : std::uint8_t {
  kNone,
  kTouches,        ///< S1: the motion to the returned positions touches
  kRejected,       ///< a valid input was called invalid, or abandoned unasked
  kStoppedFreely,  ///< S1: stopped although nothing is scripted, or without a witness, or with other positions
  kUnnamedNear,    ///< S2: a pair ends nearer than the tolerance and the report does not name it
  kOffScript,      ///< S4: a scripted vertex is neither at its candidate nor waiting
  kOffLattice,     ///< float32 was asked for
  kBadVelocity,    ///< velocity dt is not the displacement, up to the rounding of x
  kMomentum,       ///< S3: linear momentum changed, with nothing scripted and no fail-safe
  kEnergy,         ///< S3: kinetic energy grew by inelastic impulses
  kInterferes,     ///< no pair was near or collided, and yet the candidates were changed
  kNotRefused,     ///< a candidate that is not a number was not called invalid
  kOutsideDomain,  ///< a coordinate beyond kMaxCoordinate, or a velocity that is not finite
};
[[nodiscard]] std::string_view name_of(StepDefect defect);

/// A step under test: ours, or one with a planted defect.
using StepFunction =
    std::function<sim::CollisionStepResult(const StepWorld&, const Positions& x_t0, const Positions& candidate)>;
[[nodiscard]] sim::CollisionStepResult selvage_step(const StepWorld& world, const Positions& x_t0,
                                                    const Positions& candidate);

/// REQUIRES that x_t0 is free of intersections. A candidate that is not finite must be refused.
[[nodiscard]] StepDefect judge_step(const StepWorld& world, const Positions& x_t0, const Positions& candidate,
                                    const sim::CollisionStepResult& result);

struct StepObservation {
  StepDefect defect = StepDefect::kNone;
  std::string_view surface, candidate;  ///< classes; of the last step
  std::int64_t steps = 0;
  std::int64_t with_collisions = 0, with_zones = 0, with_fail_safe = 0, stopped = 0;  ///< steps
  /// The failing step, for the record.
  Positions x_t0, x_candidate, x_t1;
};

/// A world and one to four steps in a row, each from the positions that the last one returned, judged one by one.
[[nodiscard]] StepObservation run_steps(ChoiceSource& source, const StepFunction& step);
[[nodiscard]] StepObservation run_steps(ChoiceSource& source, const StepWorld& world, const StepFunction& step);

}  // namespace selvage::fuzz
