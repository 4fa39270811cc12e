// Vertices that follow a script instead of the dynamics: rigid bodies, figures that a sequence animates, and pins of
// cloth.
#pragma once

#include <limits>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "sim/body_sequence.h"
#include "sim/linkage.h"

namespace selvage::sim {

class Collider {
 public:
  /// In the frame of the linkage: as many rows as vertices, or what animates them.
  using Local = std::variant<Positions, std::shared_ptr<const BodySequence>>;

  /// Vertex vertices[i] is at row i of `local` at t, transformed by linkage.at(t), until release_s.
  Collider(std::string name, std::vector<VertexId> vertices, Local local, Linkage linkage,
           double release_s = std::numeric_limits<double>::infinity());

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] const std::vector<VertexId>& vertices() const { return vertices_; }
  [[nodiscard]] bool holds(double time_s) const { return time_s < release_s_; }
  /// Null where it is rigid.
  [[nodiscard]] const BodySequence* sequence() const;
  /// Its vertices, in their order, at the time: the script exactly, rounded to the precision of the state. Throws
  /// io::Error where a frame of the sequence cannot be read any more.
  [[nodiscard]] Positions placed_at(double time_s, bool round_to_float32) const;
  /// Writes them to their rows.
  void place_at(double time_s, bool round_to_float32, Positions& x) const;

 private:
  std::string name_;
  std::vector<VertexId> vertices_;
  Local local_;
  Linkage linkage_;
  double release_s_;
};

}  // namespace selvage::sim
