// The query properties as parts of a campaign: a stream for every class and kind.
#pragma once

#include "fuzz/campaign/property.h"
#include "fuzz/draw/generators.h"
#include "fuzz/oracle/query_property.h"

namespace selvage::fuzz {

/// The class and the kind of a stream "CLASS KIND".
struct QueryStream {
  const QueryClass* query_class = nullptr;
  PairKind kind = PairKind::kVf;
};

/// Streams for the kinds `kinds`, and what each stands for; per_unit is the class's, divided by `divisor`.
[[nodiscard]] std::vector<Stream> query_streams(std::span<const PairKind> kinds, std::int64_t divisor);
/// Makes one query of each class, so that what is made once (a recording) is not charged to a case.
void prepare_queries();
[[nodiscard]] QueryStream query_stream(const Stream& stream);

[[nodiscard]] std::unique_ptr<Property> make_query_campaign(const QueryProperty& property);

}  // namespace selvage::fuzz
