#include "bench/method_bench.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <random>
#include <stdexcept>

#include <nlohmann/json.hpp>

#include "bench/measure.h"
#include "kernel/ccd_batch.h"
#include "kernel/collisions.h"

namespace selvage::bench {
namespace {

/// A method and what it says of a whole set: fills `answers`, in the order of the queries.
struct Contestant {
  std::string method, setting;
  std::function<void(std::span<const std::size_t> order, std::vector<MethodAnswer>& answers)> ask;
  bool gives_toi;
  std::size_t asked;                                         ///< queries in a pass
  double best_ns = std::numeric_limits<double>::infinity();  // a pass
  std::vector<MethodAnswer> answers = {};
};

/// Keeps the answers to the queries of the set. Both lists are ascending.
void keep_answers(const QuerySet& set, const BatchReport& report, std::size_t first,
                  std::vector<MethodAnswer>& answers) {
  auto query = std::lower_bound(set.place.begin(), set.place.end(), first);
  for (const BatchAnswer& answer : report.answers) {
    query = std::lower_bound(query, set.place.end(), first + answer.candidate);
    if (query == set.place.end()) return;
    if (*query != first + answer.candidate) continue;
    answers[static_cast<std::size_t>(query - set.place.begin())] = {true, answer.ccd.verdict == CcdVerdict::kUnresolved,
                                                                    answer.ccd.toi_lower};
  }
}

void ask_batches(const QuerySet& set, std::vector<MethodAnswer>& answers) {
  std::fill(answers.begin(), answers.end(), MethodAnswer{});
  CcdOptions options;
  options.tolerance = 0;
  const MeshMotion& motion = *set.motion;
  const std::size_t count = set.candidates.vf.size() + set.candidates.ee.size();
  const CcdBatch batch(motion.mesh, motion.V_t0, motion.V_t1, options, count);
  keep_answers(set, batch.ask(set.candidates.vf), 0, answers);
  keep_answers(set, batch.ask(set.candidates.ee), set.candidates.vf.size(), answers);
}

std::vector<Contestant> contestants(const QuerySet& set) {
  std::vector<Contestant> all;
  for (MethodSetting& setting : method_settings()) {
    const auto one_by_one = [&set, ask = std::move(setting.ask)](std::span<const std::size_t> order,
                                                                 std::vector<MethodAnswer>& answers) {
      for (const std::size_t i : order) answers[i] = ask(set.queries[i]);
    };
    all.push_back({setting.method, setting.setting, one_by_one, setting.gives_toi, set.queries.size()});
  }
  if (set.motion != nullptr) {
    const std::size_t count = set.candidates.vf.size() + set.candidates.ee.size();
    all.push_back(
        {"kernel in batches", "0 m", [&set](auto, auto& answers) { ask_batches(set, answers); }, true, count});
  }
  return all;
}

void time_passes(const QuerySet& set, int repeat, std::vector<Contestant>& all) {
  std::vector<std::size_t> order(set.queries.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::mt19937_64 shuffler(1);  // a fixed order of few queries would teach it to the branch predictor
  constexpr double kSlowNs = 1e9;
  for (int pass = 0; pass < repeat; ++pass) {
    if (set.motion == nullptr) std::shuffle(order.begin(), order.end(), shuffler);
    for (Contestant& contestant : all) {
      if (pass > 0 && contestant.best_ns > kSlowNs) continue;
      contestant.answers.resize(set.queries.size());
      const double start = thread_nanoseconds();
      contestant.ask(order, contestant.answers);
      contestant.best_ns = std::min(contestant.best_ns, thread_nanoseconds() - start);
    }
  }
}

SettingReport judge(const QuerySet& set, const std::vector<verify::MotionAnswer>& truth, const Contestant& contestant) {
  SettingReport report;
  report.method = contestant.method;
  report.setting = contestant.setting;
  report.ns = contestant.best_ns / static_cast<double>(std::max<std::size_t>(1, contestant.asked));
  ToiErrors errors;
  std::vector<double> off;
  for (std::size_t i = 0; i < set.queries.size(); ++i) {
    const MethodAnswer& answer = contestant.answers[i];
    report.misses += truth[i].touches && !answer.alarm;
    report.false_alarms += !truth[i].touches && answer.alarm;
    report.gave_up += answer.gave_up;
    if (!contestant.gives_toi || !truth[i].touches || !answer.alarm) continue;
    const MethodQuery& query = set.queries[i];
    const double first = truth[i].first.lower_approx;
    const bool is_vf = query.kind == PairKind::kVf;
    errors.add(first, answer.toi, verify::compare_first_touch(query.point_t0, query.point_t1, is_vf, answer.toi) < 0);
    off.push_back(std::abs(first - answer.toi));
  }
  std::sort(off.begin(), off.end());
  report.toi_off_p99 = quantile(off, 0.99);
  report.toi_examined = errors.count();
  report.toi = errors.summary();
  return report;
}

MethodQuery query_of(const MeshMotion& motion, PairKind kind, std::int32_t first, std::int32_t second) {
  const std::array<VertexId, 4> vertices = pair_vertices(motion.mesh, kind, first, second);
  std::array<Vec3, 4> x_t0, x_t1;
  for (std::size_t i = 0; i < 4; ++i) {
    x_t0[i] = motion.V_t0.row(vertices[i]);
    x_t1[i] = motion.V_t1.row(vertices[i]);
  }
  return method_query(kind, x_t0, x_t1);
}

}  // namespace

QuerySet candidate_set(const std::string& name, const MeshMotion& motion, std::size_t most) {
  QuerySet set{name, "", {}, &motion, candidates_of(motion, 0), {}};
  const auto& [vf, ee] = set.candidates;
  const std::size_t count = vf.size() + ee.size();
  constexpr std::size_t kRun = 256;
  const std::size_t keep_one_in = std::max<std::size_t>(1, (count + most - 1) / std::max<std::size_t>(1, most));
  for (std::size_t i = 0; i < count; ++i) {
    if (i / kRun % keep_one_in != 0) continue;
    set.place.push_back(i);
    if (i < vf.size()) {
      set.queries.push_back(query_of(motion, PairKind::kVf, vf[i].vertex, vf[i].face));
    } else {
      const EeCandidate& pair = ee[i - vf.size()];
      set.queries.push_back(query_of(motion, PairKind::kEe, pair.a, pair.b));
    }
  }
  set.what = std::to_string(set.queries.size()) + " of the " + std::to_string(count) + " candidates of " +
             std::to_string(motion.mesh.faces.size()) + " faces";
  return set;
}

SetReport run_method_bench(const QuerySet& set, const MethodBenchOptions& options) {
  SetReport report{set.name, set.what, 0, 0, 0, {}};
  std::vector<verify::MotionAnswer> truth;
  truth.reserve(set.queries.size());
  for (const MethodQuery& query : set.queries) {
    truth.push_back(exact_answer(query, verify::Detail::kFirstTime));
    report.touching += truth.back().touches;
    ++(query.kind == PairKind::kVf ? report.vf : report.ee);
  }
  std::vector<Contestant> all = contestants(set);
  time_passes(set, options.repeat, all);
  for (const Contestant& contestant : all) report.settings.push_back(judge(set, truth, contestant));
  const auto baseline = std::find_if(report.settings.begin(), report.settings.end(), [](const SettingReport& s) {
    return s.method == kBaselineMethod && s.setting == kBaselineSetting;
  });
  if (baseline == report.settings.end()) throw std::logic_error("no baseline among the methods");
  const double baseline_ns = baseline->ns;
  for (SettingReport& setting : report.settings) setting.ratio = setting.ns / baseline_ns;
  return report;
}

bool breaks_promise(const SetReport& report) {
  return std::any_of(report.settings.begin(), report.settings.end(), [](const SettingReport& setting) {
    const bool promises = setting.method.starts_with("kernel") || setting.method == "inclusion";
    return promises && (setting.misses > 0 || setting.toi.late > 0);
  });
}

std::string to_json(std::span<const SetReport> reports) {
  nlohmann::ordered_json sets = nlohmann::ordered_json::array();
  for (const SetReport& report : reports) {
    nlohmann::ordered_json settings = nlohmann::ordered_json::array();
    for (const SettingReport& setting : report.settings) {
      settings.push_back({{"method", setting.method},
                          {"setting", setting.setting},
                          {"misses", setting.misses},
                          {"false_alarms", setting.false_alarms},
                          {"gave_up", setting.gave_up},
                          {"toi_examined", setting.toi_examined},
                          {"late_toi", setting.toi.late},
                          {"late_max", setting.toi.late_max},
                          {"early_median", setting.toi.early_median},
                          {"early_p99", setting.toi.early_p99},
                          {"early_max", setting.toi.early_max},
                          {"off_p99", setting.toi_off_p99},
                          {"ns", setting.ns},
                          {"ratio", setting.ratio}});
    }
    sets.push_back({{"name", report.name},
                    {"what", report.what},
                    {"vf", report.vf},
                    {"ee", report.ee},
                    {"touching", report.touching},
                    {"settings", settings}});
  }
  const nlohmann::ordered_json json = {{"schema", "selvage.bench.methods/1"},
                                       {"baseline", {{"method", kBaselineMethod}, {"setting", kBaselineSetting}}},
                                       {"sets", sets}};
  return json.dump(2) + "\n";
}

}  // namespace selvage::bench
