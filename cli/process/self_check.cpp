#include "cli/process/self_check.h"

#include <array>
#include <cmath>

#include "kernel/ccd.h"
#include "kernel/fp_env.h"
#include "verify/decision/exact_motion.h"
#include "verify/decision/exact_overlap.h"

namespace selvage::cli {
namespace {

using Corners = std::array<std::array<int, 3>, 4>;

/// Small integers times 2^exponent, so that the answer is known by hand and is the same at any scale.
struct Question {
  const char* name;
  bool is_vf;
  int exponent;
  Corners x_t0, x_t1;
  bool touches;
  const char* first;  ///< the exact first time
};

constexpr int kSubnormal = -1074;  // the unit is the smallest double
constexpr int kHuge = 280;

// A vertex above the middle of a face, which rests: p, a, b, c.
constexpr Corners above(int height) { return {{{100, 100, height}, {0, 0, 0}, {400, 0, 0}, {0, 400, 0}}}; }
// An edge above another, at right angles: a, b, c, d.
constexpr Corners edges(int height) { return {{{-100, 0, height}, {100, 0, height}, {0, -100, 0}, {0, 100, 0}}}; }

constexpr Question kQuestions[] = {
    {"vertex through face", true, 0, above(300), above(-300), true, "1/2"},
    {"vertex stays above face", true, 0, above(300), above(200), false, ""},
    {"vertex reaches face at the end", true, 0, above(300), above(0), true, "1"},
    {"edge through edge", false, 0, edges(100), edges(-300), true, "1/4"},
    {"edge stays above edge", false, 0, edges(100), edges(90), false, ""},
    {"subnormal contact of vertex and face", true, kSubnormal, above(300), above(-300), true, "1/2"},
    {"subnormal gap between vertex and face", true, kSubnormal, above(300), above(200), false, ""},
    {"subnormal contact of edges", false, kSubnormal, edges(100), edges(-300), true, "1/4"},
    {"subnormal gap between edges", false, kSubnormal, edges(100), edges(90), false, ""},
    {"huge contact", true, kHuge, above(300), above(-300), true, "1/2"},
    {"huge gap", true, kHuge, above(300), above(200), false, ""},
};

/// Exact: made under a guard, because under flush to zero the question itself would be another.
double scaled(int integer, int exponent) {
  const FpEnvGuard guard;
  return std::ldexp(integer, exponent);
}

std::array<verify::Point, 4> exact_points(const Corners& corners, int exponent) {
  std::array<verify::Point, 4> points;
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) points[i][axis] = scaled(corners[i][axis], exponent);
  }
  return points;
}

std::array<Vec3, 4> kernel_points(const std::array<verify::Point, 4>& points) {
  std::array<Vec3, 4> x;
  for (std::size_t i = 0; i < 4; ++i) x[i] = Vec3(points[i][0], points[i][1], points[i][2]);
  return x;
}

bool kernel_is_right(const Question& question, const std::array<verify::Point, 4>& x_t0,
                     const std::array<verify::Point, 4>& x_t1) {
  CcdOptions options;
  options.tolerance = 0;
  const CcdResult result = (question.is_vf ? vf_ccd : ee_ccd)(kernel_points(x_t0), kernel_points(x_t1), options);
  if (!question.touches) return result.verdict == CcdVerdict::kSeparated;
  return result.verdict == CcdVerdict::kCollides &&
         verify::compare_first_touch(x_t0, x_t1, question.is_vf, result.toi_lower) >= 0;
}

bool checker_is_right(const Question& question, const std::array<verify::Point, 4>& x_t0,
                      const std::array<verify::Point, 4>& x_t1) {
  const verify::MotionAnswer answer =
      (question.is_vf ? verify::exact_vf_motion : verify::exact_ee_motion)(x_t0, x_t1, verify::Detail::kFirstTime);
  if (answer.touches != question.touches) return false;
  return !question.touches || (answer.first.lower == question.first && answer.first.upper == question.first);
}

/// Two faces in parallel planes, the smallest double apart, or in one.
bool overlap_is_right(int height) {
  const auto at = [](int x, int y, int z) -> verify::Point {
    return {scaled(x, 0), scaled(y, 0), scaled(z, kSubnormal)};
  };
  const verify::OverlapAnswer answer =
      verify::exact_overlap({0, 1, 2}, {at(0, 0, 0), at(4, 0, 0), at(0, 4, 0)}, {3, 4, 5},
                            {at(1, 1, height), at(2, 1, height), at(1, 2, height)});
  return answer.kind == (height == 0 ? verify::OverlapKind::kCoplanar : verify::OverlapKind::kNone);
}

}  // namespace

SelfCheck run_self_check() {
  SelfCheck check;
  const auto expect = [&](bool is_right, const std::string& what) {
    ++check.answers;
    if (!is_right) check.wrong.push_back(what);
  };
  for (const Question& question : kQuestions) {
    const auto x_t0 = exact_points(question.x_t0, question.exponent);
    const auto x_t1 = exact_points(question.x_t1, question.exponent);
    expect(kernel_is_right(question, x_t0, x_t1), std::string("kernel: ") + question.name);
    expect(checker_is_right(question, x_t0, x_t1), std::string("checker: ") + question.name);
  }
  expect(overlap_is_right(0), "checker: faces in one plane");
  expect(overlap_is_right(1), "checker: faces that the smallest double keeps apart");
  return check;
}

}  // namespace selvage::cli
