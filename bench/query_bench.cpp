#include "bench/query_bench.h"

#include <algorithm>
#include <chrono>
#include <limits>
#include <numeric>
#include <random>

#include <nlohmann/json.hpp>

#include "bench/measure.h"
#include "bench/textbook.h"
#include "kernel/ccd.h"
#include "verify/decision/exact_motion.h"

namespace selvage::bench {
namespace {

struct BenchQuery {
  PairKind kind = PairKind::kVf;
  std::array<Vec3, 4> x_t0, x_t1;
  std::array<verify::Point, 4> point_t0{}, point_t1{};
  std::optional<bool> truth;
  std::size_t file = 0, line = 0;  ///< of its first row
  double tolerance = 0;
};

struct BenchAnswer {
  bool positive = false, unresolved = false;
  double toi = 0;
};

struct Method {
  const char* name;
  BenchAnswer (*ask)(const BenchQuery&);
  bool gives_toi;
};

BenchAnswer ask_kernel(const BenchQuery& query) {
  CcdOptions options;
  options.tolerance = query.tolerance;
  const CcdResult result =
      query.kind == PairKind::kVf ? vf_ccd(query.x_t0, query.x_t1, options) : ee_ccd(query.x_t0, query.x_t1, options);
  return {result.verdict != CcdVerdict::kSeparated, result.verdict == CcdVerdict::kUnresolved, result.toi_lower};
}

BenchAnswer ask_textbook(const BenchQuery& query) {
  const TextbookAnswer answer =
      query.kind == PairKind::kVf ? textbook_vf(query.x_t0, query.x_t1) : textbook_ee(query.x_t0, query.x_t1);
  return {answer.collides, false, answer.toi};
}

verify::MotionAnswer exact_answer(const BenchQuery& query, verify::Detail detail) {
  return query.kind == PairKind::kVf ? verify::exact_vf_motion(query.point_t0, query.point_t1, detail)
                                     : verify::exact_ee_motion(query.point_t0, query.point_t1, detail);
}

BenchAnswer ask_exact(const BenchQuery& query) {
  return {exact_answer(query, verify::Detail::kDecision).touches, false, 0};
}

constexpr std::array<Method, 3> kQueryMethods{
    {{"kernel", ask_kernel, true}, {"textbook", ask_textbook, true}, {"exact", ask_exact, false}}};

std::vector<BenchQuery> flatten(std::span<const QueryFile> files, double tolerance) {
  std::vector<BenchQuery> queries;
  for (const QueryFile& file : files) {
    std::size_t line = 1;
    for (const io::CcdQuery& read : file.queries) {
      BenchQuery query;
      query.file = static_cast<std::size_t>(&file - files.data());
      query.line = line;
      line += io::kRowsPerQuery;
      query.kind = file.kind;
      query.truth = read.truth;
      query.tolerance = tolerance;
      for (std::size_t i = 0; i < 4; ++i) {
        query.point_t0[i] = read.points[i];
        query.point_t1[i] = read.points[i + 4];
        query.x_t0[i] = Vec3(query.point_t0[i][0], query.point_t0[i][1], query.point_t0[i][2]);
        query.x_t1[i] = Vec3(query.point_t1[i][0], query.point_t1[i][1], query.point_t1[i][2]);
      }
      queries.push_back(query);
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
std::vector<BenchAnswer> time_method(const Method& method, const std::vector<BenchQuery>& queries, int repeat,
                                     QueryTimes& ns) {
  std::vector<std::size_t> order(queries.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::vector<BenchAnswer> answers(queries.size());
  for (const std::size_t i : order) answers[i] = method.ask(queries[i]);  // warms up, and gives the answers

  std::vector<double> single(queries.size(), std::numeric_limits<double>::infinity());
  double best_pass = std::numeric_limits<double>::infinity();
  std::mt19937_64 shuffler(1);  // a fixed order of queries would teach it to the branch predictor
  bool answered = true;         // keeps the calls from being removed
  for (int pass = 0; pass < repeat; ++pass) {
    std::shuffle(order.begin(), order.end(), shuffler);
    const double pass_start = thread_nanoseconds();
    for (const std::size_t i : order) answered &= method.ask(queries[i]).positive == answers[i].positive;
    best_pass = std::min(best_pass, thread_nanoseconds() - pass_start);
    for (const std::size_t i : order) {
      const Clock::time_point start = Clock::now();
      answered &= method.ask(queries[i]).positive == answers[i].positive;
      single[i] = std::min(single[i], nanoseconds(Clock::now() - start));
    }
  }
  if (!answered) throw std::logic_error(std::string(method.name) + " answered one query in two ways");
  std::sort(single.begin(), single.end());
  ns = {best_pass / static_cast<double>(queries.size()), quantile(single, 0.5), quantile(single, 0.99), single.back()};
  return answers;
}

ToiError measure_toi(const std::vector<BenchQuery>& queries, const std::vector<BenchAnswer>& answers,
                     const std::vector<verify::MotionAnswer>& exact) {
  ToiError error;
  std::vector<double> early;
  for (std::size_t i = 0; i < queries.size(); ++i) {
    if (!exact[i].touches || !answers[i].positive) continue;
    const double toi = answers[i].toi;
    const bool is_vf = queries[i].kind == PairKind::kVf;
    if (verify::compare_first_touch(queries[i].point_t0, queries[i].point_t1, is_vf, toi) < 0) {
      ++error.late;
      error.late_max = std::max(error.late_max, toi - exact[i].first.lower_approx);
    }
    early.push_back(std::max(0.0, exact[i].first.lower_approx - toi));
  }
  std::sort(early.begin(), early.end());
  error.early_median = quantile(early, 0.5);
  error.early_p99 = quantile(early, 0.99);
  error.early_max = early.empty() ? 0 : early.back();
  return error;
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
  const std::vector<BenchQuery> queries = flatten(files, options.tolerance);
  std::vector<verify::MotionAnswer> exact;
  exact.reserve(queries.size());
  std::vector<bool> truth;
  for (const BenchQuery& query : queries) {
    exact.push_back(exact_answer(query, verify::Detail::kFirstTime));
    truth.push_back(query.truth.value_or(exact.back().touches));
    report.truth_in_files += query.truth.has_value();
    report.positives += truth.back();
    if (truth.back() != exact.back().touches) {
      report.contradicted.push_back(report.files[query.file] + ":" + std::to_string(query.line));
    }
  }
  report.queries = static_cast<std::int64_t>(queries.size());
  report.clock_ns = clock_cost();
  for (const Method& method : kQueryMethods) {
    MethodReport& of_method = report.methods.emplace_back();
    of_method.name = method.name;
    const std::vector<BenchAnswer> answers = time_method(method, queries, options.repeat, of_method.ns);
    for (std::size_t i = 0; i < queries.size(); ++i) {
      of_method.false_negatives += truth[i] && !answers[i].positive;
      of_method.false_positives += !truth[i] && answers[i].positive;
      of_method.unresolved += answers[i].unresolved;
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
