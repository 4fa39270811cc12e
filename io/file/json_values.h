// JSON of a known shape, read value by value: no tree is built, whose memory would be some twenty times the text.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <variant>

namespace selvage::io {

enum class JsonType { kText, kNumber, kObject, kList };

/// Where the text may hold a value, and of which type. The outermost value is "", the key k of the object P is "P.k",
/// any object of the list P is "P[]", and where there is none such, the items of the list P are "P[0]", "P[1]", ...
struct JsonPlace {
  std::string_view path;
  JsonType type;
  std::string_view fault = {};  ///< where the value is of another type, or a list has more items; a text needs none
};

/// What was read, by path; objects and lists are there without a value.
using JsonValues = std::map<std::string, std::variant<std::monostate, std::string, std::uint64_t, double>, std::less<>>;

struct JsonReading {
  std::span<const JsonPlace> places;
  /// Shown all values where an object of a list ends; those of that object are then forgotten, so that one is in
  /// memory.
  std::function<void(const JsonValues&)> at_item;
  std::function<void(std::string_view what)> fail;                               ///< throws
  std::function<void(std::size_t lines_before, std::string_view what)> fail_at;  ///< throws, at the line
};

/// Refuses whatever has no place: other keys, other types, a key that is there twice. O(text) time; memory for the
/// values and for what the parser needs for the longest text between quotes.
[[nodiscard]] JsonValues read_json(std::string_view text, const JsonReading& reading);

/// Where JSON that nlohmann-json is to read has a zero byte, which no JSON holds; npos: nowhere. It takes one for the
/// end of the text, without a word of what stands behind: a frame whose line break had become zero was not in the
/// sequence.
[[nodiscard]] inline std::size_t find_zero_byte(std::string_view json) { return json.find('\0'); }
/// The same in words, for those who read a tree; empty: nowhere.
[[nodiscard]] std::string zero_byte_fault(std::string_view json);

/// The last key on a path, for messages.
[[nodiscard]] std::string_view last_key(std::string_view path);

}  // namespace selvage::io
