#include "bench/guest_method.h"

#include <nlohmann/json.hpp>

namespace selvage::bench {

nlohmann::ordered_json to_json(const GuestFacts& facts) {
  return {{"file", facts.file},
          {"name", facts.name},
          {"crc32", facts.crc32},
          {"tolerance", facts.tolerance},
          {"relative_tolerance", facts.relative_tolerance},
          {"has_toi", facts.has_toi}};
}

}  // namespace selvage::bench
