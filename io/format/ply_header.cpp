#include "io/format/ply_header.h"

#include <algorithm>
#include <array>
#include <utility>

#include "io/fail.h"
#include "io/format/polygon.h"

namespace selvage::io {
namespace {

/// PLY's own names and the ones with sizes, which meshio and others write.
constexpr std::array<std::pair<std::string_view, PlyType>, 16> kTypeNames = {{
    {"char", PlyType::kInt8},
    {"int8", PlyType::kInt8},
    {"uchar", PlyType::kUint8},
    {"uint8", PlyType::kUint8},
    {"short", PlyType::kInt16},
    {"int16", PlyType::kInt16},
    {"ushort", PlyType::kUint16},
    {"uint16", PlyType::kUint16},
    {"int", PlyType::kInt32},
    {"int32", PlyType::kInt32},
    {"uint", PlyType::kUint32},
    {"uint32", PlyType::kUint32},
    {"float", PlyType::kFloat32},
    {"float32", PlyType::kFloat32},
    {"double", PlyType::kFloat64},
    {"float64", PlyType::kFloat64},
}};

/// Elements of a file, properties of an element: scanners write some dozens.
constexpr std::size_t kMaxInHeader = 256;

PlyType parse_type(const LineReader& lines, std::string_view token) {
  for (const auto& [type_name, type] : kTypeNames) {
    if (type_name == token) return type;
  }
  lines.fail(in_quotes(token) + " is not a PLY type; use float, double, int, uchar, ...");
}

PlyFormat parse_format(const LineReader& lines, std::string_view rest) {
  const std::string_view format = next_token(rest);
  if (next_token(rest) != "1.0" || !next_token(rest).empty()) lines.fail("the format is not version 1.0; convert it");
  if (format == "ascii") return PlyFormat::kAscii;
  if (format == "binary_little_endian") return PlyFormat::kLittleEndian;
  if (format == "binary_big_endian") return PlyFormat::kBigEndian;
  lines.fail(in_quotes(format) + " is not a PLY format; use ascii, binary_little_endian or binary_big_endian");
}

PlyElement parse_element(const LineReader& lines, std::string_view rest) {
  PlyElement element;
  element.name = next_token(rest);
  element.line = lines.line();
  const std::string_view token = next_token(rest);
  const std::optional<std::int64_t> count = parse_integer(token);
  if (element.name.empty() || !count || *count < 0 || !next_token(rest).empty()) {
    lines.fail("an element needs a name and a count, at most 2^31; correct the header");
  }
  if (*count > static_cast<std::int64_t>(kMaxElements)) lines.fail("more than 2^31 - 1 elements; split the mesh");
  element.count = static_cast<std::uint64_t>(*count);
  return element;
}

PlyProperty parse_property(const LineReader& lines, std::string_view rest) {
  PlyProperty property;
  std::string_view token = next_token(rest);
  if (token == "list") {
    property.list_count = parse_type(lines, next_token(rest));
    if (!is_integer(*property.list_count)) lines.fail("the count of a list is not an integer type; use uchar");
    token = next_token(rest);
  }
  property.type = parse_type(lines, token);
  property.name = next_token(rest);
  if (property.name.empty() || !next_token(rest).empty()) lines.fail("a property needs a type and a name; add them");
  return property;
}

/// Fewest bytes that one record of the element takes: what makes a count believable.
std::uint64_t smallest_record(const PlyElement& element, PlyFormat format) {
  if (format == PlyFormat::kAscii)
    return 2 * element.properties.size() - 1;  // digits and blanks; no line end at the end
  std::uint64_t bytes = 0;
  for (const PlyProperty& property : element.properties) bytes += size_of(property.list_count.value_or(property.type));
  return bytes;
}

void check_counts(const LineReader& lines, const PlyHeader& header) {
  std::uint64_t remaining = lines.rest().size();
  for (const PlyElement& element : header.elements) {
    if (element.properties.empty()) lines.fail_at(element.line, "an element has no property; remove it");
    const std::uint64_t needed = element.count * smallest_record(element, header.format);
    if (needed > remaining) {
      lines.fail_at(element.line, std::to_string(element.count) + " of " + in_quotes(element.name) +
                                      " do not fit in the " + std::to_string(remaining) +
                                      " bytes left; the file is cut short");
    }
    remaining -= needed;
  }
}

}  // namespace

std::optional<std::size_t> PlyElement::find(std::initializer_list<std::string_view> names) const {
  const auto found = std::find_if(properties.begin(), properties.end(), [&](const PlyProperty& property) {
    return std::find(names.begin(), names.end(), property.name) != names.end();
  });
  if (found == properties.end()) return std::nullopt;
  return static_cast<std::size_t>(found - properties.begin());
}

PlyHeader parse_ply_header(LineReader& lines) {
  if (lines.next().value_or("") != "ply") lines.fail_at(1, "the first line is not \"ply\"; is this a PLY file?");
  PlyHeader header;
  bool has_format = false;
  for (;;) {
    std::optional<std::string_view> line = lines.next();
    if (!line) lines.fail("the header has no \"end_header\"; the file is cut short");
    const std::string_view keyword = next_token(*line);
    if (keyword == "end_header") break;
    if (keyword == "comment" || keyword == "obj_info") continue;
    if (keyword == "format" && !has_format) {
      header.format = parse_format(lines, *line);
      has_format = true;
    } else if (keyword == "element") {
      if (header.elements.size() == kMaxInHeader) lines.fail("too many elements; remove some");
      header.elements.push_back(parse_element(lines, *line));
    } else if (keyword == "property" && !header.elements.empty()) {
      PlyProperty property = parse_property(lines, *line);
      PlyElement& element = header.elements.back();
      if (element.properties.size() == kMaxInHeader) lines.fail("too many properties; remove some");
      if (element.find({property.name}))
        lines.fail("two properties are named " + in_quotes(property.name) + "; rename one");
      element.properties.push_back(std::move(property));
    } else {
      lines.fail(in_quotes(keyword) + " does not belong here in a PLY header; correct it");
    }
  }
  if (!has_format) lines.fail("the header has no \"format\" line; add it");
  check_counts(lines, header);
  return header;
}

}  // namespace selvage::io
