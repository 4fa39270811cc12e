#include "io/points.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "io/fail.h"
#include "io/file/byte_order.h"
#include "io/file/fp_guard.h"

namespace selvage::io {
namespace {

/// Least magnitude that rounds to infinity: half a step beyond the largest float, where the tie goes up.
constexpr double kFloatOverflow = 0x1.ffffffp+127;
static_assert(kFloatOverflow > static_cast<double>(std::numeric_limits<float>::max()));

bool overflows(double value) { return !(std::abs(value) < kFloatOverflow); }
double nearest_float(double value) { return static_cast<double>(static_cast<float>(value)); }

template <typename Item>
void append_as(std::string& bytes, const Points& points) {
  bytes.reserve(bytes.size() + points.size() * 3 * sizeof(Item));
  for (const auto& point : points) {
    for (const double x : point) append(bytes, static_cast<Item>(x), std::endian::little);
  }
}

}  // namespace

std::optional<std::size_t> first_not_finite(const Points& points) {
  const auto is_finite = [](const auto& point) {
    return std::ranges::all_of(point, [](double x) { return std::isfinite(x); });
  };
  const auto found = std::ranges::find_if_not(points, is_finite);
  if (found == points.end()) return std::nullopt;
  return static_cast<std::size_t>(found - points.begin());
}

void append_points(std::string& bytes, const Points& points, Precision precision, const std::string& name) {
  const FpGuard guard;
  if (precision == Precision::kFloat64) return append_as<double>(bytes, points);
  for (std::size_t vertex = 0; vertex < points.size(); ++vertex) {
    for (const double x : points[vertex]) {
      if (!overflows(x) && nearest_float(x) == x) continue;
      bad_input(name, "vertex " + std::to_string(vertex) + " is not on the float32 lattice; record float64");
    }
  }
  append_as<float>(bytes, points);
}

void round_to_float32(Points& points, Rounding& rounding, const std::string& name) {
  const FpGuard guard;
  for (std::size_t vertex = 0; vertex < points.size(); ++vertex) {
    for (double& x : points[vertex]) {
      if (overflows(x)) {
        bad_input(name, "vertex " + std::to_string(vertex) + " is beyond the range of float32; rescale it");
      }
      const double rounded = nearest_float(x);
      ++rounding.values;
      rounding.changed += rounded != x ? 1 : 0;
      rounding.largest_change = std::max(rounding.largest_change, std::abs(rounded - x));
      x = rounded;
    }
  }
}

}  // namespace selvage::io
