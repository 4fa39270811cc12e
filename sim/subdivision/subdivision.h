// Collision-aware subdivision of recorded frames (paper, section 8): no frame depends on another.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "io/mesh_data.h"
#include "kernel/kernel.h"
#include "sim/subdivision/loop_rules.h"

namespace selvage::sim {

struct SubdivisionCounts {
  std::int64_t rounds = 0;   ///< searches for collisions beyond the first of each level
  std::int64_t stopped = 0;  ///< vertices that did not reach their smooth place
};

/// Whether so many faces, split into four `levels` times, are not more than a mesh may have. PRE: levels >= 0.
[[nodiscard]] bool may_subdivide(std::size_t face_count, std::int32_t levels);

class Subdivision {
 public:
  /// Throws std::invalid_argument where `levels` < 1, the faces become too many (may_subdivide), or a group names faces
  /// that do not exist. REQUIRES triangles as make_mesh() does. Faces of bodies are split but not smoothed: the cloth
  /// was kept off their flat faces.
  Subdivision(const io::Triangles& triangles, std::int32_t vertex_count, const std::vector<io::Group>& groups,
              std::int32_t levels);
  ~Subdivision();

  [[nodiscard]] const io::Triangles& triangles() const;
  [[nodiscard]] std::int32_t vertex_count() const;
  [[nodiscard]] const std::vector<io::Group>& groups() const { return groups_; }

  /// The finest positions. PRE: V is free of intersections. At every level the vertices start on the surface, at the
  /// midpoints of edges, and move towards their smooth places; the kernel tests this motion, and what would touch stops
  /// just before ("as if they had inelastically collided"), until nothing does. So every level is as free of
  /// intersections as its start; that midpoints are rounded, by half an ulp, is what an exact check of the result has
  /// to cover. May be called from several threads.
  /// `stop` is asked in between; where it says so, the result is empty.
  [[nodiscard]] Positions operator()(const PositionsRef& V, SubdivisionCounts& counts,
                                     const std::function<bool()>& stop = {}) const;

 private:
  struct Level;
  std::vector<std::unique_ptr<Level>> levels_;
  std::vector<io::Group> groups_;
};

}  // namespace selvage::sim
