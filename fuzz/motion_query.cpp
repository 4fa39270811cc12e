#include "fuzz/motion_query.h"

#include <algorithm>
#include <cmath>

#include "kernel/assert.h"
#include "verify/exact_distance.h"

namespace selvage::fuzz {
namespace {

std::array<Vec3, 3> first_three(const std::array<Vec3, 4>& x) { return {x[0], x[1], x[2]}; }

// Point p against the segment (a, b) is point p against the triangle (a, b, b), which is the union of its edges.
std::array<verify::Point, 4> raw_of(PairKind kind, const std::array<Vec3, 4>& x) {
  std::array<verify::Point, 4> points = raw(x);
  if (kind == PairKind::kSelf) points[3] = points[2];
  return points;
}

}  // namespace

std::string_view name_of(PairKind kind) {
  switch (kind) {
    case PairKind::kVf:
      return "vf";
    case PairKind::kEe:
      return "ee";
    case PairKind::kSelf:
      break;
  }
  return "self";
}

CcdResult selvage_kernel(const MotionQuery& query) {
  switch (query.kind) {
    case PairKind::kVf:
      return vf_ccd(query.x_t0, query.x_t1, query.options);
    case PairKind::kEe:
      return ee_ccd(query.x_t0, query.x_t1, query.options);
    case PairKind::kSelf:
      break;
  }
  return self_ccd(first_three(query.x_t0), first_three(query.x_t1), query.options);
}

std::array<verify::Point, 4> raw(const std::array<Vec3, 4>& x) {
  std::array<verify::Point, 4> points{};
  for (std::size_t i = 0; i < 4; ++i) points[i] = {x[i].x(), x[i].y(), x[i].z()};
  return points;
}

verify::MotionAnswer exact_motion(const MotionQuery& query, verify::Detail detail) {
  const std::array<verify::Point, 4> t0 = raw(query.x_t0);
  const std::array<verify::Point, 4> t1 = raw(query.x_t1);
  switch (query.kind) {
    case PairKind::kVf:
      return verify::exact_vf_motion(t0, t1, detail);
    case PairKind::kEe:
      return verify::exact_ee_motion(t0, t1, detail);
    case PairKind::kSelf:
      break;
  }
  return verify::exact_self_motion({t0[0], t0[1], t0[2]}, {t1[0], t1[1], t1[2]}, detail);
}

int compare_first_touch(const MotionQuery& query, double t) {
  const bool is_vf = query.kind != PairKind::kEe;
  return verify::compare_first_touch(raw_of(query.kind, query.x_t0), raw_of(query.kind, query.x_t1), is_vf, t);
}

bool within_at(const MotionQuery& query, double t, double d) {
  const std::array<verify::Point, 4> t0 = raw_of(query.kind, query.x_t0);
  const std::array<verify::Point, 4> t1 = raw_of(query.kind, query.x_t1);
  return query.kind == PairKind::kEe ? verify::ee_within_at(t0, t1, t, d) : verify::vf_within_at(t0, t1, t, d);
}

double max_coordinate(const MotionQuery& query) {
  double largest = 0;
  for (const auto* x : {&query.x_t0, &query.x_t1}) {
    for (int i = 0; i < point_count(query.kind); ++i) {
      largest = std::max(largest, (*x)[static_cast<std::size_t>(i)].cwiseAbs().maxCoeff());
    }
  }
  return largest;
}

double extent(const MotionQuery& query) {
  Vec3 low = query.x_t0[0];
  Vec3 high = low;
  for (const auto* x : {&query.x_t0, &query.x_t1}) {
    for (int i = 0; i < point_count(query.kind); ++i) {
      low = low.cwiseMin((*x)[static_cast<std::size_t>(i)]);
      high = high.cwiseMax((*x)[static_cast<std::size_t>(i)]);
    }
  }
  return (high - low).maxCoeff();
}

}  // namespace selvage::fuzz
