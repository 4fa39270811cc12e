#include "cli/answer/replay.h"

#include <algorithm>

#include "fuzz/oracle/query_property.h"
#include "fuzz/run/redraw.h"
#include "kernel/assert.h"

namespace selvage::cli {
namespace {

std::array<verify::Point, 3> first_three(const std::array<verify::Point, 4>& x) { return {x[0], x[1], x[2]}; }

/// Of the property that the case is about.
std::string failure_of_property(const fuzz::Case& kept) {
  fuzz::ChoiceSource source = fuzz::ChoiceSource::from_words(kept.choices);
  const auto& properties = fuzz::query_properties();
  const auto property = std::ranges::find(properties, kept.property, &fuzz::QueryProperty::name);
  SELVAGE_ASSERT(property != properties.end());
  return std::string(property->check(kept.query, fuzz::selvage_kernel, source).failure);
}

}  // namespace

MotionReplay replay_motion(const fuzz::Case& kept, const std::optional<PluginToAsk>& asked) {
  MotionReplay replay;
  replay.kept = kept;
  replay.kernel = fuzz::selvage_kernel(kept.query);
  const fuzz::MotionQuery& query = kept.query;
  replay.is_in_domain = fuzz::is_in_domain(query);
  if (asked && replay.is_in_domain && is_for_plugins(std::string(fuzz::name_of(query.kind)))) {
    const fuzz::BatchSize batch = kept.plugin ? kept.plugin->batch : fuzz::kUsualBatch;  // which asks it alone first
    replay.plugin = fuzz::try_plugin(asked->library, query, batch, asked->case_seconds);
  }
  const auto x_t0 = fuzz::raw(query.x_t0), x_t1 = fuzz::raw(query.x_t1);
  replay.exact = fuzz::exact_motion(query, verify::Detail::kFirstTime);
  if (replay.is_in_domain) {
    replay.judgement = fuzz::judge(query, replay.kernel);
    replay.failure = failure_of_property(kept);
  }
  switch (query.kind) {
    case PairKind::kVf:
      replay.second = verify::second_opinion_vf(x_t0, x_t1);
      replay.textbook = bench::textbook_vf(query.x_t0, query.x_t1);
      replay.polynomials = {verify::explain_vf_motion(x_t0, x_t1)};
      break;
    case PairKind::kEe:
      replay.second = verify::second_opinion_ee(x_t0, x_t1);
      replay.textbook = bench::textbook_ee(query.x_t0, query.x_t1);
      replay.polynomials = {verify::explain_ee_motion(x_t0, x_t1)};
      break;
    case PairKind::kSelf:
      replay.second = verify::second_opinion_self(first_three(x_t0), first_three(x_t1));
      replay.polynomials = verify::explain_self_motion(first_three(x_t0), first_three(x_t1));
      break;
  }
  return replay;
}

ReplayOutcome MotionReplay::outcome() const {
  if (exact.touches != second.touches) return ReplayOutcome::kDivided;
  if (exact.touches != kept.touches) return ReplayOutcome::kContradicted;
  if (!is_in_domain) return ReplayOutcome::kOutside;
  const bool agrees =
      judgement.disagreement == fuzz::Disagreement::kNone && failure.empty() && (!plugin || plugin->failure.empty());
  return agrees ? ReplayOutcome::kAgree : ReplayOutcome::kBroken;
}

OverlapReplay replay_overlap(const fuzz::OverlapCase& kept) {
  const verify::OverlapKind exact = verify::exact_overlap(kept.faces[0], kept.x[0], kept.faces[1], kept.x[1]).kind;
  return {kept, exact, verify::second_opinion_overlap(kept.faces[0], kept.x[0], kept.faces[1], kept.x[1])};
}

ReplayOutcome OverlapReplay::outcome() const {
  const bool touches = exact != verify::OverlapKind::kNone;
  if (touches != second) return ReplayOutcome::kDivided;
  return touches == kept.touches ? ReplayOutcome::kAgree : ReplayOutcome::kContradicted;
}

KeptReplay replay_kept(const std::string& name, fuzz::ParsedCase parsed) {
  fuzz::Retrial retrial = parsed.kept->retry();
  if (!retrial.unfit.empty()) throw io::Error(io::ErrorKind::kBadInput, name + ": " + retrial.unfit);
  return {std::move(parsed), std::move(retrial)};
}

bool is_for_plugins(const std::string& kind) {
  return kind == fuzz::name_of(PairKind::kVf) || kind == fuzz::name_of(PairKind::kEe);
}

Explanation replay_text(const std::string& text, const std::string& name, const std::optional<PluginToAsk>& asked) {
  const std::string kind = fuzz::kind_of_case(text, name);
  if (kind == "overlap") return explain(name, replay_overlap(fuzz::parse_overlap_case(text, name)));
  const auto is_motion = [&](PairKind pair) { return fuzz::name_of(pair) == kind; };
  if (std::ranges::any_of(fuzz::kPairKinds, is_motion)) {
    return explain(name, replay_motion(fuzz::parse_case(text, name), asked));
  }
  return explain(name, replay_kept(name, fuzz::parse_kept_case(text, name, fuzz::redraw)));
}

}  // namespace selvage::cli
