#include "tests/mutants/properties.h"

#include <algorithm>
#include <stdexcept>

namespace selvage::mutants {

const Property& property_named(std::string_view name) {
  const auto found = std::ranges::find(properties(), name, &Property::name);
  if (found == properties().end()) throw std::runtime_error("there is no property '" + std::string(name) + "'");
  return *found;
}

}  // namespace selvage::mutants
