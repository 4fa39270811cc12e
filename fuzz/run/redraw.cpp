#include "fuzz/run/redraw.h"

#include <algorithm>
#include <exception>
#include <memory>

#include "fuzz/base/deaths.h"
#include "fuzz/campaign/property.h"
#include "fuzz/run/worker.h"

namespace selvage::fuzz {
namespace {

Retrial retry_drawn(Property& property, const Stream& stream, const CaseOrigin& origin) {
  try {
    const OneCase run = run_case(property, stream, origin.seed, origin.number, kCaseSeconds);
    return {run.outcome.failure, {"drawn again from its seed, in a process of its own"}, {}};
  } catch (const std::exception& error) {
    return {kThrew, {error.what()}, {}};
  }
}

}  // namespace

std::optional<Redrawn> redraw(const CaseOrigin& origin) {
  for (auto& one : all_properties()) {
    if (one->name() != origin.property) continue;
    const std::shared_ptr<Property> property = std::move(one);
    const auto stream = std::ranges::find(property->streams(), origin.stream, &Stream::name);
    if (stream == property->streams().end()) return std::nullopt;
    return Redrawn{property->promise(),
                   [property, &stream = *stream, origin] { return retry_drawn(*property, stream, origin); }};
  }
  return std::nullopt;
}

}  // namespace selvage::fuzz
