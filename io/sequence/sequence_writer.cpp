// Writes the sequence folder. Order on disk: a frame's file is renamed and synced before its line is appended and
// synced, and the header appears behind faces and list, so that whatever is listed is there at any instant of a kill.
#include <algorithm>
#include <cerrno>
#include <cmath>
#include <optional>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <sys/file.h>

#include "io/fail.h"
#include "io/file/atomic_file.h"
#include "io/file/checksum.h"
#include "io/file/posix_file.h"
#include "io/file/text.h"
#include "io/format/npy.h"
#include "io/points.h"
#include "io/sequence.h"
#include "io/sequence/sequence_json.h"
#include "io/sequence/sequence_readers.h"

namespace selvage::io {
namespace fs = std::filesystem;
namespace {

std::string frame_file(std::size_t index) {
  const std::string number = std::to_string(index);
  return "frame_" + std::string(number.size() < 6 ? 6 - number.size() : 0, '0') + number + ".npy";
}

void check_header(const SequenceHeader& header, const std::string& name) {
  check_is_surface(header.triangles, name);
  for (const auto& corners : header.triangles) {
    const bool repeated = corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0];
    if (repeated || *std::min_element(corners.begin(), corners.end()) < 0) {
      bad_input(name, "a face repeats a vertex or has a negative index; correct the faces");
    }
  }
  check_groups(header.groups, header.triangles.size(), name);
  require_one_role(header.groups, name);
  bool is_text = is_utf8(header.producer);
  for (const Group& group : header.groups) is_text = is_text && is_utf8(group.name);
  if (!is_text) bad_input(name, "a group's name or the producer is not UTF-8; rename it");
}

/// One writer a folder: the lock goes with the process, however it ends. Some network file systems have no locks
/// (ENOLCK, EOPNOTSUPP); to refuse all work there would help nobody, so those who write see to it (docs/formats.md).
PosixFile lock_folder(const fs::path& folder) {
  PosixFile handle(folder, O_RDONLY | O_DIRECTORY);
  if (::flock(handle.descriptor(), LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
    throw Error(ErrorKind::kFile, folder.string() + ": another run writes to this folder; choose another");
  }
  return handle;
}

/// Those of `folder` and the folders above it that are not there, the lowest first.
std::vector<fs::path> absent_folders(fs::path folder) {
  if (!folder.has_filename()) folder = folder.parent_path();  // of a name that ends in a slash
  std::vector<fs::path> absent;
  std::error_code status;
  for (; !folder.empty() && !fs::exists(folder, status); folder = folder.parent_path()) absent.push_back(folder);
  return absent;
}

fs::path create_folder(const fs::path& folder) {
  std::error_code status;
  fs::create_directories(folder, status);
  if (status) file_error(folder.string(), "create", status.value());
  return folder;
}

/// What killed runs left of this folder's own files, and of nobody else's.
void remove_temporaries(const fs::path& folder) {
  std::error_code status;
  for (fs::directory_iterator entry(folder, status), end; !status && entry != end; entry.increment(status)) {
    const std::string file = entry->path().filename().string();
    const bool is_ours = file.starts_with("frame_") || file.starts_with(kHeaderFile) || file.starts_with(kFacesFile) ||
                         file.starts_with(kFramesFile);
    std::error_code kept;
    if (is_ours && is_temporary_name(file)) fs::remove(entry->path(), kept);
  }
}

SequenceDescription describe(const SequenceHeader& header, std::uint32_t faces_crc32) {
  return {header.producer, header.kind, header.precision, header.groups, std::string(kFacesFile), faces_crc32};
}

/// Why frames of `now` cannot follow those of `before`.
std::string first_difference(const SequenceDescription& before, const SequenceDescription& now) {
  if (before.kind != now.kind) {
    const bool has_steps = before.kind == SequenceKind::kSteps;
    return has_steps ? "holds every step, and frames alone are to follow" : "holds frames, and every step is to follow";
  }
  if (before.precision != now.precision) {
    const bool is_float32 = before.precision == Precision::kFloat32;
    return is_float32 ? "holds float32, and float64 is to follow" : "holds float64, and float32 is to follow";
  }
  if (before.producer != now.producer) return "was recorded by " + before.producer + ", and this is " + now.producer;
  return "was recorded with other faces or groups";
}

}  // namespace

struct SequenceWriter::Impl {
  Impl(const fs::path& where, const SequenceHeader& header, bool resume, HeaderTime header_time)
      : made_folders((check_header(header, where.string()), absent_folders(where))),
        folder(create_folder(where)),
        lock(lock_folder(folder)),
        precision(header.precision) {
    for (const auto& corners : header.triangles) {
      for (const std::int32_t vertex : corners) {
        fewest_vertices = std::max(fewest_vertices, static_cast<std::size_t>(vertex) + 1);
      }
    }
    std::error_code status;
    if (!fs::exists(folder / kHeaderFile, status)) {
      begin(header, header_time);
    } else if (resume) {
      continue_from(header);
    } else {
      throw Error(ErrorKind::kFile, folder.string() + ": holds a sequence already; remove it, or resume it");
    }
  }

  void begin(const SequenceHeader& header, HeaderTime header_time) try {
    const std::string faces = npy_bytes(header.triangles);
    write_atomically(folder / kFacesFile, faces);
    rewrite_list();
    header_text = to_json(describe(header, crc32(faces)));
    if (header_text.size() > kLargestHeader) {  // which no reader would take
      bad_input(folder.string(), std::to_string(header.groups.size()) +
                                     " groups with their names do not fit into sequence.json (16 MiB); join groups, " +
                                     "or shorten their names");
    }
    if (header_time == HeaderTime::kFirst) write_header();
  } catch (...) {
    discard();
    throw;
  }

