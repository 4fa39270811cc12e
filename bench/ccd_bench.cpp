#include "bench/ccd_bench.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <map>
#include <stdexcept>
#include <utility>

#include <nlohmann/json.hpp>

#include "bench/ccd_methods.h"
#include "bench/measure.h"
#include "verify/decision/exact_distance.h"

namespace selvage::bench {
namespace {

constexpr std::array<PairKind, 2> kKinds{PairKind::kVf, PairKind::kEe};
/// An exact first touch costs some 50 us; this many contacts of each kind give quantiles of an error.
constexpr std::size_t kToiSample = 4000;
constexpr double kNever = std::numeric_limits<double>::infinity();

class CcdBench {
 public:
  CcdBench(const MeshMotion& motion, TimedCandidates candidates, const CcdBenchOptions& options)
      : motion_(motion), repeat_(options.repeat), candidates_(std::move(candidates.pairs)) {
    ccd_options_.tolerance = options.tolerance;
    report_.broad_phase_ns = candidates.ns;
  }

  CcdBenchReport run(std::span<const LabelledPair> labels, const std::optional<GuestMethod<KindTimes>>& guest) {
    report_.vertices = motion_.mesh.vertex_count;
    report_.faces = static_cast<std::int64_t>(motion_.mesh.faces.size());
    report_.vf_candidates = static_cast<std::int64_t>(candidates_.vf.size());
    report_.ee_candidates = static_cast<std::int64_t>(candidates_.ee.size());
    const auto methods = ccd_methods();
    for (const CcdMethod& method : methods) report_.methods.emplace_back().name = method.name;
    for (const PairKind kind : kKinds) measure(kind, methods);
    if (guest) judge_guest(*guest);
    compare_labels(labels);
    summarize();
    return std::move(report_);
  }

 private:
  void measure(PairKind kind, std::span<const CcdMethod> methods);
  using IsWithinGap = std::function<bool(const Alarm&)>;
  void judge(PairKind kind, const std::vector<Alarm>& alarms, bool gives_toi, const IsWithinGap& is_within_gap,
             CcdMethodReport& of_method);
  void judge_guest(const GuestMethod<KindTimes>& guest);
  [[nodiscard]] bool within_gap(PairKind kind, const Alarm& alarm) const;
  void measure_toi(PairKind kind, const std::vector<Alarm>& found, ToiErrors& errors);
  void compare_labels(std::span<const LabelledPair> labels);
  void summarize();
  std::vector<bool>& truth(PairKind kind) { return kind == PairKind::kVf ? vf_truth_ : ee_truth_; }

