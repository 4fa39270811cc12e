// Mesh sequences written frame by frame in the formats of docs/formats.md, whole or not at all.
#pragma once

#include <cstddef>
#include <filesystem>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "io/error.h"
#include "io/sequence.h"

namespace selvage::io {

enum class OutputFormat { kFolder, kNpz, kObj, kPc2, kPvd };

/// By extension: .npz, .obj, .pc2, .pvd; a folder where there is none or the name ends in a slash. Throws
/// Error(kBadInput): another one, or no name before it.
[[nodiscard]] OutputFormat output_format(const std::filesystem::path& target);

/// The mesh that a .pc2 of this name moves, which is written beside it as OBJ.
[[nodiscard]] std::filesystem::path base_beside(const std::filesystem::path& cache);

/// What the format keeps of a sequence besides positions and faces.
struct OutputTraits {
  const char* name;
  bool is_float32;    ///< stores float32 whatever the input; otherwise every double is kept
  bool changes_mesh;  ///< faces and number of vertices may change from frame to frame
  bool keeps_times, keeps_kind, keeps_roles, keeps_group_names;
  bool is_read;  ///< open_sequence() reads it
};
[[nodiscard]] const OutputTraits& traits(OutputFormat format);

/// What is known of the whole sequence before its first frame.
struct OutputHeader {
  SequenceHeader sequence;       ///< faces and groups of the first frame, precision of all
  std::size_t vertex_count = 0;  ///< of the first frame
  std::size_t frame_count = 0;
};

/// One sequence on its way to disk. What was written is removed again unless finish() returns; a kill may leave the
/// frames of an OBJ or VTP sequence, a folder without a header, which is no sequence, or temporary files, never half a
/// file. A file that others make meanwhile stays: finish() or append() throws Error(kFile) then.
class SequenceOutput {
 public:
  virtual ~SequenceOutput() = default;
  SequenceOutput(const SequenceOutput&) = delete;
  SequenceOutput& operator=(const SequenceOutput&) = delete;

  /// Frames come in order, as many as the header announces. Throws Error(kBadInput): one too many, a time that does not
  /// increase, a value that is not finite, or no float32 where the format stores these (they are never rounded here),
  /// faces or groups of what does not exist, another mesh or other groups than those of the first where the format has
  /// one. Nothing has changed then, and another frame may take its place. Any failure of the file system is
  /// Error(kFile), after which both calls throw that: a file may hold half a frame.
  void append(double time_s, const MeshData& mesh);
  /// On disk, under its own name, when it returns, and then it is at its end: both calls throw Error(kBadInput). Throws
  /// Error(kBadInput) where frames are missing, which may follow, and Error(kFile) as append() does.
  void finish();
  /// What to give to open_sequence(), after finish().
  [[nodiscard]] virtual std::vector<std::filesystem::path> sources() const = 0;

 protected:
  SequenceOutput(std::filesystem::path target, OutputHeader header)
      : target_(std::move(target)), header_(std::move(header)) {}
  [[nodiscard]] const std::filesystem::path& target() const { return target_; }
  [[nodiscard]] const OutputHeader& header() const { return header_; }
  /// Those that were written.
  [[nodiscard]] std::size_t frame_count() const { return frame_count_; }

 private:
  /// Throws Error(kBadInput) before it writes anything.
  virtual void write_frame(double time_s, const MeshData& mesh) = 0;
  virtual void commit() = 0;

  enum class State { kOpen, kFinished, kFailed };
  void require_open() const;

  std::filesystem::path target_;
  OutputHeader header_;
  std::size_t frame_count_ = 0;
  double last_time_s_ = -std::numeric_limits<double>::infinity();
  State state_ = State::kOpen;
};

/// Writes to `target`: the file; for OBJ with several frames cloth_000000.obj, ... in place of cloth.obj; for PC2 also
/// the base mesh cloth.obj beside cloth.pc2; for PVD also cloth_000000.vtp, ... Throws Error(kFile) if one of these is
/// there already, or a folder that is not empty; kBadInput where there is no face, faces name vertices, or groups
/// faces, that do not exist, or a face is in a cloth and in a body.
[[nodiscard]] std::unique_ptr<SequenceOutput> create_output(const std::filesystem::path& target, OutputHeader header);

}  // namespace selvage::io
