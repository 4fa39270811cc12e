#include "page/scene.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "page/json.h"
#include "page/packed.h"

namespace selvage::page {
namespace {

/// ldexp in two steps: the factor alone may leave the doubles.
double scaled(double x, int exponent) { return std::ldexp(std::ldexp(x, exponent / 2), exponent - exponent / 2); }

constexpr double kLargestInteger = 2147483647;

}  // namespace

void Box::add(const Point& point) {
  for (std::size_t k = 0; k < 3; ++k) {
    lower[k] = std::min(lower[k], point[k]);
    upper[k] = std::max(upper[k], point[k]);
  }
}

ViewUnits ViewUnits::of(const Box& box) {
  ViewUnits units;
  if (box.is_empty()) return units;
  double largest = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    largest = std::max({largest, std::abs(box.lower[k]), std::abs(box.upper[k])});
  }
  if (largest == 0) return units;
  units.exponent = -std::ilogb(largest) - 1;  // the largest becomes at least 1/2 and less than 1
  double diagonal = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const double lower = scaled(box.lower[k], units.exponent), upper = scaled(box.upper[k], units.exponent);
    units.origin[k] = (lower + upper) / 2;
    diagonal = std::hypot(diagonal, upper - lower);
  }
  if (diagonal > 0) units.radius = diagonal / 2;
  return units;
}

Point ViewUnits::to_view(const Point& x) const {
  Point view;
  for (std::size_t k = 0; k < 3; ++k) view[k] = (scaled(x[k], exponent) - origin[k]) / radius;
  return view;
}

Scene::Scene(const Box& stage, int bits, Prediction prediction)
    : units_(ViewUnits::of(stage)), bits_(bits), prediction_(prediction) {}

std::vector<std::int32_t> Scene::on_grid(std::span<const Point> points, std::int64_t& moved) const {
  std::vector<std::int32_t> grid;
  grid.reserve(3 * points.size());
  for (const Point& point : points) {
    bool is_moved = false;
    for (const double x : units_.to_view(point)) {
      const double steps = std::nearbyint(std::ldexp(x, bits_));
      const double kept = std::clamp(steps, -kLargestInteger, kLargestInteger);
      is_moved = is_moved || kept != steps;
      grid.push_back(static_cast<std::int32_t>(kept));
    }
    if (is_moved) ++moved;
  }
  return grid;
}

bool Scene::add_frame(const SceneFrame& frame, std::size_t byte_limit) {
  Surface surface;
  for (const int bodies : {0, 1}) {
    for (std::size_t f = 0; f < frame.triangles.size(); ++f) {
      if (frame.is_body[f] == bodies) surface.triangles.push_back(frame.triangles[f]);
    }
    if (bodies == 0) surface.cloth_count = surface.triangles.size();
  }
  const bool is_new = surfaces_.empty() || surface.triangles != surfaces_.back().triangles ||
                      surface.cloth_count != surfaces_.back().cloth_count;
  if (is_new) {
    std::vector<std::int32_t> corners;
    for (const Triangle& triangle : surface.triangles) corners.insert(corners.end(), triangle.begin(), triangle.end());
    surface.packed = packed_integers(corners, 3);
  }
  std::int64_t moved = 0;
  std::vector<std::int32_t> grid = on_grid(frame.points, moved);
  const bool predicted = prediction_ == Prediction::kPrevious && !is_new && grid.size() == previous_.size();
  std::string packed;
  if (predicted) {
    std::vector<std::int32_t> difference(grid.size());
    for (std::size_t i = 0; i < grid.size(); ++i) {
      difference[i] =
          static_cast<std::int32_t>(static_cast<std::uint32_t>(grid[i]) - static_cast<std::uint32_t>(previous_[i]));
    }
    packed = packed_integers(difference, 3);
  } else {
    packed = packed_integers(grid, 3);
  }
  const std::size_t bytes = bytes_ + surface.packed.size() + packed.size();
  if (bytes > byte_limit) return false;
  bytes_ = bytes;
  moved_points_ += moved;
  if (is_new) surfaces_.push_back(std::move(surface));
  frames_.push_back({"{\"frame\": " + std::to_string(frame.number) + ", \"name\": " + json_string(frame.name) +
                         ", \"time\": " + json_number(frame.time) +
                         ", \"surface\": " + std::to_string(surfaces_.size() - 1) +
                         ", \"predicted\": " + (predicted ? "true" : "false") + "}",
                     std::move(packed)});
  previous_ = std::move(grid);
  return true;
}

double Scene::grid_step() const { return scaled(std::ldexp(units_.radius, -bits_), -units_.exponent); }

void Scene::add_to(Page& page) const {
  std::string json = "{\"bits\": " + std::to_string(bits_) + ", \"exponent\": " + std::to_string(units_.exponent) +
                     ", \"radius\": " + json_number(units_.radius) + ", \"origin\": [";
  for (std::size_t k = 0; k < 3; ++k) json += (k > 0 ? ", " : "") + json_number(units_.origin[k]);
  json += "],\n\"surfaces\": [";
  for (std::size_t i = 0; i < surfaces_.size(); ++i) {
    json += (i > 0 ? ", " : "") + std::string("{\"cloth\": ") + std::to_string(surfaces_[i].cloth_count) + "}";
    page.add_packed("surface-" + std::to_string(i), surfaces_[i].packed);
  }
  json += "],\n\"frames\": [";
  for (std::size_t i = 0; i < frames_.size(); ++i) {
    json += (i > 0 ? ",\n" : "\n") + frames_[i].label;
    page.add_packed("frame-" + std::to_string(i), frames_[i].packed);
  }
  page.add_data("scene", json + "]}");
}

}  // namespace selvage::page
