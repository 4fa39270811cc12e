// The header of .npy: magic, version, length, and a Python dictionary of three known keys.
#include <algorithm>
#include <limits>
#include <optional>

#include "io/fail.h"
#include "io/file/byte_order.h"
#include "io/file/text.h"
#include "io/format/npy.h"

namespace selvage::io {
namespace {

constexpr std::string_view kMagic = "\x93NUMPY";

/// Reads just enough of Python's literals; anything else is refused.
class DictionaryReader {
 public:
  DictionaryReader(std::string_view text, const std::string& name) : rest_(text), name_(name) {}

  void read(NpyHeader& header) {
    bool has_type = false, has_order = false, has_shape = false;
    expect('{');
    while (!accept('}')) {
      const std::string_view key = string();
      expect(':');
      if (key == "descr" && !has_type) {
        read_type(header);
        has_type = true;
      } else if (key == "fortran_order" && !has_order) {
        header.fortran_order = boolean();
        has_order = true;
      } else if (key == "shape" && !has_shape) {
        header.shape = tuple();
        has_shape = true;
      } else {
        fail();
      }
      if (!accept(',')) {
        expect('}');
        break;
      }
    }
    skip_blanks();
    if (!has_type || !has_order || !has_shape || !rest_.empty()) fail();
  }

 private:
  void read_type(NpyHeader& header) {
    skip_blanks();
    if (!rest_.starts_with('\'') && !rest_.starts_with('"')) unsupported("a record");
    const std::string_view descr = string();
    if (descr.size() != 3) unsupported(descr);
    header.order = descr[0] == '>' ? std::endian::big : std::endian::little;
    header.kind = descr[1] == 'f' ? NpyKind::kFloat : descr[1] == 'u' ? NpyKind::kUnsigned : NpyKind::kSigned;
    header.item_size = static_cast<std::size_t>(descr[2] - '0');
    constexpr std::string_view kKnown[] = {"f4", "f8", "i1", "i2", "i4", "i8", "u1", "u2", "u4", "u8"};
    const bool has_known_order = descr[0] == '<' || descr[0] == '>' || (descr[0] == '|' && descr[2] == '1');
    if (!has_known_order || std::find(std::begin(kKnown), std::end(kKnown), descr.substr(1)) == std::end(kKnown)) {
      unsupported(descr);
    }
  }

  std::vector<std::uint64_t> tuple() {
    std::vector<std::uint64_t> values;
    expect('(');
    while (!accept(')')) {
      const std::size_t length = std::min(rest_.find_first_not_of("0123456789"), rest_.size());
      const std::optional<std::int64_t> value = parse_integer(rest_.substr(0, length));
      if (!value || values.size() == kMaxDimensions) fail();
      values.push_back(static_cast<std::uint64_t>(*value));
      rest_.remove_prefix(length);
      if (!accept(',')) {
        expect(')');
        break;
      }
      skip_blanks();
    }
    return values;
  }

  bool boolean() {
    skip_blanks();
    for (const bool value : {false, true}) {
      const std::string_view word = value ? "True" : "False";
      if (!rest_.starts_with(word)) continue;
      rest_.remove_prefix(word.size());
      return value;
    }
    fail();
  }

  std::string_view string() {
    skip_blanks();
    if (rest_.empty() || (rest_[0] != '\'' && rest_[0] != '"')) fail();
    const std::size_t end = rest_.find(rest_[0], 1);
    if (end == rest_.npos) fail();
    const std::string_view text = rest_.substr(1, end - 1);
    rest_.remove_prefix(end + 1);
    return text;
  }

  bool accept(char c) {
    skip_blanks();
    if (!rest_.starts_with(c)) return false;
    rest_.remove_prefix(1);
    return true;
  }
  void expect(char c) {
    if (!accept(c)) fail();
  }
  void skip_blanks() { rest_.remove_prefix(std::min(rest_.find_first_not_of(" \n"), rest_.size())); }

  [[noreturn]] void fail() const { bad_input(name_, "the .npy header is malformed; write the file with numpy.save"); }
  [[noreturn]] void unsupported(std::string_view descr) const {
    bad_input(name_, "the array's type " + in_quotes(descr) + " is not supported; save float64, float32 or int32");
  }

  static constexpr std::size_t kMaxDimensions = 8;
  std::string_view rest_;
  const std::string& name_;
};

}  // namespace

NpyHeader parse_npy_header(std::string_view start, const std::string& name) {
  if (!start.starts_with(kMagic)) bad_input(name, "no .npy magic at byte 0; is this a NumPy file?");
  const auto truncated = [&] { bad_input(name, "the .npy header is cut short; copy the file again"); };
  if (start.size() < 10) truncated();
  const int version = start[6];
  if (version < 1 || version > 3 || start[7] != 0) {
    bad_input(name,
              ".npy version " + std::to_string(version) + " is not known; save it with a NumPy that writes 1 to 3");
  }
  const std::size_t length_size = version == 1 ? 2 : 4;
  if (start.size() < 8 + length_size) truncated();
  const std::size_t length = version == 1 ? load<std::uint16_t>(start.data() + 8, std::endian::little)
                                          : load<std::uint32_t>(start.data() + 8, std::endian::little);
  NpyHeader header;
  header.data_offset = 8 + length_size + length;
  if (header.data_offset > kLongestNpyHeader) {
    bad_input(name,
              "the .npy header is longer than " + std::to_string(kLongestNpyHeader) + " bytes; save a plain array");
  }
  if (start.size() < header.data_offset) truncated();
  DictionaryReader(start.substr(8 + length_size, length), name).read(header);

  header.data_size = header.item_size;
  for (const std::uint64_t extent : header.shape) {
    if (extent != 0 && header.data_size > std::numeric_limits<std::uint64_t>::max() / extent) {
      bad_input(name, "the shape is larger than any file; correct the header");
    }
    header.data_size *= extent;
  }
  return header;
}

}  // namespace selvage::io
