// A frame as a renderer wants it: points, smooth normals, and which faces are cloth.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include <Eigen/Core>

#include "io/mesh_data.h"

namespace selvage::cli {

using Vec3 = Eigen::Vector3d;

struct RenderSurface {
  std::vector<Vec3> points;
  io::Triangles triangles;
  std::vector<Vec3> normals;          ///< per point, unit, weighted by the areas of the faces; zero without area
  std::vector<std::uint8_t> is_body;  ///< per face
};

[[nodiscard]] RenderSurface make_render_surface(const io::MeshData& mesh);

/// An axis-aligned box of points.
struct Bounds {
  Vec3 lower = Vec3::Constant(std::numeric_limits<double>::infinity());
  Vec3 upper = Vec3::Constant(-std::numeric_limits<double>::infinity());
  void add(const Vec3& point);
  [[nodiscard]] Vec3 center() const { return (lower + upper) / 2; }
  [[nodiscard]] double radius() const { return (upper - lower).norm() / 2; }
};

/// What is to fill the picture: the points of the cloth in all the frames that are drawn.
struct Stage {
  std::vector<Vec3> points;
  Bounds bounds;
  /// The points of the cloth's faces; of all faces if there is no cloth.
  void add_cloth(const RenderSurface& surface);
};

/// Drawing takes fourth powers of lengths, which leave the doubles long before lengths do. 0 where these can be drawn
/// as they are; or else e, so that they can be once scaled by 2^e.
[[nodiscard]] int drawing_exponent(const Stage& stage);
/// By 2^exponent. What then lies farther away than can be drawn (bodies, for the stage is what fills the picture) is
/// drawn at the end of what can be.
[[nodiscard]] RenderSurface scaled(const RenderSurface& surface, int exponent);
[[nodiscard]] Stage scaled(const Stage& stage, int exponent);

}  // namespace selvage::cli
