#include "io/sequence/sequence_json.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <functional>
#include <initializer_list>
#include <limits>
#include <span>
#include <utility>

#include <nlohmann/json.hpp>

#include "io/fail.h"
#include "io/file/fp_guard.h"
#include "io/file/json_values.h"
#include "io/file/text.h"

namespace selvage::io {
namespace {

using Json = nlohmann::ordered_json;  // keeps the order of keys: a folder is read by people too

constexpr std::string_view kSchema = "selvage.sequence/1";
constexpr std::size_t kLongestRecord = std::size_t{1} << 12;
constexpr std::size_t kShortestRecord = std::string_view(R"({"file":"a"})").size();

constexpr std::string_view kNoObject = "not a JSON object; correct it";
constexpr std::string_view kNoRange = "\"faces\" of a group is not [begin, end]; correct it";
constexpr std::string_view kNoFace = "a group's range is not of face numbers; correct it";

constexpr JsonPlace kHeaderPlaces[] = {
    {"", JsonType::kObject, kNoObject},
    {"schema", JsonType::kText},
    {"producer", JsonType::kText},
    {"kind", JsonType::kText},
    {"precision", JsonType::kText},
    {"faces", JsonType::kObject, kNoObject},
    {"faces.file", JsonType::kText},
    {"faces.crc32", JsonType::kText},
    {"groups", JsonType::kList, "\"groups\" is not a list; correct it"},
    {"groups[]", JsonType::kObject, kNoObject},
    {"groups[].name", JsonType::kText},
    {"groups[].role", JsonType::kText},
    {"groups[].faces", JsonType::kList, kNoRange},
    {"groups[].faces[0]", JsonType::kNumber, kNoFace},
    {"groups[].faces[1]", JsonType::kNumber, kNoFace},
    {"frames", JsonType::kText},
    {"note", JsonType::kText},
};

constexpr JsonPlace kFramePlaces[] = {
    {"", JsonType::kObject, kNoObject},
    {"file", JsonType::kText},
    {"time", JsonType::kNumber, "\"time\" is not a number; correct it"},
    {"crc32", JsonType::kText},
};

/// What is being read: every complaint names it, and the line where the text is one.
struct Source {
  const std::string& name;
  std::optional<std::size_t> line = std::nullopt;

