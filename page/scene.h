// Meshes for the 3D view of a page: positions on a grid, for looking at and for nothing else.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "page/page.h"

namespace selvage::page {

using Point = std::array<double, 3>;
using Triangle = std::array<std::int32_t, 3>;

struct Box {
  Point lower, upper;

  Box() {
    lower.fill(std::numeric_limits<double>::infinity());
    upper.fill(-std::numeric_limits<double>::infinity());
  }
  void add(const Point& point);
  [[nodiscard]] bool is_empty() const { return !(lower[0] <= upper[0]); }
};

/// x is shown at (2^exponent x - origin) / radius, which brings a box to about the unit ball, whatever its size.
struct ViewUnits {
  int exponent = 0;
  Point origin{};
  double radius = 1;

  [[nodiscard]] static ViewUnits of(const Box& box);
  [[nodiscard]] Point to_view(const Point& x) const;
};

/// What the view shows at one instant. The spans are read during the call only.
struct SceneFrame {
  std::int64_t number = 0;
  std::string name;
  double time = 0;
  std::span<const Point> points;
  std::span<const Triangle> triangles;
  std::span<const std::uint8_t> is_body;  ///< of each triangle, 0 or 1
};

/// kNone: a frame is packed by itself; kPrevious: as the difference from the frame before, which is smaller where
/// frames follow each other closely.
enum class Prediction : std::uint8_t { kNone, kPrevious };

class Scene {
 public:
  /// The view is about `stage`, the box of what is to be looked at. Positions are rounded to 2^-bits of its radius, and
  /// moved to the border where they are 2^(31 - bits) radii away.
  Scene(const Box& stage, int bits, Prediction prediction);

  /// Adds the frame unless bytes() would then exceed `byte_limit`: then the scene stays as it is, and the answer is
  /// false. Frames with the same triangles as the one before share them.
  [[nodiscard]] bool add_frame(const SceneFrame& frame, std::size_t byte_limit);

  [[nodiscard]] std::size_t bytes() const { return bytes_; }  ///< of the page
  [[nodiscard]] std::size_t frame_count() const { return frames_.size(); }
  /// The rounding of positions, in the unit of the input: half of this at most on each axis.
  [[nodiscard]] double grid_step() const;
  /// How many positions were so far away that they were moved.
  [[nodiscard]] std::int64_t moved_points() const { return moved_points_; }

  /// Data "scene", and packed data "surface-K" and "frame-I".
  void add_to(Page& page) const;

 private:
  struct Surface {
    std::vector<Triangle> triangles;  ///< cloth first, then bodies
    std::size_t cloth_count = 0;
    std::string packed;
  };
  struct Stored {
    std::string label;  ///< JSON
    std::string packed;
  };
  [[nodiscard]] std::vector<std::int32_t> on_grid(std::span<const Point> points, std::int64_t& moved) const;

  ViewUnits units_;
  int bits_;
  Prediction prediction_;
  std::vector<Surface> surfaces_;
  std::vector<Stored> frames_;
  std::vector<std::int32_t> previous_;  ///< on the grid
  std::size_t bytes_ = 0;
  std::int64_t moved_points_ = 0;
};

}  // namespace selvage::page
