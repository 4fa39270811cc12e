// The named classes of collision queries (docs/fuzzing.md). Each declares which share of its cases must be exact hits,
// so a class that has gone dead fails the campaign (F1).
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "fuzz/base/choice_source.h"
#include "fuzz/base/motion_query.h"

namespace selvage::fuzz {

/// Closed band for the share of hits: cases whose features touch exactly. Measured over 5,000 cases and widened by 15
/// %; wider where the class follows the simulator.
struct HitBand {
  double low = 0, high = 1;
};

/// What makes the classes of a group hard, by letter; campaigns report by group.
struct QueryGroup {
  char letter;
  std::string_view name;
};
[[nodiscard]] const std::vector<QueryGroup>& query_groups();

struct QueryClass {
  char group;
  std::int64_t per_unit = 0;  ///< cases, of each kind, in a work unit of a campaign
  std::string name;
  std::function<MotionQuery(ChoiceSource&, PairKind)> make;  ///< geometry; options are left at their defaults
  std::array<std::optional<HitBand>, 3> hits;                ///< by PairKind; absent: not made for this kind
  bool aims_at_end = false;                                  ///< a hit is an end within the tolerance instead
  /// Only one case in so many: classes whose exact answers cost milliseconds (wide exponent spread).
  int dilution = 1;

  [[nodiscard]] const std::optional<HitBand>& band(PairKind kind) const { return hits[static_cast<std::size_t>(kind)]; }
};

/// In a fixed order.
[[nodiscard]] const std::vector<QueryClass>& query_classes();

/// Geometry of the class, then tolerance and limit: 0 in half of the cases, else absolute, relative to the query, or an
/// axis distance of the end positions; in one case of 32 a limit of few intervals; in one of 8 zeros with either sign.
[[nodiscard]] MotionQuery make_query(const QueryClass& query_class, PairKind kind, ChoiceSource& source);

}  // namespace selvage::fuzz
