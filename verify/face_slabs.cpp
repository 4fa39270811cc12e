#include "verify/face_slabs.h"

#include <algorithm>
#include <cmath>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "verify/direction.h"
#include "verify/fp_guard.h"

namespace selvage::verify {
namespace {

std::size_t at(std::int32_t index) { return static_cast<std::size_t>(index); }

/// More than the errors of two computed u . x, for any direction u that is taken as it is and any |x_k| <= largest[k].
/// Each errs by gamma(3) sum |u_k x_k| + 3 * 2^-1075 at most (Higham 2002, Lemma 3.1); 2^-49 = 16 unit roundoffs leave
/// room for both, for the rounding of this margin, and for one more addition of it. Overflow makes it infinite or NaN,
/// and then no comparison with it succeeds.
double margin(const Point& u, const Point& largest) {
  return 0x1p-49 * (std::abs(u[0]) * largest[0] + std::abs(u[1]) * largest[1] + std::abs(u[2]) * largest[2]) +
         0x1p-1070;
}

}  // namespace

FaceSlabs::FaceSlabs(std::span<const std::array<std::int32_t, 3>> triangles, std::span<const Point> V)
    : triangles_(triangles), V_(V), slabs_(triangles.size()) {
  for (const Point& p : V) {
    for (std::size_t k = 0; k < 3; ++k) largest_[k] = std::max(largest_[k], std::abs(p[k]));
  }
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, triangles.size()), [&](const auto& range) {
    const FpGuard guard;
    for (std::size_t f = range.begin(); f < range.end(); ++f) {
      const Corners x = corners(static_cast<std::int32_t>(f));
      const Point n = cross(difference(x.b, x.a), difference(x.c, x.a));
      const double p = dot(n, x.a), q = dot(n, x.b), r = dot(n, x.c);
      const double m = margin(n, largest_);
      slabs_[f] = {n, std::min({p, q, r}) - m, std::max({p, q, r}) + m};
    }
  });
}

FaceSlabs::Corners FaceSlabs::corners(std::int32_t face) const {
  const auto& [a, b, c] = triangles_[at(face)];
  return {V_[at(a)], V_[at(b)], V_[at(c)]};
}

bool FaceSlabs::outside(const Slab& slab, const Corners& x) {
  const double p = dot(slab.direction, x.a), q = dot(slab.direction, x.b), r = dot(slab.direction, x.c);
  return std::min(std::min(p, q), r) > slab.high || std::max(std::max(p, q), r) < slab.low;
}

bool FaceSlabs::center_plane_between(const Corners& x, const Corners& y) const {
  Point u;
  for (std::size_t k = 0; k < 3; ++k) u[k] = (x.a[k] + x.b[k] + x.c[k]) - (y.a[k] + y.b[k] + y.c[k]);
  const double lowest = std::min(std::min(dot(u, x.a), dot(u, x.b)), dot(u, x.c));
  const double highest = std::max(std::max(dot(u, y.a), dot(u, y.b)), dot(u, y.c));
  return lowest - highest > margin(u, largest_);
}

bool FaceSlabs::triage_apart(std::int32_t f, std::int32_t g) const {
  const Corners x = corners(f), y = corners(g);
  return outside(slabs_[at(f)], y) || outside(slabs_[at(g)], x) || center_plane_between(x, y);
}

}  // namespace selvage::verify
