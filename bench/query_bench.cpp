#include "bench/query_bench.h"

#include <algorithm>
#include <chrono>
#include <limits>
#include <stdexcept>

#include <nlohmann/json.hpp>

#include "bench/query_methods.h"
#include "bench/textbook.h"

namespace selvage::bench {
namespace {

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

struct Answered {
  std::vector<MethodAnswer> answers;  ///< in the order of the queries
  QueryTimes ns;
};

Answered time_method(const TimedMethod& method, const std::vector<FileQuery>& queries, int repeat) {
  const auto ask = [&](std::size_t i) { return method.ask(queries[i].asked, method.tolerance); };
  Answered answered;
  for (std::size_t i = 0; i < queries.size(); ++i) answered.answers.push_back(ask(i));
  const TimedAnswers timed = time_answers(answered.answers, repeat, ask);
  if (timed.unsteady) throw std::logic_error(std::string(method.name) + " answered one query in two ways");
  answered.ns = timed.ns;
  return answered;
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

/// What the methods' answers are held against.
struct Truth {
  std::vector<verify::MotionAnswer> exact;
  std::vector<bool> touches;  ///< by the file, or by the exact checker where it says nothing
};

MethodReport judge(const std::string& name, const Answered& answered, bool gives_toi,
                   const std::vector<FileQuery>& queries, const Truth& truth) {
  MethodReport report;
  report.name = name;
  report.ns = answered.ns;
  report.gives_toi = gives_toi;
  for (std::size_t i = 0; i < queries.size(); ++i) {
    const MethodAnswer& answer = answered.answers[i];
    report.false_negatives += truth.touches[i] && !answer.alarm;
    report.false_positives += !truth.touches[i] && answer.alarm;
    report.unresolved += answer.gave_up;
  }
  if (gives_toi) report.toi = measure_toi(queries, answered.answers, truth.exact);
  return report;
}

std::int64_t count_beyond_gap(const GuestMethod<QueryTimes>& guest, const std::vector<FileQuery>& queries,
                              const Truth& truth) {
  std::int64_t count = 0;
  for (std::size_t i = 0; i < queries.size(); ++i) {
    const bool is_false = guest.answers[i].alarm && !truth.touches[i] && !truth.exact[i].touches;
    count += is_false && guest.is_beyond_gap(queries[i].asked, guest.answers[i]);
  }
  return count;
}

}  // namespace

QueryBenchReport run_query_bench(std::span<const QueryFile> files, const QueryBenchOptions& options,
                                 const std::optional<GuestMethod<QueryTimes>>& guest) {
  QueryBenchReport report;
  for (const QueryFile& file : files) report.files.push_back(file.file.string());
  const std::vector<FileQuery> queries = all_queries(files);
  Truth truth;
  truth.exact.reserve(queries.size());
  for (const FileQuery& query : queries) {
    truth.exact.push_back(exact_answer(query.asked, verify::Detail::kFirstTime));
    const bool touches = truth.exact.back().touches;
    truth.touches.push_back(query.truth.value_or(touches));
    report.truth_in_files += query.truth.has_value();
    report.positives += truth.touches.back();
    if (truth.touches.back() != touches) report.contradicted.push_back(place_of(query, files));
  }
  report.queries = static_cast<std::int64_t>(queries.size());
  report.clock_ns = clock_cost();
  for (const TimedMethod& method : timed_methods(options.tolerance)) {
    const Answered answered = time_method(method, queries, options.repeat);
    report.methods.push_back(judge(method.name, answered, method.gives_toi, queries, truth));
  }
  if (guest) {
    report.methods.push_back(judge(kGuestRow, {guest->answers, guest->ns}, guest->facts.has_toi, queries, truth));
    report.methods.back().false_positives_beyond_gap = count_beyond_gap(*guest, queries, truth);
    report.guest = guest->facts;
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
    if (method.false_positives_beyond_gap) {
      methods[method.name]["false_positives_beyond_gap"] = *method.false_positives_beyond_gap;
    }
  }
  nlohmann::ordered_json json = {{"schema", "selvage.bench.queries/1"},
                                 {"files", report.files},
                                 {"queries", report.queries},
                                 {"positives", report.positives},
                                 {"truth_in_files", report.truth_in_files},
                                 {"contradicted", report.contradicted},
                                 {"clock_ns", report.clock_ns},
                                 {"methods", methods}};
  if (report.guest) json[kGuestRow] = to_json(*report.guest);
  return json.dump(2) + "\n";
}

}  // namespace selvage::bench
