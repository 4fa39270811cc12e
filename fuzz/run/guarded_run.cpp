#include "fuzz/run/guarded_run.h"

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <new>
#include <optional>
#include <system_error>
#include <thread>

#include <oneapi/tbb/global_control.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "fuzz/base/deaths.h"
#include "fuzz/run/case_clock.h"
#include "fuzz/run/process_sight.h"
#include "io/error.h"

namespace selvage::fuzz {
namespace {

enum class Stage : int { kBegun, kPrepared, kDone, kRefused, kThrew };

/// At the head of the memory that parent and child share.
struct alignas(64) Shared {
  std::atomic<Stage> stage = Stage::kBegun;
  std::atomic<std::int64_t> beat = 0;
  char refusal[512] = {};
};
static_assert(std::atomic<Stage>::is_always_lock_free && std::atomic<std::int64_t>::is_always_lock_free,
              "shared between processes");

class SharedMemory {
 public:
  explicit SharedMemory(std::size_t size) : size_(sizeof(Shared) + size) {
    memory_ = mmap(nullptr, size_, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (memory_ == MAP_FAILED) throw std::system_error(errno, std::generic_category(), "mmap");
    head_ = new (memory_) Shared;
  }
  ~SharedMemory() { munmap(memory_, size_); }
  SharedMemory(const SharedMemory&) = delete;
  SharedMemory& operator=(const SharedMemory&) = delete;
  [[nodiscard]] Shared& head() const { return *head_; }
  [[nodiscard]] void* result() const { return head_ + 1; }

 private:
  std::size_t size_;
  void* memory_ = nullptr;
  Shared* head_ = nullptr;
};

[[noreturn]] void be_the_child(const ChildWork& child, const SharedMemory& memory) {
  become_test_process();
  dup2(2, 1);
  const oneapi::tbb::global_control one_thread(oneapi::tbb::global_control::max_allowed_parallelism, 1);
  Shared& head = memory.head();
  try {
    child.prepare.run();
    head.stage = Stage::kPrepared;
    child.work(memory.result(), head.beat);
    head.stage = Stage::kDone;
  } catch (const std::exception& error) {
    const bool is_refusal = head.stage == Stage::kBegun;
    std::strncpy(head.refusal, error.what(), sizeof head.refusal - 1);
    head.stage = is_refusal ? Stage::kRefused : Stage::kThrew;
  } catch (...) {
    head.stage = Stage::kThrew;
  }
  std::fflush(nullptr);  // of what the code under test printed
  _exit(0);
}

/// Its status as waitpid() gives it; nothing where it had to be killed.
std::optional<int> wait_for(pid_t process, const Shared& head, const ChildWork& child) {
  CaseClock clock;
  auto pause = std::chrono::microseconds(200);
  while (true) {
    int status = 0;
    if (waitpid(process, &status, WNOHANG) == process) return status;
    std::this_thread::sleep_for(pause);
    pause = std::min(2 * pause, std::chrono::microseconds(100'000));  // as the driver looks
    const bool is_preparing = head.stage == Stage::kBegun;
    const WorkerSight sight{is_preparing ? 0 : 1 + head.beat, processor_seconds(process).value_or(0),
                            is_asleep(process), std::chrono::steady_clock::now()};
    if (!clock.is_over(sight, is_preparing ? child.prepare.seconds : child.seconds)) continue;
    kill(process, SIGKILL);
    waitpid(process, nullptr, 0);
    return std::nullopt;
  }
}

}  // namespace

void become_test_process() {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  for (const int crash : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT}) std::signal(crash, SIG_DFL);
  std::setvbuf(stdout, nullptr, _IOLBF, BUFSIZ);
}

std::string death_of(int status) {
  if (!WIFSIGNALED(status)) return kExited;
  const char* name = sigabbrev_np(WTERMSIG(status));
  return std::string(kCrashed) + "-SIG" + (name != nullptr ? name : "?");
}

ChildEnd run_in_child(const ChildWork& child, void* result) {
  const SharedMemory memory(child.size);
  std::fflush(nullptr);  // or the child would write it once more
  const pid_t process = fork();
  if (process < 0) throw std::system_error(errno, std::generic_category(), "fork");
  if (process == 0) be_the_child(child, memory);
  const std::optional<int> status = wait_for(process, memory.head(), child);
  const Stage stage = memory.head().stage;
  if (stage == Stage::kRefused) throw io::Error(io::ErrorKind::kBadInput, memory.head().refusal);
  ChildEnd end{{}, stage != Stage::kBegun};
  if (!status) {
    end.death = kHung;
  } else if (stage == Stage::kThrew) {
    end.death = kThrew;
  } else if (stage != Stage::kDone || WIFSIGNALED(*status)) {
    end.death = death_of(*status);
  }
  std::memcpy(result, memory.result(), child.size);
  return end;
}

}  // namespace selvage::fuzz
