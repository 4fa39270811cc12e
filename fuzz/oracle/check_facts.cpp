#include "fuzz/oracle/check_facts.h"

#include <algorithm>

namespace selvage::fuzz {
namespace {

std::string vertices_of(const verify::Violation& violation, std::size_t begin, std::size_t end) {
  std::string text;
  for (std::size_t i = begin; i < end; ++i) text += " " + std::to_string(violation.vertices[i]);
  return text;
}

std::string features_of(const verify::Violation& violation) {
  switch (violation.event) {
    case verify::EventKind::kVf:
      return "vertex" + vertices_of(violation, 0, 1) + " and face" + vertices_of(violation, 1, 4);
    case verify::EventKind::kEe:
      return "edges" + vertices_of(violation, 0, 2) + " and" + vertices_of(violation, 2, 4);
    case verify::EventKind::kOverlap:
      return "faces" + vertices_of(violation, 0, 3) + " and" + vertices_of(violation, 3, 6);
    case verify::EventKind::kSelf:
      break;
  }
  return "vertex" + vertices_of(violation, 0, 1) + " and the edge" + vertices_of(violation, 1, 3) + " of its face";
}

std::string when(const verify::Violation& violation) {
  if (!violation.motion) return "";
  if (violation.t.lower == violation.t.upper) return ", first at t = " + violation.t.lower;
  return ", first at t in (" + violation.t.lower + ", " + violation.t.upper + ")";
}

}  // namespace

void append_facts(std::vector<std::string>& facts, const std::string& what, const verify::CheckResult& result) {
  if (result.violations_total.total() == 0) {
    facts.push_back("exactly, " + what + " is free of touching");
    return;
  }
  const std::size_t listed = std::min(kListedFacts, result.violations.size());
  for (std::size_t i = 0; i < listed; ++i) {
    const verify::Violation& violation = result.violations[i];
    facts.push_back("exactly, in " + what + " " + features_of(violation) + ": " + violation.kind + when(violation));
  }
  const std::int64_t more = result.violations_total.total() - static_cast<std::int64_t>(listed);
  if (more > 0) facts.push_back("and " + std::to_string(more) + " more");
}

}  // namespace selvage::fuzz
