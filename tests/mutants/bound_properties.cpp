// What rounding uses of the error bounds.
#include "tests/kernel/bound_shares.h"
#include "tests/mutants/properties.h"

namespace selvage::mutants {
namespace {

/// A case is a climb of one bound.
std::optional<Kill> falsify_bounds(std::uint64_t seed, long limit) {
  testing::Random random(seed);
  const auto bounds = testing::bounds();
  for (long number = 0; number < limit; ++number) {
    const testing::Bound& bound = bounds[static_cast<std::size_t>(number) % bounds.size()];
    if (testing::climb(bound, random) > 1) return Kill{number + 1, std::string("exceeded: ") + bound.name};
  }
  return std::nullopt;
}

}  // namespace

std::vector<Property> bound_properties() {
  return {{"bounds", "rounding never uses more than the whole of an error bound (K1 to K4)", falsify_bounds}};
}

}  // namespace selvage::mutants
