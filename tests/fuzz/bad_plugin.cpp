// A plugin that says "collides" wherever boxes meet and does one thing that nobody may do, chosen by a macro.
#include <algorithm>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <stdexcept>

#include <fenv.h>
#include <sys/resource.h>
#include <unistd.h>

#include "fuzz/selvage-plugin.h"
#include "tests/fp_control.h"
#if defined(INVENTS_FAILURES)
#include "fuzz/run/worker.h"
#endif

namespace {

#if defined(HAS_A_BAD_NAME)
// A line break, the start of a command to the terminal, a byte that is no UTF-8; then a character across the 63rd byte.
constexpr const char* kName = "a\n\x1b[31m \xff ........ ........ ........ ........ ........ .......\xc3\xa9 and so on";
#else
constexpr const char* kName = "bad";
#endif

#if defined(IS_OF_ANOTHER_VERSION)
constexpr std::uint32_t kVersion = SELVAGE_PLUGIN_VERSION + 1;
#else
constexpr std::uint32_t kVersion = SELVAGE_PLUGIN_VERSION;
#endif
#if defined(GIVES_NO_TIME) || defined(CALLS_ALL_COLLISIONS) || defined(ANSWERS_LATE)
constexpr std::int32_t kHasToi = 1;
#else
constexpr std::int32_t kHasToi = 0;
#endif

#if defined(CALLS_ALL_COLLISIONS)
constexpr double kTolerance = 1e308;
#else
constexpr double kTolerance = 0x1p+1000;
#endif

/// Whether the boxes about the paths of the two features meet: the first feature are the points below `first_of_other`.
bool boxes_meet(const selvage_query& query, int first_of_other) {
  for (int axis = 0; axis < 3; ++axis) {
    double low[2], high[2];
    for (int i = 0; i < 4; ++i) {
      const bool is_first = i == 0 || i == first_of_other;
      const int feature = i < first_of_other ? 0 : 1;
      const auto [least, most] = std::minmax(query.x_t0[i][axis], query.x_t1[i][axis]);
      low[feature] = is_first ? least : std::min(low[feature], least);
      high[feature] = is_first ? most : std::max(high[feature], most);
    }
    if (low[0] > high[1] || low[1] > high[0]) return false;
  }
  return true;
}

void answer(int32_t kind, const selvage_query* query, selvage_answer* answer) {
  answer->verdict = boxes_meet(*query, kind == SELVAGE_VF ? 1 : 2) ? SELVAGE_COLLIDES : SELVAGE_SEPARATED;
  answer->toi = std::numeric_limits<double>::quiet_NaN();  // which counts where it is said to be a time
#if defined(CALLS_ALL_COLLISIONS)
  *answer = {SELVAGE_COLLIDES, 0};
#elif defined(ANSWERS_LATE)
  answer->toi = 1;
#elif defined(HANGS)
  volatile bool goes_on = true;
  while (goes_on) {
  }
#elif defined(NAPS)
  usleep(2000);
#elif defined(SLEEPS)
  std::puts("a plugin falls asleep");
  while (true) pause();
#elif defined(EXITS)
  std::exit(0);
#elif defined(THROWS)
  throw 1;
#elif defined(UNMASKS_FP_ERRORS)
  feenableexcept(FE_INEXACT);
#elif defined(FORKS)
  static int calls = 0;
  if (++calls == 30) [[maybe_unused]]
    const auto ignored = fork();
#elif defined(CRASHES_AT_REST)
  if (std::memcmp(query->x_t0, query->x_t1, sizeof query->x_t0) == 0) std::raise(SIGSEGV);
#elif defined(CRASHES)
  std::raise(SIGSEGV);
#elif defined(WRITES_OUT_OF_BOUNDS)
  answer[1].verdict = 0;
#elif defined(GIVES_NO_VERDICT)
  answer->verdict = 17;
#elif defined(REMEMBERS)
  static int calls = 0;
  if (++calls % 50 == 0) answer->verdict = SELVAGE_SEPARATED;
#elif defined(WAVERS)
  static std::uint32_t state = 1;
  state = 1664525 * state + 1013904223;
  if (state >> 31 != 0) answer->verdict = SELVAGE_SEPARATED;
#elif defined(KEEPS_ITS_LAST_ANSWER)
  static selvage_query last_query;
  static selvage_answer last_answer;
  static int calls = 0;
  const bool is_last = calls++ > 0 && std::memcmp(query, &last_query, sizeof last_query) == 0;
  if (calls % 50 == 0) answer->verdict = SELVAGE_SEPARATED;
  if (is_last) *answer = last_answer;
  last_query = *query;
  last_answer = *answer;
#elif defined(CHANGES_ROUNDING)
  selvage::testing::set_fp_control(selvage::testing::fp_control() | selvage::testing::kRoundUp);
#elif defined(SETS_FTZ)
  selvage::testing::set_fp_control(selvage::testing::fp_control() | selvage::testing::kFlushToZero);
#elif defined(WRITES_TO_FILES)
  for (int file = 3; file < 64; ++file) [[maybe_unused]] const auto ignored = write(file, "{}\n", 3);
#elif defined(INVENTS_FAILURES)
  selvage::fuzz::Event event;
  event.kind = selvage::fuzz::Event::Kind::kFailure;
  event.number = std::int64_t{1} << 40;  // of a unit that its worker does not have
  std::strcpy(event.failure, "invented");
  for (int file = 3; file < 64; ++file) [[maybe_unused]] const auto ignored = write(file, &event, sizeof event);
#elif defined(FORBIDS_FILES)
  const rlimit none = {3, 3};
  setrlimit(RLIMIT_NOFILE, &none);
  answer->verdict = SELVAGE_SEPARATED;  // which is a case to keep
#elif defined(CLOSES_FILES)
  for (int file = 0; file < 64; ++file) close(file);
#endif
}

void answer_batch(int32_t kind, size_t count, const selvage_query* queries, selvage_answer* answers) {
#if defined(WRITES_WHOLE_VECTORS)
  if (count % 4 == 3) answers[count].verdict = SELVAGE_SEPARATED;
#elif defined(ANSWERS_AT_LEAST_ONE)
  if (count == 0) answers[0].verdict = SELVAGE_SEPARATED;
#endif
  for (size_t i = 0; i < count; ++i) {
#if defined(ANSWERS_ALL_LIKE_THE_FIRST)
    answer(kind, queries, answers + i);
#else
    answer(kind, queries + i, answers + i);
#endif
#if defined(FORGETS_LATER_LANES)
    if (i >= 3) answers[i].verdict = SELVAGE_SEPARATED;
#elif defined(FORGETS_THE_LAST)
    if (i + 1 == count) answers[i].verdict = SELVAGE_SEPARATED;
#elif defined(HAS_ROOM_FOR_A_HUNDRED)
    if (i >= 100) answers[i] = answers[i - 100];
#elif defined(REPEATS_A_VECTOR)
    if (i >= 4) answers[i] = answers[i - 4];
#endif
  }
}

}  // namespace

#if defined(HAS_ANOTHER_ENTRY)
#define selvage_plugin_entry selvage_plugin_entry_v0
#endif

extern "C" const selvage_plugin* selvage_plugin_entry(void) {
  std::puts("a plugin says hello");
#if defined(EXITS_AT_LOAD)
  std::exit(0);
#elif defined(THROWS_AT_LOAD)
  throw std::runtime_error("no licence");
#elif defined(HANGS_AT_LOAD)
  while (true) pause();
#elif defined(HANGS_IN_WORKERS)
  struct sigaction on_stop = {};  // a campaign's workers ignore what asks their driver to stop
  sigaction(SIGTERM, nullptr, &on_stop);
  while (on_stop.sa_handler == SIG_IGN) pause();
#endif
#if defined(REMEMBERS)
  static const selvage_plugin plugin = {kVersion, kName, kTolerance, 0, kHasToi, answer, nullptr};
#else
  static const selvage_plugin plugin = {kVersion, kName, kTolerance, 0, kHasToi, answer, answer_batch};
#endif
  return &plugin;
}
