#include "verify/report/report_sums.h"

#include <algorithm>
#include <vector>

namespace selvage::verify {
namespace {

std::string differ(const std::string& what, std::int64_t said, std::int64_t found) {
  return what + " are " + std::to_string(said) + " in one place and " + std::to_string(found) + " in another";
}

/// Of frames or motions: all of the range are expected, or none is asked for.
std::string contradiction_in(const std::string& what, const SequenceReport::Counted& counted, std::int64_t expected,
                             std::int64_t in_range, std::int64_t listed) {
  if (expected != 0 && expected != in_range) return differ("expected " + what, expected, in_range);
  if (counted.checked > expected) {
    return std::to_string(counted.checked) + " of " + std::to_string(expected) + " " + what + " are checked";
  }
  if (counted.violated != listed) return differ("violated " + what, counted.violated, listed);
  return "";
}

std::string contradiction_between(const ViolationCounts& total, const ViolationCounts& sum) {
  if (total.vf != sum.vf) return differ("violations vf", total.vf, sum.vf);
  if (total.ee != sum.ee) return differ("violations ee", total.ee, sum.ee);
  if (total.overlap != sum.overlap) return differ("violations overlap", total.overlap, sum.overlap);
  if (total.self != sum.self) return differ("violations self", total.self, sum.self);
  return "";
}

std::string contradiction_in(const Violation& violation) {
  if (!violation.motion) return "";
  const ExactTime& t = violation.t;
  return t.lower_approx >= 0 && t.lower_approx <= t.upper_approx && t.upper_approx <= 1
             ? ""
             : "a violation is at no time of its motion";
}

/// While the sum goes on: it may come from anywhere, and would overflow.
std::string excess_over(const ViolationCounts& total, const ViolationCounts& sum) {
  const bool exceeds = sum.vf > total.vf || sum.ee > total.ee || sum.overlap > total.overlap || sum.self > total.self;
  return exceeds ? contradiction_between(total, sum) : "";
}

/// Of what is listed as far as `most` goes.
std::string contradiction_in_list(const std::string& what, const std::vector<Violation>& listed, std::int64_t total,
                                  std::int64_t most) {
  const std::int64_t expected = std::min(most, total);
  if (std::ssize(listed) != expected) return differ("listed " + what, std::ssize(listed), expected);
  for (const Violation& violation : listed) {
    if (const std::string fault = contradiction_in(violation); !fault.empty()) return fault;
  }
  return "";
}

}  // namespace

std::string contradiction_in(const SequenceReport& report) {
  ViolationCounts sum;
  for (const SequenceReport::Violated& unit : report.violated) {
    if (unit.counts.total() == 0) return "a frame or motion is listed as violated without a violation";
    sum += unit.counts;
    if (const std::string what = excess_over(report.violations_total, sum); !what.empty()) return what;
  }
  const std::int64_t motions = std::ranges::count(report.violated, true, &SequenceReport::Violated::motion);
  const std::int64_t range = report.end_frame - report.first_frame, first_motion = report.first_frame == 0 ? 1 : 0;
  for (const std::string& what :
       {contradiction_in("frames", report.frames, report.frames_expected, range, std::ssize(report.violated) - motions),
        contradiction_in("motions", report.motions, report.motions_expected, range - first_motion, motions),
        contradiction_between(report.violations_total, sum),
        contradiction_in_list("violations", report.violations, report.violations_total.total(), report.max_violations),
        contradiction_in_list("disagreements", report.disagreements, report.pairs.disagreed, report.max_violations)}) {
    if (!what.empty()) return what;
  }
  if (report.verdict != verdict_of(report)) return "the verdict is not that of its numbers";
  const bool is_cut = report.verdict == Verdict::kClean && !is_complete(report);
  return is_cut ? "it is clean without a checksum of every frame" : "";
}

}  // namespace selvage::verify
