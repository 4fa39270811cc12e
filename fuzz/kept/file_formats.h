// Every parser that reads what others wrote, behind one face: the file campaign and the libFuzzer harnesses share it.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace selvage::fuzz {

enum class ParseResult : std::uint8_t {
  kAccepted,
  kRefused,  ///< by the parser's own error: the right answer to a damaged file
  kUnsound,  ///< accepted, but an index is out of range or a coordinate is not finite
};

struct FileFormat {
  std::string_view name;
  std::vector<std::string> samples;  ///< small valid files to start from
  /// Anything but the parser's own error passes through: it is a defect.
  ParseResult (*parse)(std::string_view bytes);
};

[[nodiscard]] const std::vector<FileFormat>& file_formats();

}  // namespace selvage::fuzz
