#include "io/format/npy.h"

#include <cmath>
#include <limits>

#include "io/fail.h"
#include "io/file/byte_order.h"
#include "io/file/fp_guard.h"
#include "io/format/polygon.h"

namespace selvage::io {
namespace {

double load_real(const NpyHeader& header, const char* item) {
  return header.item_size == 4 ? static_cast<double>(load<float>(item, header.order))
                               : load<double>(item, header.order);
}

/// Any integer type; uint64 beyond int64 becomes the largest int64, which no index and no group number is.
std::int64_t load_integer(const NpyHeader& header, const char* item) {
  const bool is_signed = header.kind == NpyKind::kSigned;
  switch (header.item_size) {
    case 1:
      return is_signed ? load<std::int8_t>(item, header.order) : load<std::uint8_t>(item, header.order);
    case 2:
      return is_signed ? load<std::int16_t>(item, header.order) : load<std::uint16_t>(item, header.order);
    case 4:
      return is_signed ? std::int64_t{load<std::int32_t>(item, header.order)} : load<std::uint32_t>(item, header.order);
    default: {
      if (is_signed) return load<std::int64_t>(item, header.order);
      constexpr auto kLargest = static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max());
      return static_cast<std::int64_t>(std::min(load<std::uint64_t>(item, header.order), kLargest));
    }
  }
}

/// As the file holds it.
std::string integer_text(const NpyHeader& header, const char* item) {
  const bool may_be_larger = header.kind == NpyKind::kUnsigned && header.item_size == 8;
  return may_be_larger ? std::to_string(load<std::uint64_t>(item, header.order))
                       : std::to_string(load_integer(header, item));
}

std::string shape_text(const NpyHeader& header) {
  std::string text;
  for (const std::uint64_t extent : header.shape) text += (text.empty() ? "" : " by ") + std::to_string(extent);
  return text.empty() ? "a single number" : text;
}

/// Header of a whole file whose size is exactly what the header says.
NpyHeader whole_file_header(std::string_view bytes, const std::string& name) {
  NpyHeader header = parse_npy_header(bytes.substr(0, kLongestNpyHeader), name);
  const std::uint64_t present = bytes.size() - header.data_offset;
  if (present != header.data_size) {
    bad_input(name, "the header announces " + std::to_string(header.data_size) + " bytes of data, " +
                        std::to_string(present) + " follow; write the file again");
  }
  return header;
}

void require_rows_of_three(const NpyHeader& header, const std::string& name) {
  if (header.shape.size() == 2 && header.shape[1] == 3 && header.shape[0] <= kMaxElements) return;
  bad_input(name, "the shape is " + shape_text(header) +
                      ", not n by 3; write rows of three, "
                      "positions or corners: split polygons into triangles, and leave out what a row has besides");
}

/// Where item (row, column) of an n-by-3 array lies.
const char* item_at(const NpyHeader& header, const char* data, std::size_t row, std::size_t column) {
  const std::size_t index = header.fortran_order ? column * header.shape[0] + row : row * 3 + column;
  return data + index * header.item_size;
}

}  // namespace

Points decode_npy_points(const NpyHeader& header, std::string_view data, const std::string& name) {
  const FpGuard guard;
  NpyHeader rows = header;
  rows.shape = {data.size() / (3 * header.item_size), 3};
  Points points(rows.shape[0]);
  for (std::size_t row = 0; row < points.size(); ++row) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      points[row][axis] = load_real(rows, item_at(rows, data.data(), row, axis));
      if (!std::isfinite(points[row][axis])) {
        bad_input(name, "vertex " + std::to_string(row) + " is not finite; repair the export");
      }
    }
  }
  return points;
}

NpyPoints parse_npy_points(std::string_view bytes, const std::string& name) {
  const NpyHeader header = whole_file_header(bytes, name);
  if (header.kind != NpyKind::kFloat) bad_input(name, "positions are integers; save them as float64");
  require_rows_of_three(header, name);
  return {decode_npy_points(header, bytes.substr(header.data_offset), name),
          header.item_size == 4 ? Precision::kFloat32 : Precision::kFloat64};
}

Triangles parse_npy_triangles(std::string_view bytes, const std::string& name) {
  const NpyHeader header = whole_file_header(bytes, name);
  if (header.kind == NpyKind::kFloat) bad_input(name, "faces are not integers; save them as int32");
  require_rows_of_three(header, name);
  const char* data = bytes.data() + header.data_offset;
  Triangles triangles(header.shape[0]);
  for (std::size_t row = 0; row < triangles.size(); ++row) {
    auto& corners = triangles[row];
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const char* item = item_at(header, data, row, corner);
      const std::int64_t index = load_integer(header, item);
      if (index < 0 || index > static_cast<std::int64_t>(kMaxElements)) {
        bad_input(name, "face " + std::to_string(row) + " names vertex " + integer_text(header, item) + "; correct it");
      }
      corners[corner] = static_cast<std::int32_t>(index);
    }
    if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0]) {
      bad_input(name, "face " + std::to_string(row) + " names the same vertex twice; remove the face");
    }
  }
  return triangles;
}

std::vector<std::int64_t> parse_npy_integers(std::string_view bytes, const std::string& name) {
  const NpyHeader header = whole_file_header(bytes, name);
  if (header.kind == NpyKind::kFloat || header.shape.size() != 1) {
    bad_input(name, "not a list of integers; save one int32 array of one dimension");
  }
  std::vector<std::int64_t> values(header.shape[0]);
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = load_integer(header, bytes.data() + header.data_offset + i * header.item_size);
  }
  return values;
}

}  // namespace selvage::io
