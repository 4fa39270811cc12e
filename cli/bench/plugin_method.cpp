#include "cli/bench/plugin_method.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstring>
#include <limits>
#include <new>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "bench/ccd_methods.h"
#include "bench/measure.h"
#include "cli/arguments/number_check.h"
#include "fuzz/base/deaths.h"
#include "fuzz/plugin/plugin.h"
#include "fuzz/plugin/plugin_trial.h"
#include "fuzz/run/guarded_run.h"
#include "io/fail.h"
#include "io/file/text.h"

namespace selvage::cli {
namespace {

/// At the head of the memory that the plugin's process leaves, also where it dies; behind it are the answers.
template <typename Times>
struct Left {
  std::size_t in_hand = 0;  ///< 1 for the first query; 0: none
  bool is_timed = false;    ///< it has answered all of them
  char misdeed[fuzz::kFailureWord] = {};
  Times ns;
};

fuzz::MotionQuery motion_query(const bench::MethodQuery& query) { return {query.kind, query.x_t0, query.x_t1}; }

bench::MethodAnswer method_answer(const selvage_answer& answer, bool has_toi) {
  const bool alarm = answer.verdict == SELVAGE_COLLIDES;
  return {alarm, false, alarm && has_toi ? answer.toi : 1};
}

/// The queries of files, each alone and in orders that change.
class FileQueries {
 public:
  using Times = bench::QueryTimes;
  /// Throws io::Error where one is beyond what a plugin is asked.
  explicit FileQueries(std::span<const bench::QueryFile> files) : files_(files), queries_(bench::all_queries(files)) {
    for (const bench::FileQuery& query : queries_) {
      const fuzz::MotionQuery asked = motion_query(query.asked);
      plain_.push_back(fuzz::plain(asked));
      if (fuzz::is_in_domain(asked)) continue;
      io::bad_input_at_line(files[query.file].file.string(), query.line,
                            "a coordinate is beyond 2^1000, up to which a plugin is asked; leave this query out");
    }
  }
  [[nodiscard]] std::size_t count() const { return queries_.size(); }
  [[nodiscard]] fuzz::MotionQuery at(std::size_t i) const { return motion_query(queries_[i].asked); }
  [[nodiscard]] std::string place(std::size_t i) const { return bench::place_of(queries_[i], files_); }

  template <typename Ask>
  std::optional<std::size_t> time(const std::vector<bench::MethodAnswer>& answers, int repeat, const Ask& ask,
                                  Times& ns) const {
    const bench::TimedAnswers timed =
        bench::time_answers(answers, repeat, [&](std::size_t i) { return ask(i, queries_[i].asked.kind, plain_[i]); });
    ns = timed.ns;
    return timed.unsteady;
  }

 private:
  std::span<const bench::QueryFile> files_;
  std::vector<bench::FileQuery> queries_;
  std::vector<selvage_query> plain_;
};

/// The candidates of a motion, which are gathered from its positions when they are asked: they would fill gigabytes.
class MotionQueries {
 public:
  using Times = bench::KindTimes;
  MotionQueries(const bench::MeshMotion& motion, const Candidates& candidates)
      : motion_(motion), candidates_(candidates) {}
  [[nodiscard]] std::size_t count() const { return candidates_.vf.size() + candidates_.ee.size(); }
  [[nodiscard]] fuzz::MotionQuery at(std::size_t i) const {
    const auto [kind, pair] = pair_at(i);
    return motion_query(bench::query_of(kind, motion_, candidates_, pair));
  }
  [[nodiscard]] std::string place(std::size_t i) const {
    const auto [kind, pair] = pair_at(i);
    if (kind == PairKind::kVf) {
      const VfCandidate& vf = candidates_.vf[pair];
      return fmt::format("of vertex {} and face {}", vf.vertex, vf.face);
    }
    const auto& a = motion_.mesh.edges[static_cast<std::size_t>(candidates_.ee[pair].a)];
    const auto& b = motion_.mesh.edges[static_cast<std::size_t>(candidates_.ee[pair].b)];
    return fmt::format("of edges {}-{} and {}-{}", a[0], a[1], b[0], b[1]);
  }

