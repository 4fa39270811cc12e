// A process that runs cases for a campaign, so that a crash or a hang in the code under test is a finding.
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <string>

#include <sys/types.h>

#include "fuzz/base/counts.h"
#include "fuzz/campaign/property.h"
#include "fuzz/oracle/accuracy.h"

namespace selvage::fuzz {

/// Longest word for a failure, with its end.
inline constexpr std::size_t kFailureWord = 48;
/// That a case may compute and sleep in all (case_clock.h), unless somebody says otherwise.
inline constexpr double kCaseSeconds = 10;
/// Where workers, and what they run, write their messages.
inline constexpr const char* kWorkerLog = "workers.log";

struct Job {
  enum class Kind : std::int32_t { kUnit, kKeep } kind = Kind::kUnit;
  std::int32_t property = 0, stream = 0;  ///< the stream of kKeep
  std::int64_t number = 0;                ///< of the unit, or of the case to keep
  char failure[kFailureWord] = {};        ///< of kKeep
  std::int32_t shrunk = 1;                ///< of kKeep: whether the code under test may run for it
};

struct Event {
  enum class Kind : std::int32_t { kFailure, kDone } kind = Kind::kDone;
  std::int32_t stream = 0;
  std::int64_t number = 0;
  char failure[kFailureWord] = {};
  double seconds = 0;  ///< of kDone: processor time
};

/// Where a worker is, in memory that outlives it: whoever takes over continues behind the case that killed it.
struct Progress {
  std::atomic<std::int64_t> beat = 0;  ///< grows with every case
  std::int32_t stream = 0;
  std::int64_t number = 0;  ///< of the case in the unit's part of the stream
  static constexpr std::size_t kMaxStreams = 192;
  Counts rows[kMaxStreams];
  Accuracy accuracy[kMaxStreams];
  bool is_skipped[kMaxStreams] = {};      ///< streams not to be run any more
  std::atomic<bool> is_stopping = false;  ///< a unit ends behind the case in hand
  std::atomic<bool> has_started = false;  ///< this worker: what is tested is loaded
  std::atomic<bool> has_kept = false;     ///< of kKeep: the case is written, be it not yet simple
};
static_assert(std::atomic<std::int64_t>::is_always_lock_free, "shared between processes");

struct WorkerSetting {
  Properties& properties;
  std::uint64_t seed = 0;
  std::filesystem::path folder;  ///< for kept cases
};

[[nodiscard]] std::string kept_name(const Property& property, const Stream& stream, const std::string& failure);
/// "PROPERTY:STREAM:SEED:NUMBER".
[[nodiscard]] std::string case_origin(const Property& property, const Stream& stream, std::uint64_t seed,
                                      std::int64_t number);

/// The life of a worker: jobs in, events out, until the job pipe is closed. Each job ends with kDone, a unit that was
/// stopped too: progress says how far it came.
[[noreturn]] void work(const WorkerSetting& setting, Progress& progress, int jobs, int events);

struct OneCase {
  Outcome outcome;
  bool has_died = false;  ///< and the failure says how
};
/// Runs one case now, in a process of its own. Throws io::Error(kBadInput) where it dies before the case begins.
[[nodiscard]] OneCase run_case(Property& property, const Stream& stream, std::uint64_t seed, std::int64_t number,
                               double case_seconds);

}  // namespace selvage::fuzz
