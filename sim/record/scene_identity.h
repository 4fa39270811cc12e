// What determines a run: which checkpoint goes with which scene, and if none does, why.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "sim/scene/scene.h"
#include "sim/world.h"

namespace selvage::sim {

struct SceneIdentity {
  std::string text;  ///< of the scene file: what changed in it can be said
  Quality quality = Quality::kDraft;
  /// FNV-1a of each cloth and body: its faces, its positions at time 0 (which cover the mesh files), and the frames of
  /// an animated one.
  std::vector<std::uint64_t> parts;
  std::uint64_t whole = 0;  ///< of all faces, and all positions and velocities at time 0, those of no face too

  friend bool operator==(const SceneIdentity&, const SceneIdentity&) = default;
};

/// Reads the scene file.
[[nodiscard]] SceneIdentity identify(const Scene& scene, const World& world);

/// FNV-1a of all of it: a checkpoint's number in run.json.
[[nodiscard]] std::uint64_t fingerprint_of(const SceneIdentity& identity);

/// What is not what it was: the first setting of the file with both values, --quality, or the part whose mesh or
/// sequence changed; nothing where they determine the same run, with other comments perhaps. `world` is the one of
/// `now`.
[[nodiscard]] std::optional<std::string> first_difference(const SceneIdentity& before, const SceneIdentity& now,
                                                          const World& world);

}  // namespace selvage::sim
