// A sequence that was just written, opened again and held against what was to be written.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "io/sequence.h"

namespace selvage::cli {

/// Remembers a frame in four bytes.
[[nodiscard]] std::uint32_t checksum(const io::Points& points);

/// What of the input is not in the file, and yet decides what is to be checked.
struct Claims {
  io::SequenceKind kind = io::SequenceKind::kFrames;
  bool keeps_groups = true;       ///< false: `groups` take the place of those in the file
  std::vector<io::Group> groups;  ///< which faces are bodies
};

/// `written` with the claims of the input. Its frame() throws io::Error where the positions are not, bit for bit, those
/// of `checksums`: a disk or a writer that cannot be trusted.
[[nodiscard]] std::unique_ptr<io::SequenceReader> read_back(std::unique_ptr<io::SequenceReader> written, Claims claims,
                                                            std::vector<std::uint32_t> checksums);

}  // namespace selvage::cli
