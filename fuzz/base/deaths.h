// How code under test ends that comes to no answer: words that stand where a judge would name the broken promise.
#pragma once

#include <string_view>

namespace selvage::fuzz {

inline constexpr const char* kHung = "hung";
inline constexpr const char* kThrew = "threw";
inline constexpr const char* kExited = "exited";
/// A crash has its signal behind this: "crashed-SIGSEGV".
inline constexpr const char* kCrashed = "crashed";

/// Whether it is one of these. Such a case is not shrunk: every trial could end the process that tries.
[[nodiscard]] inline bool is_death(std::string_view failure) {
  return failure == kHung || failure == kThrew || failure == kExited || failure.starts_with(kCrashed);
}

}  // namespace selvage::fuzz
