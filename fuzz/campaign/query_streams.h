// Queries as streams of a campaign: one for every class and kind.
#pragma once

#include <span>

#include "fuzz/campaign/property.h"
#include "fuzz/draw/generators.h"

namespace selvage::fuzz {

/// The class and the kind of a stream "CLASS KIND".
struct QueryStream {
  const QueryClass* query_class = nullptr;
  PairKind kind = PairKind::kVf;
};

/// Streams for the kinds `kinds`, and what each stands for; per_unit is the class's, divided by `divisor`.
[[nodiscard]] std::vector<Stream> query_streams(std::span<const PairKind> kinds, std::int64_t divisor);
[[nodiscard]] QueryStream query_stream(const Stream& stream);
[[nodiscard]] MotionQuery draw_query(const Stream& stream, ChoiceSource& source);
/// Makes one query of each class, so that what is made once (a recording) is not charged to a case.
void prepare_queries();

}  // namespace selvage::fuzz
