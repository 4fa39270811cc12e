// For the short form, which compiles no other properties.
#include "tests/mutants/properties.h"

namespace selvage::mutants {

const std::vector<Property>& properties() {
  static const std::vector<Property> all = query_properties();
  return all;
}

}  // namespace selvage::mutants
