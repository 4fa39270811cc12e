#include "cli/page/report_words.h"

#include <fmt/format.h>

namespace selvage::cli {

using page::element;
using page::Html;
using page::text;

namespace {

Html fact(const std::string& name, const std::string& value, const std::string& detail) {
  Html shown = text(value);
  if (!detail.empty()) shown += element("small", {}, text(detail));
  return element("div", {}, element("dt", {}, text(name)) + element("dd", {}, shown)) + Html{"\n"};
}

std::string by_event(const verify::ViolationCounts& counts) {
  return fmt::format("{} vertex-face, {} edge-edge, {} face-face, {} within a face", grouped(counts.vf),
                     grouped(counts.ee), grouped(counts.overlap), grouped(counts.self));
}

std::string of_expected(const verify::SequenceReport::Counted& units, std::int64_t expected) {
  return expected == 0 ? "not asked for" : fmt::format("{} of {}", grouped(units.checked), grouped(expected));
}

Html paragraph(const std::string& plain) { return element("p", {}, text(plain)) + Html{"\n"}; }

}  // namespace

std::string grouped(std::int64_t count) {
  std::string digits = std::to_string(count);
  for (std::ptrdiff_t at = std::ssize(digits) - 3; at > (count < 0 ? 1 : 0); at -= 3) {
    digits.insert(static_cast<std::size_t>(at), ",");
  }
  return digits;
}

std::string counted(std::int64_t count, const std::string& singular) {
  return grouped(count) + " " + singular + (count == 1 ? "" : "s");
}

std::string source_names(const std::vector<std::string>& sources) {
  constexpr std::size_t kMaxNamed = 3;
  if (sources.size() > kMaxNamed) {
    return fmt::format("{} ... {} ({} files)", sources.front(), sources.back(), sources.size());
  }
  std::string all;
  for (const std::string& source : sources) all += (all.empty() ? "" : " ") + source;
  return all;
}

std::string verdict_sentence(const verify::SequenceReport& report) {
  switch (report.verdict) {
    case verify::Verdict::kClean:
      return fmt::format(
          "Exactly, nothing touches: {}{} were checked, without a tolerance.", counted(report.frames.checked, "frame"),
          report.motions_expected > 0 ? " and " + counted(report.motions.checked, "straight motion") + " between them"
                                      : "");
    case verify::Verdict::kViolated:
      return fmt::format("{} in {} of {}{}.", counted(report.violations_total.total(), "violation"),
                         grouped(report.frames.violated), counted(report.frames.checked, "frame"),
                         report.motions_expected > 0 ? fmt::format(" and {} of {}", grouped(report.motions.violated),
                                                                   counted(report.motions.checked, "motion"))
                                                     : "");
    case verify::Verdict::kUnknown:
      return "There is no verdict: something that was to be checked was not.";
  }
  return "";
}

Html facts(const verify::SequenceReport& report) {
  Html list = fact("Frames checked", of_expected(report.frames, report.frames_expected),
                   counted(report.frames.violated, "frame") + " violated");
  list += fact("Motions checked", of_expected(report.motions, report.motions_expected),
               report.motions_expected > 0 ? counted(report.motions.violated, "motion") + " violated"
                                           : "what lies between the frames is not claimed");
  const verify::PairCounts& pairs = report.pairs;
  list += fact("Pairs examined", grouped(pairs.vf + pairs.ee + pairs.overlap + pairs.self),
               by_event({pairs.vf, pairs.ee, pairs.overlap, pairs.self}));
  list += fact("Decided by exact arithmetic", grouped(pairs.exact), "the others by filters that are proved");
  list += fact("Violations", grouped(report.violations_total.total()), by_event(report.violations_total));
  list += fact("Surface", counted(report.faces, "face"), grouped(report.vertices) + " vertices");
  list += fact("Coordinates", report.precision == io::Precision::kFloat32 ? "float32" : "float64",
               "checked as they are stored");
  list += fact("Largest coordinate", fmt::format("{}", report.largest_coordinate), "magnitude");
  if (report.gap) {
    list += fact("Smallest gap", fmt::format("{:.6g}", report.gap->upper),
                 fmt::format("frame {}, {} {} and {}", report.gap->frame, verify::name_of(report.gap->event),
                             report.gap->features[0], report.gap->features[1]));
  } else if (report.gap_searched) {
    list += fact("Smallest gap", "none", "no two features without a common vertex");
  }
  if (report.second_opinion != verify::SecondOpinionScope::kNone) {
    list += fact("Second opinion", counted(report.pairs.asked_again, "pair"),
                 counted(report.pairs.disagreed, "disagreement"));
  }
  list += fact("Time", fmt::format("{:.3g} s", report.seconds), "");
  return element("dl", {{"class", "facts"}}, list);
}

Html left_out(const verify::SequenceReport& report, const std::vector<std::string>& notes) {
  Html list;
  for (const std::string& note : notes) list += paragraph("Note: " + note);
  for (const std::string& what : report.unchecked) list += paragraph("Not checked: " + what);
  for (const auto& [groups, pairs] : report.exempted) {
    list += paragraph(fmt::format("Exempt: \"{}\" and \"{}\" may touch; {} were left out.", groups[0], groups[1],
                                  counted(pairs, "pair")));
  }
  for (const auto& [group, faces] : report.ignored) {
    list += paragraph(fmt::format("Ignored: \"{}\", {}.", group, counted(faces, "face")));
  }
  if (report.welded) {
    list += paragraph(fmt::format("Welded: {} joined to another at the same place in every frame; {} lost a corner.",
                                  counted(report.welded->vertices, "point"),
                                  counted(report.welded->collapsed_faces, "face")));
  }
  if (report.body_faces > 0 && !report.bodies_checked) {
    list += paragraph(counted(report.body_faces, "face") +
                      " of bodies are checked against the cloth, not against bodies (--bodies does that too).");
  }
  if (const auto change = verify::first_surface_change(report)) {
    list += paragraph(fmt::format(
        "The number of vertices, the faces or what belongs to bodies or rules change, first at frame {}.", *change));
  }
  if (report.unreferenced_vertices > 0) {
    list += paragraph(counted(report.unreferenced_vertices, "point") + " of no face are not checked.");
  }
  return list;
}

std::string features_of(const verify::Violation& violation) {
  const auto [first, second] = violation.features;
  switch (violation.event) {
    case verify::EventKind::kVf:
      return fmt::format("vertex {} and face {}", first, second);
    case verify::EventKind::kEe:
      return fmt::format("edges {} and {}", first, second);
    case verify::EventKind::kOverlap:
      return fmt::format("faces {} and {}", first, second);
    case verify::EventKind::kSelf:
      return violation.kind == "degenerate" ? fmt::format("face {}", second)
                                            : fmt::format("vertex {} and its face {}", first, second);
  }
  return "";
}

std::string unit_of(std::int64_t frame, bool motion) {
  return motion ? fmt::format("motion {} to {}", frame, frame + 1) : fmt::format("frame {}", frame);
}

}  // namespace selvage::cli
