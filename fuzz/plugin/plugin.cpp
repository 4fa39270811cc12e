#include "fuzz/plugin/plugin.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstring>
#include <numeric>
#include <optional>
#include <system_error>
#include <tuple>
#include <utility>
#include <vector>

#include <dlfcn.h>
#include <pthread.h>
#include <sys/wait.h>
#include <unistd.h>

#include "fuzz/base/case_text.h"
#include "fuzz/base/deaths.h"
#include "fuzz/run/guarded_run.h"
#include "io/fail.h"
#include "io/file/atomic_file.h"
#include "io/file/checksum.h"
#include "io/file/text.h"
#include "kernel/fp_env.h"

namespace selvage::fuzz {
namespace {

[[noreturn]] void refuse(const std::filesystem::path& library, const std::string& why) {
  throw io::Error(io::ErrorKind::kBadInput, library.string() + ": " + why);
}

/// What somebody did to this thread's environment, by name; it is not repaired here.
std::string fp_misdeed() {
  const unsigned defects = fp_env_defects();
  if ((defects & kFpRounding) != 0) return "changed-rounding-mode";
  return (defects & (kFpFlush | kFpDenormals)) != 0 ? "set-flush-to-zero" : "";
}

/// Of this process, by whichever thread.
std::atomic<std::int64_t> fork_count = 0;
/// Between calls of which nobody sees whether a child comes back: it would go on with them, and fork again.
std::atomic<bool> ends_children_at_once = false;
void end_child() {
  if (ends_children_at_once) _exit(0);
}

/// Begins before somebody else's code runs.
class ForkWatch {
 public:
  ForkWatch() {
    static const int is_counting = pthread_atfork(
        nullptr, [] { ++fork_count; }, end_child);
    if (is_counting != 0) throw std::system_error(is_counting, std::generic_category(), "pthread_atfork");
    forks_ = fork_count;
  }
  /// A misdeed, or nothing. A child that comes back ends here: it would be a second worker with the pipes of the first.
  [[nodiscard]] std::string misdeed() const {
    if (getpid() != process_) _exit(0);
    if (fork_count == forks_) return "";
    while (waitpid(-1, nullptr, WNOHANG) > 0) {  // thousands that ended would fill the table of processes
    }
    return "forked";
  }

 private:
  pid_t process_ = getpid();
  std::int64_t forks_;
};

/// Memory with a pattern on both sides, which nobody has a reason to change.
template <class T>
class Fenced {
 public:
  explicit Fenced(std::size_t count) : all_(count + 2 * kFence) {
    std::memset(all_.data(), kPattern, kFenceBytes);
    std::memset(data() + count, kPattern, kFenceBytes);
  }
  [[nodiscard]] bool is_whole() const {
    const auto untouched = [](const T* fence) {
      std::array<unsigned char, kFenceBytes> bytes;
      std::memcpy(bytes.data(), fence, kFenceBytes);
      return std::ranges::all_of(bytes, [](unsigned char byte) { return byte == kPattern; });
    };
    return untouched(all_.data()) && untouched(all_.data() + all_.size() - kFence);
  }
  T* data() { return all_.data() + kFence; }
  T& operator[](std::size_t i) { return data()[i]; }

