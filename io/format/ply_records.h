// The data of a PLY file as a stream of values, the same calls for text and for binary.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "io/file/byte_order.h"
#include "io/file/text.h"
#include "io/format/ply_header.h"

namespace selvage::io {

/// Values written as text, one record a line. All functions throw Error with the line. A copy looks ahead.
class AsciiRecords {
 public:
  explicit AsciiRecords(const LineReader& lines) : lines_(lines) {}

  void begin_record();
  void end_record() const;
  /// Nothing but blank lines may follow.
  void end_data();

  /// The next value; finite. Text of a float is rounded once, to float.
  double real(PlyType type);
  std::int64_t integer(PlyType type);
  void skip(PlyType type, std::int64_t count);
  /// Whether the text ends with the last value's last digit: there may have been more digits.
  [[nodiscard]] bool may_be_cut() const { return record_.data() == lines_.rest().data(); }
  /// Most items that a list of this record can still have.
  [[nodiscard]] std::size_t most_items(PlyType) const { return record_.size(); }

  [[noreturn]] void fail(std::string_view what) const { lines_.fail(what); }

 private:
  std::string_view next_value();

  LineReader lines_;
  std::string_view record_;
};

/// Values in binary, without separators. All functions throw Error with the byte. A copy looks ahead.
class BinaryRecords {
 public:
  BinaryRecords(std::string_view bytes, std::size_t offset, std::string_view name, std::endian order)
      : bytes_(bytes), offset_(offset), name_(name), order_(order) {}

  void begin_record() {}
  void end_record() {}
  void end_data() const;

  double real(PlyType type);
  std::int64_t integer(PlyType type);
  void skip(PlyType type, std::int64_t count);
  [[nodiscard]] bool may_be_cut() const { return false; }
  [[nodiscard]] std::size_t most_items(PlyType type) const { return (bytes_.size() - offset_) / size_of(type); }

  [[noreturn]] void fail(std::string_view what) const;

 private:
  template <typename T>
  T take() {
    require(sizeof(T));
    const T value = load<T>(bytes_.data() + offset_, order_);
    offset_ += sizeof(T);
    return value;
  }
  void require(std::uint64_t count) const;

  std::string_view bytes_;
  std::size_t offset_;
  std::string_view name_;
  std::endian order_;
};

}  // namespace selvage::io
