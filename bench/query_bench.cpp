#include "bench/query_bench.h"

#include <algorithm>
#include <chrono>
#include <limits>
#include <numeric>
#include <random>

#include <nlohmann/json.hpp>

#include "bench/measure.h"
#include "bench/query_methods.h"
#include "bench/textbook.h"

namespace selvage::bench {
namespace {

struct FileQuery {
  MethodQuery asked;
  std::optional<bool> truth;
  std::size_t file = 0, line = 0;  ///< of its first row
};

struct TimedMethod {
  const char* name;
  MethodAnswer (*ask)(const MethodQuery&, double tolerance);
  double tolerance;
  bool gives_toi;
};

std::array<TimedMethod, 3> timed_methods(double kernel_tolerance) {
  const auto exact = [](const MethodQuery& query, double) { return exact_decision(query); };
  return {{{"kernel", kernel_within, kernel_tolerance, true},
           {"textbook", textbook_within, kTextbookTolerance, true},
           {"exact", exact, 0, false}}};
}

std::vector<FileQuery> flatten(std::span<const QueryFile> files) {
  std::vector<FileQuery> queries;
  for (const QueryFile& file : files) {
    std::size_t line = 1;
    for (const io::CcdQuery& read : file.queries) {
      std::array<Vec3, 4> x_t0, x_t1;
      for (std::size_t i = 0; i < 4; ++i) {
        x_t0[i] = Vec3(read.points[i].data());
        x_t1[i] = Vec3(read.points[i + 4].data());
      }
      const auto number = static_cast<std::size_t>(&file - files.data());
      queries.push_back({method_query(file.kind, x_t0, x_t1), read.truth, number, line});
      line += io::kRowsPerQuery;
    }
  }
  return queries;
}

using Clock = std::chrono::steady_clock;
double nanoseconds(Clock::duration duration) { return std::chrono::duration<double, std::nano>(duration).count(); }

double clock_cost() {
  double best = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 1000; ++i) {
    const Clock::time_point start = Clock::now();
    best = std::min(best, nanoseconds(Clock::now() - start));
  }
  return best;
}

/// Answers in the order of the queries, and the times of `repeat` passes.
std::vector<MethodAnswer> time_method(const TimedMethod& method, const std::vector<FileQuery>& queries, int repeat,
                                      QueryTimes& ns) {
  const auto ask = [&](std::size_t i) { return method.ask(queries[i].asked, method.tolerance); };
  std::vector<std::size_t> order(queries.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::vector<MethodAnswer> answers(queries.size());
  for (const std::size_t i : order) answers[i] = ask(i);  // warms up, and gives the answers

  std::vector<double> single(queries.size(), std::numeric_limits<double>::infinity());
  double best_pass = std::numeric_limits<double>::infinity();
  std::mt19937_64 shuffler(1);  // a fixed order of queries would teach it to the branch predictor
  bool answered = true;         // keeps the calls from being removed
  for (int pass = 0; pass < repeat; ++pass) {
    std::shuffle(order.begin(), order.end(), shuffler);
    const double pass_start = thread_nanoseconds();
    for (const std::size_t i : order) answered &= ask(i).alarm == answers[i].alarm;
    best_pass = std::min(best_pass, thread_nanoseconds() - pass_start);
    for (const std::size_t i : order) {
      const Clock::time_point start = Clock::now();
      answered &= ask(i).alarm == answers[i].alarm;
      single[i] = std::min(single[i], nanoseconds(Clock::now() - start));
    }
  }
  if (!answered) throw std::logic_error(std::string(method.name) + " answered one query in two ways");
  std::sort(single.begin(), single.end());
  ns = {best_pass / static_cast<double>(queries.size()), quantile(single, 0.5), quantile(single, 0.99), single.back()};
  return answers;
}

ToiError measure_toi(const std::vector<FileQuery>& queries, const std::vector<MethodAnswer>& answers,
                     const std::vector<verify::MotionAnswer>& exact) {
  ToiErrors errors;
  for (std::size_t i = 0; i < queries.size(); ++i) {
    if (!exact[i].touches || !answers[i].alarm) continue;
    const MethodQuery& query = queries[i].asked;
    const double toi = answers[i].toi;
    const bool is_vf = query.kind == PairKind::kVf;
    errors.add(exact[i].first.lower_approx, toi,
               verify::compare_first_touch(query.point_t0, query.point_t1, is_vf, toi) < 0);
  }
  return errors.summary();
}

}  // namespace

std::optional<PairKind> kind_of_path(const std::filesystem::path& file) {
  const std::string stem = file.stem().string();
  if (stem.ends_with("vf")) return PairKind::kVf;
  if (stem.ends_with("ee")) return PairKind::kEe;
  for (const std::filesystem::path& folder : file.parent_path()) {
    if (folder == "vertex-face") return PairKind::kVf;
    if (folder == "edge-edge") return PairKind::kEe;
  }
  return std::nullopt;
}

QueryBenchReport run_query_bench(std::span<const QueryFile> files, const QueryBenchOptions& options) {
  QueryBenchReport report;
  for (const QueryFile& file : files) report.files.push_back(file.file.string());
  const std::vector<FileQuery> queries = flatten(files);
  std::vector<verify::MotionAnswer> exact;
  exact.reserve(queries.size());
  std::vector<bool> truth;
  for (const FileQuery& query : queries) {
    exact.push_back(exact_answer(query.asked, verify::Detail::kFirstTime));
    truth.push_back(query.truth.value_or(exact.back().touches));
    report.truth_in_files += query.truth.has_value();
    report.positives += truth.back();
    if (truth.back() != exact.back().touches) {
      report.contradicted.push_back(report.files[query.file] + ":" + std::to_string(query.line));
    }
  }
  report.queries = static_cast<std::int64_t>(queries.size());
  report.clock_ns = clock_cost();
  for (const TimedMethod& method : timed_methods(options.tolerance)) {
    MethodReport& of_method = report.methods.emplace_back();
    of_method.name = method.name;
    const std::vector<MethodAnswer> answers = time_method(method, queries, options.repeat, of_method.ns);
    for (std::size_t i = 0; i < queries.size(); ++i) {
      of_method.false_negatives += truth[i] && !answers[i].alarm;
      of_method.false_positives += !truth[i] && answers[i].alarm;
      of_method.unresolved += answers[i].gave_up;
    }
    if (method.gives_toi) of_method.toi = measure_toi(queries, answers, exact);
  }
  return report;
}

std::string to_json(const QueryBenchReport& report) {
  nlohmann::ordered_json methods;
  for (const MethodReport& method : report.methods) {
    const ToiError& toi = method.toi;
    methods[method.name] = {
        {"false_negatives", method.false_negatives},
        {"false_positives", method.false_positives},
        {"unresolved", method.unresolved},
        {"late_toi", toi.late},
        {"toi_error",
         {{"late_max", toi.late_max},
          {"early_median", toi.early_median},
          {"early_p99", toi.early_p99},
          {"early_max", toi.early_max}}},
        {"ns",
         {{"mean", method.ns.mean}, {"median", method.ns.median}, {"p99", method.ns.p99}, {"max", method.ns.max}}}};
  }
  const nlohmann::ordered_json json = {{"schema", "selvage.bench.queries/1"},
                                       {"files", report.files},
                                       {"queries", report.queries},
                                       {"positives", report.positives},
                                       {"truth_in_files", report.truth_in_files},
                                       {"contradicted", report.contradicted},
                                       {"clock_ns", report.clock_ns},
                                       {"methods", methods}};
  return json.dump(2) + "\n";
}

}  // namespace selvage::bench