 private:
  static constexpr std::size_t kFence = (256 + sizeof(T) - 1) / sizeof(T);
  static constexpr std::size_t kFenceBytes = kFence * sizeof(T);
  static constexpr unsigned char kPattern = 0xa5;
  std::vector<T> all_;
};

bool is_same(const selvage_query& a, const selvage_query& b) { return std::memcmp(&a, &b, sizeof a) == 0; }

/// Whether the parts that say something have the same bits.
bool is_same(const selvage_answer& a, const selvage_answer& b, bool has_toi) {
  const bool has_time = has_toi && a.verdict == SELVAGE_COLLIDES;
  return a.verdict == b.verdict &&
         (!has_time || std::bit_cast<std::uint64_t>(a.toi) == std::bit_cast<std::uint64_t>(b.toi));
}

/// What a query is put into a batch with: queries with other answers, made of nothing but the query, so that a case
/// replays and shrinks.
using Company = std::array<selvage_query, 5>;
constexpr std::array<const char*, 5> kCompanyNames{"the query", "reversed in time", "at rest at its start",
                                                   "at rest at its end", "its points moved up by one place"};

Company company_of(const selvage_query& query) {
  Company company;
  company.fill(query);
  auto& [itself, reversed, still_at_t0, still_at_t1, turned] = company;
  std::swap(reversed.x_t0, reversed.x_t1);
  std::memcpy(still_at_t0.x_t1, query.x_t0, sizeof query.x_t0);
  std::memcpy(still_at_t1.x_t0, query.x_t1, sizeof query.x_t1);
  for (std::size_t i = 0; i < 4; ++i) {
    std::memcpy(turned.x_t0[i], query.x_t0[(i + 1) % 4], sizeof turned.x_t0[i]);
    std::memcpy(turned.x_t1[i], query.x_t1[(i + 1) % 4], sizeof turned.x_t1[i]);
  }
  return company;
}

/// Which of the company has each place in a batch of `count`: the query first, never one twice in a row, and without a
/// period. A kernel that answers one vector with another one's answers, or a lane with its neighbour's, meets different
/// queries there.
std::vector<std::size_t> order_of(std::size_t count) {
  constexpr std::size_t kSize = std::tuple_size_v<Company>;
  std::vector<std::size_t> order(count);
  for (std::size_t i = 1; i < count; ++i) order[i] = (order[i - 1] + 1 + mix(i, 0) % (kSize - 1)) % kSize;
  return order;
}

/// 0 to 40: a query more than two vectors of 16 and one of 8, and so all tails there are.
constexpr std::uint32_t kSmallBatches = 41;

/// A batch that would take longer, by what its queries took alone, is not asked: a plugin that takes 10 ms a query, in
/// rational numbers, would be called hung in one of a thousand.
constexpr std::int64_t kLongestBatch_ns = 1'000'000'000;

/// What nobody answers with: to be overwritten.
constexpr selvage_answer kUnanswered{0x5a5a5a5a, -1};

std::string judge_form(const selvage_answer& answer, bool has_toi) {
  if (answer.verdict != SELVAGE_SEPARATED && answer.verdict != SELVAGE_COLLIDES) return "invalid-verdict";
  const bool is_time = answer.toi >= 0 && answer.toi <= 1;
  return has_toi && answer.verdict == SELVAGE_COLLIDES && !is_time ? "invalid-time" : "";
}

}  // namespace

Plugin::Plugin(const std::filesystem::path& library) {
  const FpEnvGuard guard;
  const ForkWatch forks;
  const std::filesystem::path file = std::filesystem::absolute(library);  // dlopen searches for bare names
  void* handle = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (handle == nullptr) refuse(library, std::string("cannot be loaded: ") + dlerror());
  const auto entry = std::bit_cast<selvage_plugin_entry_function>(dlsym(handle, "selvage_plugin_entry"));
  if (entry == nullptr) refuse(library, "has no function selvage_plugin_entry");
  try {
    plugin_ = entry();
  } catch (const std::exception& error) {
    refuse(library, std::string("throws from selvage_plugin_entry: ") + error.what());
  } catch (...) {
    refuse(library, "throws from selvage_plugin_entry");
  }
  load_misdeed_ = forks.misdeed();
  if (load_misdeed_.empty()) load_misdeed_ = fp_misdeed();
  if (plugin_ == nullptr) refuse(library, "selvage_plugin_entry returns nothing");
  if (plugin_->version != SELVAGE_PLUGIN_VERSION) {
    refuse(library, "is built for version " + std::to_string(plugin_->version) +
                        " of selvage-plugin.h, this is version " + std::to_string(SELVAGE_PLUGIN_VERSION));
  }
  const bool are_lengths = plugin_->tolerance >= 0 && std::isfinite(plugin_->tolerance) &&
                           plugin_->relative_tolerance >= 0 && std::isfinite(plugin_->relative_tolerance);
  if (plugin_->answer == nullptr) refuse(library, "declares no function `answer`");
  if (plugin_->name == nullptr) refuse(library, "declares no `name`");
  if (!are_lengths) refuse(library, "declares a tolerance that is none: both are finite, from 0 up");
  io::printable(plugin_->name, sizeof info_.name - 1).copy(info_.name, sizeof info_.name - 1);
  info_.gap = {plugin_->tolerance, plugin_->relative_tolerance};
  info_.has_toi = plugin_->has_toi != 0;
  info_.has_batch = plugin_->answer_batch != nullptr;
}

selvage_query plain(const MotionQuery& query) {
  selvage_query plain{};
  for (std::size_t i = 0; i < 4; ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      plain.x_t0[i][axis] = query.x_t0[i][axis];
      plain.x_t1[i][axis] = query.x_t1[i][axis];
    }
  }
  return plain;
}