  template <typename Ask>
  std::optional<std::size_t> time(const std::vector<bench::MethodAnswer>& answers, int repeat, const Ask& ask,
                                  Times& ns) const {
    std::optional<std::size_t> unsteady;
    ns = {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
    const auto pass = [&](PairKind kind, const auto& pairs, std::size_t first, double& best) {
      const double start = bench::thread_nanoseconds();
      for (std::size_t pair = 0; pair < pairs.size(); ++pair) {
        const selvage_query query = gathered(pair_vertices(motion_.mesh, pairs[pair]));
        if (ask(first + pair, kind, query) != answers[first + pair]) unsteady = first + pair;
      }
      best = std::min(best, bench::thread_nanoseconds() - start);
    };
    for (int i = 0; i < repeat; ++i) {
      pass(PairKind::kVf, candidates_.vf, 0, ns.vf);
      pass(PairKind::kEe, candidates_.ee, candidates_.vf.size(), ns.ee);
    }
    return unsteady;
  }

 private:
  [[nodiscard]] std::pair<PairKind, std::size_t> pair_at(std::size_t i) const {
    const std::size_t vf = candidates_.vf.size();
    return i < vf ? std::pair{PairKind::kVf, i} : std::pair{PairKind::kEe, i - vf};
  }
  [[nodiscard]] selvage_query gathered(const std::array<VertexId, 4>& vertices) const {
    selvage_query query;
    for (int i = 0; i < 4; ++i) {
      for (int k = 0; k < 3; ++k) {
        query.x_t0[i][k] = motion_.V_t0(vertices[static_cast<std::size_t>(i)], k);
        query.x_t1[i][k] = motion_.V_t1(vertices[static_cast<std::size_t>(i)], k);
      }
    }
    return query;
  }

  const bench::MeshMotion& motion_;
  const Candidates& candidates_;
};

/// All that happens in the plugin's process.
template <typename Queries>
class Session {
 public:
  using Remains = Left<typename Queries::Times>;
  Session(fuzz::Plugin& plugin, const Queries& queries, Remains& left, std::atomic<std::int64_t>& beat)
      : plugin_(plugin), queries_(queries), left_(left), beat_(beat) {}

  /// The answers; fewer than there are queries where it does something besides answering.
  std::vector<bench::MethodAnswer> ask_all() {
    std::vector<bench::MethodAnswer> answers;
    plugin_.before_asking([this] { count_beat(); });
    note(plugin_.load_misdeed(), 0);
    for (std::size_t i = 0; i < queries_.count() && !has_misbehaved(); ++i) {
      left_.in_hand = i + 1;
      const fuzz::Plugin::Answer given = plugin_.ask(queries_.at(i), std::nullopt);
      note(given.misdeed, i + 1);
      if (!has_misbehaved()) answers.push_back(method_answer(given.answer, plugin_.info().has_toi));
    }
    return answers;
  }

