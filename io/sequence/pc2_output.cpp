// Writes PC2, float32 in little endian, and its base mesh as OBJ beside it. The cache appears last and whole.
#include <limits>
#include <utility>

#include "io/fail.h"
#include "io/file/atomic_file.h"
#include "io/point_cache.h"
#include "io/points.h"
#include "io/sequence/sequence_outputs.h"

namespace selvage::io {
namespace fs = std::filesystem;
namespace {

class Pc2Output final : public SequenceOutput {
 public:
  Pc2Output(fs::path file, OutputHeader all)
      : SequenceOutput(std::move(file), std::move(all)),
        base_(base_beside(target())),
        cache_(target()) {
    constexpr std::size_t kMax = std::numeric_limits<std::int32_t>::max();
    const auto& [sequence, vertex_count, frame_count] = header();
    if (frame_count > kMax || vertex_count > kMax) {
      bad_input(target().string(), "more than 2^31 - 1 frames or vertices; split the sequence");
    }
    require_absent(target());
    require_absent(base_);
    cache_.write(pc2_header(static_cast<std::uint32_t>(vertex_count), static_cast<std::uint32_t>(frame_count)));
  }
  std::vector<fs::path> sources() const override { return {target()}; }

 private:
  void write_frame(double, const MeshData& mesh) override {
    require_same_mesh(header(), mesh, OutputFormat::kPc2, target());
    std::string bytes;
    append_points(bytes, mesh.points, Precision::kFloat32, target().string());
    if (frame_count() == 0) written_.write(base_, obj_bytes(mesh, base_.string()));
    cache_.write(bytes);
  }
  void commit() override {
    cache_.commit_new();
    written_.keep();
  }

  fs::path base_;
  AtomicFile cache_;
  WrittenFiles written_;
};

}  // namespace

std::unique_ptr<SequenceOutput> create_pc2_output(fs::path target, OutputHeader header) {
  return std::make_unique<Pc2Output>(std::move(target), std::move(header));
}

}  // namespace selvage::io
