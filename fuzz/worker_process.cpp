#include "fuzz/worker_process.h"

#include <csignal>
#include <cstring>
#include <ctime>
#include <new>
#include <stdexcept>
#include <system_error>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include "fuzz/wire.h"

namespace selvage::fuzz {
namespace {

/// A sleeping case uses no processor time, and on a crowded machine a busy one may get a small share of it.
constexpr double kClockShare = 20;

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
  pid_ = fork();
  if (pid_ < 0) fail("fork");
  if (pid_ == 0) {
    close(jobs[1]);
    close(events[0]);
    work(setting_, *progress_, jobs[0], events[1]);
  }
  close(jobs[0]);
  close(events[1]);
  jobs_ = jobs[1];
  events_ = events[0];
  beat_at_start_ = progress_->beat.load();
  last_beat_ = -1;
  was_hung_ = false;
}

void WorkerProcess::give(const Job& job, const std::vector<bool>& is_skipped) {
  progress_->stream = 0;
  progress_->number = 0;
  for (Counts& row : progress_->rows) row = {};
  for (std::size_t i = 0; i < is_skipped.size(); ++i) progress_->is_skipped[i] = is_skipped[i];
  job_ = job;
  last_beat_ = -1;
  send(jobs_, job);
}

std::optional<Event> WorkerProcess::receive_event() {
  Event event;
  if (!receive(events_, event)) return std::nullopt;
  event.failure[kFailureWord - 1] = '\0';
  return event;
}

Death WorkerProcess::bury() {
  int status = 0;
  if (waitpid(pid_, &status, 0) != pid_) fail("waitpid");
  pid_ = -1;
  close(jobs_);
  close(events_);
  jobs_ = events_ = -1;
  Death death;
  death.at_start = progress_->beat.load() == beat_at_start_;
  if (was_hung_) {
    death.failure = "hung";
  } else if (WIFSIGNALED(status)) {
    const char* name = sigabbrev_np(WTERMSIG(status));
    death.failure = std::string("crashed-SIG") + (name != nullptr ? name : "?");
  } else {
    death.failure = "exited";
  }
  return death;
}

void WorkerProcess::revive() {
  start();
  if (job_ && job_->kind == Job::Kind::kUnit) {
    send(jobs_, *job_);
  } else {
    job_.reset();
  }
}

double WorkerProcess::processor_seconds() const {
  clockid_t clock{};
  timespec now{};
  if (clock_getcpuclockid(pid_, &clock) != 0 || clock_gettime(clock, &now) != 0) return seconds_at_beat_;  // just died
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

void WorkerProcess::watch(double case_seconds) {
  if (!job_ || job_->kind != Job::Kind::kUnit) return;  // shrinking runs many cases, and is bounded by their number
  const std::int64_t beat = progress_->beat.load();
  if (beat == beat_at_start_) return;  // not at its first case yet
  const auto now = std::chrono::steady_clock::now();
  if (beat != last_beat_) {
    last_beat_ = beat;
    seconds_at_beat_ = processor_seconds();
    clock_at_beat_ = now;
    return;
  }
  const bool too_busy = processor_seconds() - seconds_at_beat_ > case_seconds;
  const bool too_long = std::chrono::duration<double>(now - clock_at_beat_).count() > kClockShare * case_seconds;
  if (!too_busy && !too_long) return;
  was_hung_ = true;
  kill(pid_, SIGKILL);
}

}  // namespace selvage::fuzz
