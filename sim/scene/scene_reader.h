// Scene files: TOML in the schema of docs/scenes.md, checked before anything is built.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "io/error.h"
#include "sim/scene/scene.h"

namespace selvage::sim {

/// Of a run: the six digits of frame_000000.npy hold one more, the start.
inline constexpr std::int64_t kMaxFrames = 999'999;

/// Throws io::Error "FILE:LINE: what is wrong; what to do" on syntax errors, unknown keys, wrong types and bad values.
/// Mesh files are named relative to the scene file; they are read when the world is built.
[[nodiscard]] Scene read_scene(const std::filesystem::path& file, Quality quality = Quality::kDraft);

/// The same for text in memory; `name` appears in errors.
[[nodiscard]] Scene parse_scene(std::string_view text, const std::string& name, Quality quality = Quality::kDraft);

}  // namespace selvage::sim
