#include "fuzz/worker_process.h"

#include <csignal>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <new>
#include <string>
#include <system_error>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include "fuzz/wire.h"

namespace selvage::fuzz {
namespace {

[[noreturn]] void fail(const char* what) { throw std::system_error(errno, std::generic_category(), what); }

std::array<int, 2> make_pipe() {
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0) fail("pipe");
  return ends;
}

/// Of all its threads. Nothing where it has died.
std::optional<double> processor_seconds(pid_t process) {
  clockid_t clock{};
  timespec now{};
  if (clock_getcpuclockid(process, &clock) != 0 || clock_gettime(clock, &now) != 0) return std::nullopt;
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Whether none of its threads runs, waits for a processor or for a disk: all sleep, or were stopped.
bool is_asleep(pid_t process) {
  std::error_code error;  // of threads that end while we look
  std::filesystem::directory_iterator thread("/proc/" + std::to_string(process) + "/task", error);
  for (; !error && thread != end(thread); thread.increment(error)) {
    std::ifstream file(thread->path() / "stat");
    std::string stat;
    std::getline(file, stat);
    const std::size_t state = stat.rfind(')') + 2;  // behind the program's name, which may hold anything
    if (state >= stat.size() || (stat[state] != 'S' && stat[state] != 'T')) return false;
  }
  return !error;
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
    madvise(progress_, sizeof(Progress), MADV_DONTFORK);  // what the code under test forks takes no part in it
    work(setting_, *progress_, jobs[0], events[1]);
  }
  close(jobs[0]);
  close(events[1]);
  jobs_ = jobs[1];
  events_ = events[0];
  beat_at_start_ = progress_->beat.load();
  clock_ = {};
  was_hung_ = false;
}

void WorkerProcess::give(const Job& job, const std::vector<bool>& is_skipped) {
  progress_->stream = 0;
  progress_->number = 0;
  for (Counts& row : progress_->rows) row = {};
  for (std::size_t i = 0; i < is_skipped.size(); ++i) progress_->is_skipped[i] = is_skipped[i];
  job_ = job;
  clock_ = {};
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

void WorkerProcess::watch(double case_seconds) {
  if (!job_ || job_->kind != Job::Kind::kUnit) return;  // shrinking runs many cases, and is bounded by their number
  const std::int64_t beat = progress_->beat.load();
  if (beat == beat_at_start_) return;  // not at its first case yet
  const std::optional<double> used = processor_seconds(pid_);
  if (!used) return;  // it has just died
  if (!clock_.is_over({beat, *used, is_asleep(pid_), std::chrono::steady_clock::now()}, case_seconds)) return;
  was_hung_ = true;
  kill(pid_, SIGKILL);
}

}  // namespace selvage::fuzz
