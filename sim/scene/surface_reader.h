// The surfaces of a scene file: exactly one table of a cloth or body names its shape. Internal to the scene reader.
#pragma once

#include "sim/scene/scene.h"
#include "sim/scene/toml_table.h"

namespace selvage::sim {

/// Throw io::Error as the functions of TomlTable do, and where there is no surface, or a second one.
[[nodiscard]] Surface read_cloth_surface(TomlTable& cloth);
[[nodiscard]] BodySurface read_body_surface(TomlTable& body);

}  // namespace selvage::sim
