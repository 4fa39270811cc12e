// The two text files of a sequence folder (docs/formats.md): sequence.json, written once, and frames.jsonl, which grows
// by one line a frame. One list in one file rewritten after each frame would cost O(n^2) bytes over a run.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/error.h"
#include "io/sequence.h"

namespace selvage::io {

/// Bytes of sequence.json: some 100,000 groups.
inline constexpr std::size_t kLargestHeader = std::size_t{1} << 24;

inline constexpr std::string_view kHeaderFile = "sequence.json";
inline constexpr std::string_view kFacesFile = "faces.npy";
inline constexpr std::string_view kFramesFile = "frames.jsonl";

/// sequence.json: all of SequenceHeader but the triangles, which are in `faces_file`.
struct SequenceDescription {
  std::string producer;
  SequenceKind kind = SequenceKind::kFrames;
  Precision precision = Precision::kFloat64;
  std::vector<Group> groups;  ///< each 0 <= begin <= end; the caller compares with the number of faces
  std::string faces_file;     ///< a plain name
  std::optional<std::uint32_t> faces_crc32;
};

/// One line of frames.jsonl.
struct FrameRecord {
  std::string file;  ///< a plain name
  double time_s = 0;
  std::optional<std::uint32_t> crc32;  ///< of the whole file
};

[[nodiscard]] std::string to_json(const SequenceDescription& description);
/// One line, with its end.
[[nodiscard]] std::string to_json(const FrameRecord& frame);

/// Throws Error: bad JSON, wrong schema, unknown or missing keys, file names that leave the folder.
[[nodiscard]] SequenceDescription parse_sequence_json(std::string_view bytes, const std::string& name);
/// Throws Error likewise, and where times do not increase. A last line without its end is what a killed run may leave:
/// it is not part of the list, whatever it holds.
[[nodiscard]] std::vector<FrameRecord> parse_frame_list(std::string_view bytes, const std::string& name);

}  // namespace selvage::io