const std::vector<std::uint32_t>& batch_sizes() {
  static const std::vector<std::uint32_t> sizes = [] {
    std::vector<std::uint32_t> all(kSmallBatches);
    std::iota(all.begin(), all.end(), 0);
    for (std::uint32_t block = 64; block <= 1024; block *= 2) all.insert(all.end(), {block - 1, block, block + 1});
    return all;
  }();
  return sizes;
}

std::uint32_t draw_batch_size(ChoiceSource& source) {
  const std::vector<std::uint32_t>& sizes = batch_sizes();
  const auto all = static_cast<std::uint32_t>(sizes.size());
  return source.one_in(8) ? sizes[kSmallBatches + source.n(all - kSmallBatches)] : sizes[source.n(kSmallBatches)];
}

Plugin::Answer Plugin::ask(const MotionQuery& query, BatchSize batch) const {
  const FpEnvGuard guard;  // asked in a clean environment, whatever it left behind the last time
  const std::int32_t kind = query.kind == PairKind::kVf ? SELVAGE_VF : SELVAGE_EE;
  const selvage_query original = plain(query);
  Answer result = ask_alone(kind, original);
  if (batch && info_.has_batch && result.misdeed.empty()) ask_batch(kind, original, *batch, result);
  return result;
}

std::string Plugin::watch(const std::function<void()>& calls) const {
  const FpEnvGuard guard;
  const ForkWatch forks;
  ends_children_at_once = true;
  calls();
  ends_children_at_once = false;
  const std::string misdeed = forks.misdeed();
  return misdeed.empty() ? fp_misdeed() : misdeed;
}

bool Plugin::stands_by(const MotionQuery& query, const Answer& before, BatchSize batch) const {
  const Answer now = ask(query, batch);
  return now.misdeed == (batch ? before.misdeed : "") && (!batch || now.difference == before.difference) &&
         is_same(before.answer, now.answer, info_.has_toi);
}

Plugin::Answer Plugin::ask_alone(std::int32_t kind, const selvage_query& query) const {
  Fenced<selvage_query> asked(1);
  Fenced<selvage_answer> given(1);
  asked[0] = query;
  given[0] = kUnanswered;
  Answer result;
  before_asking_();
  const ForkWatch forks;
  const auto start = std::chrono::steady_clock::now();
  plugin_->answer(kind, asked.data(), given.data());
  result.nanoseconds = std::chrono::nanoseconds(std::chrono::steady_clock::now() - start).count();
  result.answer = given[0];
  result.misdeed = forks.misdeed();
  if (result.misdeed.empty()) result.misdeed = fp_misdeed();
  if (result.misdeed.empty() && !(asked.is_whole() && given.is_whole())) result.misdeed = "wrote-out-of-bounds";
  if (result.misdeed.empty() && !is_same(asked[0], query)) result.misdeed = "changed-the-query";
  if (result.misdeed.empty()) result.misdeed = judge_form(result.answer, info_.has_toi);
  return result;
}

