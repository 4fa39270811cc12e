// The exact checker's answers to the kernel's queries.
#pragma once

#include "kernel/ccd.h"
#include "verify/decision/exact_motion.h"

namespace selvage::testing {

inline std::array<verify::Point, 4> raw(const std::array<Vec3, 4>& x) {
  std::array<verify::Point, 4> result;
  for (std::size_t i = 0; i < 4; ++i) result[i] = {x[i][0], x[i][1], x[i][2]};
  return result;
}

/// REQUIRES kind kVf or kEe, as the others.
inline verify::MotionAnswer exact_answer(PairKind kind, const std::array<Vec3, 4>& x_t0,
                                         const std::array<Vec3, 4>& x_t1, verify::Detail detail) {
  return kind == PairKind::kVf ? verify::exact_vf_motion(raw(x_t0), raw(x_t1), detail)
                               : verify::exact_ee_motion(raw(x_t0), raw(x_t1), detail);
}

inline CcdResult kernel_answer(PairKind kind, const std::array<Vec3, 4>& x_t0, const std::array<Vec3, 4>& x_t1) {
  const CcdOptions no_tolerance{.tolerance = 0};
  return kind == PairKind::kVf ? vf_ccd(x_t0, x_t1, no_tolerance) : ee_ccd(x_t0, x_t1, no_tolerance);
}

}  // namespace selvage::testing
