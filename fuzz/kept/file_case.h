// A damaged file as a case: a format and bytes.
#pragma once

#include "fuzz/kept/byte_case.h"

namespace selvage::fuzz {

[[nodiscard]] const ByteKind& file_kind();
[[nodiscard]] ByteCase file_case(std::string_view format, std::string bytes);

}  // namespace selvage::fuzz
