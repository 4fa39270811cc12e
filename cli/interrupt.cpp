#include "cli/interrupt.h"

#include <atomic>
#include <csignal>

namespace selvage::cli {
namespace {

std::atomic<bool> stop_requested = false;
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may only touch lock-free atomics");

void request_stop(int /*signal*/) { stop_requested.store(true, std::memory_order_relaxed); }

}  // namespace

void catch_interrupts() {
  struct sigaction action = {};
  action.sa_handler = request_stop;
  action.sa_flags =
      SA_RESTART | static_cast<int>(SA_RESETHAND);  // the second signal finds the default action: it kills
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

bool interrupted() noexcept { return stop_requested.load(std::memory_order_relaxed); }

void make_size_limits_errors() { std::signal(SIGXFSZ, SIG_IGN); }

}  // namespace selvage::cli
