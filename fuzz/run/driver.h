// Runs a campaign: gives work units to worker processes, joins what they find, and writes down what is done.
#pragma once

#include <functional>
#include <memory>
#include <optional>

#include "fuzz/ledger/ledger.h"
#include "fuzz/run/worker_process.h"

namespace selvage::fuzz {

struct DriverOptions {
  std::optional<double> seconds;  ///< none: until `cases`
  std::int64_t cases = 0;         ///< of each property, rounded up to work units; 0: without end
  std::uint64_t seed = 1;
  int jobs = 1;                  ///< worker processes
  std::filesystem::path folder;  ///< campaign.json, stats.jsonl and kept cases
  std::int64_t shard = 1, shards = 1;
  bool resume = false;
  double case_seconds = kCaseSeconds;  ///< that a case may compute or sleep (case_clock.h)
  std::string version, target = "selvage";
  std::optional<std::uint32_t> plugin_crc32;
};

struct DriverStatus {
  double seconds = 0, processor_seconds = 0;  ///< of this run
  std::int64_t cases = 0;                     ///< of this run
};

/// The names of the files in a campaign's folder.
inline constexpr const char* kLedgerFile = "campaign.json";
inline constexpr const char* kStatsFile = "stats.jsonl";

class Driver {
 public:
  /// Throws io::Error: a folder that holds another campaign, or one that is not to be resumed.
  Driver(Properties& properties, DriverOptions options);
  ~Driver();

  /// Until all is done, the time is over, or `stop` says so: then the cases in hand are finished and written, which
  /// takes no longer than a case may, and a unit that is cut short goes on from there when it is resumed. `watch` is
  /// called several times a second. False: stopped. What campaign.json says is done stays done, whatever happens.
  bool run(const std::function<bool()>& stop, const std::function<void(const DriverStatus&)>& watch);

  [[nodiscard]] const Ledger& ledger() const { return ledger_; }
  [[nodiscard]] const DriverStatus& status() const { return status_; }

 private:
  struct WorkerSlot;        // a worker and what it has reported about its job
  struct PropertyProgress;  // of a property: what is given out, and what it cost

  enum class Pace { kFull, kStopping, kLate };
  [[nodiscard]] Pace pace(bool stopped);
  bool assign(WorkerSlot& slot, Pace pace);
  [[nodiscard]] std::optional<Job> next_job(Pace pace);
  void receive_or_watch(WorkerSlot& slot, Pace pace, short revents);
  void receive(WorkerSlot& slot, bool has_hung_up);
  void take_done(WorkerSlot& slot, const Event& done);
  void take_unit(WorkerSlot& slot);
  void take_death(WorkerSlot& slot);
  void take_kept(const Job& job);
  void take_death_of_keeping(WorkerSlot& slot, const Job& job, const Death& death);
  [[noreturn]] void fail_of_worker(const Death& death, const std::string& what_for) const;
  void take_broken_channel(WorkerSlot& slot);
  void save();
  void append_stats() const;

  Properties& properties_;
  DriverOptions options_;
  Ledger ledger_;
  DriverStatus status_;
  WorkerSetting setting_;
  std::vector<PropertyProgress> property_progress_;
  std::vector<std::unique_ptr<WorkerSlot>> slots_;
  std::optional<double> stopping_since_s_;
  bool is_dirty_ = false;
};

}  // namespace selvage::fuzz
