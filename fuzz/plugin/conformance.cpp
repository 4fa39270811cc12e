#include "fuzz/plugin/conformance.h"

#include <array>
#include <optional>

#include "fuzz/campaign/query_streams.h"
#include "fuzz/draw/query_makers.h"
#include "fuzz/kept/case_file.h"
#include "fuzz/plugin/plugin_trial.h"
#include "fuzz/shrink/shrink_query.h"

namespace selvage::fuzz {
namespace {

constexpr std::array<PairKind, 2> kKinds{PairKind::kVf, PairKind::kEe};

/// Cases that are asked in a batch too.
constexpr std::uint32_t kInBatchOneIn = 16;

/// Besides the classes of queries, those that only this plugin makes hard.
const std::array<Stream, 2> kBesideGap{Stream{"beside-gap vf", 'A', 40}, Stream{"beside-gap ee", 'A', 40}};

struct PluginCase {
  MotionQuery query;
  BatchSize batch;
};

/// Whether it moves, and its points are as many, as in `first`. Without that misses of many classes end as one query of
/// a single point at rest, which says nothing of what is special in each.
bool is_as_general(const MotionQuery& simpler, const MotionQuery& first) {
  const auto moves = [](const MotionQuery& query) { return query.x_t0 != query.x_t1; };
  if (moves(first) && !moves(simpler)) return false;
  const auto are_one = [](const MotionQuery& query, std::size_t i, std::size_t k) {
    return query.x_t0[i] == query.x_t0[k] && query.x_t1[i] == query.x_t1[k];
  };
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      if (are_one(simpler, i, k) && !are_one(first, i, k)) return false;
    }
  }
  return true;
}

class Conformance final : public Property {
 public:
  Conformance(std::filesystem::path library, std::uint32_t crc32, DeclaredGap gap)
      : Property("conformance", "the plugin misses no contact, is never late, and no alarm is beyond its declared gap"),
        library_(std::move(library)),
        crc32_(crc32),
        gap_(gap) {
    streams_ = query_streams(kKinds, 1);
    streams_.insert(streams_.begin(), kBesideGap.begin(), kBesideGap.end());
    counters_ = {"touches", "alarms", "missed", "late", "too far", "nanoseconds"};
  }

  void prepare() override { prepare_queries(); }
  void start() override {
    if (crc32_of_plugin(library_) != crc32_) {
      throw io::Error(io::ErrorKind::kBadInput, library_.string() + ": has changed since this began; start anew");
    }
    plugin_.emplace(library_);
    plugin_->before_asking(beat_);
    has_loaded_cleanly_ = plugin_->load_misdeed().empty();
  }

  Outcome run(const Stream& stream, ChoiceSource source) override {
    if (!has_loaded_cleanly_) return load_failure();
    const auto [query, batch] = draw(stream, source);
    const PluginJudgement verdict = judge_steadily(*plugin_, query, batch);
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
    PluginCase drawn = draw(stream, source);
    drawn.query.options = CcdOptions{.tolerance = 0};  // the plugin has its own
    const auto [query, batch] = shrunk && failure != kUnsteady ? simplest(drawn, failure) : drawn;
    const bool touches = exact_motion(query, verify::Detail::kDecision).touches;
    const std::string text =
        format_case({query, origin, touches, Case().property, {}, PluginRecord{library_.string(), failure, batch}});
    if (!shrunk) return text;
    return text + "# answered: " + words_of(judge_plugin(*plugin_, query, batch).answer, plugin_->info().has_toi) +
           "\n";
  }

 private:
  [[nodiscard]] PluginCase draw(const Stream& stream, ChoiceSource& source) const {
    PluginCase drawn;
    const auto* beside = std::ranges::find(kBesideGap, stream.name, &Stream::name);
    drawn.query = beside == kBesideGap.end()
                      ? draw_query(stream, source)
                      : make::beside_gap(source, kKinds[static_cast<std::size_t>(beside - kBesideGap.begin())], gap_);
    if (source.one_in(kInBatchOneIn)) drawn.batch = draw_batch_size(source);
    return drawn;
  }
  /// That fails alike: first in the smallest batch, or alone, then with the simplest query that is as general.
  [[nodiscard]] PluginCase simplest(PluginCase one, const std::string& failure) const {
    const auto fails = [&](const MotionQuery& query, BatchSize batch) {
      beat_();
      return judge_plugin(*plugin_, query, batch).failure == failure;
    };
    if (one.batch && fails(one.query, std::nullopt)) one.batch.reset();
    if (one.batch) {
      one.batch = *std::ranges::find_if(
          batch_sizes(), [&](std::uint32_t size) { return size == *one.batch || fails(one.query, size); });
    }
    const auto is_like_it = [&, first = one.query](const MotionQuery& simpler) {
      return is_as_general(simpler, first) && fails(simpler, one.batch);
    };
    one.query = shrink(one.query, is_like_it).query;
    return one;
  }
  /// Of the first case of a process: it says what loading did.
  Outcome load_failure() {
    has_loaded_cleanly_ = true;
    return {{1, 1, {}, 0}, failure_at_load(plugin_->load_misdeed())};
  }

  std::filesystem::path library_;
  std::uint32_t crc32_;
  DeclaredGap gap_;
  std::optional<Plugin> plugin_;
  bool has_loaded_cleanly_ = true;
};

}  // namespace

std::unique_ptr<Property> make_conformance(const std::filesystem::path& library, std::uint32_t crc32,
                                           const DeclaredGap& gap) {
  return std::make_unique<Conformance>(library, crc32, gap);
}

}  // namespace selvage::fuzz
