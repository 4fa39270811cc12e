#include "io/sequence_json.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <utility>

#include <nlohmann/json.hpp>

#include "io/fail.h"
#include "io/fp_guard.h"
#include "io/text.h"

namespace selvage::io {
namespace {

using Json = nlohmann::ordered_json;  // keeps the order of keys: a folder is read by people too

constexpr std::string_view kSchema = "selvage.sequence/1";
constexpr std::size_t kLargestHeader = std::size_t{1} << 20;  // JSON in memory takes up to some 20 times its text
constexpr std::size_t kLongestRecord = std::size_t{1} << 12;
constexpr int kDeepest = 4;  // sequence.json needs three levels

/// What is being read: every complaint names it, and the line where the text is one.
struct Source {
  const std::string& name;
  std::optional<std::size_t> line = std::nullopt;

  [[noreturn]] void fail(std::string_view what) const {
    if (line) bad_input_at_line(name, *line, what);
    bad_input(name, what);
  }
};

Json parse_json(std::string_view text, const Source& source) {
  const auto check_depth = [&](int depth, Json::parse_event_t, const Json&) {
    if (depth > kDeepest) source.fail("JSON nested deeper than " + std::to_string(kDeepest) + " levels; remove it");
    return true;
  };
  try {
    return Json::parse(text, check_depth);
  } catch (const Json::parse_error& error) {
    const auto lines_before =
        std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(std::min(error.byte, text.size())), '\n');
    const std::size_t line = source.line.value_or(1) + static_cast<std::size_t>(lines_before);
    bad_input_at_line(source.name, line, "not valid JSON; correct it");
  } catch (const Json::out_of_range&) {
    source.fail("a number is outside the range of double; correct it");
  }
}

void require_keys(const Json& object, std::initializer_list<std::string_view> known, const Source& source) {
  if (!object.is_object()) source.fail("not a JSON object; correct it");
  for (const auto& [key, value] : object.items()) {
    if (std::find(known.begin(), known.end(), key) == known.end())
      source.fail("unknown key " + in_quotes(key) + "; remove it");
  }
}

const Json& member(const Json& object, const char* key, const Source& source) {
  const auto found = object.find(key);
  if (found == object.end()) source.fail("the key " + in_quotes(key) + " is missing; add it");
  return *found;
}

std::string text_member(const Json& object, const char* key, const Source& source) {
  const Json& value = member(object, key, source);
  if (!value.is_string()) source.fail(in_quotes(key) + " is not a text; correct it");
  return value.get<std::string>();
}

/// A file of this folder and no other: the list may come from a stranger.
std::string file_member(const Json& object, const char* key, const Source& source) {
  std::string file = text_member(object, key, source);
  const bool leaves =
      file.empty() || file == "." || file == ".." || file.find_first_of(std::string_view("/\\\0", 3)) != file.npos;
  if (leaves) source.fail(in_quotes(file) + " is not the name of a file in the folder; correct it");
  return file;
}

template <typename Choice>
Choice choice_member(const Json& object, const char* key, const Source& source,
                     std::initializer_list<std::pair<std::string_view, Choice>> choices) {
  const std::string text = text_member(object, key, source);
  std::string known;
  for (const auto& [word, choice] : choices) {
    if (word == text) return choice;
    known += (known.empty() ? "" : " or ") + std::string(word);
  }
  source.fail(in_quotes(key) + " is " + in_quotes(text) + "; write " + known);
}

std::optional<std::uint32_t> crc32_member(const Json& object, const Source& source) {
  if (!object.contains("crc32")) return std::nullopt;
  const std::string text = text_member(object, "crc32", source);
  std::uint32_t value = 0;
  const std::from_chars_result result = std::from_chars(text.data(), text.data() + text.size(), value, 16);
  if (result.ec != std::errc() || result.ptr != text.data() + text.size() || text.size() != 8) {
    source.fail("\"crc32\" is " + in_quotes(text) + "; write eight hexadecimal digits");
  }
  return value;
}

std::string crc32_text(std::uint32_t crc32) {
  std::string text(8, '0');
  for (std::size_t i = 8; i-- > 0; crc32 >>= 4) text[i] = "0123456789abcdef"[crc32 & 0xf];
  return text;
}

std::int32_t face_index(const Json& value, const Source& source) {
  const bool fits =
      value.is_number_unsigned() && value.get<std::uint64_t>() <= std::numeric_limits<std::int32_t>::max();
  if (!fits) source.fail("a group's range is not of face numbers; correct it");
  return value.get<std::int32_t>();
}

Group parse_group(const Json& object, const Source& source) {
  require_keys(object, {"name", "role", "faces"}, source);
  Group group;
  group.name = text_member(object, "name", source);
  group.role = choice_member<Group::Role>(object, "role", source,
                                          {{"cloth", Group::Role::kCloth}, {"body", Group::Role::kBody}});
  const Json& range = member(object, "faces", source);
  if (!range.is_array() || range.size() != 2) source.fail("\"faces\" of a group is not [begin, end]; correct it");
  group.face_begin = face_index(range[0], source);
  group.face_end = face_index(range[1], source);
  if (group.face_begin > group.face_end) source.fail("a group ends before it begins; correct it");
  return group;
}

FrameRecord parse_frame(std::string_view line, const Source& source, std::size_t index) {
  if (line.size() > kLongestRecord) source.fail("the line is too long for a frame; correct it");
  const Json object = parse_json(line, source);
  require_keys(object, {"file", "time", "crc32"}, source);
  FrameRecord frame;
  frame.file = file_member(object, "file", source);
  frame.time_s = static_cast<double>(index);
  if (object.contains("time")) {
    const Json& time = member(object, "time", source);
    if (!time.is_number()) source.fail("\"time\" is not a number; correct it");
    frame.time_s = time.get<double>();
  }
  frame.crc32 = crc32_member(object, source);
  return frame;
}

}  // namespace

