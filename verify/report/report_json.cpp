#include <cstdio>

#include <nlohmann/json.hpp>

#include "verify/report/report.h"

namespace selvage::verify {
namespace {

using Json = nlohmann::ordered_json;  // keys stay in the order of writing: the verdict is on top

std::string to_hex(double x) {
  char buffer[40];
  std::snprintf(buffer, sizeof buffer, "%a", x);
  return buffer;
}

std::string hex_word(std::uint32_t x) {
  char buffer[16];
  std::snprintf(buffer, sizeof buffer, "%08x", static_cast<unsigned>(x));
  return buffer;
}

Json bits(const std::vector<Point>& points) {
  Json json = Json::array();
  for (const auto& [x, y, z] : points) json.push_back({to_hex(x), to_hex(y), to_hex(z)});
  return json;
}

const char* unit_name(bool motion) { return motion ? "motion" : "frame"; }

Json to_json(const Violation& violation) {
  Json vertices = Json::array();
  for (const std::int32_t v : violation.vertices) {
    if (v >= 0) vertices.push_back(v);
  }
  Json json = {{"frame", violation.frame},
               {"unit", unit_name(violation.motion)},
               {"event", name_of(violation.event)},
               {"kind", violation.kind},
               {"features", violation.features},
               {"vertices", vertices},
               {"t", nullptr},
               {"positions", violation.at_touch},
               {"bits_t0", bits(violation.x_t0)}};
  if (violation.motion) {
    json["t"] = {{"lower", violation.t.lower},
                 {"upper", violation.t.upper},
                 {"lower_number", violation.t.lower_approx},
                 {"upper_number", violation.t.upper_approx}};
    json["bits_t1"] = bits(violation.x_t1);
  }
  if (!violation.case_file.empty()) {
    json["case"] = violation.case_file;
    json["replay"] = replay_command(violation.case_file);
  }
  return json;
}

Json to_json(const ViolationCounts& counts) {
  return {{"vf", counts.vf}, {"ee", counts.ee}, {"overlap", counts.overlap}, {"self", counts.self}};
}

Json violated(const SequenceReport& report) {
  Json units = Json::array();
  for (const auto& [frame, motion, counts] : report.violated) {
    units.push_back({{"frame", frame}, {"unit", unit_name(motion)}});
    units.back().update(to_json(counts));
  }
  return units;
}

Json allowances(const SequenceReport& report) {
  Json exempted = Json::array(), ignored = Json::array(), weld = nullptr;
  for (const auto& [groups, pairs] : report.exempted) exempted.push_back({{"groups", groups}, {"pairs", pairs}});
  for (const auto& [group, faces] : report.ignored) ignored.push_back({{"group", group}, {"faces", faces}});
  if (report.welded) {
    weld = {{"vertices", report.welded->vertices}, {"collapsed_faces", report.welded->collapsed_faces}};
  }
  return {{"exempted", exempted}, {"ignored", ignored}, {"weld", weld}};
}

Json second_opinion(const SequenceReport& report) {
  if (report.second_opinion == SecondOpinionScope::kNone) return nullptr;
  Json disagreements = Json::array();
  for (const Violation& violation : report.disagreements) disagreements.push_back(to_json(violation));
  return {{"scope", report.second_opinion == SecondOpinionScope::kAll ? "all" : "undecided"},
          {"asked", report.pairs.asked_again},
          {"disagreed", report.pairs.disagreed},
          {"disagreements", disagreements}};
}

Json gap(const SequenceReport& report) {
  if (!report.gap_searched) return nullptr;
  if (!report.gap) return {{"lower", nullptr}};
  return {{"lower", report.gap->lower},
          {"upper", report.gap->upper},
          {"lower_hex", to_hex(report.gap->lower)},
          {"upper_hex", to_hex(report.gap->upper)},
          {"frame", report.gap->frame},
          {"event", name_of(report.gap->event)},
          {"features", report.gap->features},
          {"bits", bits(report.gap->x)}};
}

Json hex_words(const std::vector<std::uint32_t>& words) {
  Json json = Json::array();
  for (const std::uint32_t word : words) json.push_back(hex_word(word));
  return json;
}

Json hex_or_null(const std::optional<std::uint32_t>& word) { return word ? Json(hex_word(*word)) : Json(nullptr); }

Json sequence(const SequenceReport& report) {
  return {{"identity", report.sequence},
          {"frames", report.frame_count},
          {"first_frame", report.first_frame},
          {"end_frame", report.end_frame},
          {"crc32", hex_words(report.frame_crc32)},
          {"crc32_before", hex_or_null(report.crc32_before)},
          {"surface_crc32", hex_words(report.surface_crc32)},
          {"surface_crc32_before", hex_or_null(report.surface_crc32_before)}};
}

}  // namespace

std::string json_report(const SequenceReport& report, const ReportContext& context) {
  Json json;
  json["schema"] = kReportSchema;
  json["program"] = context.program;
  json["sources"] = context.sources;
  json["notes"] = context.notes;
  json["options"] = Json::object();
  for (const auto& [name, value] : context.options) json["options"][name] = value;
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
  json["allowed"] = allowances(report);
  json["violations_total"] = to_json(report.violations_total);
  json["violated"] = violated(report);
  json["gap"] = gap(report);
  json["second_opinion"] = second_opinion(report);
  json["max_violations"] = report.max_violations;
  json["violations"] = Json::array();
  for (const Violation& violation : report.violations) {
    Json entry = to_json(violation);
    const auto name = context.frame_names.find(violation.frame);
    if (name != context.frame_names.end()) entry["frame_name"] = name->second;
    json["violations"].push_back(std::move(entry));
  }
  json["unchecked"] = report.unchecked;
  json["surface"] = {{"faces", report.faces},
                     {"vertices", report.vertices},
                     {"unreferenced_vertices", report.unreferenced_vertices},
                     {"first_change", nullptr},
                     {"body_faces", report.body_faces},
                     {"body_pairs", report.bodies_checked ? "checked" : "skipped"},
                     {"precision", report.precision == io::Precision::kFloat32 ? "float32" : "float64"},
                     {"largest_coordinate", report.largest_coordinate},
                     {"largest_coordinate_hex", to_hex(report.largest_coordinate)}};
  if (const auto change = first_surface_change(report)) json["surface"]["first_change"] = *change;
  json["sequence"] = sequence(report);
  json["seconds"] = report.seconds;
  // A file name may hold bytes that are no UTF-8: they are replaced, the report is valid all the same.
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace selvage::verify
