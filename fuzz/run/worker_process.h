// A worker as its driver sees it: a child process, two pipes, shared progress, and a watch on its time.
#pragma once

#include <optional>
#include <vector>

#include "fuzz/ledger/ledger.h"
#include "fuzz/run/case_clock.h"
#include "fuzz/run/worker.h"

namespace selvage::fuzz {

/// How a worker died, for the report (deaths.h).
struct Death {
  std::string failure;
  bool at_start = false;      ///< before it ran a case
  bool is_abandoned = false;  ///< by abandon(): nothing is known about the case in hand
};

class WorkerProcess {
 public:
  /// Forks. REQUIRES a process without threads of its own.
  explicit WorkerProcess(const WorkerSetting& setting);
  ~WorkerProcess();  ///< kills it
  WorkerProcess(const WorkerProcess&) = delete;
  WorkerProcess& operator=(const WorkerProcess&) = delete;

  /// A unit begins at `from`. REQUIRES that it is idle.
  void give(const Job& job, const std::vector<bool>& is_skipped, const UnitPlace& from);
  [[nodiscard]] const std::optional<Job>& job() const { return job_; }
  [[nodiscard]] int events() const { return events_; }
  /// Reads one event. Nothing where the worker has died: then reap() and restart().
  [[nodiscard]] std::optional<Event> receive_event();
  /// The job is done: the worker is idle.
  void finish() { job_.reset(); }

  [[nodiscard]] Death reap();
  /// Another process takes over: the unit goes on behind the case that killed the last one; a kept case is given up.
  void restart();
  /// Whether it has loaded what it tests.
  [[nodiscard]] bool has_started() const { return progress_->has_started; }
  /// Kills it if the case in hand, or loading what it tests, has taken too long (case_clock.h).
  void watch(double case_seconds);
  /// A unit in hand ends behind the case in hand.
  void ask_to_stop() { progress_->is_stopping = true; }
  /// Kills it, whatever it does.
  void abandon();

  [[nodiscard]] Progress& progress() { return *progress_; }

 private:
  void start();

  const WorkerSetting& setting_;
  Progress* progress_ = nullptr;
  pid_t pid_ = -1;
  int jobs_ = -1, events_ = -1;
  std::optional<Job> job_;
  bool was_hung_ = false, was_abandoned_ = false;
  std::int64_t beat_at_start_ = 0, beat_at_job_ = 0;
  CaseClock clock_;
};

}  // namespace selvage::fuzz
