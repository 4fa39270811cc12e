#include "fuzz/run/worker_process.h"

#include <csignal>
#include <cstring>
#include <new>
#include <string>
#include <system_error>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include "fuzz/base/deaths.h"
#include "fuzz/run/guarded_run.h"
#include "fuzz/run/process_sight.h"
#include "fuzz/run/wire.h"

namespace selvage::fuzz {
namespace {

[[noreturn]] void fail(const char* what) { throw std::system_error(errno, std::generic_category(), what); }

std::array<int, 2> make_pipe() {
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) fail("pipe");
  return ends;
}

}  // namespace

WorkerProcess::WorkerProcess(const WorkerSetting& setting) : setting_(setting) {
  void* shared = mmap(nullptr, sizeof(Progress), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (shared == MAP_FAILED) fail("mmap");
  progress_ = new (shared) Progress;
  start();
}

WorkerProcess::~WorkerProcess() {
  if (pid_ > 0) {
    kill(pid_, SIGKILL);
    waitpid(pid_, nullptr, 0);
  }
  close(jobs_);
  close(events_);
  munmap(progress_, sizeof(Progress));
}

void WorkerProcess::start() {
  const auto jobs = make_pipe(), events = make_pipe();
  progress_->has_started = false;
  pid_ = fork();
  if (pid_ < 0) fail("fork");
  if (pid_ == 0) {
    close(jobs[1]);
    close(events[0]);
    madvise(progress_, sizeof(Progress), MADV_DONTFORK);  // what the code under test forks takes no part in it
    work(setting_, *progress_, jobs[0], events[1]);
  }
  close(jobs[0]);
  close(events[1]);
  jobs_ = jobs[1];
  events_ = events[0];
  beat_at_start_ = progress_->beat.load();
  clock_ = {};
  was_hung_ = was_abandoned_ = false;
}

void WorkerProcess::give(const Job& job, const std::vector<bool>& is_skipped, const UnitPlace& from) {
  progress_->stream = static_cast<std::int32_t>(from.stream);
  progress_->number = from.number;
  progress_->has_kept = false;
  for (Counts& row : progress_->rows) row = {};
  for (Accuracy& row : progress_->accuracy) row = {};
  for (std::size_t i = 0; i < is_skipped.size(); ++i) progress_->is_skipped[i] = is_skipped[i];
  job_ = job;
  clock_ = {};
  beat_at_job_ = progress_->beat.load();
  static_cast<void>(try_send(jobs_, job));  // one that has died meanwhile is reaped where its events end
}

std::optional<Event> WorkerProcess::receive_event() {
  Event event;
  if (!receive(events_, event)) return std::nullopt;
  event.failure[kFailureWord - 1] = '\0';
  return event;
}

Death WorkerProcess::reap() {
  int status = 0;
  if (waitpid(pid_, &status, 0) != pid_) fail("waitpid");
  pid_ = -1;
  close(jobs_);
  close(events_);
  jobs_ = events_ = -1;
  Death death;
  death.at_start = progress_->beat.load() == beat_at_start_;
  death.is_abandoned = was_abandoned_;
  death.failure = was_hung_ ? kHung : death_of(status);
  return death;
}

void WorkerProcess::restart() {
  start();
  if (job_ && job_->kind == Job::Kind::kUnit) {
    static_cast<void>(try_send(jobs_, *job_));
  } else {
    job_.reset();
  }
}

void WorkerProcess::watch(double case_seconds) {
  if (!job_) return;
  const std::int64_t beat = progress_->beat.load();
  // Loaded, and not at its first case yet; or it shrinks what does not beat, which runs many cases and is bounded by
  // their number.
  const std::int64_t idle_beat = job_->kind == Job::Kind::kUnit ? beat_at_start_ : beat_at_job_;
  if (progress_->has_started && beat == idle_beat) return;
  const std::optional<double> used = processor_seconds(pid_);
  if (!used) return;  // it has just died
  if (!clock_.is_over({beat, *used, is_asleep(pid_), std::chrono::steady_clock::now()}, case_seconds)) return;
  was_hung_ = true;
  kill(pid_, SIGKILL);
}

void WorkerProcess::abandon() {
  if (was_abandoned_) return;
  was_abandoned_ = true;
  kill(pid_, SIGKILL);
}

}  // namespace selvage::fuzz
