// Loops in lanes exist once for every kind of vector unit, and the machine's best is chosen when the first one runs:
// tests run the others as well.
#pragma once

#include <cstdint>

#include <hwy/targets.h>

namespace selvage::testing {

/// While it lives, loops in lanes run on this unit.
class ChosenVectorUnit {
 public:
  explicit ChosenVectorUnit(std::int64_t target) { hwy::SetSupportedTargetsForTest(target); }
  ~ChosenVectorUnit() { hwy::SetSupportedTargetsForTest(0); }  // the best again
  ChosenVectorUnit(const ChosenVectorUnit&) = delete;
  ChosenVectorUnit& operator=(const ChosenVectorUnit&) = delete;
};

/// Calls body(name) on each vector unit of this machine.
template <typename Body>
void on_every_vector_unit(const Body& body) {
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    const ChosenVectorUnit unit(target);
    body(hwy::TargetName(target));
  }
}

}  // namespace selvage::testing
