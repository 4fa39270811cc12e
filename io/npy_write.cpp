// Writes .npy version 1.0, C order, little endian, the data aligned to 64 bytes as numpy does.
#include <limits>

#include "io/byte_order.h"
#include "io/fail.h"
#include "io/npy.h"

namespace selvage::io {
namespace {

std::string npy_start(std::string_view type, std::size_t rows) {
  std::string dictionary =
      "{'descr': '" + std::string(type) + "', 'fortran_order': False, 'shape': (" + std::to_string(rows) + ", 3), }";
  constexpr std::size_t kPrefix = 10, kAlignment = 64;  // magic, version and length; numpy aligns for memory mapping
  const std::size_t length = (kPrefix + dictionary.size() + 1 + kAlignment - 1) / kAlignment * kAlignment - kPrefix;
  dictionary.resize(length - 1, ' ');
  std::string bytes("\x93NUMPY\x01\x00", 8);
  append(bytes, static_cast<std::uint16_t>(length), std::endian::little);
  return bytes + dictionary + '\n';
}

template <typename Item, typename Rows>
std::string rows_of_three(std::string_view type, const Rows& rows) {
  std::string bytes = npy_start(type, rows.size());
  bytes.reserve(bytes.size() + rows.size() * 3 * sizeof(Item));
  for (const auto& row : rows) {
    for (const auto value : row) append(bytes, static_cast<Item>(value), std::endian::little);
  }
  return bytes;
}

}  // namespace

std::string npy_bytes(const Points& points, Precision precision, const std::string& name) {
  if (precision == Precision::kFloat64) return rows_of_three<double>("<f8", points);
  for (std::size_t row = 0; row < points.size(); ++row) {
    for (const double value : points[row]) {
      const bool fits = std::abs(value) <= static_cast<double>(std::numeric_limits<float>::max());
      if (!fits || static_cast<double>(static_cast<float>(value)) != value) {
        bad_input(name, "vertex " + std::to_string(row) + " is not on the float32 lattice; record float64");
      }
    }
  }
  return rows_of_three<float>("<f4", points);
}

std::string npy_bytes(const Triangles& triangles) { return rows_of_three<std::int32_t>("<i4", triangles); }

}  // namespace selvage::io
