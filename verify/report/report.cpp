#include "verify/report/report.h"

#include <algorithm>
#include <cstdio>
#include <set>
#include <span>

#include "io/file/text.h"

namespace selvage::verify {
namespace {

std::string number(double x) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.17g", x);
  return buffer;
}

/// The vertices that the violation names: the places that are not -1.
std::vector<std::int32_t> vertices(const Violation& violation) {
  std::vector<std::int32_t> used;
  for (const std::int32_t v : violation.vertices) {
    if (v >= 0) used.push_back(v);
  }
  return used;
}

std::string feature_names(const Violation& violation) {
  const char* first = "face";
  const char* second = "face";
  if (violation.event == EventKind::kVf || violation.event == EventKind::kSelf) first = "vertex";
  if (violation.event == EventKind::kEe) first = second = "edge";
  std::string text = std::string(first) + " " + std::to_string(violation.features[0]) + ", " + second + " " +
                     std::to_string(violation.features[1]) + " (vertices";
  for (const std::int32_t v : vertices(violation)) text += " " + std::to_string(v);
  return text + ")";
}

/// Where to look: the first vertex at the first touch, rounded. If it is the vertex that meets the face or the edge it
/// is the point of contact; else that is somewhere on the features, and the vertex is named.
std::string place(const Violation& violation) {
  if (violation.at_touch.empty()) return "";
  const bool of_vertex = violation.event == EventKind::kVf || violation.event == EventKind::kSelf;
  const bool is_contact = of_vertex && violation.kind != "near";
  char buffer[96];
  const auto& [x, y, z] = violation.at_touch.front();
  std::snprintf(buffer, sizeof buffer, " (%.9g, %.9g, %.9g)", x, y, z);
  return (is_contact ? ", at" : ", with vertex " + std::to_string(violation.vertices[0]) + " at") + std::string(buffer);
}

std::string line(const Violation& violation, const ReportContext& context) {
  const auto frame_name = [&](std::int64_t frame) {
    const auto name = context.frame_names.find(frame);
    return name != context.frame_names.end() ? io::printable(name->second) : std::to_string(frame);
  };
  std::string text = "  frame " + std::to_string(violation.frame);
  if (violation.motion) {
    text += " to " + std::to_string(violation.frame + 1) + ", t in [" + number(violation.t.lower_approx) + ", " +
            number(violation.t.upper_approx) + "]";
  }
  text += std::string(": ") + name_of(violation.event) + " " + violation.kind + ", " + feature_names(violation) +
          place(violation);
  text += " [" + frame_name(violation.frame) + "]\n";
  if (!violation.case_file.empty()) text += "    " + io::printable(replay_command(violation.case_file)) + "\n";
  return text;
}

/// "Clean" of frames alone is not to be read as clean of what happens between them.
std::string motions_line(const SequenceReport& report) {
  if (report.motions_expected == 0 && report.frame_count > 1) return "motions:    not checked (--motion does)\n";
  return "motions:    " + std::to_string(report.motions.checked) + " of " + std::to_string(report.motions_expected) +
         " checked, " + std::to_string(report.motions.violated) + " violated\n";
}

/// Vertices of violations that lie exactly where another of the same violation does.
std::set<std::int32_t> coincident(std::span<const Violation> violations) {
  std::set<std::int32_t> found;
  for (const Violation& violation : violations) {
    const std::vector<std::int32_t> v = vertices(violation);
    for (std::size_t i = 0; i < v.size(); ++i) {
      for (std::size_t k = 0; k < v.size(); ++k) {
        const bool lies_on = v[i] != v[k] && violation.x_t0[i] == violation.x_t0[k];
        if (lies_on && violation.x_t1[i] == violation.x_t1[k]) found.insert(v[i]);
      }
    }
  }
  return found;
}

}  // namespace

const char* name_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::kClean:
      return "clean";
    case Verdict::kViolated:
      return "violated";
    case Verdict::kUnknown:
      return "unknown";
  }
  return "unknown";
}

const char* name_of(EventKind event) {
  switch (event) {
    case EventKind::kVf:
      return "vf";
    case EventKind::kEe:
      return "ee";
    case EventKind::kOverlap:
      return "overlap";
    case EventKind::kSelf:
      return "self";
  }
  return "unknown";
}

std::string replay_command(const std::string& case_file) { return "selvage replay " + io::shell_word(case_file); }

std::optional<std::int64_t> first_surface_change(const SequenceReport& report) {
  std::optional<std::uint32_t> before = report.surface_crc32_before;
  for (std::size_t k = 0; k < report.surface_crc32.size(); ++k) {
    if (before && *before != report.surface_crc32[k]) return report.first_frame + static_cast<std::int64_t>(k);
    before = report.surface_crc32[k];
  }
  return std::nullopt;
}

