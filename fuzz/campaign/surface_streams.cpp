#include "fuzz/campaign/surface_streams.h"

#include <string>

#include "fuzz/draw/surface_makers.h"

namespace selvage::fuzz {

std::vector<Stream> surface_streams(std::int64_t per_unit) {
  std::vector<Stream> streams;
  for (const SurfaceClass& surface : surface_classes()) streams.push_back({std::string(surface.name), 0, per_unit});
  return streams;
}

}  // namespace selvage::fuzz
