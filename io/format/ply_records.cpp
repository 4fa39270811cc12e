#include "io/format/ply_records.h"

#include <cmath>
#include <optional>
#include <string>

#include "io/fail.h"

namespace selvage::io {

void AsciiRecords::begin_record() {
  do {
    const std::optional<std::string_view> line = lines_.next();
    if (!line) fail("records are missing; the file is cut short");
    record_ = trimmed(*line);
  } while (record_.empty());
}

void AsciiRecords::end_record() const {
  if (!trimmed(record_).empty()) fail("the record has more values than properties; correct it");
}

void AsciiRecords::end_data() {
  while (const std::optional<std::string_view> line = lines_.next()) {
    if (!trimmed(*line).empty()) fail("more records than the header announces; correct the count");
  }
}

double AsciiRecords::real(PlyType type) {
  if (is_integer(type)) return static_cast<double>(integer(type));
  const std::string_view token = next_value();
  double value = 0;
  float single = 0;
  const NumberFault fault = type == PlyType::kFloat32 ? parse_number(token, single) : parse_number(token, value);
  if (fault != NumberFault::kNone) fail(describe(fault, token));
  return type == PlyType::kFloat32 ? static_cast<double>(single) : value;
}

std::int64_t AsciiRecords::integer(PlyType type) {
  const std::string_view token = next_value();
  const std::optional<std::int64_t> value = parse_integer(token);
  const unsigned bits = static_cast<unsigned>(8 * size_of(type));
  const bool is_signed = type == PlyType::kInt8 || type == PlyType::kInt16 || type == PlyType::kInt32;
  const std::int64_t high = (std::int64_t{1} << (is_signed ? bits - 1 : bits)) - 1;
  const std::int64_t low = is_signed ? -high - 1 : 0;
  if (!value || *value < low || *value > high) fail(in_quotes(token) + " is no integer of its type; correct it");
  return *value;
}

void AsciiRecords::skip(PlyType, std::int64_t count) {
  for (std::int64_t i = 0; i < count; ++i) next_value();
}

std::string_view AsciiRecords::next_value() {
  const std::string_view token = next_token(record_);
  if (token.empty()) fail("the record has fewer values than properties; correct it");
  return token;
}

void BinaryRecords::end_data() const {
  if (offset_ != bytes_.size()) fail("bytes follow the last record; correct the counts");
}

double BinaryRecords::real(PlyType type) {
  if (is_integer(type)) return static_cast<double>(integer(type));
  const double value = type == PlyType::kFloat32 ? static_cast<double>(take<float>()) : take<double>();
  if (!std::isfinite(value)) fail("a coordinate is not finite; repair the export");
  return value;
}

std::int64_t BinaryRecords::integer(PlyType type) {
  switch (type) {
    case PlyType::kInt8:
      return take<std::int8_t>();
    case PlyType::kUint8:
      return take<std::uint8_t>();
    case PlyType::kInt16:
      return take<std::int16_t>();
    case PlyType::kUint16:
      return take<std::uint16_t>();
    case PlyType::kInt32:
      return take<std::int32_t>();
    default:
      return take<std::uint32_t>();
  }
}

void BinaryRecords::skip(PlyType type, std::int64_t count) {
  const auto needed = static_cast<std::uint64_t>(count) * size_of(type);  // below 2^32 times 8
  require(needed);
  offset_ += needed;
}

void BinaryRecords::fail(std::string_view what) const { bad_input_at_byte(name_, offset_, what); }

void BinaryRecords::require(std::uint64_t count) const {
  if (count > bytes_.size() - offset_) fail("records are missing; the file is cut short");
}

}  // namespace selvage::io
