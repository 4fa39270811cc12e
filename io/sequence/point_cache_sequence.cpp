// A point cache with its base mesh as a sequence; a frame is read when it is asked for, so that the file may be larger
// than the memory.
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "io/fail.h"
#include "io/file/byte_order.h"
#include "io/file/fp_guard.h"
#include "io/format/polygon.h"
#include "io/mesh_reader.h"
#include "io/sequence/sequence_readers.h"

namespace selvage::io {
namespace {

class PointCacheSequence final : public SequenceReader {
 public:
  PointCacheSequence(std::shared_ptr<const ByteSource> source, PointCacheFormat format, MeshData base, std::string name)
      : source_(std::move(source)),
        name_(std::move(name)),
        header_(read_point_cache_header(*source_, format, name_)),
        counts_frames_(format == PointCacheFormat::kPc2),
        triangles_(std::move(base.triangles)),
        groups_(std::move(base.groups)),
        split_polygons_(base.split_polygons) {
    if (header_.vertex_count == base.points.size()) return;
    bad_input(name_, std::to_string(header_.vertex_count) + " vertices, the base mesh has " +
                         std::to_string(base.points.size()) + "; name the mesh that the cache was made of");
  }

  std::size_t frame_count() const override { return header_.frame_count; }
  SequenceKind kind() const override { return SequenceKind::kFrames; }
  Precision precision() const override { return Precision::kFloat32; }
  const std::vector<Group>& groups() const override { return groups_; }
  std::string frame_name(std::size_t frame) const override { return name_ + "[" + std::to_string(frame) + "]"; }
  double time(std::size_t frame) const override { return header_.times.at(frame); }
  bool counts_frames() const override { return counts_frames_; }
  bool same_faces_as_previous(std::size_t) const override { return true; }
  std::int64_t split_polygons() const override { return split_polygons_; }
  std::string remark() const override { return split_remark("the base mesh of " + name_, split_polygons_); }

  MeshData frame(std::size_t frame) const override {
    const FpGuard guard;
    if (frame >= header_.frame_count) throw std::out_of_range(frame_name(frame));
    const std::uint64_t offset = header_.data_offset + frame * header_.frame_size();
    const std::string data = source_->read(offset, header_.frame_size());
    Points points(header_.vertex_count);
    const char* item = data.data();
    for (std::size_t vertex = 0; vertex < points.size(); ++vertex) {
      for (double& x : points[vertex]) {
        x = static_cast<double>(load<float>(item, header_.order));
        if (!std::isfinite(x)) {
          bad_input_at_byte(name_, offset + static_cast<std::uint64_t>(item - data.data()),
                            "frame " + std::to_string(frame) + ", vertex " + std::to_string(vertex) +
                                " is not finite; repair the export");
        }
        item += sizeof(float);
      }
    }
    return {std::move(points), triangles_, groups_, Precision::kFloat32};
  }

 private:
  std::shared_ptr<const ByteSource> source_;
  std::string name_;
  PointCacheHeader header_;
  bool counts_frames_;
  Triangles triangles_;
  std::vector<Group> groups_;
  std::int64_t split_polygons_;  ///< of the base mesh
};

}  // namespace

std::filesystem::path find_base_mesh(const std::filesystem::path& cache) {
  for (const char* extension : {".obj", ".OBJ", ".ply", ".PLY"}) {
    std::filesystem::path candidate = cache;
    std::error_code status;
    if (std::filesystem::exists(candidate.replace_extension(extension), status)) return candidate;
  }
  bad_input(cache.string(), "has no faces, and no " + cache.stem().string() +
                                ".obj or .ply stands beside it; name the base mesh (--base)");
}

std::unique_ptr<SequenceReader> open_point_cache(std::shared_ptr<const ByteSource> source, PointCacheFormat format,
                                                 MeshData base, std::string name) {
  return std::make_unique<PointCacheSequence>(std::move(source), format, std::move(base), std::move(name));
}

}  // namespace selvage::io
