#include "cli/render/renderer.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include <Eigen/Geometry>
#include <oneapi/tbb/parallel_for.h>

#include "cli/render/depth_map.h"
#include "cli/render/triangle_raster.h"

namespace selvage::cli {
namespace {

constexpr int kSamples = 2;                                      // a side: 2 by 2 a pixel
constexpr int kSunMapSize = 1536, kSunBlur = 1;                  // texels
constexpr int kSkyLights = 64, kSkyMapSize = 256, kSkyBlur = 0;  // so many that their sharp shadows blend
constexpr std::int32_t kNoFace = -1;
constexpr int kBandSamples = 1 << 21;  // 80 MiB, about a second's work; small pictures are one band

// Linear light. Warm and cool differ in hue and in brightness, so that they survive greyscale and colour blindness.
const Vec3 kClothFront(0.68, 0.14, 0.045), kClothBack(0.035, 0.17, 0.36), kBody(0.40, 0.40, 0.42);
const Vec3 kHorizon(0.80, 0.83, 0.87), kZenith(0.70, 0.76, 0.84);
const Vec3 kSunColour = 2.1 * Vec3(1.0, 0.95, 0.86), kSkyColour = 0.95 * Vec3(0.88, 0.94, 1.0);

struct Light {
  Vec3 direction, colour;
  DepthMap shadow;
};

// The sun, and a spiral of directions over the upper half sphere (the golden angle spreads them evenly).
std::vector<Light> make_lights(const RenderSurface& surface, const View& view, const Bounds& stage) {
  Bounds region = stage;
  const Vec3 reach = Vec3::Constant(0.6 * stage.radius());  // bodies around the cloth cast shadows on it
  region.add(stage.lower - reach);
  region.add(stage.upper + reach);
  const Vec3 up = up_of(view), east(1, 0, 0), north = up.cross(east);
  const auto towards = [&](double azimuth, double height) {
    return Vec3(std::sqrt(1 - height * height) * (std::cos(azimuth) * east + std::sin(azimuth) * north) + height * up);
  };
  std::vector<Light> lights;
  const double sun_azimuth = (view.azimuth_deg - 62) * std::numbers::pi / 180;  // over the viewer's left shoulder
  lights.push_back({towards(sun_azimuth, 0.72), kSunColour,
                    DepthMap(surface, towards(sun_azimuth, 0.72), region, kSunMapSize, kSunBlur)});
  const double golden_angle = std::numbers::pi * (3 - std::sqrt(5.0));
  for (int i = 0; i < kSkyLights; ++i) {
    const Vec3 direction = towards(golden_angle * i, 0.08 + 0.9 * (i + 0.5) / kSkyLights);
    lights.push_back(
        {direction, 2.0 / kSkyLights * kSkyColour, DepthMap(surface, direction, region, kSkyMapSize, kSkyBlur)});
  }
  return lights;
}

struct Sample {
  std::int32_t face = kNoFace;
  double depth = std::numeric_limits<double>::infinity();
  Eigen::Vector3d weight = Eigen::Vector3d::Zero();  ///< on the face, in space
};

// A corner of a clipped triangle: where it is, and its weights on the whole triangle.
struct Corner {
  Vec3 camera;
  Eigen::Vector3d weight;
};

// Nearest face at every sample of a band of rows. Faces that reach behind the near plane are cut there.
class DepthBuffer {
 public:
  DepthBuffer(const RenderSurface& surface, const Camera& camera, int width)
      : surface_(surface), camera_(camera), width_(width) {
    for (const Vec3& point : surface.points) seen_.push_back(camera.to_camera(point));
  }

