// NumPy's .npy: arrays of numbers with a short text header, in the shapes that meshes need.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "io/error.h"
#include "io/mesh_data.h"

namespace selvage::io {

enum class NpyKind : std::uint8_t { kFloat, kSigned, kUnsigned };

/// Read: float32, float64 and all integers of 1 to 8 bytes, both byte orders, format versions 1 to 3.
struct NpyHeader {
  NpyKind kind = NpyKind::kFloat;
  std::size_t item_size = 8;
  std::endian order = std::endian::little;
  bool fortran_order = false;
  std::vector<std::uint64_t> shape;
  std::size_t data_offset = 0;
  std::uint64_t data_size = 0;  ///< bytes of the array: the product of the shape and item_size, without overflow
};

/// Longest header that is read; numpy itself writes 118 bytes for any array of up to 9 dimensions.
inline constexpr std::size_t kLongestNpyHeader = 4096;

/// `start`: the file, or at least its first kLongestNpyHeader bytes. Throws Error. The caller compares data_offset +
/// data_size with the size of the file before it believes the shape.
[[nodiscard]] NpyHeader parse_npy_header(std::string_view start, const std::string& name);

struct NpyPoints {
  Points points;
  Precision precision = Precision::kFloat64;
};

/// A whole file: float, #V by 3, all finite; C or Fortran order. Throws Error.
[[nodiscard]] NpyPoints parse_npy_points(std::string_view bytes, const std::string& name);
/// A whole file: integers, #F by 3, each in [0, 2^31), the corners of a face distinct; C or Fortran order. Throws
/// Error.
[[nodiscard]] Triangles parse_npy_triangles(std::string_view bytes, const std::string& name);
/// A whole file: integers, one dimension. Throws Error.
[[nodiscard]] std::vector<std::int64_t> parse_npy_integers(std::string_view bytes, const std::string& name);

/// `count` points from C-ordered `data` of the header's type. Throws Error where one is not finite.
[[nodiscard]] Points decode_npy_points(const NpyHeader& header, std::string_view data, const std::string& name);

/// What precedes the data of an array in C order, `type` being numpy's word for it ("<f8").
[[nodiscard]] std::string npy_start(std::string_view type, const std::vector<std::uint64_t>& shape);
[[nodiscard]] std::string_view npy_type(Precision precision);
/// float64, or float32 where `precision` says so; throws Error(kBadInput) where a value is not exactly a float32.
[[nodiscard]] std::string npy_bytes(const Points& points, Precision precision, const std::string& name);
/// int32.
[[nodiscard]] std::string npy_bytes(const Triangles& triangles);

}  // namespace selvage::io
