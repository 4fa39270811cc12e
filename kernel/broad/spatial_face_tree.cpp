#include "kernel/broad/spatial_face_tree.h"

#include <algorithm>
#include <cmath>

#include <tbb/blocked_range.h>
#include <tbb/parallel_invoke.h>

#include "kernel/box.h"
#include "kernel/fp_env.h"
#include "kernel/own_tasks.h"

namespace selvage {

namespace {

/// Below this many faces a task is not worth starting: splitting them takes some 100 us.
constexpr std::size_t kTaskFaces = 4096;

struct CentredFace {
  std::array<double, 3> centre;  ///< the sum of the corners at both ends: six times the mean
  FaceId face;
};

CentredFace centred(const Mesh& mesh, const PositionsRef& V_t0, const PositionsRef& V_t1, std::size_t f) {
  CentredFace result = {{0, 0, 0}, static_cast<FaceId>(f)};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    double& sum = result.centre[axis];
    for (const VertexId v : mesh.faces[f]) {
      const auto column = static_cast<Eigen::Index>(axis);
      sum += V_t0(v, column) + V_t1(v, column);
    }
    if (std::isnan(sum)) sum = 0;  // outside the domain; but nothing may run astray: the order below is total
  }
  return result;
}

class Splitter {
 public:
  explicit Splitter(std::vector<CentredFace> faces) : faces_(std::move(faces)) {
    tree_.children.resize(faces_.size() - 1);
    in_own_task([&] {
      const FpEnvGuard guard;
      split(0, faces_.size(), 0);
    });
  }
  [[nodiscard]] FaceTree take() { return std::move(tree_); }

 private:
  using Iterator = std::vector<CentredFace>::iterator;

  [[nodiscard]] Iterator at(std::size_t i) { return faces_.begin() + static_cast<std::ptrdiff_t>(i); }

  /// Makes the subtree over the faces [begin, end) and returns its root. Its inner nodes, one less than faces, are the
  /// children from `first` on, the root last: the numbers are known before the subtrees are, so tasks share nothing.
  std::int32_t split(std::size_t begin, std::size_t end, std::size_t first) {
    const std::size_t count = end - begin;
    if (count == 1) return at(begin)->face;
    std::size_t middle = begin + count / 2;
    if (count > kSpatialLeafFaces) {
      const std::size_t leaf_count = (count + kSpatialLeafFaces - 1) / kSpatialLeafFaces;
      middle = begin + leaf_count / 2 * kSpatialLeafFaces;
      const std::size_t axis = longest_axis(begin, end);
      std::nth_element(at(begin), at(middle), at(end), [axis](const CentredFace& a, const CentredFace& b) {
        return a.centre[axis] != b.centre[axis] ? a.centre[axis] < b.centre[axis] : a.face < b.face;
      });
    }
    std::array<std::int32_t, 2> children{};
    const auto left = [&] {
      const FpEnvGuard guard;  // oneTBB gives the calling thread's tasks its arena's environment, too
      children[0] = split(begin, middle, first);
    };
    const auto right = [&] {
      const FpEnvGuard guard;
      children[1] = split(middle, end, first + middle - begin - 1);
    };
    if (count < kTaskFaces) {
      left();
      right();
    } else {
      tbb::parallel_invoke(left, right);
    }
    const std::size_t node = first + count - 2;
    tree_.children[node] = children;
    return static_cast<std::int32_t>(faces_.size() + node);
  }

  [[nodiscard]] std::size_t longest_axis(std::size_t begin, std::size_t end) {
    Box bounds;
    std::for_each(at(begin), at(end), [&](const CentredFace& f) { bounds.merge({f.centre, f.centre}); });
    std::size_t longest = 0;
    for (std::size_t axis = 1; axis < 3; ++axis) {
      if (bounds.upper[axis] - bounds.lower[axis] > bounds.upper[longest] - bounds.lower[longest]) longest = axis;
    }
    return longest;
  }

  std::vector<CentredFace> faces_;
  FaceTree tree_;
};

}  // namespace

FaceTree make_spatial_face_tree(const Mesh& mesh, const PositionsRef& V_t0, const PositionsRef& V_t1) {
  std::vector<CentredFace> faces(mesh.faces.size());
  if (faces.empty()) return {};
  own_parallel_for(tbb::blocked_range<std::size_t>(0, faces.size(), kTaskFaces), [&](const auto& range) {
    const FpEnvGuard guard;
    for (std::size_t f = range.begin(); f != range.end(); ++f) faces[f] = centred(mesh, V_t0, V_t1, f);
  });
  return Splitter(std::move(faces)).take();
}

}  // namespace selvage