  /// Goes on to these rows; those before are forgotten.
  void fill(Rows rows) {
    rows_ = rows;
    samples_.assign(static_cast<std::size_t>(width_) * static_cast<std::size_t>(rows.end - rows.begin), Sample{});
    for (std::size_t f = 0; f < surface_.triangles.size(); ++f) {
      std::vector<Corner> polygon;
      for (std::size_t k = 0; k < 3; ++k) {
        polygon.push_back({seen_[static_cast<std::size_t>(surface_.triangles[f][k])],
                           Eigen::Vector3d::Unit(static_cast<Eigen::Index>(k))});
      }
      polygon = clip(polygon);
      for (std::size_t k = 2; k < polygon.size(); ++k) {
        draw(static_cast<std::int32_t>(f), {polygon[0], polygon[k - 1], polygon[k]});
      }
    }
  }
  [[nodiscard]] const Sample& at(int x, int y) const { return samples_[index(x, y)]; }

 private:
  [[nodiscard]] std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y - rows_.begin) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
  }

  [[nodiscard]] std::vector<Corner> clip(const std::vector<Corner>& polygon) const {
    std::vector<Corner> kept;
    for (std::size_t k = 0; k < polygon.size(); ++k) {
      const Corner &from = polygon[k], &to = polygon[(k + 1) % polygon.size()];
      const double a = from.camera.z() - camera_.near_depth(), b = to.camera.z() - camera_.near_depth();
      if (a >= 0) kept.push_back(from);
      if ((a < 0) != (b < 0)) {
        const double s = a / (a - b);
        kept.push_back({from.camera + s * (to.camera - from.camera), from.weight + s * (to.weight - from.weight)});
      }
    }
    return kept;
  }

  void draw(std::int32_t face, const std::array<Corner, 3>& corner) {
    std::array<Eigen::Vector2d, 3> screen;
    for (std::size_t k = 0; k < 3; ++k) screen[k] = camera_.to_screen(corner[k].camera);
    for_each_covered(screen, width_, rows_, [&](int x, int y, const Eigen::Vector3d& flat) {
      // Weights in space are those on the screen divided by the depths.
      Eigen::Vector3d w(flat[0] / corner[0].camera.z(), flat[1] / corner[1].camera.z(), flat[2] / corner[2].camera.z());
      const double depth = 1 / w.sum();
      w *= depth;
      Sample& sample = samples_[index(x, y)];
      if (!(depth < sample.depth)) return;
      sample = {face, depth, w[0] * corner[0].weight + w[1] * corner[1].weight + w[2] * corner[2].weight};
    });
  }

  const RenderSurface& surface_;
  const Camera& camera_;
  int width_;
  Rows rows_{0, 0};
  std::vector<Vec3> seen_;  ///< the points, as the camera has them
  std::vector<Sample> samples_;
};

class Shader {
 public:
  Shader(const RenderSurface& surface, const Camera& camera, const View& view, const Bounds& stage)
      : surface_(surface), camera_(camera), lights_(make_lights(surface, view, stage)), stage_(stage) {}

  [[nodiscard]] Vec3 background(double height) const { return kHorizon + height * (kZenith - kHorizon); }

  [[nodiscard]] Vec3 colour(const Sample& sample, double height) const {
    if (sample.face == kNoFace) return background(height);
    const auto& t = surface_.triangles[static_cast<std::size_t>(sample.face)];
    std::array<Vec3, 3> corner;
    Vec3 point = Vec3::Zero(), smooth = Vec3::Zero();
    for (std::size_t k = 0; k < 3; ++k) {
      corner[k] = surface_.points[static_cast<std::size_t>(t[k])];
      point += sample.weight[static_cast<Eigen::Index>(k)] * corner[k];
      smooth += sample.weight[static_cast<Eigen::Index>(k)] * surface_.normals[static_cast<std::size_t>(t[k])];
    }
    const Vec3 to_eye = (camera_.eye() - point).normalized();
    Vec3 flat = (corner[1] - corner[0]).cross(corner[2] - corner[0]).normalized();
    const bool front = flat.dot(to_eye) >= 0;
    if (!front) flat = -flat;
    if (smooth.dot(flat) < 0) smooth = -smooth;
    const Vec3 normal = smooth.norm() > 0 ? smooth.normalized() : flat;
    const bool body = surface_.is_body[static_cast<std::size_t>(sample.face)] != 0;
    const Vec3 lit = albedo(body, front).cwiseProduct(light_at(point, normal));
    return body ? fade(lit, point, height) : lit;
  }

