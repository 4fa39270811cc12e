#include "fuzz/base/motion_query.h"

#include <algorithm>
#include <cmath>

#include "kernel/assert.h"
#include "verify/arithmetic/fp_guard.h"
#include "verify/decision/exact_distance.h"
#include "verify/filter/distance_filter.h"
#include "verify/filter/near_filter.h"

namespace selvage::fuzz {
namespace {

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
  return pair_ccd(query.kind, query.x_t0, query.x_t1, query.options);
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

verify::MotionAgainst motion_against(const MotionQuery& query, double t) {
  const std::array<verify::Point, 4> t0 = raw(query.x_t0);
  const std::array<verify::Point, 4> t1 = raw(query.x_t1);
  switch (query.kind) {
    case PairKind::kVf:
      return verify::vf_motion_against(t0, t1, t);
    case PairKind::kEe:
      return verify::ee_motion_against(t0, t1, t);
    case PairKind::kSelf:
      break;
  }
  return verify::self_motion_against({t0[0], t0[1], t0[2]}, {t1[0], t1[1], t1[2]}, t);
}

bool within_at(const MotionQuery& query, double t, double d) {
  const std::array<verify::Point, 4> t0 = raw_of(query.kind, query.x_t0);
  const std::array<verify::Point, 4> t1 = raw_of(query.kind, query.x_t1);
  if (t == 0 || t == 1) {
    const verify::FpGuard guard;
    const std::array<verify::Point, 4>& x = t == 0 ? t0 : t1;
    const bool is_ee = query.kind == PairKind::kEe;
    if (is_ee ? verify::triage_ee_farther(x, d) : verify::triage_vf_farther(x, d)) return false;
    if (is_ee ? verify::triage_ee_nearer(x, d) : verify::triage_vf_nearer(x, d)) return true;
  }
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

bool is_in_domain(const MotionQuery& query) {
  for (const auto* x : {&query.x_t0, &query.x_t1}) {
    for (int i = 0; i < point_count(query.kind); ++i) {  // each by itself: a maximum may pass over NaN
      if (!((*x)[static_cast<std::size_t>(i)].array().abs() <= kMaxCoordinate).all()) return false;
    }
  }
  return query.options.tolerance >= 0 && std::isfinite(query.options.tolerance) && query.options.max_intervals >= 1;
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
