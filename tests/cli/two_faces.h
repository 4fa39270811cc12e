// The smallest mesh that can intersect itself.
#pragma once

#include <string>

#include <fmt/format.h>

namespace selvage::testing {

/// A face at z = 0 and, above it by `height`, another; as OBJ.
inline std::string two_faces(double height) {
  return fmt::format("v 0 0 0\nv 4 0 0\nv 0 4 0\nf 1 2 3\nv 1 1 {0}\nv 2 1 {0}\nv 1 2 {0}\nf 4 5 6\n", height);
}

}  // namespace selvage::testing