std::string text_report(const SequenceReport& report, const ReportContext& context, std::size_t max_listed) {
  const auto count = [](std::int64_t n) { return std::to_string(n); };
  std::string text = name_of(report.verdict);
  if (report.first_frame > 0 || report.end_frame < report.frame_count) {
    text += " (a part: frames " + count(report.first_frame) + " to " + count(report.end_frame - 1) + " of " +
            count(report.frame_count) + ")";
  }
  text += "\n";
  text += "frames:     " + count(report.frames.checked) + " of " + count(report.frames_expected) + " checked, " +
          count(report.frames.violated) + " violated\n";
  text += motions_line(report);
  text += "pairs:      " + count(report.pairs.vf) + " vf, " + count(report.pairs.ee) + " ee, " +
          count(report.pairs.overlap) + " overlap, " + count(report.pairs.self) + " self; " +
          count(report.pairs.exact) + " needed exact arithmetic\n";
  text += "violations: " + count(report.violations_total.vf) + " vf, " + count(report.violations_total.ee) + " ee, " +
          count(report.violations_total.overlap) + " overlap, " + count(report.violations_total.self) + " self\n";
  text += "surface:    " + count(report.faces) + " faces, " + count(report.vertices) + " vertices, " +
          (report.precision == io::Precision::kFloat32 ? "float32" : "float64") +
          " coordinates checked as stored, the largest " + number(report.largest_coordinate) + "\n";
  if (const auto change = first_surface_change(report)) {
    text += "note:       the number of vertices, the faces or what belongs to bodies or rules change, first at frame " +
            count(*change) + "; the surface above is the last frame's\n";
  }
  if (report.unreferenced_vertices > 0) {
    text += "note:       " + count(report.unreferenced_vertices) + " vertices belong to no face and are not checked\n";
  }
  if (report.body_faces > 0 && !report.bodies_checked) {
    text += "note:       " + count(report.body_faces) + " faces belong to bodies; bodies are not checked against " +
            "each other or themselves (--bodies does)\n";
  }
  if (report.gap) {
    text += "gap:        " + number(report.gap->lower) + (report.gap->lower < report.gap->upper ? " to " : "") +
            (report.gap->lower < report.gap->upper ? number(report.gap->upper) : "") +
            ", the smallest: " + name_of(report.gap->event) + " " + count(report.gap->features[0]) + " " +
            count(report.gap->features[1]) + " in frame " + count(report.gap->frame) + "\n";
  }
  if (report.gap_searched && !report.gap)
    text +=
        "gap:        none: no pair of features without a common vertex, or all farther apart than a double can say\n";
  if (report.second_opinion != SecondOpinionScope::kNone) {
    text += "second:     " + count(report.pairs.asked_again) + " pairs decided again, " +
            count(report.pairs.disagreed) + " disagreements\n";
  }
  for (const Violation& violation : report.disagreements) text += line(violation, context);
  for (const auto& [groups, pairs] : report.exempted) {
    text += "exempted:   " + count(pairs) + " pairs of \"" + io::printable(groups[0]) + "\" and \"" +
            io::printable(groups[1]) + "\"\n";
  }
  for (const auto& [group, faces] : report.ignored) {
    text += "ignored:    " + count(faces) + " faces of \"" + io::printable(group) + "\"\n";
  }
  if (report.welded) {
    text += "welded:     " + count(report.welded->vertices) +
            " vertices joined to another at the same place in every " + "frame; " +
            count(report.welded->collapsed_faces) + " faces lost a corner and are degenerate\n";
  }
  for (const std::string& what : report.unchecked) text += "unchecked:  " + io::printable(what) + "\n";
  if (const std::size_t seam = coincident(report.violations).size(); seam > 0 && !report.welded) {
    text += "note:       at least " + std::to_string(seam) +
            " vertices of the violations lie at the place of another, " +
            (context.is_rounded ? "where rounding or a seam of the mesh has put them\n"
                                : "as where a mesh is split at seams (selvage verify --weld joins them)\n");
  }
  const std::size_t listed = std::min(max_listed, report.violations.size());
  for (std::size_t i = 0; i < listed; ++i) text += line(report.violations[i], context);
  if (listed > 0 && report.violations.front().case_file.empty()) {
    text += "  selvage verify --cases DIR writes each as a case, which selvage replay explains\n";
  }
  const std::int64_t left_out = report.violations_total.total() - static_cast<std::int64_t>(listed);
  if (left_out > 0) text += "  and " + count(left_out) + " more (--max-violations lists more)\n";
  return text;
}

}  // namespace selvage::verify
