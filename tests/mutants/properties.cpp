#include "tests/mutants/properties.h"

#include <algorithm>
#include <stdexcept>

namespace selvage::mutants {

const std::vector<Property>& properties() {
  static const std::vector<Property> all = [] {
    std::vector<Property> joined = kernel_properties();
    for (const auto& part : {mesh_properties(), checker_properties(), step_properties(), simulation_properties()}) {
      joined.insert(joined.end(), part.begin(), part.end());
    }
    return joined;
  }();
  return all;
}

const Property& property_named(std::string_view name) {
  const auto found = std::ranges::find(properties(), name, &Property::name);
  if (found == properties().end()) throw std::runtime_error("there is no property '" + std::string(name) + "'");
  return *found;
}

}  // namespace selvage::mutants
