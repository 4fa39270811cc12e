// Floating-point environments in which the libraries must answer as in a sound one.
#pragma once

#include <cfenv>
#include <vector>

namespace selvage::cli {

struct HostileFp {
  const char* name;
  int rounding;  ///< as for fesetround()
  bool flushes;  ///< subnormal results and operands
};
[[nodiscard]] const std::vector<HostileFp>& hostile_environments();

/// Sets the calling thread's environment for a scope.
class HostileScope {
 public:
  explicit HostileScope(const HostileFp& hostile) noexcept;
  HostileScope(const HostileScope&) = delete;
  HostileScope& operator=(const HostileScope&) = delete;
  ~HostileScope();

 private:
  std::fenv_t found_{};
};

}  // namespace selvage::cli
