// One simulation, measured: time, and the errors that need no other run to be known.
#pragma once

#include "kernel/types.h"
#include "sim/scene/scene.h"
#include "sim/step.h"

namespace selvage::bench {

struct SimRun {
  double cpu_ns = 0, wall_ns = 0;  ///< of the steps, and of subdivision where it is asked for
  std::int64_t frames = 0, steps = 0;
  std::int64_t vertices = 0;       ///< of the cloth
  std::int64_t fine_vertices = 0;  ///< of all after subdivision; 0 where none is asked for
  sim::StepPhases phases;
  std::int64_t contacts = 0;  ///< repulsions and frictions, and collisions left by them
  std::int64_t fail_safe_vertices = 0;
  /// Of the frames, the largest; shares of the kinetic energy at its largest.
  double energy_drift = 0;  ///< |energy - energy at the start|: kinetic, elastic, and of gravity
  double energy_gain = 0;   ///< energy above that of any frame before
  /// Shares of sum m |v| and of sum m |x| |v| at the start, x from the centre of mass then.
  double momentum_drift = 0, angular_momentum_drift = 0;
  double strain = 0;  ///< largest relative elongation or compression of a structural or shear spring at a frame
  Positions x;        ///< of the cloth, at the end
};

struct SimRunOptions {
  std::int64_t most_steps = 1'000'000;  ///< collision steps
  std::int32_t subdivision_levels = 0;  ///< of every frame; their time is in that of the steps
};

/// Runs the scene to its end, or to `most_steps`. Throws std::runtime_error where a step is not safe.
[[nodiscard]] SimRun run_simulation(const sim::Scene& scene, const SimRunOptions& options = {});

}  // namespace selvage::bench
