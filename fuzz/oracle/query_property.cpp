#include "fuzz/oracle/query_property.h"

#include "fuzz/oracle/metamorphic.h"
#include "fuzz/oracle/proximity_oracle.h"
#include "fuzz/oracle/query_oracle.h"

namespace selvage::fuzz {
namespace {

Observation observe(const MotionQuery& query, const CcdResult& answer) {
  Observation seen;
  seen.alarm = answer.verdict == CcdVerdict::kCollides;
  seen.unresolved =
      answer.verdict == CcdVerdict::kUnresolved && query.options.max_intervals == CcdOptions{}.max_intervals;
  return seen;
}

Observation check_ccd(const MotionQuery& query, CcdKernel kernel, ChoiceSource& /*source*/) {
  const CcdResult answer = kernel(query);
  const Judgement judgement = judge(query, answer);
  Observation seen = observe(query, answer);
  if (seen.alarm) seen.toi = answer.toi_lower;
  seen.touches = judgement.touches;
  seen.hit = judgement.hit;
  seen.undecided = judgement.gap_unknown;
  seen.exact_used = judgement.exact_used;
  seen.near_miss_bits = judgement.near_miss_bits;
  if (judgement.disagreement != Disagreement::kNone) seen.failure = name_of(judgement.disagreement);
  return seen;
}

Observation check_symmetry(const MotionQuery& query, CcdKernel kernel, ChoiceSource& /*source*/) {
  const CcdResult answer = kernel(query);
  Observation seen = observe(query, answer);
  if (!answers_follow_relabelling(query, answer, kernel)) seen.failure = "asymmetric";
  return seen;
}

Observation check_scale(const MotionQuery& query, CcdKernel kernel, ChoiceSource& source) {
  const CcdResult answer = kernel(query);
  Observation seen = observe(query, answer);
  const auto exponent = static_cast<int>(source.zigzag(1200));
  const std::optional<MotionQuery> scaled = scaled_query(query, exponent);
  if (scaled && !answer_follows_scale(answer, exponent, kernel(*scaled))) seen.failure = "scale-dependent";
  return seen;
}

Observation check_proximity(const MotionQuery& query, CcdKernel /*kernel*/, ChoiceSource& /*source*/) {
  Observation seen;
  if (query.kind == PairKind::kSelf) return seen;
  for (const auto* x : {&query.x_t0, &query.x_t1}) {
    const ProximityJudgement judgement = judge_proximity(query.kind, *x);
    seen.touches = seen.touches || judgement.exactly_zero;
    if (judgement.defect != ProximityDefect::kNone) seen.failure = name_of(judgement.defect);
  }
  return seen;
}

}  // namespace

const std::vector<QueryProperty>& query_properties() {
  static const std::vector<QueryProperty> properties = {
      {"ccd", "no missed contact, no late time of impact, no alarm beyond its bound (K1, K2, K3)", check_ccd},
      {"symmetry", "relabelling and orientation change nothing, bit for bit (K5)", check_symmetry},
      {"scale", "a factor 2^k changes lengths by 2^k and nothing else, bit for bit (K5)", check_scale},
      {"proximity", "distances lie in their bracket, which is narrow (K4)", check_proximity},
  };
  return properties;
}

}  // namespace selvage::fuzz
