// Reads a report back: a run that was killed continues from one, and parts of a sequence are joined.
#include <algorithm>
#include <array>
#include <charconv>
#include <limits>

#include <nlohmann/json.hpp>

#include "io/error.h"
#include "io/file/json_values.h"
#include "verify/report/report.h"
#include "verify/report/report_sums.h"

namespace selvage::verify {
namespace {

using Json = nlohmann::ordered_json;

/// Not a report: what is wrong with it.
struct Fault {
  std::string what;
};

std::uint32_t word(const std::string& text) {
  std::uint32_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value, 16);
  if (error != std::errc() || end != text.data() + text.size() || text.size() != 8) {
    throw Fault{"'" + text + "' is no checksum"};
  }
  return value;
}

double from_hex(const std::string& text) {
  if (text == "inf") return std::numeric_limits<double>::infinity();
  std::string_view digits = text;
  const bool negative = digits.starts_with('-');
  if (negative) digits.remove_prefix(1);
  double value = 0;
  const bool has_prefix = digits.starts_with("0x");
  if (has_prefix) digits.remove_prefix(2);
  const auto [end, error] =
      std::from_chars(digits.data(), digits.data() + digits.size(), value, std::chars_format::hex);
  if (!has_prefix || error != std::errc() || end != digits.data() + digits.size()) {
    throw Fault{"'" + text + "' is no hexadecimal float"};
  }
  return negative ? -value : value;
}

template <class T, std::size_t N>
T named(const Json& json, const std::array<std::pair<const char*, T>, N>& names) {
  const auto text = json.get<std::string>();
  for (const auto& [name, value] : names) {
    if (text == name) return value;
  }
  throw Fault{"unknown word '" + text + "'"};
}

/// Not negative, and so that sums of many and products with small numbers do not overflow. The library itself would
/// convert -1, 1e300, and 2^40 to an index, without a word.
std::int64_t count(const Json& json, std::int64_t largest = std::int64_t{1} << 53) {
  if (!json.is_number_unsigned() || json.get<std::uint64_t>() > static_cast<std::uint64_t>(largest)) {
    throw Fault{"'" + json.dump() + "' is no such count or index"};
  }
  return json.get<std::int64_t>();
}
std::int32_t index(const Json& json) {
  return static_cast<std::int32_t>(count(json, std::numeric_limits<std::int32_t>::max()));
}

std::array<std::int32_t, 2> features(const Json& json) {
  if (json.size() != 2) throw Fault{"an event has not two features"};
  return {index(json.at(0)), index(json.at(1))};
}

std::vector<Point> points(const Json& json) {
  std::vector<Point> result;
  for (const Json& point : json) {
    result.push_back({from_hex(point.at(0)), from_hex(point.at(1)), from_hex(point.at(2))});
  }
  return result;
}

bool is_motion(const Json& json) { return named<bool, 2>(json, {{{"motion", true}, {"frame", false}}}); }

ViolationCounts violation_counts(const Json& json) {
  return {count(json.at("vf")), count(json.at("ee")), count(json.at("overlap")), count(json.at("self"))};
}

Violation violation(const Json& json) {
  Violation result;
  result.frame = count(json.at("frame"));
  result.motion = is_motion(json.at("unit"));
  result.event = named<EventKind, 4>(
      json.at("event"),
      {{{"vf", EventKind::kVf}, {"ee", EventKind::kEe}, {"overlap", EventKind::kOverlap}, {"self", EventKind::kSelf}}});
  result.kind = json.at("kind");
  result.features = features(json.at("features"));
  result.vertices.fill(-1);
  const Json& vertices = json.at("vertices");
  if (vertices.size() > result.vertices.size()) throw Fault{"a violation has too many vertices"};
  for (std::size_t i = 0; i < vertices.size(); ++i) result.vertices[i] = index(vertices.at(i));
  result.at_touch = json.at("positions").get<std::vector<Point>>();
  result.x_t0 = points(json.at("bits_t0"));
  result.x_t1 = result.motion ? points(json.at("bits_t1")) : result.x_t0;
  if (result.motion) {
    const Json& t = json.at("t");
    result.t = {t.at("lower"), t.at("upper"), t.at("lower_number"), t.at("upper_number")};
  }
  const std::size_t wanted = result.event == EventKind::kOverlap ? 6 : result.event == EventKind::kSelf ? 3 : 4;
  for (const std::size_t size : {vertices.size(), result.at_touch.size(), result.x_t0.size(), result.x_t1.size()}) {
    if (size != wanted) throw Fault{"a violation has not as many vertices and positions as its event"};
  }
  if (json.contains("case")) result.case_file = json.at("case");
  return result;
}

SequenceReport::Counted counted(const Json& json, std::int64_t& expected) {
  expected = count(json.at("expected"));
  return {count(json.at("checked")), count(json.at("violated"))};
}

void parse_allowances(const Json& json, SequenceReport& report) {
  for (const Json& entry : json.at("exempted"))
    report.exempted.push_back({entry.at("groups"), count(entry.at("pairs"))});
  for (const Json& entry : json.at("ignored")) report.ignored.push_back({entry.at("group"), count(entry.at("faces"))});
  const Json& weld = json.at("weld");
  if (!weld.is_null()) report.welded = {count(weld.at("vertices")), count(weld.at("collapsed_faces"))};
}

/// A violation is in one of the frames, or in a motion that leads to one.
void require_frame(const SequenceReport& report, std::int64_t frame, bool motion) {
  const std::int64_t first = motion ? std::max<std::int64_t>(report.first_frame - 1, 0) : report.first_frame;
  const std::int64_t end = motion ? report.end_frame - 1 : report.end_frame;
  if (frame < first || frame >= end) throw Fault{"a violation is in none of its frames and motions"};
}

std::vector<std::uint32_t> words(const Json& json) {
  std::vector<std::uint32_t> result;
  for (const Json& entry : json) result.push_back(word(entry));
  return result;
}

std::optional<std::uint32_t> word_or_nothing(const Json& json) {
  return json.is_null() ? std::nullopt : std::optional(word(json));
}

void parse_sequence(const Json& json, SequenceReport& report) {
  report.sequence = json.at("identity");
  report.frame_count = count(json.at("frames"));
  report.first_frame = count(json.at("first_frame"));
  report.end_frame = count(json.at("end_frame"));
  report.frame_crc32 = words(json.at("crc32"));
  report.crc32_before = word_or_nothing(json.at("crc32_before"));
  if (json.contains("surface_crc32")) {  // not in reports of earlier versions
    report.surface_crc32 = words(json.at("surface_crc32"));
    report.surface_crc32_before = word_or_nothing(json.at("surface_crc32_before"));
  }
  const std::int64_t checked = std::ssize(report.frame_crc32);
  if (report.first_frame >= report.end_frame || report.end_frame > report.frame_count ||
      checked > report.end_frame - report.first_frame) {
    throw Fault{"the range of frames makes no sense"};
  }
  if (!report.surface_crc32.empty() && report.surface_crc32.size() != report.frame_crc32.size()) {
    throw Fault{"there are not as many checksums of surfaces as of positions"};
  }
}

void parse_surface(const Json& json, SequenceReport& report) {
  report.faces = count(json.at("faces"));
  report.vertices = count(json.at("vertices"));
  report.unreferenced_vertices = count(json.at("unreferenced_vertices"));
  report.body_faces = count(json.at("body_faces"));
  report.bodies_checked = named<bool, 2>(json.at("body_pairs"), {{{"checked", true}, {"skipped", false}}});
  report.precision = named<io::Precision, 2>(
      json.at("precision"), {{{"float32", io::Precision::kFloat32}, {"float64", io::Precision::kFloat64}}});
  report.largest_coordinate = from_hex(json.at("largest_coordinate_hex"));
}

ParsedReport parse(const Json& json) {
  if (!json.is_object() || json.value("schema", "") != kReportSchema) {
    throw Fault{std::string("its schema is not ") + kReportSchema};
  }
  ParsedReport parsed;
  SequenceReport& report = parsed.report;
  parsed.context.program = json.at("program");
  parsed.context.sources = json.at("sources").get<std::vector<std::string>>();
  if (json.contains("notes")) {  // not in reports of earlier versions
    parsed.context.notes = json.at("notes").get<std::vector<std::string>>();
  }
  for (const auto& [name, value] : json.at("options").items()) parsed.context.options.emplace_back(name, value);
  report.verdict = named<Verdict, 3>(
      json.at("verdict"),
      {{{"clean", Verdict::kClean}, {"violated", Verdict::kViolated}, {"unknown", Verdict::kUnknown}}});
  parse_sequence(json.at("sequence"), report);
  report.frames = counted(json.at("frames"), report.frames_expected);
  report.motions = counted(json.at("motions"), report.motions_expected);
  const Json& pairs = json.at("pairs");
  report.pairs = {count(pairs.at("vf")),
                  count(pairs.at("ee")),
                  count(pairs.at("overlap")),
                  count(pairs.at("self")),
                  count(pairs.at("exact")),
                  0,
                  0};
  report.violations_total = violation_counts(json.at("violations_total"));
  for (const Json& entry : json.at("violated")) {
    report.violated.push_back({count(entry.at("frame")), is_motion(entry.at("unit")), violation_counts(entry)});
    require_frame(report, report.violated.back().frame, report.violated.back().motion);
  }
  const Json& gap = json.at("gap");
  report.gap_searched = !gap.is_null();
  if (report.gap_searched && !gap.at("lower").is_null()) {
    report.gap = {from_hex(gap.at("lower_hex")), from_hex(gap.at("upper_hex")), count(gap.at("frame")),
                  named<EventKind, 2>(gap.at("event"), {{{"vf", EventKind::kVf}, {"ee", EventKind::kEe}}}),
                  features(gap.at("features"))};
    if (gap.contains("bits")) report.gap->x = points(gap.at("bits"));  // not in reports of earlier versions
  }
  const Json& second = json.at("second_opinion");
  if (!second.is_null()) {
    report.second_opinion = named<SecondOpinionScope, 2>(
        second.at("scope"), {{{"undecided", SecondOpinionScope::kUndecided}, {"all", SecondOpinionScope::kAll}}});
    report.pairs.asked_again = count(second.at("asked"));
    report.pairs.disagreed = count(second.at("disagreed"));
    for (const Json& entry : second.at("disagreements")) {
      report.disagreements.push_back(violation(entry));
      require_frame(report, report.disagreements.back().frame, report.disagreements.back().motion);
    }
  }
  parse_allowances(json.at("allowed"), report);
  report.max_violations = count(json.at("max_violations"));
  for (const Json& entry : json.at("violations")) {
    report.violations.push_back(violation(entry));
    const std::int64_t frame = report.violations.back().frame;
    require_frame(report, frame, report.violations.back().motion);
    if (entry.contains("frame_name")) parsed.context.frame_names[frame] = entry.at("frame_name");
  }
  report.unchecked = json.at("unchecked").get<std::vector<std::string>>();
  parse_surface(json.at("surface"), report);
  report.seconds = json.at("seconds");
  if (const std::string what = contradiction_in(report); !what.empty()) {
    throw Fault{what + "; it is damaged, check again"};
  }
  return parsed;
}

}  // namespace

ParsedReport parse_report(const std::string& text, const std::string& name) {
  const auto fail = [&name](const std::string& what) -> ParsedReport {
    throw io::Error(io::ErrorKind::kBadInput, name + ": not a report of selvage verify: " + what);
  };
  if (const std::string fault = io::zero_byte_fault(text); !fault.empty()) return fail(fault);
  try {
    return parse(Json::parse(text));
  } catch (const Fault& fault) {
    return fail(fault.what);
  } catch (const Json::parse_error& error) {
    return fail("not valid JSON at byte " + std::to_string(error.byte) + "; is it whole?");
  } catch (const Json::exception& error) {
    const std::string_view what = error.what();  // "[json.exception.out_of_range.403] key 'program' not found"
    return fail(std::string(what.substr(what.find("] ") + 2)) + "; is it whole?");
  }
}

}  // namespace selvage::verify
