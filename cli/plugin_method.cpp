#include "cli/plugin_method.h"

#include <atomic>
#include <cstddef>
#include <cstring>
#include <new>
#include <optional>

#include <fmt/format.h>

#include "fuzz/base/deaths.h"
#include "fuzz/plugin/plugin.h"
#include "fuzz/plugin/plugin_trial.h"
#include "fuzz/run/guarded_run.h"
#include "fuzz/run/worker.h"
#include "io/fail.h"
#include "io/text.h"

namespace selvage::cli {
namespace {

/// At the head of the memory that the plugin's process leaves, also where it dies; behind it are the answers.
struct Left {
  std::size_t in_hand = 0;  ///< 1 for the first query; 0: none
  bool is_timed = false;    ///< it has answered all of them
  char misdeed[fuzz::kFailureWord] = {};
  bench::QueryTimes ns;
};

fuzz::MotionQuery motion_query(const bench::MethodQuery& query) { return {query.kind, query.x_t0, query.x_t1}; }

bench::MethodAnswer method_answer(const selvage_answer& answer, bool has_toi) {
  const bool alarm = answer.verdict == SELVAGE_COLLIDES;
  return {alarm, false, alarm && has_toi ? answer.toi : 1};
}

/// All that happens in the plugin's process.
class Session {
 public:
  Session(fuzz::Plugin& plugin, const std::vector<bench::FileQuery>& queries, Left& left,
          std::atomic<std::int64_t>& beat)
      : plugin_(plugin), queries_(queries), left_(left), beat_(beat) {}

  /// The answers; fewer than there are queries where it does something besides answering.
  std::vector<bench::MethodAnswer> ask_all() {
    std::vector<bench::MethodAnswer> answers;
    plugin_.before_asking([this] { count_beat(); });
    note(plugin_.load_misdeed(), 0);
    for (std::size_t i = 0; i < queries_.size() && !has_misbehaved(); ++i) {
      left_.in_hand = i + 1;
      const fuzz::Plugin::Answer given = plugin_.ask(motion_query(queries_[i].asked), std::nullopt);
      note(given.misdeed, i + 1);
      if (!has_misbehaved()) answers.push_back(method_answer(given.answer, plugin_.info().has_toi));
    }
    return answers;
  }

  /// REQUIRES the answers to all queries.
  void time(const std::vector<bench::MethodAnswer>& answers, int repeat) {
    std::vector<selvage_query> plain;
    for (const bench::FileQuery& query : queries_) plain.push_back(fuzz::plain(motion_query(query.asked)));
    const bool has_toi = plugin_.info().has_toi;
    left_.is_timed = true;
    bench::TimedAnswers timed;
    const std::string misdeed = plugin_.watch([&] {
      timed = bench::time_answers(answers, repeat, [&](std::size_t i) {
        left_.in_hand = i + 1;
        count_beat();
        return method_answer(plugin_.answer(queries_[i].asked.kind, plain[i]), has_toi);
      });
    });
    left_.ns = timed.ns;
    note(misdeed, 0);
    if (timed.unsteady) note(fuzz::kUnsteady, *timed.unsteady + 1);
  }

  [[nodiscard]] bool has_misbehaved() const { return left_.misdeed[0] != '\0'; }

 private:
  void note(const std::string& misdeed, std::size_t in_hand) {
    if (misdeed.empty() || has_misbehaved()) return;
    misdeed.copy(left_.misdeed, sizeof left_.misdeed - 1);
    left_.in_hand = in_hand;
  }
  /// There is one writer, and to lock the bus would cost as much as some answers.
  void count_beat() { beat_.store(beat_.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed); }

  fuzz::Plugin& plugin_;
  const std::vector<bench::FileQuery>& queries_;
  Left& left_;
  std::atomic<std::int64_t>& beat_;
};

std::string words_of(const std::filesystem::path& library, const std::string& misdeed, const std::string& where) {
  const std::string more_time = misdeed == fuzz::kHung ? ", or give it more time with --case-time, if it needs it" : "";
  return fmt::format("{}: {} {}; nothing was measured: mend it{}; selvage fuzz --plugin {} finds more of the kind",
                     library.string(), misdeed, where, more_time, io::shell_word(library.string()));
}

}  // namespace

PluginMeasurement measure_plugin(const std::filesystem::path& library, std::span<const bench::QueryFile> files,
                                 int repeat, double case_seconds) {
  const std::uint32_t crc32 = fuzz::crc32_of_plugin(library);
  const fuzz::PluginInfo info = fuzz::probe_plugin(library, case_seconds);
  const std::vector<bench::FileQuery> queries = bench::all_queries(files);
  for (const bench::FileQuery& query : queries) {
    if (fuzz::is_in_domain(motion_query(query.asked))) continue;
    io::bad_input_at_line(files[query.file].file.string(), query.line,
                          "a coordinate is beyond 2^1000, up to which a plugin is asked; leave this query out");
  }
  const std::size_t bytes_of_answers = queries.size() * sizeof(bench::MethodAnswer);
  std::vector<std::byte> memory(sizeof(Left) + bytes_of_answers);
  std::optional<fuzz::Plugin> plugin;
  const auto work = [&](void* shared, std::atomic<std::int64_t>& beat) {
    Left& left = *new (shared) Left;
    Session session(*plugin, queries, left, beat);
    const std::vector<bench::MethodAnswer> answers = session.ask_all();
    if (session.has_misbehaved()) return;
    session.time(answers, repeat);
    std::memcpy(static_cast<void*>(&left + 1), answers.data(), answers.size() * sizeof answers[0]);
  };
  const fuzz::ChildEnd end = fuzz::run_in_child(
      {{[&] { plugin.emplace(library); }, case_seconds}, work, memory.size(), case_seconds}, memory.data());
  Left left;
  std::memcpy(&left, memory.data(), sizeof left);
  PluginMeasurement measured;
  const std::string misdeed = end.death.empty() ? left.misdeed : end.death;
  if (!misdeed.empty()) {
    const std::size_t query = left.in_hand - 1;  // of none, or what a plugin has written there, is beyond them all
    const std::string where = query < queries.size() ? "at the query " + bench::place_of(queries[query], files)
                              : left.is_timed        ? "while it was timed"
                                                     : "while it was loaded";
    measured.misbehaviour = words_of(library, misdeed, where);
    return measured;
  }
  measured.method.facts = {library.string(), info.name, crc32, info.gap.tolerance, info.gap.relative_tolerance,
                           info.has_toi};
  measured.method.answers.resize(queries.size());
  std::memcpy(measured.method.answers.data(), memory.data() + sizeof left, bytes_of_answers);
  measured.method.ns = left.ns;
  measured.method.is_beyond_gap = [gap = info.gap](const bench::MethodQuery& query, const bench::MethodAnswer& answer) {
    return fuzz::is_beyond_gap(motion_query(query), gap, answer.toi);
  };
  return measured;
}

}  // namespace selvage::cli
