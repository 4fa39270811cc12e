// Which exact-arithmetic libraries a verdict rests on.
#pragma once

#include <string>

namespace selvage::verify {

/// "CGAL x.y.z, GMP x.y.z": CGAL as compiled in, GMP as loaded.
[[nodiscard]] std::string library_versions();

}  // namespace selvage::verify
