// A broad phase of another library. Each is a shared object of its own, loaded by name and never installed: the program
// that people get holds neither CGAL's GPL part nor Embree.
#pragma once

#include <span>

#include "kernel/box.h"
#include "kernel/candidates.h"

namespace selvage::bench {

/// The boxes of all features of a mesh, by number.
struct FeatureBoxes {
  const Mesh* mesh;
  std::span<const Box> vertices, edges, faces;
};

class Rival {
 public:
  virtual ~Rival() = default;
  Rival() = default;
  Rival(const Rival&) = delete;
  Rival& operator=(const Rival&) = delete;

  /// Takes over the boxes and builds whatever is built once.
  virtual void build(const FeatureBoxes& boxes) = 0;
  /// The same mesh elsewhere. Returns whether the library can do this cheaper than build(), and did.
  virtual bool refit(const FeatureBoxes& boxes) = 0;
  /// Pairs without a common vertex whose boxes overlap as far as the library can tell, sorted and unique.
  [[nodiscard]] virtual Candidates query() = 0;
};

template <std::size_t N, std::size_t M>
bool share_vertex(const std::array<VertexId, N>& a, const std::array<VertexId, M>& b) {
  return std::any_of(a.begin(), a.end(), [&](VertexId v) { return std::find(b.begin(), b.end(), v) != b.end(); });
}

/// What a rival's shared object exports under the name "selvage_make_rival"; the caller owns the result.
using MakeRival = Rival* (*)(int thread_count);

}  // namespace selvage::bench
