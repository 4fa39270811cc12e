// What a method takes for a query, over passes in many orders.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <limits>
#include <numeric>
#include <optional>
#include <random>
#include <vector>

#include "bench/measure.h"
#include "bench/query_methods.h"

namespace selvage::bench {

/// Nanoseconds a query. The mean is the best pass, timed as a whole in processor time of the thread. The others are
/// single queries in wall time, each at its best over the passes, with the clock's own cost in them.
struct QueryTimes {
  double mean = 0, median = 0, p99 = 0, max = 0;
};

struct TimedAnswers {
  QueryTimes ns;
  std::optional<std::size_t> unsteady;  ///< a query that got another answer than the first time
};

/// `ask(i)` answers query i, again and again; `answers` has what it said the first time, which warmed it up. Every pass
/// visits the queries in a new order that depends on the pass alone. REQUIRES at least one query.
template <typename Ask>
[[nodiscard]] TimedAnswers time_answers(const std::vector<MethodAnswer>& answers, int repeat, const Ask& ask) {
  using Clock = std::chrono::steady_clock;
  TimedAnswers timed;
  std::vector<std::size_t> order(answers.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::vector<double> single(answers.size(), std::numeric_limits<double>::infinity());
  double best_pass = std::numeric_limits<double>::infinity();
  std::mt19937_64 shuffler(1);  // a fixed order of queries would teach it to the branch predictor
  for (int pass = 0; pass < repeat; ++pass) {
    std::shuffle(order.begin(), order.end(), shuffler);
    const double pass_start = thread_nanoseconds();
    for (const std::size_t i : order) {
      if (ask(i) != answers[i]) timed.unsteady = i;
    }
    best_pass = std::min(best_pass, thread_nanoseconds() - pass_start);
    for (const std::size_t i : order) {
      const Clock::time_point start = Clock::now();
      if (ask(i) != answers[i]) timed.unsteady = i;
      single[i] = std::min(single[i], std::chrono::duration<double, std::nano>(Clock::now() - start).count());
    }
  }
  std::sort(single.begin(), single.end());
  timed.ns = {best_pass / static_cast<double>(answers.size()), quantile(single, 0.5), quantile(single, 0.99),
              single.back()};
  return timed;
}

}  // namespace selvage::bench
