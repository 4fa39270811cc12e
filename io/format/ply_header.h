// The header of a PLY file, always text.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/file/text.h"

namespace selvage::io {

enum class PlyFormat { kAscii, kLittleEndian, kBigEndian };
enum class PlyType : std::uint8_t { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat32, kFloat64 };

[[nodiscard]] constexpr std::size_t size_of(PlyType type) {
  constexpr std::size_t kSizes[] = {1, 1, 2, 2, 4, 4, 4, 8};
  return kSizes[static_cast<std::size_t>(type)];
}
[[nodiscard]] constexpr bool is_integer(PlyType type) { return type < PlyType::kFloat32; }

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::kFloat32;   ///< of the value, or of the items of a list
  std::optional<PlyType> list_count;  ///< there for a list; an integer type
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;  ///< what the header claims; at most kMaxElements, and what the bytes behind it can hold
  std::vector<PlyProperty> properties;  ///< at least one, names unique
  std::size_t line = 0;

  /// Position of the property with one of these names.
  [[nodiscard]] std::optional<std::size_t> find(std::initializer_list<std::string_view> names) const;
};

struct PlyHeader {
  PlyFormat format = PlyFormat::kAscii;
  std::vector<PlyElement> elements;
};

/// Reads up to and including "end_header"; lines.rest() is then the data. Throws Error: anything malformed, or counts
/// that the remaining bytes cannot hold.
[[nodiscard]] PlyHeader parse_ply_header(LineReader& lines);

}  // namespace selvage::io
