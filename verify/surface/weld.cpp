#include "verify/surface/weld.h"

#include <algorithm>
#include <bit>
#include <numeric>
#include <stdexcept>
#include <utility>

namespace selvage::verify {
namespace {

/// Equal where the coordinates are, as there is no NaN, and in no order that means anything.
using Place = std::array<std::uint64_t, 3>;

/// Compared as bits a subnormal is never taken for a zero, whatever the processor is set to.
std::uint64_t bits_of(double coordinate) {
  constexpr std::uint64_t kMinusZero = std::uint64_t{1} << 63;
  const auto bits = std::bit_cast<std::uint64_t>(coordinate);
  return bits == kMinusZero ? 0 : bits;
}

Place place_of(const Point& p) { return {bits_of(p[0]), bits_of(p[1]), bits_of(p[2])}; }

/// Splits vertices into those at one place; those without a partner are dropped.
void split(std::vector<std::int32_t> vertices, std::span<const Point> V, std::vector<std::vector<std::int32_t>>& out) {
  std::vector<std::pair<Place, std::int32_t>> keyed;
  keyed.reserve(vertices.size());
  for (const std::int32_t v : vertices) keyed.emplace_back(place_of(V[static_cast<std::size_t>(v)]), v);
  std::sort(keyed.begin(), keyed.end());
  for (std::size_t begin = 0, end = 0; begin < keyed.size(); begin = end) {
    while (end < keyed.size() && keyed[end].first == keyed[begin].first) ++end;
    if (end - begin < 2) continue;
    std::vector<std::int32_t>& together = out.emplace_back();
    for (std::size_t i = begin; i < end; ++i) together.push_back(keyed[i].second);
  }
}

}  // namespace

void Weld::narrow(std::span<const Point> V) {
  std::vector<std::vector<std::int32_t>> before = std::move(together_);
  together_.clear();
  if (!has_frame_) {
    has_frame_ = true;
    vertex_count_ = V.size();
    std::vector<std::int32_t> all(V.size());
    std::iota(all.begin(), all.end(), 0);
    before = {std::move(all)};
  }
  if (V.size() != vertex_count_) throw std::invalid_argument("welding needs the same vertices in all frames");
  for (std::vector<std::int32_t>& vertices : before) split(std::move(vertices), V, together_);
}

std::vector<std::int32_t> Weld::representatives() const {
  std::vector<std::int32_t> result(vertex_count_);
  std::iota(result.begin(), result.end(), 0);
  for (const auto& vertices : together_) {
    for (const std::int32_t v : vertices) result[static_cast<std::size_t>(v)] = vertices.front();
  }
  return result;
}

WeldedFaces weld_faces(std::span<const std::array<std::int32_t, 3>> triangles,
                       std::span<const std::int32_t> representatives) {
  WeldedFaces welded;
  welded.triangles.reserve(triangles.size());
  for (std::size_t f = 0; f < triangles.size(); ++f) {
    std::array<std::int32_t, 3> face = triangles[f];
    bool collapsed = false;
    for (std::int32_t& corner : face) {
      const std::int32_t name = representatives[static_cast<std::size_t>(corner)];
      if (name == corner) continue;
      const bool is_taken = std::find(face.begin(), face.end(), name) != face.end();
      collapsed = collapsed || is_taken;
      if (!is_taken) corner = name;
    }
    if (collapsed) welded.collapsed.push_back(static_cast<std::int32_t>(f));
    welded.triangles.push_back(face);
  }
  return welded;
}

}  // namespace selvage::verify
