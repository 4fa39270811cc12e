// Code under test, run once in a child process, where it may crash, hang or exit.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <type_traits>

namespace selvage::fuzz {

/// In a child process that is to run code under test: it dies with its parent; a crash ends it by its signal, of which
/// a sanitizer's handler would make an exit; and what is printed is written line by line, so that a crash loses none.
void become_test_process();

/// How a child died, from its status: kExited, or kCrashed with the signal (deaths.h).
[[nodiscard]] std::string death_of(int status);

/// What has to be done before the code under test is asked, and how long it may take, counted as a case (case_clock.h).
struct Preparation {
  std::function<void()> run;
  double seconds = 0;
};

/// What `prepare` and then `work` leave in a memory of `size` bytes that parent and child share, zero before; also
/// where the child dies. How it died (deaths.h), or nothing. What `prepare` throws is thrown here, as
/// io::Error(kBadInput). What the child prints goes to stderr: it is no result.
struct ChildWork {
  Preparation prepare;
  std::function<void(void* memory, std::atomic<std::int64_t>& beat)> work;
  std::size_t size = 0;
  double seconds = 0;  ///< for `work`, anew whenever it has made `beat` grow
};
struct ChildEnd {
  std::string death;
  bool has_prepared = false;
};
[[nodiscard]] ChildEnd run_in_child(const ChildWork& child, void* result);

template <class Result>
struct Guarded {
  std::string death;
  bool has_prepared = false;
  Result result{};  ///< where it did not die
};

template <class Result>
[[nodiscard]] Guarded<Result> run_guarded(Preparation prepare, const std::function<Result()>& work, double seconds) {
  static_assert(std::is_trivially_copyable_v<Result>);
  Guarded<Result> guarded;
  const auto leave = [&work](void* memory, std::atomic<std::int64_t>&) { *static_cast<Result*>(memory) = work(); };
  Result left{};
  const ChildEnd end = run_in_child({std::move(prepare), leave, sizeof(Result), seconds}, &left);
  if (end.death.empty()) guarded.result = left;
  guarded.death = end.death;
  guarded.has_prepared = end.has_prepared;
  return guarded;
}

}  // namespace selvage::fuzz
