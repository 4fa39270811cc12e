// Counts every allocation of C++ in this program.
#pragma once

#include <cstddef>
#include <functional>

namespace selvage::testing {

/// What a parser may have in use at once: this many times the file, and a constant for tables, messages and zlib's
/// window.
inline constexpr std::size_t kMaxMemory = 10, kMemoryConstant = std::size_t{256} << 10;

/// Most bytes in use at once while `body` runs, beyond those before it. One thread.
[[nodiscard]] std::size_t peak_during(const std::function<void()>& body);

}  // namespace selvage::testing