  const MeshMotion& motion_;
  int repeat_;
  CcdOptions ccd_options_;
  Candidates candidates_;
  std::vector<bool> vf_truth_, ee_truth_;
  std::map<std::string, ToiErrors> toi_errors_;  // by method, over both kinds
  CcdBenchReport report_;
};

void CcdBench::measure(PairKind kind, std::span<const CcdMethod> methods) {
  std::vector<CcdAnswers> answers(methods.size());
  std::vector<double> best_ns(methods.size(), kNever);
  for (int pass = 0; pass < repeat_; ++pass) {
    for (std::size_t i = 0; i < methods.size(); ++i) {
      const double start = thread_nanoseconds();
      CcdAnswers of_pass = methods[i].ask(kind, motion_, candidates_, ccd_options_);
      best_ns[i] = std::min(best_ns[i], thread_nanoseconds() - start);
      if (pass > 0 && of_pass.alarms.size() != answers[i].alarms.size()) {
        throw std::logic_error(std::string(methods[i].name) + " answered one list in two ways");
      }
      answers[i] = std::move(of_pass);
    }
  }
  const bool is_vf = kind == PairKind::kVf;
  truth(kind).assign(is_vf ? candidates_.vf.size() : candidates_.ee.size(), false);
  for (const Alarm& contact : answers.back().alarms) truth(kind)[contact.pair] = true;
  (is_vf ? report_.vf_contacts : report_.ee_contacts) = static_cast<std::int64_t>(answers.back().alarms.size());
  for (std::size_t i = 0; i < methods.size(); ++i) {
    judge(
        kind, answers[i].alarms, methods[i].gives_toi,
        [&](const Alarm& alarm) { return methods[i].gives_gap_bound && !alarm.unresolved && within_gap(kind, alarm); },
        report_.methods[i]);
    (is_vf ? report_.methods[i].ns_vf : report_.methods[i].ns_ee) = best_ns[i];
    report_.methods[i].searched += answers[i].searched;
  }
}

void CcdBench::judge(PairKind kind, const std::vector<Alarm>& alarms, bool gives_toi, const IsWithinGap& is_within_gap,
                     CcdMethodReport& of_method) {
  std::vector<Alarm> found;
  for (const Alarm& alarm : alarms) {
    of_method.unresolved += alarm.unresolved;
    if (truth(kind)[alarm.pair]) {
      found.push_back(alarm);
      continue;
    }
    ++of_method.false_positives;
    of_method.false_positives_beyond_gap += !is_within_gap(alarm);
  }
  const std::int64_t contacts = kind == PairKind::kVf ? report_.vf_contacts : report_.ee_contacts;
  of_method.alarms += static_cast<std::int64_t>(alarms.size());
  of_method.false_negatives += contacts - static_cast<std::int64_t>(found.size());
  of_method.gives_toi = gives_toi;
  if (gives_toi) measure_toi(kind, found, toi_errors_[of_method.name]);
}

void CcdBench::judge_guest(const GuestMethod<KindTimes>& guest) {
  CcdMethodReport& row = report_.methods.emplace_back();
  row.name = kGuestRow;
  row.ns_vf = guest.ns.vf;
  row.ns_ee = guest.ns.ee;
  auto answer = guest.answers.begin();
  for (const PairKind kind : kKinds) {
    std::vector<Alarm> alarms;
    const std::size_t count = truth(kind).size();
    for (std::size_t pair = 0; pair < count; ++pair, ++answer) {
      if (answer->alarm) alarms.push_back({pair, answer->toi, 0, answer->gave_up});
    }
    const auto is_within_gap = [&](const Alarm& alarm) {
      const MethodQuery query = query_of(kind, motion_, candidates_, alarm.pair);
      return !guest.is_beyond_gap(query, {true, alarm.unresolved, alarm.toi});
    };
    judge(kind, alarms, guest.facts.has_toi, is_within_gap, row);
  }
  report_.guest = guest.facts;
}

/// The witness of an alarm is at toi_lower or, where only the end of the step is near, at 1.
bool CcdBench::within_gap(PairKind kind, const Alarm& alarm) const {
  const MethodQuery query = query_of(kind, motion_, candidates_, alarm.pair);
  const auto within_at = kind == PairKind::kVf ? verify::vf_within_at : verify::ee_within_at;
  return within_at(query.point_t0, query.point_t1, alarm.toi, alarm.gap_bound);
}

void CcdBench::measure_toi(PairKind kind, const std::vector<Alarm>& found, ToiErrors& errors) {
  const std::size_t stride = found.size() / kToiSample + 1;
  for (std::size_t i = 0; i < found.size(); i += stride) {
    const MethodQuery query = query_of(kind, motion_, candidates_, found[i].pair);
    const double toi = found[i].toi;
    errors.add(exact_answer(query, verify::Detail::kFirstTime).first.lower_approx, toi,
               verify::compare_first_touch(query.point_t0, query.point_t1, kind == PairKind::kVf, toi) < 0);
  }
}

/// A published verdict is contradicted by another verdict of the exact checker; so is a published contact that is no
/// candidate.
void CcdBench::compare_labels(std::span<const LabelledPair> labels) {
  report_.labels = static_cast<std::int64_t>(labels.size());
  const auto touches = [](const auto& pairs, const auto& pair, const std::vector<bool>& truth) {
    const auto found = std::lower_bound(pairs.begin(), pairs.end(), pair);
    return found != pairs.end() && *found == pair && truth[static_cast<std::size_t>(found - pairs.begin())];
  };
  for (const LabelledPair& label : labels) {
    const bool real = label.kind == PairKind::kVf
                          ? touches(candidates_.vf, VfCandidate{label.first, label.second}, vf_truth_)
                          : touches(candidates_.ee, EeCandidate{label.first, label.second}, ee_truth_);
    report_.labels_contradicted += real != label.touches;
  }
}

void CcdBench::summarize() {
  const auto vf = static_cast<double>(report_.vf_candidates), ee = static_cast<double>(report_.ee_candidates);
  for (CcdMethodReport& of_method : report_.methods) {
    of_method.ns_mean = (of_method.ns_vf + of_method.ns_ee) / std::max(1.0, vf + ee);
    of_method.ns_vf /= std::max(1.0, vf);
    of_method.ns_ee /= std::max(1.0, ee);
    const ToiErrors& errors = toi_errors_[of_method.name];
    of_method.toi_examined = errors.count();
    of_method.toi = errors.summary();
  }
  const auto textbook = std::find_if(report_.methods.begin(), report_.methods.end(),
                                     [](const CcdMethodReport& method) { return method.name == "textbook"; });
  for (CcdMethodReport& of_method : report_.methods) of_method.ratio = of_method.ns_mean / textbook->ns_mean;
}

}  // namespace

TimedCandidates time_candidates(const MeshMotion& motion, double tolerance) {
  const double start = process_nanoseconds();
  TimedCandidates found{candidates_of(motion, tolerance)};
  found.ns = process_nanoseconds() - start;
  return found;
}

CcdBenchReport run_ccd_bench(const MeshMotion& motion, TimedCandidates candidates, std::span<const LabelledPair> labels,
                             const CcdBenchOptions& options, const std::optional<GuestMethod<KindTimes>>& guest) {
  return CcdBench(motion, std::move(candidates), options).run(labels, guest);
}

std::string to_json(const CcdBenchReport& report) {
  nlohmann::ordered_json methods, ratio;
  for (const CcdMethodReport& method : report.methods) {
    methods[method.name] = {{"alarms", method.alarms},
                            {"false_negatives", method.false_negatives},
                            {"false_positives", method.false_positives},
                            {"false_positives_beyond_gap", method.false_positives_beyond_gap},
                            {"unresolved", method.unresolved},
                            {"searched", method.searched},
                            {"toi_examined", method.toi_examined},
                            {"late_toi", method.toi.late},
                            {"toi_error",
                             {{"late_max", method.toi.late_max},
                              {"early_median", method.toi.early_median},
                              {"early_p99", method.toi.early_p99},
                              {"early_max", method.toi.early_max}}},
                            {"ns", {{"mean", method.ns_mean}, {"vf", method.ns_vf}, {"ee", method.ns_ee}}}};
    ratio[method.name] = method.ratio;
  }
  nlohmann::ordered_json json = {{"schema", "selvage.bench.ccd/1"},
                                 {"motion", report.motion},
                                 {"vertices", report.vertices},
                                 {"faces", report.faces},
                                 {"candidates", {{"vf", report.vf_candidates}, {"ee", report.ee_candidates}}},
                                 {"contacts", {{"vf", report.vf_contacts}, {"ee", report.ee_contacts}}},
                                 {"labels", report.labels},
                                 {"labels_contradicted", report.labels_contradicted},
                                 {"broad_phase_ns", report.broad_phase_ns},
                                 {"methods", methods},
                                 {"ratio_to_textbook", ratio}};
  if (report.guest) json[kGuestRow] = to_json(*report.guest);
  return json.dump(2) + "\n";
}

}  // namespace selvage::bench
