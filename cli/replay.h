// What `selvage replay` finds out about a case, and how it says it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bench/textbook.h"
#include "fuzz/case_file.h"
#include "fuzz/kept_case.h"
#include "fuzz/overlap_case.h"
#include "fuzz/query_oracle.h"
#include "verify/explain.h"
#include "verify/second_opinion.h"

namespace selvage::cli {

enum class ReplayOutcome {
  kAgree,         ///< no promise is broken (an unresolved answer breaks none)
  kBroken,        ///< a promise is broken
  kContradicted,  ///< the exact answer is not the one that the file expects
  kDivided,       ///< the two exact deciders disagree
};

struct MotionReplay {
  fuzz::Case kept;
  CcdResult kernel;
  verify::MotionAnswer exact;
  verify::SecondOpinion second;
  std::optional<bench::TextbookAnswer> textbook;  ///< it has no answer for a vertex and its own face
  fuzz::Judgement judgement;
  std::string failure;  ///< of the property that the case is about, or empty
  std::vector<verify::ExplainedPolynomial> polynomials;

  [[nodiscard]] ReplayOutcome outcome() const;
};
[[nodiscard]] MotionReplay replay_motion(const fuzz::Case& kept);

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

}  // namespace selvage::cli
