// A handful of questions with known answers, asked of the kernel and of the exact checker.
#pragma once

#include <string>
#include <vector>

namespace selvage::cli {

struct SelfCheck {
  int answers = 0;                 ///< that were compared
  std::vector<std::string> wrong;  ///< "kernel: subnormal contact"
};

/// In the environment of the caller. O(1), below a millisecond.
[[nodiscard]] SelfCheck run_self_check();

}  // namespace selvage::cli
