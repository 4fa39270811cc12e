// OBJ: what of it is a surface. Texture coordinates, normals and materials are skipped; lines, points and free-form
// surfaces are refused, because a mesh without them would be checked in the name of one with them.
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "io/fail.h"
#include "io/file/fp_guard.h"
#include "io/file/text.h"
#include "io/format/polygon.h"
#include "io/mesh_reader.h"

namespace selvage::io {
namespace {

constexpr std::array<std::string_view, 7> kSkipped = {"vt", "vn", "s", "usemtl", "mtllib", "usemap", "maplib"};
constexpr std::array<std::string_view, 4> kOfNumbers = {"v", "vt", "vn", "f"};

bool is_one_of(std::string_view keyword, std::span<const std::string_view> keywords) {
  return std::find(keywords.begin(), keywords.end(), keyword) != keywords.end();
}

/// A backslash ends a name or a path too, where it must not swallow the vertex on the next line; and a name may hold
/// '#'.
bool is_of_numbers(std::string_view line) { return is_one_of(next_token(line), kOfNumbers); }

constexpr std::string_view kFaceMayBeCut =
    "the last line has no end and the face may be cut; restore the file, or add the line break if it is whole";

/// Of a line of numbers. A backslash in the comment is part of it. In 1.#INF and 1.#QNAN, which old C libraries of
/// Windows print, no comment begins: what is left would be read as a finite number.
std::string_view without_comment(std::string_view line) {
  const auto is_letter = [](char c) { return ('a' <= c && c <= 'z') || ('A' <= c && c <= 'Z'); };
  const auto is_in_number = [&](std::size_t at) {
    return at > 0 && line[at - 1] == '.' && at + 1 < line.size() && is_letter(line[at + 1]);
  };
  std::size_t at = line.find('#');
  while (at != line.npos && is_in_number(at)) at = line.find('#', at + 1);
  return line.substr(0, at);
}

class ObjParser {
 public:
  ObjParser(std::string_view bytes, const std::string& name) : bytes_(bytes), lines_(bytes, name), name_(name) {}

  MeshData parse() {
    reserve();
    while (const std::optional<std::string_view> line = next_statement()) parse_statement(*line);
    if (mesh_.points.empty()) bad_input(name_, "no vertex; is this an OBJ file?");
    if (mesh_.triangles.empty()) bad_input(name_, "no face; the file is cut short or holds no surface");
    if (highest_corner_ > static_cast<std::int64_t>(mesh_.points.size())) {
      bad_input_at_line(name_, highest_line_, out_of_range(std::to_string(highest_corner_)));
    }
    end_group();
    return std::move(mesh_);
  }

 private:
  /// Room for all that the statements announce: growing by doubling would take up to three times as much at once,
  /// beyond ten times the file. A group that is kept has a face.
  void reserve() {
    std::size_t vertices = 0, triangles = 0, groups = 1;
    while (std::optional<std::string_view> rest = next_statement()) {
      const std::string_view keyword = next_token(*rest);
      if (keyword == "v") ++vertices;
      if (keyword == "g" || keyword == "o") ++groups;
      if (keyword != "f") continue;
      std::size_t corners = 0;
      while (!next_token(*rest).empty()) ++corners;
      triangles += std::max<std::size_t>(corners, 2) - 2;
    }
    mesh_.points.reserve(vertices);
    mesh_.triangles.reserve(triangles);
    mesh_.groups.reserve(std::min(groups, triangles + 1));
    lines_ = LineReader(bytes_, name_);
  }

  /// A line; of numbers, without its comment and joined with the next while it ends in a backslash.
  std::optional<std::string_view> next_statement() {
    std::optional<std::string_view> line = lines_.next();
    if (!line || !is_of_numbers(*line)) return line;
    line = without_comment(*line);
    look_for_end(*line);
    if (!line->ends_with('\\')) return line;
    joined_.clear();
    while (line && line->ends_with('\\')) {
      joined_.append(line->substr(0, line->size() - 1)).push_back(' ');
      if (joined_.size() > kLongestLine) lines_.fail("statement longer than a line may be; split it");
      line = lines_.next();
      if (line) line = without_comment(*line);
    }
    if (!line) lines_.fail("the file ends behind a backslash; complete the line");
    look_for_end(*line);
    return joined_.append(*line);
  }

  /// Of a line of numbers: whether the file ends with it, without a line break.
  void look_for_end(std::string_view line) {
    has_no_end_ = line.data() + line.size() == bytes_.data() + bytes_.size();
    ends_in_number_ = trimmed(line).data() + trimmed(line).size() == line.data() + line.size();
  }

  void parse_statement(std::string_view rest) {
    const std::string_view keyword = next_token(rest);
    if (keyword.empty() || keyword[0] == '#') return;
    if (keyword == "v") return parse_vertex(rest);
    if (keyword == "f") return parse_face(rest);
    if (keyword == "o" || keyword == "g") return begin_group(trimmed(rest));
    if (is_one_of(keyword, kSkipped)) return;
    lines_.fail(in_quotes(keyword) + " is not part of a surface; remove the line or export triangles");
  }

