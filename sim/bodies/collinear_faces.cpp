#include "sim/bodies/collinear_faces.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <map>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

namespace selvage::sim {
namespace {

using Face = std::array<VertexId, 3>;

/// Of its longest edge: as parallel as contact calls edges that are as near along all of their length.
constexpr double kLeastHeight = 1e-6;

struct Line {
  VertexId a, middle, b;
};

/// Of the longest edge, and the corner that is off it.
Line line_of(const Face& face, const Positions& x) {
  std::array<double, 3> length{};  // of the edge opposite to each corner
  for (std::size_t k = 0; k < 3; ++k) length[k] = (x.row(face[(k + 1) % 3]) - x.row(face[(k + 2) % 3])).stableNorm();
  const auto middle = static_cast<std::size_t>(std::ranges::max_element(length) - length.begin());
  return {face[(middle + 1) % 3], face[middle], face[(middle + 2) % 3]};
}

bool is_collinear(const Face& face, const Positions& x) {
  const Line line = line_of(face, x);
  const Vec3 a = x.row(line.a), b = x.row(line.b), middle = x.row(line.middle);
  return (middle - a).cross((b - a).stableNormalized()).stableNorm() <= kLeastHeight * (b - a).stableNorm();
}

bool has_corner(const Face& face, VertexId vertex) { return std::ranges::find(face, vertex) != face.end(); }

class CollinearFaces {
 public:
  CollinearFaces(io::Triangles triangles, const Positions& x) : x_(x), faces_(std::move(triangles)) {
    for (const Face& face : faces_) is_collinear_.push_back(is_collinear(face, x) ? 1 : 0);
    for (std::size_t f = 0; f < faces_.size(); ++f) {
      if (is_collinear_[f] == 0) continue;
      for (const VertexId corner : faces_[f]) around_[corner];
    }
    if (around_.empty()) return;
    for (std::size_t f = 0; f < faces_.size(); ++f) set(f, faces_[f]);
  }

  SplitFaces resolved() && {
    std::vector<std::size_t> left;  // from the last on: of a fan with several of them each waits for the next one
    for (std::size_t f = faces_.size(); f-- > 0;) {
      if (is_collinear_[f] != 0) left.push_back(f);
    }
    while (std::erase_if(left, [&](std::size_t f) { return resolve(f); }) > 0) {
    }
    std::erase(faces_, kGone);
    return {std::move(faces_), resolved_};
  }

 private:
  static constexpr Face kGone{-1, -1, -1};

  void set(std::size_t f, const Face& face) {
    for (const VertexId corner : faces_[f]) {
      if (const auto found = around_.find(corner); found != around_.end()) std::erase(found->second, f);
    }
    faces_[f] = face;
    for (const VertexId corner : face) {
      if (const auto found = around_.find(corner); found != around_.end()) found->second.push_back(f);
    }
  }

  /// Face f is none from now on, or one with area.
  void resolve_to(std::size_t f, const Face& face) {
    is_collinear_[f] = 0;
    ++resolved_;
    set(f, face);
  }

  /// The faces but f that hold both corners of it.
  [[nodiscard]] std::vector<std::size_t> beyond(std::size_t f, VertexId a, VertexId b) const {
    std::vector<std::size_t> found;
    std::ranges::copy_if(around_.at(a), std::back_inserter(found),
                         [&](std::size_t g) { return g != f && has_corner(faces_[g], b); });
    return found;
  }

  /// Whether it could be done.
  bool resolve(std::size_t f) {
    const auto [a, middle, b] = line_of(faces_[f], x_);
    const std::vector<std::size_t> others = beyond(f, a, b);
    const auto is_twin = [&, middle = middle](std::size_t g) { return has_corner(faces_[g], middle); };
    const bool has_twin = std::ranges::any_of(others, is_twin);
    if (has_twin || (others.empty() && !beyond(f, a, middle).empty() && !beyond(f, middle, b).empty())) {
      resolve_to(f, kGone);
      return true;
    }
    if (others.empty() || std::ranges::any_of(others, [&](std::size_t g) { return is_collinear_[g] != 0; })) {
      return false;
    }
    for (const std::size_t g : others) {
      Face first = faces_[g], second = faces_[g];
      std::ranges::replace(first, b, middle);
      std::ranges::replace(second, a, middle);
      set(g, first);
      if (g == others.front()) {
        resolve_to(f, second);
      } else {
        faces_.push_back(kGone);
        is_collinear_.push_back(0);
        set(faces_.size() - 1, second);
      }
    }
    return true;
  }

  const Positions& x_;
  io::Triangles faces_;
  std::vector<std::uint8_t> is_collinear_;               ///< #F: and not resolved yet
  std::map<VertexId, std::vector<std::size_t>> around_;  ///< the faces around each corner of a collinear one
  std::int32_t resolved_ = 0;
};

}  // namespace

SplitFaces split_at_collinear_corners(io::Triangles triangles, const Positions& x) {
  return CollinearFaces(std::move(triangles), x).resolved();
}

}  // namespace selvage::sim
