// How a time stands in every report.
#pragma once

#include <nlohmann/json.hpp>

#include "bench/timed.h"

namespace selvage::bench {

[[nodiscard]] inline nlohmann::ordered_json json_of(const BestTime& time) {
  return {{"cpu", time.cpu}, {"wall", time.wall}};
}

}  // namespace selvage::bench
