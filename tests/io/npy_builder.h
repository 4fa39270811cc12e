// .npy files byte by byte, honest or not.
#pragma once

#include <bit>
#include <cstdint>
#include <initializer_list>
#include <string>

#include "io/file/byte_order.h"
#include "io/mesh_data.h"

namespace selvage::testing {

/// A file as numpy lays it out, from its dictionary and data.
inline std::string npy(const std::string& dictionary, const std::string& data, char version = 1) {
  std::string bytes = "\x93NUMPY";
  bytes += version;
  bytes += '\0';
  const std::string text = dictionary + "\n";
  if (version == 1) {
    io::append(bytes, static_cast<std::uint16_t>(text.size()), std::endian::little);
  } else {
    io::append(bytes, static_cast<std::uint32_t>(text.size()), std::endian::little);
  }
  return bytes + text + data;
}

inline std::string dictionary(const std::string& descr, const std::string& shape, bool fortran = false) {
  return "{'descr': '" + descr + "', 'fortran_order': " + (fortran ? "True" : "False") + ", 'shape': " + shape + ", }";
}

template <typename T>
std::string numbers(std::initializer_list<int> values, std::endian order = std::endian::little) {
  std::string bytes;
  for (const int value : values) io::append(bytes, static_cast<T>(value), order);
  return bytes;
}

inline std::string doubles(const io::Points& points) {
  std::string bytes;
  for (const auto& point : points) {
    for (const double x : point) io::append(bytes, x, std::endian::little);
  }
  return bytes;
}

}  // namespace selvage::testing