  void write_header() {
    AtomicFile file(folder / kHeaderFile);
    file.write(header_text);
    file.commit_new();
    has_written_header = true;
  }

  /// The header first: what lists no frame is no sequence. A folder that holds anything else stays, with that.
  void discard() noexcept {
    std::error_code status;
    if (has_written_header) fs::remove(folder / kHeaderFile, status);
    for (const std::string_view file : {kFramesFile, kFacesFile}) fs::remove(folder / file, status);
    for (const FrameRecord& frame : frames) fs::remove(folder / frame.file, status);
    fs::remove(folder / frame_file(frames.size()), status);  // renamed, and then not listed
    remove_temporaries(folder);
    for (const fs::path& made : made_folders) fs::remove(made, status);
  }

  void continue_from(const SequenceHeader& header) {
    const fs::path header_file = folder / kHeaderFile, faces_file = folder / kFacesFile,
                   list_file = folder / kFramesFile;
    const std::string faces = npy_bytes(header.triangles);
    const SequenceDescription now = describe(header, crc32(faces));
    const std::string text = read_file(header_file);
    if (text != to_json(now) || read_file(faces_file) != faces) {
      const SequenceDescription before = parse_sequence_json(text, header_file.string());
      bad_input(folder.string(), first_difference(before, now) + "; resume what was started here");
    }
    frames = parse_frame_list(read_file(list_file), list_file.string());
    for (const FrameRecord& frame : frames) check_recorded(frame);
    // The list itself is rewritten with the first change: who asked may find another reason not to go on.
  }

  /// A run must not be called complete whose earlier frames are gone: every frame on the list is read once.
  void check_recorded(const FrameRecord& frame) {
    constexpr const char* kRemedy = "; restore the file, or start again in another folder";
    const std::string name = (folder / frame.file).string();
    std::error_code status;
    if (!fs::exists(name, status)) bad_input(name, std::string("is on the list and not there") + kRemedy);
    const std::string bytes = read_file(name);
    if (frame.crc32 && crc32(bytes) != *frame.crc32) {
      bad_input(name, std::string("the checksum differs from the one recorded") + kRemedy);
    }
    const std::size_t found = parse_npy_points(bytes, name).points.size();
    if (vertex_count.value_or(found) != found) {
      bad_input(name, std::string("has another number of vertices than the first frame") + kRemedy);
    }
    vertex_count = found;
  }

  /// The folder's first change, and after failures. Atomically; drops the torn line that a kill or a failed append has
  /// left, and the frames that were truncated.
  void rewrite_list() {
    remove_temporaries(folder);
    std::string text;
    for (const FrameRecord& frame : frames) text += to_json(frame);
    write_atomically(folder / kFramesFile, text);
    list.emplace(folder / kFramesFile, O_WRONLY | O_APPEND);
  }

  void append(double time_s, const Points& points) {
    const fs::path file = folder / frame_file(frames.size());
    check_frame(time_s, points, file.string());
    if (!list) rewrite_list();
    const std::string bytes = npy_bytes(points, precision, file.string());
    write_atomically(file, bytes);
    FrameRecord record = {file.filename().string(), time_s, crc32(bytes)};
    PosixFile open_list = *std::exchange(list, std::nullopt);  // comes back only if the line is whole and on disk
    open_list.write(to_json(record));
    open_list.sync();
    list = std::move(open_list);
    frames.push_back(std::move(record));
    vertex_count = points.size();
  }

  void check_frame(double time_s, const Points& points, const std::string& name) const {
    if (!std::isfinite(time_s) || (!frames.empty() && !(time_s > frames.back().time_s))) {
      bad_input(name, "the frame is not later than the one before; append frames in order");
    }
    if (points.size() < fewest_vertices || (vertex_count && points.size() != *vertex_count)) {
      bad_input(name, std::to_string(points.size()) +
                          " vertices do not match the faces or the frames before; append one mesh");
    }
    if (const auto vertex = first_not_finite(points)) {
      bad_input(name, "vertex " + std::to_string(*vertex) + " is not finite; the run has failed");
    }
  }

  void truncate(std::size_t count) {
    if (count > frames.size()) {
      bad_input(folder.string(), "lists " + std::to_string(frames.size()) + " frames, " + std::to_string(count) +
                                     " are needed; start again");
    }
    std::vector<FrameRecord> dropped(frames.begin() + static_cast<std::ptrdiff_t>(count), frames.end());
    frames.resize(count);
    if (frames.empty()) vertex_count.reset();
    rewrite_list();
    std::error_code status;
    for (const FrameRecord& frame : dropped) fs::remove(folder / frame.file, status);
  }

  std::vector<fs::path> made_folders;  ///< absent before, the lowest first
  fs::path folder;
  PosixFile lock;
  Precision precision;
  std::size_t fewest_vertices = 0;  ///< that the faces need
  std::optional<std::size_t> vertex_count;
  std::vector<FrameRecord> frames;
  std::string header_text;
  bool has_written_header = false;
  std::optional<PosixFile> list;  ///< open for appending; absent before the first change, and after a failure
};

SequenceWriter::SequenceWriter(std::filesystem::path folder, const SequenceHeader& header, bool resume,
                               HeaderTime header_time)
    : impl_(std::make_unique<Impl>(folder, header, resume, header_time)) {}
SequenceWriter::~SequenceWriter() = default;
void SequenceWriter::append(double time_s, const Points& points) { impl_->append(time_s, points); }
std::size_t SequenceWriter::frame_count() const { return impl_->frames.size(); }
void SequenceWriter::write_header() { impl_->write_header(); }
void SequenceWriter::discard() noexcept { impl_->discard(); }
void SequenceWriter::truncate(std::size_t count) { impl_->truncate(count); }

}  // namespace selvage::io
