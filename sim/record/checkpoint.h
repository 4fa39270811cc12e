// A run's state in one file, so that a killed run goes on with the same bits (S5).
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "io/error.h"
#include "sim/record/body_waits.h"
#include "sim/record/run_totals.h"
#include "sim/record/scene_identity.h"
#include "sim/step.h"

namespace selvage::sim {

struct Checkpoint {
  SceneIdentity scene;        ///< a checkpoint goes with one scene
  std::int64_t recorded = 0;  ///< frames of the sequence at this time
  SimulationState state;
  RunTotals totals;
  BodyWaits waits = {};
};

/// Replaces `file` atomically. Little-endian numbers with a checksum at the end.
void write_checkpoint(const std::filesystem::path& file, const Checkpoint& checkpoint);
/// Nothing if there is no such file; throws io::Error(kBadInput) if it is damaged.
[[nodiscard]] std::optional<Checkpoint> read_checkpoint(const std::filesystem::path& file);

}  // namespace selvage::sim
