// Surfaces that are free of intersections by construction, in units of their own spacing.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "fuzz/base/choice_source.h"
#include "kernel/types.h"

namespace selvage::fuzz {

struct SurfaceDraft {
  std::vector<Vec3> x;
  std::vector<std::array<std::int32_t, 3>> faces;
  std::vector<std::int32_t> body;  ///< a vertex: -1 cloth, else the scripted body
  double gap = 1;                  ///< the least distance between parts that are not connected, roughly
};

struct SurfaceClass {
  std::string_view name;
  SurfaceDraft (*make)(ChoiceSource&);
};

[[nodiscard]] const std::vector<SurfaceClass>& surface_classes();
/// REQUIRES that there is one of that name.
[[nodiscard]] const SurfaceClass& surface_class(std::string_view name);

}  // namespace selvage::fuzz