 private:
  [[nodiscard]] static Vec3 albedo(bool body, bool front) { return body ? kBody : (front ? kClothFront : kClothBack); }

  [[nodiscard]] Vec3 light_at(const Vec3& point, const Vec3& normal) const {
    Vec3 sum = 0.10 * kSkyColour;  // light that came by more than one reflection
    for (const Light& light : lights_) {
      const double cosine = normal.dot(light.direction);
      if (cosine > 0) sum += cosine * light.shadow.light_at(point, normal) * light.colour;
    }
    return sum;
  }

  // A wide floor goes over into the background far from the cloth instead of ending in an edge.
  [[nodiscard]] Vec3 fade(const Vec3& lit, const Vec3& point, double height) const {
    const double distance = (point - stage_.center()).norm() / stage_.radius();
    const double s = std::clamp((distance - 1.2) / 1.8, 0.0, 1.0);
    return lit + s * s * (3 - 2 * s) * (background(height) - lit);
  }

  const RenderSurface& surface_;
  const Camera& camera_;
  std::vector<Light> lights_;
  Bounds stage_;
};

// Linear light to 8 bits: the curve x / (1 + x) scaled so that 1 stays below white, then the sRGB transfer function.
std::uint8_t to_byte(double linear) {
  const double mapped = linear * (1 + linear / 9) / (1 + linear);
  const double srgb = mapped <= 0.0031308 ? 12.92 * mapped : 1.055 * std::pow(mapped, 1 / 2.4) - 0.055;
  return static_cast<std::uint8_t>(std::lround(255 * std::clamp(srgb, 0.0, 1.0)));
}

std::optional<io::Picture> draw(const RenderSurface& surface, const View& view, const Stage& stage, int width,
                                int height, const std::function<bool()>& go_on) {
  const int samples_wide = kSamples * width, samples_high = kSamples * height;
  const Camera camera(view, stage, samples_wide, samples_high);
  DepthBuffer buffer(surface, camera, samples_wide);
  const Shader shader(surface, camera, view, stage.bounds);
  io::Picture picture{
      width, height, std::vector<std::uint8_t>(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 3)};
  const auto draw_row = [&](int y) {
    std::uint8_t* out = &picture.rgb[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) * 3];
    for (int x = 0; x < width; ++x) {
      Vec3 sum = Vec3::Zero();
      for (int j = 0; j < kSamples; ++j) {
        for (int i = 0; i < kSamples; ++i) {
          const int row = kSamples * y + j;
          sum += shader.colour(buffer.at(kSamples * x + i, row), 1 - double(row) / samples_high);
        }
      }
      for (int k = 0; k < 3; ++k) *out++ = to_byte(sum[k] / (kSamples * kSamples));
    }
  };
  const int band = std::max(1, kBandSamples / (samples_wide * kSamples));
  for (int begin = 0; begin < height; begin += band) {
    if (!go_on()) return std::nullopt;
    const int end = std::min(height, begin + band);
    buffer.fill({kSamples * begin, kSamples * end});
    tbb::parallel_for(begin, end, draw_row);
  }
  return picture;
}

}  // namespace

std::optional<io::Picture> render(const RenderSurface& surface, const View& view, const Stage& stage, int width,
                                  int height, const std::function<bool()>& go_on) {
  const int exponent = drawing_exponent(stage);
  if (exponent == 0) return draw(surface, view, stage, width, height, go_on);
  return draw(scaled(surface, exponent), view, scaled(stage, exponent), width, height, go_on);
}

}  // namespace selvage::cli
