// A run's state in one file, so that a killed run goes on with the same bits (S5).
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "io/error.h"
#include "sim/run_totals.h"
#include "sim/step.h"

namespace selvage::sim {

struct Checkpoint {
  std::uint64_t scene_fingerprint = 0;  ///< of scene_fingerprint(); a checkpoint goes with one scene
  std::int64_t recorded = 0;            ///< frames of the sequence at this time
  SimulationState state;
  RunTotals totals;
};

/// FNV-1a of everything that determines the run: the scene file's bytes, the quality, the faces, and the positions and
/// velocities at time 0 (which cover the mesh files), and the frames of animated bodies.
[[nodiscard]] std::uint64_t scene_fingerprint(const Scene& scene, const World& world);

/// Replaces `file` atomically. Little-endian numbers with a checksum at the end.
void write_checkpoint(const std::filesystem::path& file, const Checkpoint& checkpoint);
/// Nothing if there is no such file; throws io::Error(kBadInput) if it is damaged.
[[nodiscard]] std::optional<Checkpoint> read_checkpoint(const std::filesystem::path& file);

}  // namespace selvage::sim
