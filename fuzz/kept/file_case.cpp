#include "fuzz/kept/file_case.h"

#include <algorithm>

#include "fuzz/kept/file_formats.h"

namespace selvage::fuzz {
namespace {

std::vector<FileFormat>::const_iterator format_named(std::string_view name) {
  return std::ranges::find(file_formats(), name, &FileFormat::name);
}

bool is_format(const std::string& name) { return format_named(name) != file_formats().end(); }

Retrial retry_file(const ByteCase& kept) {
  const std::string bytes = std::to_string(kept.bytes.size()) + " bytes of " + kept.value;
  switch (format_named(kept.value)->parse(kept.bytes)) {
    case ParseResult::kAccepted:
      return {{}, {bytes + " are accepted, and what was read is sound"}, {}};
    case ParseResult::kRefused:
      return {{}, {bytes + " are refused by the parser's own error"}, {}};
    case ParseResult::kUnsound:
      break;
  }
  return {"unsound", {bytes + " are accepted, with an index out of range or a number that is not finite"}, {}};
}

}  // namespace

const ByteKind& file_kind() {
  static const ByteKind kind{"file", "every parser refuses damaged files or reads what is sound; it never crashes",
                             "format", is_format, retry_file};
  return kind;
}

ByteCase file_case(std::string_view format, std::string bytes) {
  return {&file_kind(), std::string(format), std::move(bytes)};
}

}  // namespace selvage::fuzz
