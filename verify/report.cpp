#include "verify/report.h"

#include <algorithm>
#include <cstdio>

#include <nlohmann/json.hpp>

namespace selvage::verify {
namespace {

using Json = nlohmann::ordered_json;  // keys stay in the order of writing: the verdict is on top

std::string number(double x) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.17g", x);
  return buffer;
}

std::string hex_float(double x) {
  char buffer[40];
  std::snprintf(buffer, sizeof buffer, "%a", x);
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

Json to_json(const Violation& violation) {
  Json json = {{"frame", violation.frame},
               {"unit", violation.motion ? "motion" : "frame"},
               {"event", name_of(violation.event)},
               {"kind", violation.kind},
               {"features", violation.features},
               {"vertices", vertices(violation)},
               {"t", nullptr}};
  if (violation.motion) {
    json["t"] = {{"lower", violation.t.lower},
                 {"upper", violation.t.upper},
                 {"lower_number", violation.t.lower_approx},
                 {"upper_number", violation.t.upper_approx}};
  }
  return json;
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

std::string line(const Violation& violation, const ReportContext& context) {
  const auto frame_name = [&](std::int64_t frame) {
    const auto index = static_cast<std::size_t>(frame);
    return index < context.frame_names.size() ? context.frame_names[index] : std::to_string(frame);
  };
  std::string text = "  frame " + std::to_string(violation.frame);
  if (violation.motion) {
    text += " to " + std::to_string(violation.frame + 1) + ", t in [" + number(violation.t.lower_approx) + ", " +
            number(violation.t.upper_approx) + "]";
  }
  text += std::string(": ") + name_of(violation.event) + " " + violation.kind + ", " + feature_names(violation);
  return text + " [" + frame_name(violation.frame) + "]\n";
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

std::string text_report(const SequenceReport& report, const ReportContext& context, std::size_t max_listed) {
  const auto count = [](std::int64_t n) { return std::to_string(n); };
  std::string text = std::string(name_of(report.verdict)) + "\n";
  text += "frames:     " + count(report.frames.checked) + " of " + count(report.frames_expected) + " checked, " +
          count(report.frames.violated) + " violated\n";
  text += "motions:    " + count(report.motions.checked) + " of " + count(report.motions_expected) + " checked, " +
          count(report.motions.violated) + " violated\n";
  text += "pairs:      " + count(report.pairs.vf) + " vf, " + count(report.pairs.ee) + " ee, " +
          count(report.pairs.overlap) + " overlap, " + count(report.pairs.self) + " self; " +
          count(report.pairs.exact) + " needed exact arithmetic\n";
  text += "violations: " + count(report.violations_total.vf) + " vf, " + count(report.violations_total.ee) + " ee, " +
          count(report.violations_total.overlap) + " overlap, " + count(report.violations_total.self) + " self\n";
  text += "surface:    " + count(report.faces) + " faces, " + count(report.vertices) + " vertices, " +
          (report.precision == io::Precision::kFloat32 ? "float32" : "float64") +
          " coordinates checked as stored, the largest " + number(report.largest_coordinate) + "\n";
  if (report.unreferenced_vertices > 0) {
    text += "note:       " + count(report.unreferenced_vertices) + " vertices belong to no face and are not checked\n";
  }
  if (report.body_faces > 0 && !report.bodies_checked) {
    text += "note:       " + count(report.body_faces) + " faces belong to bodies; bodies are not checked against " +
            "each other or themselves (--bodies does)\n";
  }
  for (const std::string& what : report.unchecked) text += "unchecked:  " + what + "\n";
  const std::size_t listed = std::min(max_listed, report.violations.size());
  for (std::size_t i = 0; i < listed; ++i) text += line(report.violations[i], context);
  const std::int64_t left_out = report.violations_total.total() - static_cast<std::int64_t>(listed);
  if (left_out > 0) text += "  and " + count(left_out) + " more (--max-violations lists more)\n";
  return text;
}

std::string json_report(const SequenceReport& report, const ReportContext& context) {
  Json json;
  json["schema"] = kReportSchema;
  json["program"] = context.program;
  json["sources"] = context.sources;
  json["verdict"] = name_of(report.verdict);
  json["frames"] = {
      {"checked", report.frames.checked}, {"violated", report.frames.violated}, {"expected", report.frames_expected}};
  json["motions"] = {{"checked", report.motions.checked},
                     {"violated", report.motions.violated},
                     {"expected", report.motions_expected}};
  json["pairs"] = {{"vf", report.pairs.vf},
                   {"ee", report.pairs.ee},
                   {"overlap", report.pairs.overlap},
                   {"self", report.pairs.self},
                   {"exact", report.pairs.exact}};
  json["violations_total"] = {{"vf", report.violations_total.vf},
                              {"ee", report.violations_total.ee},
                              {"overlap", report.violations_total.overlap},
                              {"self", report.violations_total.self}};
  json["violations"] = Json::array();
  for (const Violation& violation : report.violations) {
    Json entry = to_json(violation);
    const auto frame = static_cast<std::size_t>(violation.frame);
    if (frame < context.frame_names.size()) entry["frame_name"] = context.frame_names[frame];
    json["violations"].push_back(std::move(entry));
  }
  json["unchecked"] = report.unchecked;
  json["surface"] = {{"faces", report.faces},
                     {"vertices", report.vertices},
                     {"unreferenced_vertices", report.unreferenced_vertices},
                     {"body_faces", report.body_faces},
                     {"body_pairs", report.bodies_checked ? "checked" : "skipped"},
                     {"precision", report.precision == io::Precision::kFloat32 ? "float32" : "float64"},
                     {"largest_coordinate", report.largest_coordinate},
                     {"largest_coordinate_hex", hex_float(report.largest_coordinate)}};
  json["seconds"] = report.seconds;
  // A file name may hold bytes that are no UTF-8: they are replaced, the report is valid all the same.
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace selvage::verify
