// A check of one frame by another library, in a shared object of its own as in rival.h.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace selvage::bench {

class FrameRival {
 public:
  virtual ~FrameRival() = default;
  FrameRival() = default;
  FrameRival(const FrameRival&) = delete;
  FrameRival& operator=(const FrameRival&) = delete;

  /// Takes over the mesh. REQUIRES a manifold with consistent orientation.
  virtual void build(std::span<const std::array<std::int32_t, 3>> triangles,
                     std::span<const std::array<double, 3>> points) = 0;
  /// The pairs of faces that intersect, each as {smaller, larger}, sorted.
  [[nodiscard]] virtual std::vector<std::array<std::int32_t, 2>> intersections(bool in_parallel) = 0;
};

/// What the shared object exports under the name "selvage_make_frame_rival"; the caller owns the result.
using MakeFrameRival = FrameRival* (*)();

}  // namespace selvage::bench
