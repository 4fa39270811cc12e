#include "fuzz/campaign/query_streams.h"

#include <algorithm>

#include "kernel/assert.h"

namespace selvage::fuzz {

std::vector<Stream> query_streams(std::span<const PairKind> kinds, std::int64_t divisor) {
  std::vector<Stream> streams;
  for (const QueryClass& query_class : query_classes()) {
    for (const PairKind kind : kinds) {
      if (!query_class.band(kind)) continue;
      const std::int64_t per_unit = std::max<std::int64_t>(1, query_class.per_unit / divisor);
      streams.push_back({query_class.name + " " + std::string(name_of(kind)), query_class.group, per_unit});
    }
  }
  return streams;
}

QueryStream query_stream(const Stream& stream) {
  const std::size_t space = stream.name.find(' ');
  const auto is_named = [&](const QueryClass& one) { return stream.name.compare(0, space, one.name) == 0; };
  const auto query_class = std::find_if(query_classes().begin(), query_classes().end(), is_named);
  const auto* kind = std::find_if(kPairKinds.begin(), kPairKinds.end(),
                                  [&](PairKind one) { return stream.name.substr(space + 1) == name_of(one); });
  SELVAGE_ASSERT(query_class != query_classes().end() && kind != kPairKinds.end());
  return {&*query_class, *kind};
}

MotionQuery draw_query(const Stream& stream, ChoiceSource& source) {
  const auto [query_class, kind] = query_stream(stream);
  return make_query(*query_class, kind, source);
}

void prepare_queries() {
  for (const Stream& stream : query_streams(kPairKinds, 1)) {
    ChoiceSource simplest = ChoiceSource::from_words({});
    static_cast<void>(draw_query(stream, simplest));
  }
}

}  // namespace selvage::fuzz
