// toml++ with its assertions turned into exceptions: some of them fail on malformed files ("[ = {"), and a bad file
// must be an error line, not the end of the program. Included instead of <toml++/toml.h>. (No build here defines
// NDEBUG.)
#pragma once

#include <stdexcept>

namespace selvage::sim {

/// The library met something that its authors thought impossible.
class TomlConfusion : public std::logic_error {
 public:
  TomlConfusion() : std::logic_error("what stands here is not TOML") {}
};

constexpr void require_toml(bool holds) {
  if (!holds) throw TomlConfusion();
}

}  // namespace selvage::sim

#define TOML_ASSERT(expr) ::selvage::sim::require_toml(static_cast<bool>(expr))
#include <toml++/toml.h>
