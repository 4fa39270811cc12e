// Random scene files: small, but with everything that a scene can ask for.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "fuzz/base/choice_source.h"

namespace selvage::fuzz {

/// fall: a sheet onto a body. stack: several sheets. pinch: cloth between two moving bodies. fling: pinned cloth that
/// is thrown and turned, into itself. crowd: small cloths and bodies at high speed. carry: cloth
/// that a body carries, past another.
[[nodiscard]] const std::vector<std::string_view>& scene_classes();

/// TOML in the schema of docs/scenes.md. No trigonometry, so that the same scene has the same bits everywhere.
[[nodiscard]] std::string random_scene(std::string_view scene_class, ChoiceSource& source);

}  // namespace selvage::fuzz
