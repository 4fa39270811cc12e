// One allocation of the program that fails.
#pragma once

namespace selvage::sim::testbed {

inline constexpr long kNone = -1;
/// The allocation after `before` others throws std::bad_alloc; kNone: none does.
void fail_allocation(long before);

}  // namespace selvage::sim::testbed