  /// x y z, x y z w with w = 1, or x y z and a colour.
  void parse_vertex(std::string_view rest) {
    std::array<double, 6> numbers = {};
    std::size_t count = 0;
    for (std::string_view token = next_token(rest); !token.empty(); token = next_token(rest)) {
      if (count == numbers.size()) lines_.fail("a vertex has more than six numbers; give three");
      const NumberFault fault = parse_number(token, numbers[count++]);
      if (fault != NumberFault::kNone) lines_.fail(describe(fault, token));
    }
    if (count != 3 && count != 6 && !(count == 4 && numbers[3] == 1)) {
      const char* weight = count == 4 ? ", the last of which, its weight, is not 1" : "";
      lines_.fail("a vertex has " + std::to_string(count) + " numbers" + weight + "; give three");
    }
    if (has_no_end_ && ends_in_number_) lines_.fail(kMayBeCut);
    if (mesh_.points.size() == kMaxElements) lines_.fail("more than 2^31 - 1 vertices; split the mesh");
    mesh_.points.push_back({numbers[0], numbers[1], numbers[2]});
  }

  void parse_face(std::string_view rest) {
    corners_.clear();
    corners_.reserve((rest.size() + 1) / 2);
    std::string_view last_corner;
    for (std::string_view token = next_token(rest); !token.empty(); token = next_token(rest)) {
      corners_.push_back(parse_corner(token));
      last_corner = token;
    }
    if (has_no_end_ && face_may_be_cut(last_corner)) lines_.fail(kFaceMayBeCut);
    most_corners_ = std::max(most_corners_, corners_.size());
    const std::string fault = append_fan(corners_, mesh_);
    if (!fault.empty()) lines_.fail(fault);
  }

  /// Whether more digits would name another vertex, or others have more corners. Many programs (trimesh) write no last
  /// line break, so that a file without one is read where nothing tells that it is cut.
  [[nodiscard]] bool face_may_be_cut(std::string_view last_corner) const {
    if (corners_.size() < most_corners_) return true;
    if (!ends_in_number_ || last_corner.find('/') != last_corner.npos) return false;
    const auto index = static_cast<std::uint64_t>(std::abs(parse_integer(last_corner).value_or(0)));
    return 10 * index <= mesh_.points.size();
  }

  /// v, v/vt, v//vn or v/vt/vn; the vertex counted from 1, or backwards from -1.
  std::int32_t parse_corner(std::string_view token) {
    const std::size_t slash = token.find('/');
    const std::optional<std::int64_t> index = parse_integer(token.substr(0, slash));
    if (!index || (slash != token.npos && !attributes_are_integers(token.substr(slash + 1)))) {
      lines_.fail(in_quotes(token) + " is not v, v/vt, v//vn or v/vt/vn; correct the corner");
    }
    const auto count = static_cast<std::int64_t>(mesh_.points.size());
    const bool backwards = *index < 0;
    if (*index == 0 || *index < -count || *index > static_cast<std::int64_t>(kMaxElements)) {
      lines_.fail(out_of_range(in_quotes(token)));
    }
    if (*index > highest_corner_) {  // it may be defined further down
      highest_corner_ = *index;
      highest_line_ = lines_.line();
    }
    return static_cast<std::int32_t>(backwards ? count + *index : *index - 1);
  }

  /// "vt", "/vn" or "vt/vn".
  static bool attributes_are_integers(std::string_view text) {
    const std::size_t slash = text.find('/');
    const bool has_texture = slash != 0;
    if (has_texture && !parse_integer(text.substr(0, slash))) return false;
    return slash == text.npos || parse_integer(text.substr(slash + 1)).has_value();
  }

  std::string out_of_range(const std::string& index) const {
    return "vertex " + index + " of " + std::to_string(mesh_.points.size()) + "; correct the index";
  }

  void begin_group(std::string_view group_name) {
    if (!is_utf8(group_name)) lines_.fail("the name is not UTF-8; save the file as UTF-8");
    if (mesh_.groups.empty() && !mesh_.triangles.empty()) {
      mesh_.groups.push_back({.name = "default"});  // OBJ's own name for what precedes the first group
    }
    end_group();
    const auto begin = static_cast<std::int32_t>(mesh_.triangles.size());
    mesh_.groups.push_back({.name = std::string(group_name), .face_begin = begin});
  }

  /// Ends the open group here; an empty one ("o" followed by "g") is dropped.
  void end_group() {
    if (mesh_.groups.empty()) return;
    mesh_.groups.back().face_end = static_cast<std::int32_t>(mesh_.triangles.size());
    if (mesh_.groups.back().face_begin == mesh_.groups.back().face_end) mesh_.groups.pop_back();
  }

  std::string_view bytes_;
  LineReader lines_;
  std::string name_;
  std::string joined_;
  std::vector<std::int32_t> corners_;
  bool has_no_end_ = false, ends_in_number_ = false;  ///< of the statement; as look_for_end() says
  std::size_t most_corners_ = 0;                      ///< of the faces so far
  std::int64_t highest_corner_ = 0;                   ///< counted from 1
  std::size_t highest_line_ = 0;
  MeshData mesh_;
};

}  // namespace

MeshData parse_obj(std::string_view bytes, const std::string& name) {
  const FpGuard guard;
  return ObjParser(bytes, name).parse();
}

}  // namespace selvage::io
