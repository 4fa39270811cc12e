// The methods that answer one query: what `bench methods` compares, each at several settings, and `bench queries`.
#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "kernel/types.h"
#include "verify/decision/exact_motion.h"

namespace selvage::bench {

/// Both ends of a motion, as the methods in doubles and as the checker take them.
struct MethodQuery {
  PairKind kind = PairKind::kVf;  ///< vf or ee
  std::array<Vec3, 4> x_t0, x_t1;
  std::array<verify::Point, 4> point_t0{}, point_t1{};
};
[[nodiscard]] MethodQuery method_query(PairKind kind, const std::array<Vec3, 4>& x_t0, const std::array<Vec3, 4>& x_t1);

struct MethodAnswer {
  bool alarm = false;    ///< does not call the pair separated
  bool gave_up = false;  ///< an alarm because a limit of work was reached
  double toi = 1;
  friend bool operator==(const MethodAnswer&, const MethodAnswer&) = default;
};

[[nodiscard]] MethodAnswer textbook_within(const MethodQuery& query, double tolerance);
[[nodiscard]] MethodAnswer kernel_within(const MethodQuery& query, double tolerance);
/// The checker's bare decision, without a time.
[[nodiscard]] MethodAnswer exact_decision(const MethodQuery& query);

[[nodiscard]] verify::MotionAnswer exact_answer(const MethodQuery& query, verify::Detail detail);

struct MethodSetting {
  std::string method, setting;
  std::function<MethodAnswer(const MethodQuery&)> ask;
  bool gives_toi = true;
};

/// Method and setting of the one that all times are divided by: the textbook method with the paper's tolerance.
inline constexpr const char* kBaselineMethod = "textbook";
inline constexpr const char* kBaselineSetting = "1e-06 m";

/// textbook and kernel by tolerance (lengths), additive by rescaling, inclusion by tolerance (share of the query's
/// size), exact_decision.
[[nodiscard]] std::vector<MethodSetting> method_settings();

}  // namespace selvage::bench
