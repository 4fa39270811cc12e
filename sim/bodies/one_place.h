// Vertices of a body that lie at one place: files of separate triangles have one for each corner of a face, and writers
// split them at seams.
#pragma once

#include <vector>

#include "kernel/types.h"

namespace selvage::sim {

/// Shown every frame of a body, knows which of its vertices never part. Places are equal as numbers are: -0 is 0.
class OnePlace {
 public:
  /// A frame more, as many rows as in the first, all finite. The first one costs O(#V log #V), the others a share of
  /// it: only vertices that have not parted yet are looked at.
  void narrow(const Positions& x);

  /// #V: the lowest-numbered vertex at the place of each, itself where it is alone.
  [[nodiscard]] const std::vector<VertexId>& first() const { return first_; }

 private:
  std::vector<VertexId> first_;
  std::vector<VertexId> together_;  ///< those that are not alone
  bool has_frame_ = false;
};

}  // namespace selvage::sim
