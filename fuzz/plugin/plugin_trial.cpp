#include "fuzz/plugin/plugin_trial.h"

#include <array>
#include <optional>

#include "fuzz/oracle/closest_approach.h"
#include "fuzz/run/guarded_run.h"
#include "fuzz/run/worker.h"

namespace selvage::fuzz {

PluginJudgement judge_plugin(const Plugin& plugin, const MotionQuery& query, BatchSize batch) {
  PluginJudgement judgement;
  judgement.answer = plugin.ask(query, batch);
  judgement.failure = judgement.answer.misdeed;
  if (!judgement.failure.empty()) return judgement;
  const selvage_answer& answer = judgement.answer.answer;
  judgement.alarm = answer.verdict == SELVAGE_COLLIDES;
  const bool has_time = judgement.alarm && plugin.info().has_toi;
  const verify::MotionAgainst exact = motion_against(query, has_time ? answer.toi : 0);
  judgement.touches = exact.touches;
  if (exact.touches && !judgement.alarm) judgement.failure = "missed";
  if (exact.touches && has_time && answer.toi > 0 && exact.order < 0) judgement.failure = "late-time";
  if (!exact.touches && judgement.alarm && is_beyond_gap(query, plugin.info().gap, has_time ? answer.toi : 1)) {
    judgement.failure = "alarm-too-far";
  }
  return judgement;
}

bool is_beyond_gap(const MotionQuery& query, const DeclaredGap& gap, double hint) {
  const std::array<double, 3> hints{hint, 0, 1};
  return closest_approach(query, gap.of(query), hints, kEnoughTests) == Approach::kBeyond;
}

namespace {

/// One that is right half of the times by chance, and wrong now, is wrong in all of these once in 4 * 10^9.
constexpr int kAskedAgain = 32;

/// Asked again, every other time after the points at rest, the first of them elsewhere; a batch that differed as a
/// batch now and then.
bool is_steady(const Plugin& plugin, const MotionQuery& query, BatchSize batch, const Plugin::Answer& answer) {
  constexpr int kAsBatchOneIn = 8;
  MotionQuery other = query;
  other.x_t0[0].x() = query.x_t0[0].x() == 0 ? 1 : 0;
  other.x_t1 = other.x_t0;
  for (int again = 1; again <= kAskedAgain; ++again) {
    if (again % 2 == 0) static_cast<void>(plugin.ask(other, std::nullopt));
    const bool in_batch = !answer.misdeed.empty() && again % kAsBatchOneIn == 0;
    if (!plugin.stands_by(query, answer, in_batch ? batch : std::nullopt)) return false;
  }
  return true;
}

}  // namespace

PluginJudgement judge_steadily(const Plugin& plugin, const MotionQuery& query, BatchSize batch) {
  PluginJudgement judgement = judge_plugin(plugin, query, batch);
  const std::string& misdeed = judgement.answer.misdeed;
  if (judgement.failure.empty() || !(misdeed.empty() || misdeed == kBatchDiffers)) return judgement;
  if (!is_steady(plugin, query, batch, judgement.answer)) judgement.failure = kUnsteady;
  return judgement;
}

std::string words_of(const Plugin::Answer& answer, bool has_toi) {
  if (!answer.difference.empty()) return answer.difference;
  return answer.misdeed.empty() ? words_of(answer.answer, has_toi) : answer.misdeed;
}

std::string failure_at_load(const std::string& misdeed) { return misdeed + "-at-load"; }

PluginTrial try_plugin(const std::filesystem::path& library, const MotionQuery& query, BatchSize batch,
                       double case_seconds) {
  struct Plain {
    char failure[kFailureWord] = {};
    char difference[256] = {};
    bool has_answer = false;
    selvage_answer answer{};
  };
  PluginTrial trial;
  trial.info = probe_plugin(library, case_seconds);
  std::optional<Plugin> plugin;
  const auto ask = [&] {
    Plain plain;
    const PluginJudgement judgement = judge_plugin(*plugin, query, batch);
    const std::string& misdeed = plugin->load_misdeed();
    (misdeed.empty() ? judgement.failure : failure_at_load(misdeed)).copy(plain.failure, kFailureWord - 1);
    judgement.answer.difference.copy(plain.difference, sizeof plain.difference - 1);
    plain.has_answer = judgement.answer.misdeed.empty();
    plain.answer = judgement.answer.answer;
    return plain;
  };
  const auto run = run_guarded<Plain>({[&] { plugin.emplace(library); }, case_seconds}, ask, case_seconds);
  trial.failure = run.death.empty() ? run.result.failure : run.death;
  trial.difference = run.result.difference;
  trial.has_answer = run.result.has_answer;
  trial.answer = run.result.answer;
  return trial;
}

}  // namespace selvage::fuzz
