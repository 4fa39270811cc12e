// What two faces have in common, constructed by CGAL in rational arithmetic (its LGPL parts).
#include <iterator>
#include <stdexcept>
#include <variant>
#include <vector>

// clang-format off: before all else of CGAL
#include "verify/decision/cgal_fpu.h"
// clang-format on

#include <CGAL/Gmpq.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/intersections.h>

#include "verify/arithmetic/fp_guard.h"
#include "verify/decision/second_opinion.h"

namespace selvage::verify {
namespace {

using Kernel = CGAL::Simple_cartesian<CGAL::Gmpq>;
using RationalPoint = Kernel::Point_3;
using Segment = Kernel::Segment_3;
using Triangle = Kernel::Triangle_3;
using Face = std::variant<RationalPoint, Segment, Triangle>;
using Points = std::vector<RationalPoint>;

RationalPoint rational(const Point& p) { return {CGAL::Gmpq(p[0]), CGAL::Gmpq(p[1]), CGAL::Gmpq(p[2])}; }

/// Its dimension is what its corners span: a face without area is its longest side, or a point.
Face face(const std::array<Point, 3>& corners) {
  const RationalPoint a = rational(corners[0]), b = rational(corners[1]), c = rational(corners[2]);
  if (!CGAL::collinear(a, b, c)) return Triangle(a, b, c);
  Segment longest(a, b);
  for (const Segment& side : {Segment(b, c), Segment(c, a)}) {
    if (side.squared_length() > longest.squared_length()) longest = side;
  }
  if (longest.squared_length() == 0) return a;
  return longest;
}

/// Points whose convex hull is the result of an intersection.
struct Hull {
  using result_type = Points;
  Points operator()(const RationalPoint& p) const { return {p}; }
  Points operator()(const Segment& s) const { return {s.source(), s.target()}; }
  Points operator()(const Triangle& t) const { return {t[0], t[1], t[2]}; }
  Points operator()(const Points& points) const { return points; }
};

struct Common {
  template <class A, class B>
  Points operator()(const A& a, const B& b) const {
    const auto result = CGAL::intersection(a, b);
    return result ? boost::apply_visitor(Hull(), *result) : Points();
  }
  Points operator()(const RationalPoint& p, const RationalPoint& q) const { return p == q ? Points{p} : Points(); }
  template <class B>
  Points operator()(const RationalPoint& p, const B& b) const {
    return b.has_on(p) ? Points{p} : Points();
  }
  template <class A>
  Points operator()(const A& a, const RationalPoint& p) const {
    return a.has_on(p) ? Points{p} : Points();
  }
};

bool is_within(const RationalPoint& p, const Points& shared) {
  if (shared.empty()) return false;
  if (shared.size() == 1 || shared[0] == shared[1]) return p == shared[0];
  return Segment(shared[0], shared[1]).has_on(p);
}

}  // namespace

bool second_opinion_overlap(const std::array<std::int32_t, 3>& face_a, const std::array<Point, 3>& a,
                            const std::array<std::int32_t, 3>& face_b, const std::array<Point, 3>& b) {
  const FpGuard guard;
  Points shared;
  for (std::size_t i = 0; i < 3; ++i) {
    for (const std::int32_t vertex : face_b) {
      if (vertex == face_a[i]) shared.push_back(rational(a[i]));
    }
  }
  if (shared.size() == 3) return true;
  for (const RationalPoint& p : std::visit(Common(), face(a), face(b))) {
    if (!is_within(p, shared)) return true;
  }
  return false;
}

bool second_opinion_degenerate(const std::array<Point, 3>& a) {
  const FpGuard guard;
  return CGAL::collinear(rational(a[0]), rational(a[1]), rational(a[2]));
}

}  // namespace selvage::verify
