// Pairs of triangles on a small lattice, made degenerate in one way each, with 0 to 3 vertices in common.
#pragma once

#include <random>

#include "verify/decision/exact_overlap.h"

namespace selvage::verify::testbed {

struct TwoTriangles {
  std::array<std::int32_t, 3> face_a, face_b;
  std::array<Point, 3> a, b;
};

/// Points 0-5, of which the faces name three each: (0,1,2) and, with the first `shared` of these, further ones.
inline TwoTriangles from_points(const std::array<Point, 6>& x, int shared) {
  TwoTriangles c{{0, 1, 2}, {}, {x[0], x[1], x[2]}, {}};
  for (int j = 0; j < 3; ++j) {
    const int name = j < shared ? j : 3 + j;
    c.face_b[static_cast<std::size_t>(j)] = name;
    c.b[static_cast<std::size_t>(j)] = x[static_cast<std::size_t>(name)];
  }
  return c;
}

/// How the six points of a case are drawn from a small lattice.
enum class OverlapFamily { kAny, kCoplanar, kFlatFirst, kFlatBoth, kCollinear, kCoincident };

inline std::array<Point, 6> draw(std::mt19937& random, OverlapFamily family, int range) {
  std::uniform_int_distribution<int> lattice(-range, range);
  const auto coordinate = [&] { return static_cast<double>(lattice(random)); };
  std::array<Point, 6> x;
  for (Point& p : x) p = {coordinate(), coordinate(), coordinate()};
  const auto put_on_line = [&](std::size_t target, std::size_t from, std::size_t to) {
    const double s = coordinate();
    for (std::size_t k = 0; k < 3; ++k) x[target][k] = x[from][k] + s * (x[to][k] - x[from][k]);
  };
  switch (family) {
    case OverlapFamily::kAny:
      break;
    case OverlapFamily::kCoplanar: {
      const double s = coordinate(), t = coordinate();
      for (Point& p : x) p[2] = s * p[0] + t * p[1];
      break;
    }
    case OverlapFamily::kFlatFirst:
      put_on_line(2, 0, 1);
      break;
    case OverlapFamily::kFlatBoth:
      put_on_line(2, 0, 1);
      put_on_line(5, random() % 2 == 0 ? 3 : 0, 4);
      break;
    case OverlapFamily::kCollinear:
      for (std::size_t i = 2; i < 6; ++i) put_on_line(i, 0, 1);
      break;
    case OverlapFamily::kCoincident:
      x[3 + random() % 3] = x[random() % 3];
      break;
  }
  return x;
}

inline constexpr OverlapFamily kOverlapFamilies[] = {OverlapFamily::kAny,       OverlapFamily::kCoplanar,
                                                     OverlapFamily::kFlatFirst, OverlapFamily::kFlatBoth,
                                                     OverlapFamily::kCollinear, OverlapFamily::kCoincident};

}  // namespace selvage::verify::testbed
