// A scene that is simulated for some steps as a case.
#pragma once

#include <limits>

#include "fuzz/kept/byte_case.h"

namespace selvage::fuzz {

[[nodiscard]] const ByteKind& scene_kind();
[[nodiscard]] ByteCase scene_case(std::string scene, std::int64_t steps);

/// What a simulation came to, step by step, each frame and each motion between two decided exactly.
struct SceneTrial {
  std::int64_t steps = 0, with_collisions = 0, with_zones = 0, with_fail_safe = 0;
  bool stopped = false;
  Retrial retrial;  ///< unfit: the scene begins in contact, which the program refuses
};
/// Up to `steps` steps, `jammed` of them with impact zones or the fail-safe, until the first failure. Throws io::Error
/// where it is no scene.
[[nodiscard]] SceneTrial try_scene(const std::string& scene, std::int64_t steps,
                                   std::int64_t jammed = std::numeric_limits<std::int64_t>::max());

}  // namespace selvage::fuzz
