// Writes .npy version 1.0, C order, little endian, the data aligned to 64 bytes as numpy does.
#include "io/file/byte_order.h"
#include "io/format/npy.h"
#include "io/points.h"

namespace selvage::io {

std::string npy_start(std::string_view type, const std::vector<std::uint64_t>& shape) {
  std::string extents;
  for (const std::uint64_t extent : shape) extents += (extents.empty() ? "" : ", ") + std::to_string(extent);
  if (shape.size() == 1) extents += ",";  // Python's tuple of one
  std::string dictionary =
      "{'descr': '" + std::string(type) + "', 'fortran_order': False, 'shape': (" + extents + "), }";
  constexpr std::size_t kPrefix = 10, kAlignment = 64;  // magic, version and length; numpy aligns for memory mapping
  const std::size_t length = (kPrefix + dictionary.size() + 1 + kAlignment - 1) / kAlignment * kAlignment - kPrefix;
  dictionary.resize(length - 1, ' ');
  std::string bytes("\x93NUMPY\x01\x00", 8);
  append(bytes, static_cast<std::uint16_t>(length), std::endian::little);
  return bytes + dictionary + '\n';
}

std::string_view npy_type(Precision precision) { return precision == Precision::kFloat32 ? "<f4" : "<f8"; }

std::string npy_bytes(const Points& points, Precision precision, const std::string& name) {
  std::string bytes = npy_start(npy_type(precision), {points.size(), 3});
  append_points(bytes, points, precision, name);
  return bytes;
}

std::string npy_bytes(const Triangles& triangles) {
  std::string bytes = npy_start("<i4", {triangles.size(), 3});
  bytes.reserve(bytes.size() + triangles.size() * 3 * sizeof(std::int32_t));
  for (const auto& corners : triangles) {
    for (const std::int32_t corner : corners) append(bytes, corner, std::endian::little);
  }
  return bytes;
}

}  // namespace selvage::io
