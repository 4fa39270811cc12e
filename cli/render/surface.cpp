#include "cli/render/surface.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

namespace selvage::cli {
namespace {

constexpr double kSmallest = 0x1p-100, kLargest = 0x1p+100;  // coordinates that are drawn as they are

Vec3 scaled(const Vec3& point, int exponent) {
  return point.unaryExpr([exponent](double x) { return std::clamp(std::ldexp(x, exponent), -kLargest, kLargest); });
}

void set_normals(RenderSurface& surface) {
  surface.normals.assign(surface.points.size(), Vec3::Zero());
  for (const auto& t : surface.triangles) {
    const Vec3 &a = surface.points[static_cast<std::size_t>(t[0])], &b = surface.points[static_cast<std::size_t>(t[1])],
               &c = surface.points[static_cast<std::size_t>(t[2])];
    const Vec3 normal = (b - a).cross(c - a);
    for (const std::int32_t corner : t) surface.normals[static_cast<std::size_t>(corner)] += normal;
  }
  for (Vec3& normal : surface.normals) normal.normalize();
}

}  // namespace

RenderSurface make_render_surface(const io::MeshData& mesh) {
  RenderSurface surface;
  for (const auto& point : mesh.points) surface.points.emplace_back(point[0], point[1], point[2]);
  surface.triangles = mesh.triangles;
  surface.is_body = io::body_faces(mesh.triangles.size(), mesh.groups);
  set_normals(surface);
  return surface;
}

void Bounds::add(const Vec3& point) {
  lower = lower.cwiseMin(point);
  upper = upper.cwiseMax(point);
}

void Stage::add_cloth(const RenderSurface& surface) {
  const bool all = std::find(surface.is_body.begin(), surface.is_body.end(), 0) == surface.is_body.end();
  std::vector<std::uint8_t> wanted(surface.points.size());
  for (std::size_t f = 0; f < surface.triangles.size(); ++f) {
    if (surface.is_body[f] != 0 && !all) continue;
    for (const std::int32_t corner : surface.triangles[f]) wanted[static_cast<std::size_t>(corner)] = 1;
  }
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    if (wanted[i] == 0) continue;
    points.push_back(surface.points[i]);
    bounds.add(surface.points[i]);
  }
}

int drawing_exponent(const Stage& stage) {
  const double largest = stage.bounds.lower.cwiseAbs().cwiseMax(stage.bounds.upper.cwiseAbs()).maxCoeff();
  return largest == 0 || (largest >= kSmallest && largest <= kLargest) ? 0 : -std::ilogb(largest);
}

RenderSurface scaled(const RenderSurface& surface, int exponent) {
  RenderSurface result = surface;
  for (Vec3& point : result.points) point = scaled(point, exponent);
  set_normals(result);
  return result;
}

Stage scaled(const Stage& stage, int exponent) {
  Stage result;
  for (const Vec3& point : stage.points) {
    result.points.push_back(scaled(point, exponent));
    result.bounds.add(result.points.back());
  }
  return result;
}

}  // namespace selvage::cli
