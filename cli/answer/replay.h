// What `selvage replay` finds out about a case, and how it says it.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "bench/textbook.h"
#include "fuzz/kept/case_file.h"
#include "fuzz/kept/kept_case.h"
#include "fuzz/kept/overlap_case.h"
#include "fuzz/oracle/query_oracle.h"
#include "fuzz/plugin/plugin_trial.h"
#include "fuzz/run/worker.h"
#include "verify/decision/explain.h"
#include "verify/decision/second_opinion.h"

namespace selvage::cli {

enum class ReplayOutcome {
  kAgree,         ///< no promise is broken (an unresolved answer breaks none)
  kBroken,        ///< a promise is broken
  kOutside,       ///< a query outside the kernel's domain, about which nothing is promised
  kContradicted,  ///< the exact answer is not the one that the file expects
  kDivided,       ///< the two exact deciders disagree
};

/// Somebody's collision code (fuzz/plugin/plugin.h).
struct PluginToAsk {
  std::filesystem::path library;
  double case_seconds = fuzz::kCaseSeconds;
};

struct MotionReplay {
  fuzz::Case kept;
  CcdResult kernel;
  verify::MotionAnswer exact;
  verify::SecondOpinion second;
  std::optional<bench::TextbookAnswer> textbook;  ///< it has no answer for a vertex and its own face
  bool is_in_domain = true;  ///< of the kernel: outside it nothing is judged, and no plugin is asked
  fuzz::Judgement judgement;
  std::string failure;  ///< of the property that the case is about, or empty
  std::vector<verify::ExplainedPolynomial> polynomials;
  std::optional<fuzz::PluginTrial> plugin;  ///< what a plugin did that was asked as well

  [[nodiscard]] ReplayOutcome outcome() const;
};
/// Throws io::Error(kBadInput) where the plugin is none.
[[nodiscard]] MotionReplay replay_motion(const fuzz::Case& kept, const std::optional<PluginToAsk>& asked);

struct OverlapReplay {
  fuzz::OverlapCase kept;
  verify::OverlapKind exact = verify::OverlapKind::kNone;
  bool second = false;  ///< CGAL: they meet beyond what they share

  [[nodiscard]] ReplayOutcome outcome() const;
};
[[nodiscard]] OverlapReplay replay_overlap(const fuzz::OverlapCase& kept);

struct KeptReplay {
  fuzz::ParsedCase parsed;
  fuzz::Retrial retrial;

  [[nodiscard]] ReplayOutcome outcome() const {
    return retrial.failure.empty() ? ReplayOutcome::kAgree : ReplayOutcome::kBroken;
  }
};
/// Throws io::Error(kBadInput) where nothing is promised about the case.
[[nodiscard]] KeptReplay replay_kept(const std::string& name, fuzz::ParsedCase parsed);

struct Explanation {
  std::string name;  ///< the file
  std::string text, json;
  ReplayOutcome outcome = ReplayOutcome::kAgree;
};
[[nodiscard]] Explanation explain(const std::string& name, const MotionReplay& replay);
[[nodiscard]] Explanation explain(const std::string& name, const OverlapReplay& replay);
[[nodiscard]] Explanation explain(const std::string& name, const KeptReplay& replay);

/// Whether a plugin can be asked about a case of this kind: it answers vf and ee alone.
[[nodiscard]] bool is_for_plugins(const std::string& kind);
/// The case that `text` holds, whatever its kind. Throws io::Error(kBadInput) naming `name`.
[[nodiscard]] Explanation replay_text(const std::string& text, const std::string& name,
                                      const std::optional<PluginToAsk>& asked);

}  // namespace selvage::cli
