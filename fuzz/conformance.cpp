#include "fuzz/conformance.h"

#include <array>
#include <optional>

#include "fuzz/case_file.h"
#include "fuzz/case_text.h"
#include "fuzz/closest_approach.h"
#include "fuzz/query_streams.h"
#include "fuzz/shrink_query.h"

namespace selvage::fuzz {
namespace {

constexpr std::array<PairKind, 2> kKinds{PairKind::kVf, PairKind::kEe};
/// As for our own kernel: enough to bisect down to neighbouring doubles about one closest approach.
constexpr int kMaxTests = 256;

struct Verdict {
  std::string failure;
  bool touches = false, alarm = false;
  Plugin::Answer answer;
};

class Conformance final : public Property {
 public:
  explicit Conformance(std::filesystem::path library)
      : Property("conformance", "the plugin misses no contact, is never late, and no alarm is beyond its declared gap"),
        library_(std::move(library)) {
    streams_ = query_streams(kKinds, 1);
    counters_ = {"touches", "alarms", "missed", "late", "too far", "nanoseconds"};
  }

  void prepare() override { prepare_queries(); }
  void start() override {
    plugin_.emplace(library_);
    has_loaded_cleanly_ = plugin_->load_misdeed().empty();
  }

  Outcome run(const Stream& stream, ChoiceSource source) override {
    if (!has_loaded_cleanly_) return load_failure();
    const auto [query_class, kind] = query_stream(stream);
    const MotionQuery query = make_query(*query_class, kind, source);
    const Verdict verdict = judge(query, source.one_in(16));
    Outcome outcome{{1, verdict.failure.empty() ? 0 : 1, {}, 0}, verdict.failure};
    outcome.counts.of = {verdict.touches,
                         verdict.alarm,
                         verdict.failure == "missed",
                         verdict.failure == "late-time",
                         verdict.failure == "alarm-too-far",
                         verdict.answer.nanoseconds};
    return outcome;
  }

  std::string kept(const Stream& stream, ChoiceSource source, const std::string& origin, const std::string& failure,
                   bool shrunk) override {
    const auto [query_class, kind] = query_stream(stream);
    MotionQuery query = make_query(*query_class, kind, source);
    query.options = CcdOptions{.tolerance = 0};  // the plugin has its own
    const bool in_batch = source.one_in(16);
    if (shrunk) {
      query = shrink(query, [&](const MotionQuery& simpler) {
                beat_();
                return judge(simpler, in_batch).failure == failure;
              }).query;
    }
    const std::string text = format_case({query, origin, exact_motion(query, verify::Detail::kDecision).touches});
    return shrunk ? text + "# answered: " + words_of(judge(query, in_batch).answer) + "\n" : text;
  }

 private:
  /// Of the first case of a process: it says what loading did.
  Outcome load_failure() {
    has_loaded_cleanly_ = true;
    return {{1, 1, {}, 0}, plugin_->load_misdeed() + "-at-load"};
  }

  [[nodiscard]] std::string words_of(const Plugin::Answer& answer) const {
    if (!answer.misdeed.empty()) return answer.misdeed;
    if (answer.answer.verdict != SELVAGE_COLLIDES) return "separated";
    return plugin_->info().has_toi ? "collides at t = " + hex(answer.answer.toi) : "collides";
  }

  Verdict judge(const MotionQuery& query, bool in_batch) const {
    Verdict verdict;
    verdict.answer = plugin_->ask(query, in_batch);
    verdict.failure = verdict.answer.misdeed;
    if (!verdict.failure.empty()) return verdict;
    const selvage_answer& answer = verdict.answer.answer;
    verdict.alarm = answer.verdict == SELVAGE_COLLIDES;
    const bool has_time = verdict.alarm && plugin_->info().has_toi;
    const verify::MotionAgainst exact = motion_against(query, has_time ? answer.toi : 0);
    verdict.touches = exact.touches;
    if (exact.touches && !verdict.alarm) verdict.failure = "missed";
    if (exact.touches && has_time && answer.toi > 0 && exact.order < 0) verdict.failure = "late-time";
    if (!exact.touches && verdict.alarm) {
      const double gap = plugin_->info().tolerance + plugin_->info().relative_tolerance * extent(query);
      const std::array<double, 3> hints{has_time ? answer.toi : 1, 0, 1};
      if (closest_approach(query, gap, hints, kMaxTests) == Approach::kBeyond) verdict.failure = "alarm-too-far";
    }
    return verdict;
  }

  std::filesystem::path library_;
  std::optional<Plugin> plugin_;
  bool has_loaded_cleanly_ = true;
};

}  // namespace

std::unique_ptr<Property> make_conformance(const std::filesystem::path& library) {
  return std::make_unique<Conformance>(library);
}

}  // namespace selvage::fuzz