void Plugin::ask_batch(std::int32_t kind, const selvage_query& query, std::uint32_t count, Answer& result) const {
  const Company company = company_of(query);
  std::array<selvage_answer, std::tuple_size_v<Company>> alone{result.answer};
  std::int64_t nanoseconds = result.nanoseconds;
  for (std::size_t i = 1; i < company.size(); ++i) {
    const Answer one = ask_alone(kind, company[i]);
    result.misdeed = one.misdeed;
    if (!one.misdeed.empty()) return;
    alone[i] = one.answer;
    nanoseconds += one.nanoseconds;
  }
  if (count * (nanoseconds / std::ssize(company)) > kLongestBatch_ns) return;
  const std::vector<std::size_t> order = order_of(count);
  Fenced<selvage_query> queries(count);
  Fenced<selvage_answer> answers(count);
  for (std::size_t i = 0; i < count; ++i) queries[i] = company[order[i]], answers[i] = kUnanswered;
  before_asking_();
  const ForkWatch forks;
  plugin_->answer_batch(kind, count, queries.data(), answers.data());
  result.misdeed = forks.misdeed();
  if (result.misdeed.empty()) result.misdeed = fp_misdeed();
  if (result.misdeed.empty() && !(queries.is_whole() && answers.is_whole())) result.misdeed = "wrote-out-of-bounds";
  for (std::size_t i = 0; i < count && result.misdeed.empty(); ++i) {
    const std::size_t which = order[i];
    if (!is_same(queries[i], company[which])) result.misdeed = "changed-the-query";
    if (is_same(answers[i], alone[which], info_.has_toi)) continue;
    result.misdeed = answers_alike(kind, company, alone) ? kBatchDiffers : kUnsteady;
    result.difference = "query " + std::to_string(i) + " of " + std::to_string(count) + " (" + kCompanyNames[which] +
                        "): alone " + words_of(alone[which], info_.has_toi) + ", in the batch " +
                        words_of(answers[i], info_.has_toi);
  }
}

/// Whether it says the same of all of these again. Half right by chance, it does in all rounds once in 256.
bool Plugin::answers_alike(std::int32_t kind, const std::array<selvage_query, 5>& queries,
                           const std::array<selvage_answer, 5>& answers) const {
  constexpr int kRounds = 8;
  for (int round = 0; round < kRounds; ++round) {
    for (std::size_t i = 0; i < queries.size(); ++i) {
      if (!is_same(ask_alone(kind, queries[i]).answer, answers[i], info_.has_toi)) return false;
    }
  }
  return true;
}

std::string words_of(const selvage_answer& answer, bool has_toi) {
  if (answer.verdict == SELVAGE_SEPARATED) return "separated";
  if (answer.verdict != SELVAGE_COLLIDES) return "nothing";
  return has_toi ? "collides at t = " + hex(answer.toi) : "collides";
}

PluginInfo probe_plugin(const std::filesystem::path& library, double seconds) {
  if (access(library.c_str(), R_OK) != 0) io::file_error(library.string(), "open", errno);
  std::optional<Plugin> plugin;
  const auto probe = run_guarded<PluginInfo>(
      {[&] { plugin.emplace(library); }, seconds}, [&] { return plugin->info(); }, seconds);
  if (!probe.death.empty()) {
    const std::string limit = probe.death == kHung ? "; give it more time with --case-time, if it needs it" : "";
    refuse(library, "does not survive being loaded: " + probe.death + limit);
  }
  return probe.result;
}

std::uint32_t crc32_of_plugin(const std::filesystem::path& library) { return io::crc32(io::read_file(library)); }

}  // namespace selvage::fuzz
