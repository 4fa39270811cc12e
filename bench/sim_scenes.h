// The scenes of `bench sim`: each measures one thing, and has nothing that would blur it.
#pragma once

#include <string>
#include <vector>

#include "sim/scene/scene.h"

namespace selvage::bench {

inline constexpr double kFramesPerSecond = 30;
inline constexpr double kSwingSide = 0.5;  ///< of the sheet of swing_scene, metres

/// As scene files name it.
[[nodiscard]] const char* solver_name(sim::Solver solver);

/// A square sheet, held along one edge, swings down from level for 8 frames. No damping, no drag, no limits on strain,
/// no repulsions, no contact: energy is constant, and positions have a limit as the step goes to zero. `substeps` of
/// the dynamics in a frame, however few: the bound of implicit steps that scenes have by default is lifted.
[[nodiscard]] sim::Scene swing_scene(sim::Solver solver, int nodes, int substeps);

/// Two sheets meet in weightless space with friction and touch for most of 15 frames: momentum is constant, and energy
/// may only fall.
[[nodiscard]] sim::Scene meeting_scene(sim::Solver solver);

/// A sheet of soft springs falls into its two held edges and stretches beyond the strain limit if nothing stops it.
[[nodiscard]] sim::Scene stretch_scene(sim::Solver solver);

/// A sheet of nodes x nodes that has just met a ball, for growth: every phase has work to do from the first step on.
[[nodiscard]] sim::Scene drape_scene(sim::Solver solver, int nodes);

/// The sheet of drape_scene with one module more each time: the first has springs alone.
struct ModuleScene {
  std::string added;  ///< to the one before
  sim::Scene scene;
  std::int32_t subdivision_levels = 0;  ///< of each frame
};
[[nodiscard]] std::vector<ModuleScene> module_scenes(int nodes);

}  // namespace selvage::bench
