#include "fuzz/plugin/conformance.h"

#include <array>
#include <optional>

#include "fuzz/campaign/query_streams.h"
#include "fuzz/kept/case_file.h"
#include "fuzz/plugin/plugin_trial.h"
#include "fuzz/shrink/shrink_query.h"

namespace selvage::fuzz {
namespace {

constexpr std::array<PairKind, 2> kKinds{PairKind::kVf, PairKind::kEe};

/// Cases that are asked in a batch too. run() draws it after the query; kept() draws it again there, so that the file
/// says how the case was asked.
constexpr std::uint32_t kInBatchOneIn = 16;

class Conformance final : public Property {
 public:
  Conformance(std::filesystem::path library, std::uint32_t crc32)
      : Property("conformance", "the plugin misses no contact, is never late, and no alarm is beyond its declared gap"),
        library_(std::move(library)),
        crc32_(crc32) {
    streams_ = query_streams(kKinds, 1);
    counters_ = {"touches", "alarms", "missed", "late", "too far", "nanoseconds"};
  }

  void prepare() override { prepare_queries(); }
  void start() override {
    if (crc32_of_plugin(library_) != crc32_) {
      throw io::Error(io::ErrorKind::kBadInput, library_.string() + ": has changed since this began; start anew");
    }
    plugin_.emplace(library_);
    has_loaded_cleanly_ = plugin_->load_misdeed().empty();
  }

  Outcome run(const Stream& stream, ChoiceSource source) override {
    if (!has_loaded_cleanly_) return load_failure();
    const MotionQuery query = draw_query(stream, source);
    const PluginJudgement verdict = judge_steadily(*plugin_, query, source.one_in(kInBatchOneIn));
    Outcome outcome{{1, verdict.failure.empty() ? 0 : 1, {}, 0}, verdict.failure};
    auto& of = outcome.counts.of;
    of[ConformanceRow::kTouches] = verdict.touches;
    of[ConformanceRow::kAlarms] = verdict.alarm;
    of[ConformanceRow::kMissed] = verdict.failure == "missed";
    of[ConformanceRow::kLate] = verdict.failure == "late-time";
    of[ConformanceRow::kTooFar] = verdict.failure == "alarm-too-far";
    of[ConformanceRow::kNanoseconds] = verdict.answer.nanoseconds;
    if (source.one_in(kMeasuredOneIn) && (verdict.failure.empty() || verdict.failure == "alarm-too-far")) {
      const bool has_time = verdict.alarm && plugin_->info().has_toi;
      outcome.accuracy = measure_accuracy(query, verdict.touches, verdict.alarm,
                                          has_time ? std::optional(verdict.answer.answer.toi) : std::nullopt);
    }
    return outcome;
  }

  std::string kept(const Stream& stream, ChoiceSource source, const std::string& origin, const std::string& failure,
                   bool shrunk) override {
    MotionQuery query = draw_query(stream, source);
    query.options = CcdOptions{.tolerance = 0};  // the plugin has its own
    const bool in_batch = source.one_in(kInBatchOneIn);
    if (shrunk && failure != kUnsteady) {
      query = shrink(query, [&](const MotionQuery& simpler) {
                beat_();
                return judge_plugin(*plugin_, simpler, in_batch).failure == failure;
              }).query;
    }
    const bool touches = exact_motion(query, verify::Detail::kDecision).touches;
    const std::string text =
        format_case({query, origin, touches, Case().property, {}, PluginRecord{library_.string(), failure, in_batch}});
    if (!shrunk) return text;
    return text + "# answered: " + words_of(judge_plugin(*plugin_, query, in_batch).answer, plugin_->info().has_toi) +
           "\n";
  }

 private:
  /// Of the first case of a process: it says what loading did.
  Outcome load_failure() {
    has_loaded_cleanly_ = true;
    return {{1, 1, {}, 0}, failure_at_load(plugin_->load_misdeed())};
  }

  std::filesystem::path library_;
  std::uint32_t crc32_;
  std::optional<Plugin> plugin_;
  bool has_loaded_cleanly_ = true;
};

}  // namespace

std::unique_ptr<Property> make_conformance(const std::filesystem::path& library, std::uint32_t crc32) {
  return std::make_unique<Conformance>(library, crc32);
}

}  // namespace selvage::fuzz