std::string to_json(const SequenceDescription& description) {
  const FpGuard guard;
  Json groups = Json::array();
  for (const Group& group : description.groups) {
    groups.push_back({{"name", group.name},
                      {"role", group.role == Group::Role::kCloth ? "cloth" : "body"},
                      {"faces", {group.face_begin, group.face_end}}});
  }
  Json faces = {{"file", description.faces_file}};
  if (description.faces_crc32) faces["crc32"] = crc32_text(*description.faces_crc32);
  const Json object = {
      {"schema", kSchema},
      {"producer", description.producer},
      {"kind", description.kind == SequenceKind::kSteps ? "steps" : "frames"},
      {"precision", description.precision == Precision::kFloat32 ? "float32" : "float64"},
      {"faces", faces},
      {"groups", groups},
      {"frames", kFramesFile},
      {"note", "frames.jsonl lists the frames that count, one a line; there may be more frame files than lines"}};
  return object.dump(2) + "\n";
}

std::string to_json(const FrameRecord& frame) {
  const FpGuard guard;
  Json object = {{"file", frame.file}, {"time", frame.time_s}};
  if (frame.crc32) object["crc32"] = crc32_text(*frame.crc32);
  return object.dump() + "\n";
}

SequenceDescription parse_sequence_json(std::string_view bytes, const std::string& name) {
  const FpGuard guard;
  const Source source = {name};
  if (bytes.size() > kLargestHeader) source.fail("larger than a header may be; is this a sequence?");
  const Json object = parse_json(bytes, source);
  require_keys(object, {"schema", "producer", "kind", "precision", "faces", "groups", "frames", "note"}, source);
  if (text_member(object, "schema", source) != kSchema) {
    source.fail("the schema is not " + std::string(kSchema) + "; use the version that wrote it");
  }
  SequenceDescription description;
  description.producer = text_member(object, "producer", source);
  description.kind = choice_member<SequenceKind>(object, "kind", source,
                                                 {{"frames", SequenceKind::kFrames}, {"steps", SequenceKind::kSteps}});
  description.precision = choice_member<Precision>(
      object, "precision", source, {{"float64", Precision::kFloat64}, {"float32", Precision::kFloat32}});
  const Json& faces = member(object, "faces", source);
  require_keys(faces, {"file", "crc32"}, source);
  description.faces_file = file_member(faces, "file", source);
  description.faces_crc32 = crc32_member(faces, source);
  if (text_member(object, "frames", source) != kFramesFile) {
    source.fail("\"frames\" is not " + std::string(kFramesFile) + "; correct it");
  }
  const Json& groups = member(object, "groups", source);
  if (!groups.is_array()) source.fail("\"groups\" is not a list; correct it");
  for (const Json& group : groups) description.groups.push_back(parse_group(group, source));
  return description;
}

std::vector<FrameRecord> parse_frame_list(std::string_view bytes, const std::string& name) {
  const FpGuard guard;
  std::vector<FrameRecord> frames;
  LineReader lines(bytes, name);
  while (const std::optional<std::string_view> line = lines.next()) {
    const bool may_be_torn = lines.rest().empty() && !bytes.ends_with('\n');
    if (may_be_torn && !Json::accept(*line)) break;
    frames.push_back(parse_frame(*line, {name, lines.line()}, frames.size()));
    if (!std::isfinite(frames.back().time_s)) lines.fail("the time is not finite; correct it");
    if (frames.size() > 1 && !(frames[frames.size() - 2].time_s < frames.back().time_s)) {
      lines.fail("the time is not later than that of the frame before; correct it");
    }
  }
  return frames;
}

}  // namespace selvage::io
