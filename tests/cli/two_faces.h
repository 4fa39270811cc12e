// The smallest mesh that can intersect itself.
#pragma once

#include <string>

#include <fmt/format.h>

namespace selvage::testing {

/// A face at z = 0 and, above it by `height`, another, in `unit`s; as OBJ.
inline std::string two_faces(double height, double unit = 1) {
  return fmt::format("v 0 0 0\nv {3} 0 0\nv 0 {3} 0\nf 1 2 3\nv {1} {1} {0}\nv {2} {1} {0}\nv {1} {2} {0}\nf 4 5 6\n",
                     height * unit, unit, 2 * unit, 4 * unit);
}

}  // namespace selvage::testing
