#include "fuzz/campaign/query_streams.h"

#include <algorithm>

#include "fuzz/campaign/query_campaign.h"
#include "fuzz/kept/case_file.h"
#include "fuzz/shrink/shrink_choices.h"
#include "fuzz/shrink/shrink_query.h"
#include "kernel/assert.h"

namespace selvage::fuzz {
namespace {

constexpr std::int64_t kExponentTrials = 100;  // of the only choice

Tally tally_of(const Counts& counts) {
  return {counts.cases, counts.of[0], counts.of[1], counts.of[2], counts.of[3], counts.of[4], counts.failures};
}

class QueryCampaign final : public Property {
 public:
  explicit QueryCampaign(const QueryProperty& property)
      : Property(std::string(property.name), std::string(property.promise)),
        property_(property),
        is_judged_exactly_(property.name == "ccd") {
    // The oracle is where the findings are; the others are cheap.
    weight_ = is_judged_exactly_ ? 32 : 1;
    streams_ = query_streams(kPairKinds, is_judged_exactly_ ? 1 : 8);
    counters_ = {"touches", "hits", "alarms", "unresolved", "undecided", "exact"};
  }

  void prepare() override { prepare_queries(); }

  Outcome run(const Stream& stream, ChoiceSource source) override {
    const auto [query_class, kind] = query_stream(stream);
    const MotionQuery query = make_query(*query_class, kind, source);
    const Observation seen = property_.check(query, selvage_kernel, source);
    Outcome outcome{{1, !seen.failure.empty(), {}, seen.near_miss_bits}, std::string(seen.failure)};
    outcome.counts.of = {seen.touches, seen.hit, seen.alarm, seen.unresolved, seen.undecided, seen.exact_used};
    // With a tolerance, what ends within it is rightly called a collision.
    const bool is_measured = is_judged_exactly_ && seen.failure.empty() && query.options.tolerance == 0;
    if (is_measured && source.one_in(kMeasuredOneIn)) {
      outcome.accuracy = measure_accuracy(query, seen.touches, seen.alarm, seen.toi);
    }
    return outcome;
  }

  [[nodiscard]] std::string complaint(const Stream& stream, const Counts& counts) const override {
    const auto [query_class, kind] = query_stream(stream);
    const Tally tally = tally_of(counts);
    if (is_judged_exactly_ && is_out_of_band(*query_class, kind, tally)) return "hits outside the declared band";
    return is_unresolved_too_often(kind, tally) ? "unresolved too often" : "";
  }

  std::string kept(const Stream& stream, ChoiceSource source, const std::string& origin, const std::string& failure,
                   bool shrunk) override {
    const auto [query_class, kind] = query_stream(stream);
    MotionQuery query = make_query(*query_class, kind, source);
    const auto still_fails = [&](const MotionQuery& simpler) {
      ChoiceSource again = source;  // the property's own choices stay the same
      return property_.check(simpler, selvage_kernel, again).failure == failure;
    };
    Choices choices;
    if (shrunk) {
      query = shrink(query, still_fails).query;
      const auto failure_of = [&](ChoiceSource simpler) {
        return std::string(property_.check(query, selvage_kernel, simpler).failure);
      };
      choices = shrink_choices(source, failure, failure_of, kExponentTrials);
    }
    const bool touches = exact_motion(query, verify::Detail::kDecision).touches;
    return format_case({query, origin, touches, name(), choices});
  }

 private:
  const QueryProperty& property_;
  bool is_judged_exactly_;
};

}  // namespace

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

void prepare_queries() {
  for (const Stream& stream : query_streams(kPairKinds, 1)) {
    const auto [query_class, kind] = query_stream(stream);
    ChoiceSource simplest = ChoiceSource::from_words({});
    static_cast<void>(make_query(*query_class, kind, simplest));
  }
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

std::unique_ptr<Property> make_query_campaign(const QueryProperty& property) {
  return std::make_unique<QueryCampaign>(property);
}

}  // namespace selvage::fuzz