  /// REQUIRES the answers to all queries.
  void time(const std::vector<bench::MethodAnswer>& answers, int repeat) {
    const bool has_toi = plugin_.info().has_toi;
    left_.is_timed = true;
    std::optional<std::size_t> unsteady;
    const std::string misdeed = plugin_.watch([&] {
      const auto ask = [&](std::size_t i, PairKind kind, const selvage_query& query) {
        left_.in_hand = i + 1;
        count_beat();
        return method_answer(plugin_.answer(kind, query), has_toi);
      };
      unsteady = queries_.time(answers, repeat, ask, left_.ns);
    });
    note(misdeed, 0);
    if (unsteady) note(fuzz::kUnsteady, *unsteady + 1);
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
  const Queries& queries_;
  Remains& left_;
  std::atomic<std::int64_t>& beat_;
};

std::string words_of(const std::filesystem::path& library, const std::string& misdeed, const std::string& where) {
  const std::string more_time = misdeed == fuzz::kHung ? ", or give it more time with --case-time, if it needs it" : "";
  return fmt::format("{}: {} {}; nothing was measured: mend it{}; selvage fuzz --plugin {} finds more of the kind",
                     library.string(), misdeed, where, more_time, io::shell_word(library.string()));
}

template <typename Queries>
PluginMeasurement<typename Queries::Times> measure(const PluginArguments& arguments, const Queries& queries,
                                                   int repeat) {
  using Remains = typename Session<Queries>::Remains;
  const std::filesystem::path library = arguments.library;
  const std::uint32_t crc32 = fuzz::crc32_of_plugin(library);
  const fuzz::PluginInfo info = fuzz::probe_plugin(library, arguments.case_time_s);
  const std::size_t bytes_of_answers = queries.count() * sizeof(bench::MethodAnswer);
  std::vector<std::byte> memory(sizeof(Remains) + bytes_of_answers);
  std::optional<fuzz::Plugin> plugin;
  const auto work = [&](void* shared, std::atomic<std::int64_t>& beat) {
    Remains& left = *new (shared) Remains;
    Session<Queries> session(*plugin, queries, left, beat);
    const std::vector<bench::MethodAnswer> answers = session.ask_all();
    if (session.has_misbehaved()) return;
    session.time(answers, repeat);
    if (!answers.empty()) std::memcpy(static_cast<void*>(&left + 1), answers.data(), bytes_of_answers);
  };
  const fuzz::ChildEnd end = fuzz::run_in_child(
      {{[&] { plugin.emplace(library); }, arguments.case_time_s}, work, memory.size(), arguments.case_time_s},
      memory.data());
  Remains left;
  std::memcpy(&left, memory.data(), sizeof left);
  PluginMeasurement<typename Queries::Times> measured;
  const std::string misdeed = end.death.empty() ? left.misdeed : end.death;
  if (!misdeed.empty()) {
    const std::size_t query = left.in_hand - 1;  // of none, or what a plugin has written there, is beyond them all
    const std::string where = query < queries.count() ? "at the query " + queries.place(query)
                              : left.is_timed         ? "while it was timed"
                                                      : "while it was loaded";
    measured.misbehaviour = words_of(library, misdeed, where);
    return measured;
  }
  measured.method.facts = {library.string(), info.name, crc32, info.gap.tolerance, info.gap.relative_tolerance,
                           info.has_toi};
  measured.method.answers.resize(queries.count());
  if (bytes_of_answers > 0) std::memcpy(measured.method.answers.data(), memory.data() + sizeof left, bytes_of_answers);
  measured.method.ns = left.ns;
  measured.method.is_beyond_gap = [gap = info.gap](const bench::MethodQuery& query, const bench::MethodAnswer& answer) {
    return fuzz::is_beyond_gap(motion_query(query), gap, answer.toi);
  };
  return measured;
}

}  // namespace

void add_plugin(CLI::App& bench, PluginArguments& arguments) {
  CLI::Option* const plugin =
      bench
          .add_option("--plugin", arguments.library,
                      "Measure this collision code as well: a library with the interface fuzz/selvage-plugin.h, in a "
                      "process of its own")
          ->type_name("LIB.so");
  bench
      .add_option("--case-time", arguments.case_time_s,
                  "Seconds that the plugin may compute and sleep over a query, or being loaded, before that is a hang")
      ->check(number_above(0))
      ->capture_default_str()
      ->needs(plugin);
}

std::string words_of(const bench::GuestFacts& facts) {
  return fmt::format("{} {}: {}, CRC-32 {:08x}, alarms within {:.3g} + {:.3g} of the size{}", bench::kGuestRow,
                     facts.name, facts.file, facts.crc32, facts.tolerance, facts.relative_tolerance,
                     facts.has_toi ? "" : ", no times of impact");
}

PluginMeasurement<bench::QueryTimes> measure_plugin(const PluginArguments& plugin,
                                                    std::span<const bench::QueryFile> files, int repeat) {
  return measure(plugin, FileQueries(files), repeat);
}

PluginMeasurement<bench::KindTimes> measure_plugin(const PluginArguments& plugin, const bench::MeshMotion& motion,
                                                   const Candidates& candidates, int repeat) {
  return measure(plugin, MotionQueries(motion, candidates), repeat);
}

}  // namespace selvage::cli