  [[noreturn]] void fail(std::string_view what) const {
    if (line) bad_input_at_line(name, *line, what);
    bad_input(name, what);
  }
};

JsonValues read(std::string_view text, std::span<const JsonPlace> places, const Source& source,
                const std::function<void(const JsonValues&)>& at_item = {}) {
  return read_json(text, {.places = places,
                          .at_item = at_item,
                          .fail = [&](std::string_view what) { source.fail(what); },
                          .fail_at =
                              [&](std::size_t lines_before, std::string_view what) {
                                bad_input_at_line(source.name, source.line.value_or(1) + lines_before, what);
                              }});
}

/// The value at `path`, of the type that its place has.
template <typename Value>
const Value& member(const JsonValues& values, std::string_view path, const Source& source) {
  const auto found = values.find(path);
  if (found == values.end()) {
    source.fail("the key " + in_quotes(last_key(path)) + " is missing; add it");
  }
  return std::get<Value>(found->second);
}

const std::string& text_member(const JsonValues& values, std::string_view path, const Source& source) {
  return member<std::string>(values, path, source);
}

/// A file of this folder and no other: the list may come from a stranger.
std::string file_member(const JsonValues& values, std::string_view path, const Source& source) {
  const std::string& file = text_member(values, path, source);
  const bool leaves =
      file.empty() || file == "." || file == ".." || file.find_first_of(std::string_view("/\\\0", 3)) != file.npos;
  if (leaves) source.fail(in_quotes(file) + " is not the name of a file in the folder; correct it");
  return file;
}

template <typename Choice>
Choice choice_member(const JsonValues& values, std::string_view path, const Source& source,
                     std::initializer_list<std::pair<std::string_view, Choice>> choices) {
  const std::string& text = text_member(values, path, source);
  std::string known;
  for (const auto& [word, choice] : choices) {
    if (word == text) return choice;
    known += (known.empty() ? "" : " or ") + std::string(word);
  }
  source.fail(in_quotes(last_key(path)) + " is " + in_quotes(text) + "; write " + known);
}

std::optional<std::uint32_t> crc32_member(const JsonValues& values, std::string_view path, const Source& source) {
  if (!values.contains(path)) return std::nullopt;
  const std::string& text = text_member(values, path, source);
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

std::int32_t face_index(const JsonValues& values, std::string_view path, const Source& source) {
  const auto found = values.find(path);
  if (found == values.end()) source.fail(kNoRange);
  const std::uint64_t* index = std::get_if<std::uint64_t>(&found->second);
  if (index == nullptr || *index > std::numeric_limits<std::int32_t>::max()) source.fail(kNoFace);
  return static_cast<std::int32_t>(*index);
}

Group parse_group(const JsonValues& values, const Source& source) {
  Group group;
  group.name = text_member(values, "groups[].name", source);
  group.role = choice_member<Group::Role>(values, "groups[].role", source,
                                          {{"cloth", Group::Role::kCloth}, {"body", Group::Role::kBody}});
  member<std::monostate>(values, "groups[].faces", source);
  group.face_begin = face_index(values, "groups[].faces[0]", source);
  group.face_end = face_index(values, "groups[].faces[1]", source);
  if (group.face_begin > group.face_end) source.fail("a group ends before it begins; correct it");
  return group;
}

double number(const JsonValues::mapped_type& value) {
  const std::uint64_t* whole = std::get_if<std::uint64_t>(&value);
  return whole != nullptr ? static_cast<double>(*whole) : std::get<double>(value);
}

FrameRecord parse_frame(std::string_view line, const Source& source, std::size_t index) {
  if (line.size() > kLongestRecord) source.fail("the line is too long for a frame; correct it");
  const JsonValues values = read(line, kFramePlaces, source);
  FrameRecord frame;
  frame.file = file_member(values, "file", source);
  const auto time = values.find("time");
  frame.time_s = time == values.end() ? static_cast<double>(index) : number(time->second);
  frame.crc32 = crc32_member(values, "crc32", source);
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
  SequenceDescription description;
  const JsonValues values = read(bytes, kHeaderPlaces, source, [&](const JsonValues& so_far) {
    description.groups.push_back(parse_group(so_far, source));
  });
  if (text_member(values, "schema", source) != kSchema) {
    source.fail("the schema is not " + std::string(kSchema) + "; use the version that wrote it");
  }
  description.producer = text_member(values, "producer", source);
  description.kind = choice_member<SequenceKind>(values, "kind", source,
                                                 {{"frames", SequenceKind::kFrames}, {"steps", SequenceKind::kSteps}});
  description.precision = choice_member<Precision>(
      values, "precision", source, {{"float64", Precision::kFloat64}, {"float32", Precision::kFloat32}});
  member<std::monostate>(values, "faces", source);
  description.faces_file = file_member(values, "faces.file", source);
  description.faces_crc32 = crc32_member(values, "faces.crc32", source);
  if (text_member(values, "frames", source) != kFramesFile) {
    source.fail("\"frames\" is not " + std::string(kFramesFile) + "; correct it");
  }
  member<std::monostate>(values, "groups", source);
  return description;
}

std::vector<FrameRecord> parse_frame_list(std::string_view bytes, const std::string& name) {
  const FpGuard guard;
  bytes = bytes.substr(0, bytes.rfind('\n') + 1);  // npos + 1 is 0: what has no end may be torn anywhere
  std::vector<FrameRecord> frames;
  const auto ends = static_cast<std::size_t>(std::count(bytes.begin(), bytes.end(), '\n'));
  frames.reserve(std::min(ends + 1, bytes.size() / kShortestRecord));  // growing by doubling takes three times as much
  LineReader lines(bytes, name);
  while (const std::optional<std::string_view> line = lines.next()) {
    frames.push_back(parse_frame(*line, {name, lines.line()}, frames.size()));
    if (!std::isfinite(frames.back().time_s)) lines.fail("the time is not finite; correct it");
    if (frames.size() > 1 && !(frames[frames.size() - 2].time_s < frames.back().time_s)) {
      lines.fail("the time is not later than that of the frame before; correct it");
    }
  }
  return frames;
}

}  // namespace selvage::io
