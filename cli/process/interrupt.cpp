#include "cli/process/interrupt.h"

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <ctime>

namespace selvage::cli {
namespace {

/// In nanoseconds. Longer than a launcher takes to pass on what the terminal has sent to it and to us, shorter than a
/// person who wants the end at once.
constexpr std::int64_t kOneRequest_ns = 500'000'000;

/// When the first signal came; 0: none did.
std::atomic<std::int64_t> stop_requested_ns = 0;
static_assert(std::atomic<std::int64_t>::is_always_lock_free, "a signal handler may only touch lock-free atomics");

std::int64_t now_ns() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return std::int64_t{now.tv_sec} * 1'000'000'000 + now.tv_nsec;
}

void request_stop(int number) {
  const int error = errno;  // of whatever this interrupts
  const std::int64_t now = now_ns();
  std::int64_t first = 0;
  if (!stop_requested_ns.compare_exchange_strong(first, now) && now - first > kOneRequest_ns) {
    std::signal(number, SIG_DFL);
    (void)raise(number);  // which kills as soon as this returns
  }
  errno = error;
}

}  // namespace

void catch_interrupts() {
  struct sigaction action = {};
  action.sa_handler = request_stop;
  action.sa_flags = SA_RESTART;
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  // A terminal that closes; nohup has it ignored.
  struct sigaction hangup = {};
  sigaction(SIGHUP, nullptr, &hangup);
  if (hangup.sa_handler != SIG_IGN) sigaction(SIGHUP, &action, nullptr);
}

bool interrupted() noexcept { return stop_requested_ns.load(std::memory_order_relaxed) != 0; }

void make_size_limits_errors() { std::signal(SIGXFSZ, SIG_IGN); }

}  // namespace selvage::cli
