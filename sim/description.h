// What a run models, for a person.
#pragma once

#include <string>

#include "sim/world.h"

namespace selvage::sim {

/// One line each: what the scene does not ask for is not built and not listed.
[[nodiscard]] std::string describe(const Scene& scene, const World& world);

}  // namespace selvage::sim
