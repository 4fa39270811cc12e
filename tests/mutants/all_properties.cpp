#include "tests/mutants/properties.h"

namespace selvage::mutants {

const std::vector<Property>& properties() {
  static const std::vector<Property> all = [] {
    std::vector<Property> joined = query_properties();
    for (const auto& part : {bound_properties(), cull_properties(), mesh_properties(), checker_properties(),
                             step_properties(), simulation_properties()}) {
      joined.insert(joined.end(), part.begin(), part.end());
    }
    return joined;
  }();
  return all;
}

}  // namespace selvage::mutants
