#include "fuzz/campaign/query_campaign.h"

#include <cmath>

#include "fuzz/campaign/query_streams.h"
#include "fuzz/kept/case_file.h"
#include "fuzz/shrink/shrink_choices.h"
#include "fuzz/shrink/shrink_query.h"

namespace selvage::fuzz {
namespace {

constexpr std::int64_t kExponentTrials = 100;  // of the only choice

class QueryCampaign final : public Property {
 public:
  QueryCampaign(const QueryProperty& property, CcdKernel kernel)
      : Property(std::string(property.name), std::string(property.promise)),
        property_(property),
        kernel_(kernel),
        is_judged_exactly_(property.name == "ccd") {
    // The oracle is where the findings are; the others are cheap.
    weight_ = is_judged_exactly_ ? 32 : 1;
    streams_ = query_streams(kPairKinds, is_judged_exactly_ ? 1 : 8);
    counters_ = {"touches", "hits", "alarms", "unresolved", "undecided", "exact"};
  }

  void prepare() override { prepare_queries(); }

  Outcome run(const Stream& stream, ChoiceSource source) override {
    const MotionQuery query = draw_query(stream, source);
    const Observation seen = property_.check(query, kernel_, source);
    Outcome outcome{{1, !seen.failure.empty(), {}, seen.near_miss_bits}, std::string(seen.failure)};
    auto& of = outcome.counts.of;
    of[kTouches] = seen.touches;
    of[kHits] = seen.hit;
    of[kAlarms] = seen.alarm;
    of[kUnresolved] = seen.unresolved;
    of[kUndecided] = seen.undecided;
    of[kDecidedExactly] = seen.exact_used;
    // With a tolerance, what ends within it is rightly called a collision.
    const bool is_measured = is_judged_exactly_ && seen.failure.empty() && query.options.tolerance == 0;
    if (is_measured && source.one_in(kMeasuredOneIn)) {
      outcome.accuracy = measure_accuracy(query, seen.touches, seen.alarm, seen.toi);
    }
    return outcome;
  }

  [[nodiscard]] std::string complaint(const Stream& stream, const Counts& counts) const override {
    const auto [query_class, kind] = query_stream(stream);
    if (is_judged_exactly_ && is_out_of_band(*query_class, kind, counts)) return "hits outside the declared band";
    return is_unresolved_too_often(kind, counts) ? "unresolved too often" : "";
  }

  std::string kept(const Stream& stream, ChoiceSource source, const std::string& origin, const std::string& failure,
                   bool shrunk) override {
    MotionQuery query = draw_query(stream, source);
    const auto still_fails = [&](const MotionQuery& simpler) {
      ChoiceSource again = source;  // the property's own choices stay the same
      return property_.check(simpler, kernel_, again).failure == failure;
    };
    Choices choices;
    if (shrunk) {
      query = shrink(query, still_fails).query;
      const auto failure_of = [&](ChoiceSource simpler) {
        return std::string(property_.check(query, kernel_, simpler).failure);
      };
      choices = shrink_choices(source, failure, failure_of, kExponentTrials);
    }
    const bool touches = exact_motion(query, verify::Detail::kDecision).touches;
    return format_case({query, origin, touches, name(), choices});
  }

 private:
  const QueryProperty& property_;
  CcdKernel kernel_;
  bool is_judged_exactly_;
};

/// Five standard deviations of a count.
double noise(double cases, double share) { return 5 * std::sqrt(cases * share * (1 - share)); }

}  // namespace

std::unique_ptr<Property> make_query_campaign(const QueryProperty& property, CcdKernel kernel) {
  return std::make_unique<QueryCampaign>(property, kernel);
}

bool is_out_of_band(const QueryClass& query_class, PairKind kind, const Counts& counts) {
  const HitBand& band = *query_class.band(kind);
  const auto cases = static_cast<double>(counts.cases);
  const auto hits = static_cast<double>(counts.of[query_class.aims_at_end ? kHits : kTouches]);
  return hits < cases * band.low - noise(cases, band.low) || hits > cases * band.high + noise(cases, band.high);
}

bool is_unresolved_too_often(PairKind kind, const Counts& counts) {
  // Measured: at most 1 % of any class for vf and ee; for self, which has no cubic to guide the search, 20 % of the
  // touches in which a vertex slides along its edge for a while (triple-root).
  const double share = kind == PairKind::kSelf ? 0.25 : 0.02;
  const auto cases = static_cast<double>(counts.cases);
  return static_cast<double>(counts.of[kUnresolved]) > cases * share + noise(cases, share);
}

}  // namespace selvage::fuzz
