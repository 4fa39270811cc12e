// What a campaign checks on one query: the kernel's promises as named properties over any kernel.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "fuzz/base/choice_source.h"
#include "fuzz/base/motion_query.h"

namespace selvage::fuzz {

/// What one case showed. `failure` names the broken promise in a word, or is empty.
struct Observation {
  std::string_view failure;
  bool touches = false;       ///< exactly, at some t in [0,1] (proximity: at an end)
  bool hit = false;           ///< touches or ends within tolerance: must not be answered `separated`
  bool alarm = false;         ///< answered `collides`
  bool unresolved = false;    ///< answered `unresolved` although the limit was the default one
  bool exact_used = false;    ///< no filter of the checker decided whether they touch
  int near_miss_bits = 0;     ///< as in Judgement
  std::optional<double> toi;  ///< of an alarm: no touch before it
  bool undecided = false;     ///< the oracle could not decide within its own limit
};

struct QueryProperty {
  std::string_view name;
  std::string_view promise;  ///< one line for people
  /// `source` supplies whatever the property chooses besides the query (a scale, say).
  Observation (*check)(const MotionQuery& query, CcdKernel kernel, ChoiceSource& source);
};

/// ccd (K1 to K3), symmetry and scale (K5), proximity (K4), in this order.
[[nodiscard]] const std::vector<QueryProperty>& query_properties();

}  // namespace selvage::fuzz
