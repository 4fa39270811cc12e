// Mesh sequences: the folder format of docs/formats.md, .npz, or a list of single meshes, behind one reader.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "io/error.h"
#include "io/mesh_data.h"

namespace selvage::io {

/// kSteps: the straight motion between consecutive frames is what was simulated and is to be certified.
/// kFrames: samples of a motion; nothing is claimed about what lies between them.
enum class SequenceKind { kFrames, kSteps };

/// A sequence of frames that are read on demand; frame() may be called from several threads.
class SequenceReader {
 public:
  virtual ~SequenceReader() = default;
  [[nodiscard]] virtual std::size_t frame_count() const = 0;
  [[nodiscard]] virtual SequenceKind kind() const = 0;
  [[nodiscard]] virtual Precision precision() const = 0;
  /// Of the first frame, where faces may change: frame(i).groups are those of frame i.
  [[nodiscard]] virtual const std::vector<Group>& groups() const = 0;
  /// A name a person can find again: the file of frame i, or "FILE[i]".
  [[nodiscard]] virtual std::string frame_name(std::size_t frame) const = 0;
  /// Time of frame i in seconds; in frames for PC2, which counts these; i where the source has no times.
  [[nodiscard]] virtual double time(std::size_t frame) const = 0;
  /// Whether times count frames although they need not look so, as those of PC2, which may begin anywhere.
  [[nodiscard]] virtual bool counts_frames() const = 0;
  /// Whether the faces of this frame are those of the previous one (always true where the format has one face list).
  /// True for frame 0.
  [[nodiscard]] virtual bool same_faces_as_previous(std::size_t frame) const = 0;
  /// Throws Error, and std::out_of_range where there is no such frame. Checks shape, finiteness and, where the format
  /// has hashes, the hash.
  [[nodiscard]] virtual MeshData frame(std::size_t frame) const = 0;
  /// What is there and is no part of it, or what was changed, as a sentence; nothing where there is none.
  [[nodiscard]] virtual std::string remark() const { return {}; }
  /// Faces of its files with more corners than three, which became several triangles each; of all files.
  [[nodiscard]] virtual std::int64_t split_polygons() const { return 0; }
};

/// One folder, one .npz, one .pc2 or .mdd, or one or more mesh files in the given order. `base` is the mesh that a
/// point cache moves; empty: the .obj or .ply of the same name beside it. Throws Error.
[[nodiscard]] std::unique_ptr<SequenceReader> open_sequence(const std::vector<std::filesystem::path>& sources,
                                                            const std::filesystem::path& base = {});

/// Whether the times are in seconds, as far as one can tell: not those of a PC2, nor whole numbers one after the other,
/// which count frames from some frame on. O(frames).
[[nodiscard]] bool has_times(const SequenceReader& sequence);

/// The files that open_sequence() reads. Throws Error where a header cannot be read.
[[nodiscard]] std::vector<std::filesystem::path> sequence_files(const std::vector<std::filesystem::path>& sources,
                                                                const std::filesystem::path& base = {});

struct SequenceHeader {
  Triangles triangles;
  std::vector<Group> groups;
  SequenceKind kind = SequenceKind::kFrames;
  Precision precision = Precision::kFloat64;
  std::string producer;  ///< program and version
};

/// When a new folder gets its header, without which it is no sequence: before its first frame, so that a killed run is
/// a shorter sequence, or when write_header() is called.
enum class HeaderTime { kFirst, kLast };

/// Writes the folder format (docs/formats.md). A frame appears by atomic rename and is listed, by one line appended to
/// frames.jsonl, when it is on disk: a killed run leaves a valid, shorter sequence, if it had a header. O(frame) work
/// and three fsyncs a frame, however many there are. A failed call throws Error, what was listed stays listed, and the
/// next call may work.
class SequenceWriter {
 public:
  /// Creates the folder. Throws Error if another process writes to it, or if it holds a sequence already, unless
  /// `resume`, which then continues behind the frames it lists, and checks that header and faces are the same and that
  /// these frames are there with their checksums; nothing in the folder changes before the first append() or
  /// truncate().
  SequenceWriter(std::filesystem::path folder, const SequenceHeader& header, bool resume = false,
                 HeaderTime header_time = HeaderTime::kFirst);
  ~SequenceWriter();
  /// Times increase; all frames have as many vertices as the first. With kFloat32 every value must be a float32.
  void append(double time_s, const Points& points);
  [[nodiscard]] std::size_t frame_count() const;
  /// Makes a sequence of a folder that was begun with kLast. Throws Error(kFile) where somebody else has done so.
  void write_header();
  /// Forgets all frames from `count` on: a resumed run continues behind its checkpoint. Throws Error if fewer are
  /// listed.
  void truncate(std::size_t count);
  /// Removes what was written, and the folders that were made for it where nothing else is in them. To be called last.
  void discard() noexcept;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace selvage::io
