// What a plugin is worth on one query: its answer against exact arithmetic.
#pragma once

#include <filesystem>
#include <string>

#include "fuzz/plugin/plugin.h"

namespace selvage::fuzz {

struct PluginJudgement {
  std::string failure;  ///< missed, late-time, alarm-too-far, kUnsteady, a misdeed of Plugin::Answer, or nothing
  bool touches = false, alarm = false;
  Plugin::Answer answer;
};
[[nodiscard]] PluginJudgement judge_plugin(const Plugin& plugin, const MotionQuery& query, BatchSize batch);
/// Asked again where its answer fails, 32 times, every other time after another query: an answer that is another then
/// depends on what was asked before, or on chance, and no case can keep that.
[[nodiscard]] PluginJudgement judge_steadily(const Plugin& plugin, const MotionQuery& query, BatchSize batch);

/// Of an alarm without a touch: PROVED that the features never come within the gap. `hint`: a time to try first.
[[nodiscard]] bool is_beyond_gap(const MotionQuery& query, const DeclaredGap& gap, double hint);

/// Those of its answer; or the misdeed, or where a batch differed.
[[nodiscard]] std::string words_of(const Plugin::Answer& answer, bool has_toi);

/// The failure of a plugin that did `misdeed` while it was loaded.
[[nodiscard]] std::string failure_at_load(const std::string& misdeed);

struct PluginTrial {
  PluginInfo info;
  std::string failure;      ///< as above, or how it died
  std::string difference;   ///< as in Plugin::Answer
  bool has_answer = false;  ///< it came back, and gave an answer that is one
  selvage_answer answer{};
};
/// Loads it and asks it once, in a process of its own. Throws io::Error(kBadInput), as probe_plugin() does.
[[nodiscard]] PluginTrial try_plugin(const std::filesystem::path& library, const MotionQuery& query, BatchSize batch,
                                     double case_seconds);

}  // namespace selvage::fuzz
